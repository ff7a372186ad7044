import math
from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from ehl import LineContact, solve
from ehl.discrete.grid import graded_nodes
from tests.ehl.films import quiet
from tests.validation.article import PITCH

M20 = LineContact.from_moes(20.0, 10.0)


def test_nodes_around_a_spike_are_nested_and_as_fine_as_it():
    spike = (0.9029, 2e-6)
    X = graded_nodes(0.15, 129, (-15.0, 2.5), spike)
    np.testing.assert_allclose(graded_nodes(0.15, 257, (-15.0, 2.5), spike)[::2], X, rtol=1e-9)
    assert (np.diff(X) > 0).all()
    assert np.min(np.diff(X)) < 2e-6
    assert np.max(np.abs(np.diff(np.log(np.diff(X))))) < 0.7


def test_a_spike_asked_for_is_resolved():
    film = quiet(M20, spike=0.01)
    assert film.spike.error < 0.01
    fine = quiet(M20, nodes=1025, spike=0.01)
    assert film.spike.pressure == pytest.approx(fine.spike.pressure, rel=0.01)
    assert film.spike.position == pytest.approx(fine.spike.position, abs=1e-3 * M20.half_width)
    # several nodes on the tip
    near = np.abs(film.x - film.spike.position) < film.spike.width
    assert near.sum() >= 4
    # and without being asked for, its error is not claimed
    assert math.isnan(quiet(M20).spike.error)


def test_a_contact_without_a_spike():
    film = quiet(LineContact.from_moes(2.0, 1.0), spike=0.01)
    assert film.converged
    assert film.spike is None


def test_an_incompressible_spike_that_does_not_settle_is_refused():
    film = quiet(LineContact.from_moes(20.0, 10.0, compressible=False), spike=0.01)
    assert not film.converged
    assert "leave out spike" in film.message


def test_stiffness_on_a_grid_around_the_spike():
    film, step = quiet(PITCH, spike=0.01), 0.02
    light, heavy = (quiet(replace(PITCH, load=PITCH.load * f), tolerance=5e-4) for f in (1 - step, 1 + step))
    change = 2 * step * PITCH.load
    assert film.stiffness() == pytest.approx(-change / (heavy.separation - light.separation), rel=0.01)
    tangent = -change / (heavy.central_thickness - light.central_thickness)
    assert film.stiffness("tangent") == pytest.approx(tangent, rel=0.01)


def test_uniform_grids_follow_no_spike():
    with pytest.raises(InputError, match="graded grid"):
        solve(M20, grid="uniform", domain=(-4, 1.5), spike=0.01)


def test_the_grid_of_the_article():
    film = quiet(PITCH, grid="article")
    b = PITCH.half_width
    assert film.x.size == 130
    np.testing.assert_allclose(film.x / b, np.linspace(-4.0, 1.2, 130), atol=1e-12)
    assert film.central_moes == pytest.approx(5.8562, rel=0.005)
    with pytest.raises(InputError, match="130 nodes"):
        solve(PITCH, grid="article", nodes=65)
