"""What figures are compared with for their errors is solved when an error is first asked for."""

from __future__ import annotations

import pickle

import pytest

import fem
from base import RangeWarning, SolverError
from fem.cycle.events import ContactProblem


@pytest.fixture
def asked(monkeypatch):
    """Meshes on which arcs like known ones were asked for."""
    levels, alike = [], ContactProblem._alike

    def counted(problem, bodies, known):
        levels.append(bodies.level)
        return alike(problem, bodies, known)

    monkeypatch.setattr(ContactProblem, "_alike", counted)
    return levels


def test_figures_alone_solve_no_other_mesh(article_pair, article_bodies, asked):
    cycle = fem.mesh_cycle(article_pair, 600.0, 8, article_bodies, reference="body")
    assert cycle.transmission_error_range > 0.0
    assert cycle.mean_stiffness > 0.0
    assert not asked
    assert 0.0 < cycle.errors["transmission_error_range"] < 0.01
    assert cycle.errors["mean_stiffness"] > 0.0
    assert asked == ["coarse"]


def test_copies_that_are_pickled_have_the_errors(article_pair, article_bodies, asked):
    copy = pickle.loads(pickle.dumps(fem.mesh_cycle(article_pair, 600.0, 8, article_bodies)))
    assert asked == ["coarse"]
    assert copy.errors["mean_stiffness"] > 0.0
    assert asked == ["coarse"]


def test_errors_are_unknown_where_the_other_mesh_has_no_solution(article_pair, article_bodies, monkeypatch):
    def refused(problem, bodies, known):
        raise SolverError("teeth come apart")

    cycle = fem.mesh_cycle(article_pair, 600.0, 8, article_bodies, reference="body")
    monkeypatch.setattr(ContactProblem, "_alike", refused)
    assert cycle.transmission_error_range > 0.0
    with pytest.warns(RangeWarning, match="errors of the mesh cycle are unknown: teeth come apart"):
        assert cycle.errors["transmission_error_range"] is None
    assert cycle.stiffness_harmonics_error is None
    assert cycle.stiffness_harmonics[0] > 0.0
    with pytest.raises(SolverError, match="teeth come apart"):
        _ = cycle.arcs.compared
