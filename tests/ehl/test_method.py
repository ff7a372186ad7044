"""The numbers of the method: they are those of the page, and decide answers that tests can see."""

from __future__ import annotations

import re
from dataclasses import asdict
from pathlib import Path

import pytest

from ehl import solve
from ehl.discrete.collocation import lobatto
from ehl.discrete.method import METHOD
from ehl.discrete.newton import newton
from ehl.films.solver import Options, solve_checked
from tests.validation.article import PITCH

PAGE = Path(__file__).parents[2] / "docs" / "theory" / "ehl.md"


def test_the_page_has_the_numbers_in_use():
    rows = dict(re.findall(r"^\| `(\w+)` \| (\S+) \|", PAGE.read_text(encoding="utf-8"), re.MULTILINE))
    assert {name: str(value) for name, value in asdict(METHOD).items()} == {
        name: rows[name] for name in asdict(METHOD)
    }


def test_the_first_grid_and_its_double_are_solved_first():
    """Two grids from cold: 65 nodes, and 129 from them."""
    loose = solve_checked(PITCH, Options(0.2).checked(PITCH), None)
    assert (loose.coarse.grid.nodes.size, loose.fine.grid.nodes.size) == (65, 129)
    assert (METHOD.first_nodes, lobatto().zeta.size) == (65, 11)


@pytest.mark.filterwarnings("ignore:Hertz pressure")
def test_a_flooded_inlet_is_forty_of_its_scale_long():
    """In sqrt(H_c) half-widths ahead of the dry contact, for the film that is expected."""
    found = solve_checked(PITCH, Options(0.01).checked(PITCH), None)
    plan = found.fine.plan
    assert (-1.0 - plan.domain[0]) / plan.H_c**0.5 == pytest.approx(40.0, rel=0.01)


@pytest.mark.filterwarnings("ignore:Hertz pressure")
def test_the_last_step_leaves_rounding():
    """A film continued from its end to steps a thousand times smaller moves by less than 1e-9."""
    level = solve_checked(PITCH, Options(0.01).checked(PITCH), None).fine
    on = newton(level.grid, level.groups, level.solution.P, level.solution.H0, done=1e-3 * METHOD.newton_done)
    assert pytest.approx(level.solution.H0, rel=1e-9) == on.H0
    assert solve(PITCH, nodes=129).flux_error < 1e-8
