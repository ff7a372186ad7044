"""The search for the meniscus of an oil layer: failing trials are no bounds of the root."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from ehl.solving.meniscus import MeniscusSearch

ROOT = math.log(3e-5)
MOST = 40


def flow(where: float) -> float:
    """Ln(flow/layer) as contacts have it: steeper near the edge of the dry contact, level where it is flooded."""
    return math.tanh(0.6 * (where - ROOT)) if where > ROOT else 1.2 * (where - ROOT)


def found(start: float, solvable: Callable[[float, float], bool]) -> MeniscusSearch:
    search = MeniscusSearch.at(math.exp(start), flow(start))
    for _ in range(MOST):
        if search.done or search.stuck:
            break
        if solvable(search.ln_distance, search.target):
            search.solved(flow(search.target))
        else:
            search.failed()
    return search


@pytest.mark.parametrize("reach", [math.inf, 0.5, 0.15])
@pytest.mark.parametrize("off", [-6.0, -0.6, 0.6, 5.0])
def test_the_root_is_found_where_starts_reach_but_so_far(off: float, reach: float):
    """Newton's method has to start close by: places beyond fail, those between and the root do not."""
    off = math.copysign(min(abs(off), 8 * reach), off)
    search = found(ROOT + off, lambda where, target: abs(target - where) <= reach)
    assert search.done
    assert search.ln_distance == pytest.approx(ROOT, abs=1e-9)


def test_a_place_that_failed_once_is_no_bound_of_the_root():
    """Trials between start and root fail now and then, whatever the step: the root lies beyond them."""
    tried: list[float] = []

    def solvable(where: float, target: float) -> bool:
        tried.append(target)
        return len(tried) not in (1, 2, 4, 5)

    search = found(ROOT - 0.9, solvable)
    assert search.done
    assert min(tried[:5]) < search.ln_distance


def test_a_flow_that_is_known_roughly_is_no_bound_of_the_root():
    """A film solved in part seems to carry too much where the film itself carries too little: the root lies beyond."""
    root = ROOT + 0.05
    search = MeniscusSearch.at(math.exp(ROOT), -5e-4, slope=0.02)
    search.solved(2e-5, rough=True)
    assert search.ln_distance < root
    for _ in range(MOST):
        if search.done:
            break
        search.solved(0.01 * (search.target - root))
    assert search.done
    assert search.ln_distance == pytest.approx(root, abs=1e-8)


def test_the_search_ends_where_no_place_can_be_solved():
    search = found(ROOT + 1.0, lambda where, target: False)
    assert search.stuck
    assert not search.done
    assert search.ln_distance == ROOT + 1.0


def test_rounding_of_the_place_bounds_what_is_asked_of_the_flow():
    """At 1e-7 half-widths the place -1 - d is held to 2e-9 of d."""
    search = MeniscusSearch.at(1e-7, 2e-9)
    assert search.done
    assert not MeniscusSearch.at(1e-7, 1e-8).done
    assert not MeniscusSearch.at(1e-3, 2e-9).done


def test_a_slope_that_is_known_leads_to_the_root_at_once():
    search = MeniscusSearch.at(3e-5 * math.exp(-0.01), -0.012, slope=1.2)
    assert search.target == pytest.approx(ROOT, abs=1e-12)
    assert search.step == pytest.approx(0.01)


def test_a_better_solution_at_the_same_place_aims_anew():
    search = MeniscusSearch.at(1e-3, 0.1, slope=0.5)
    search.solved(1e-12)
    assert search.done
    search.corrected(1e-6)
    assert not search.done
    assert search.step != 0.0
