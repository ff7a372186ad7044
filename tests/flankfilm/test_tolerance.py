"""The split of a tolerance: sums, costs no more than any other split, and grows with what there is to split."""

from __future__ import annotations

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from flankfilm.coupling.mesh.tolerance import CostLaw, split, step_below
from flankfilm.report.run_parts import decisions
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from tests.flankfilm.scenes import CLOSED_FORMS_WITH_FILM

positive = st.floats(1e-6, 1e-1)
laws = st.lists(
    st.builds(
        CostLaw,
        st.sampled_from("abcde"),
        coarsest=positive,
        seconds=st.floats(1e-3, 1e3),
        power=st.floats(0.2, 4.0),
        finest=st.sampled_from([0.0, 1e-8, 5e-7]),
    ),
    min_size=1,
    max_size=5,
    unique_by=lambda law: law.name,
)
tolerances = st.floats(1e-5, 0.3)


def costs(some, errors):
    return math.fsum(law.cost(e) for law, e in zip(some, errors, strict=True))


@given(laws, tolerances)
def test_shares_sum_to_the_tolerance(some, tolerance):
    found = split(tolerance, some)
    assert found is not None
    assert math.fsum(found.values()) == pytest.approx(tolerance, rel=1e-12)
    assert all(e >= law.finest for law, e in zip(some, found.values(), strict=True))


@given(laws, tolerances, st.lists(st.floats(0.01, 1.0), min_size=5, max_size=5))
def test_no_other_split_costs_less(some, tolerance, weights):
    """Equal shares among them."""
    found = split(tolerance, some)
    assert found is not None
    for tried in (weights[: len(some)], [1.0] * len(some)):
        other = [tolerance * w / math.fsum(tried) for w in tried]
        assume(all(e >= law.finest for law, e in zip(some, other, strict=True)))
        assert costs(some, found.values()) <= costs(some, other) * (1 + 1e-9)


@given(laws, tolerances, st.floats(1.0, 10.0))
def test_more_to_split_leaves_no_stage_less_and_costs_no_more(some, tolerance, factor):
    less, more = split(tolerance, some), split(factor * tolerance, some)
    assert less is not None
    assert more is not None
    assert all(b >= a * (1 - 1e-9) for a, b in zip(less.values(), more.values(), strict=True))
    assert costs(some, more.values()) <= costs(some, less.values()) * (1 + 1e-9)


def test_two_stages_of_one_power_have_lagranges_shares():
    """With c = s (e/e0)^-p for both, e_i ~ (s_i e0_i^p)^(1/(1+p))."""
    some = [CostLaw("a", 0.1, 1.0, 0.5), CostLaw("b", 0.1, 8.0, 0.5)]
    found = split(1e-3, some)
    assert found is not None
    assert found["b"] / found["a"] == pytest.approx(8.0 ** (1 / 1.5), rel=1e-9)
    assert list(found) == ["a", "b"]


def test_a_stage_at_its_coarsest_leaves_the_rest_to_the_other():
    cheap, dear = CostLaw("cheap", 1e-4, 0.1, 1.0), CostLaw("dear", 0.5, 100.0, 1.0)
    found = split(1e-2, [cheap, dear])
    assert found is not None
    assert found["cheap"] <= 1e-4 * (1 + 1e-9)
    assert found["dear"] > 0.98e-2


def test_what_no_stage_reaches_is_not_split():
    assert split(1e-6, [CostLaw("a", 1e-3, 1.0, 1.0, finest=1e-6)]) is None
    none = split(1e-3, [])
    assert none is not None
    assert len(none) == 0


@given(st.floats(1e-9, 1.0))
def test_steps_lie_below_by_less_than_a_factor_of_two_and_a_half(share):
    step = step_below(share)
    assert step <= share * (1 + 1e-9)
    assert share < 2.5 * step * (1 + 1e-9)
    assert step_below(step) == step


MOTION_ALONE = """
wants = ["sweep"]
[stiffness]
model = "given"
amplitudes = [0.18]
[dynamics]
mean_force = 0.1
error_amplitude = 0.2
half_backlash = 0.2
sweep = { frequency = [0.5, 0.7], points = 3 }
"""


@pytest.mark.parametrize("wanted", [True, False])
def test_the_report_tells_how_a_tolerance_was_split_where_it_was(wanted):
    text = CLOSED_FORMS_WITH_FILM if wanted else MOTION_ALONE
    parts = decisions(run_scene(parse_scene(text), None))
    heads = [table.heads[0] for part in parts for table in part.tables]
    assert ("share of the tolerance" in heads) == wanted
