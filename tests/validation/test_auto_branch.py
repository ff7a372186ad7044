"""Special points of the lubricated scan by AUTO-07p 0.9.2 (orthogonal collocation), with a smoothed backlash.

Printed by benchmarks/studies/auto_branches.py, which needs AUTO and a Fortran compiler: 200 intervals of four
collocation points a period, steps of at most 0.001, special points to EPSS = 1e-9. The law of AUTO is that of
`SmoothedBacklash`, so that the stepwise flow must find the same points at the same width; at no width it is the exact
flow's.
"""

from __future__ import annotations

import itertools

import pytest

from dynamics import SmoothedBacklash, SmoothOscillator, continue_branch, find_orbit
from tests.validation.article_motion import lubricated

WIDTHS = (0.004, 0.002, 0.001, 0.0005)
FOLDS = {
    "upper fold": (0.65521098817, 0.65548525105, 0.65555331597, 0.65557030375),
    "lower fold, beside the touch of the back flank": (
        0.57021276962,
        0.56968004953,
        0.56948522677,
        0.56942379276,
    ),
    "fold at 0.934": (0.93420145013, 0.93419994093, 0.93419956169, 0.93419946900),
    "fold at 0.869": (0.86949628117, 0.86930101189, 0.86925216391, 0.86923994907),
}
DOUBLING = (0.90250831808, 0.89515456185, 0.89118975153, 0.88905150364)

SOLVED = 1e-8
"""Ten times AUTO's EPSS."""


def special(orbit, kind: str) -> list[float]:
    whole = continue_branch(orbit, "frequency", (0.5, 0.95))
    assert whole.converged
    return [point.parameter for point in whole.points if point.kind == kind]


@pytest.fixture(scope="module")
def start():
    return find_orbit(lubricated(0.5), (0.4, 0.0))


@pytest.mark.parametrize(
    "number", [pytest.param(i, marks=() if width == 0.001 else pytest.mark.slow) for i, width in enumerate(WIDTHS)]
)  # fmt: skip
def test_the_stepwise_flow_finds_what_auto_finds(start, number):
    """With corners of s = 0.0005 AUTO's mesh leaves 1e-7 at the doubling; the folds are to the tolerance there too."""
    osc = lubricated(0.5)
    law = SmoothedBacklash(stiffness=osc.stiffness, half_backlash=osc.half_backlash, width=WIDTHS[number])
    rounded = SmoothOscillator(law, osc.damping_ratio, osc.mean_force, osc.error_amplitude, 0.5)
    orbit = find_orbit(rounded, start.state, tolerance=1e-10)
    assert special(orbit, "saddle-node") == pytest.approx(
        [values[number] for values in FOLDS.values()], abs=SOLVED
    )
    mesh = 1e-6 if WIDTHS[number] < 0.001 else SOLVED
    assert special(orbit, "period-doubling") == pytest.approx([DOUBLING[number]], abs=mesh)


def test_auto_tends_to_the_exact_flow(start):
    """Folds extrapolated by s^2 and s^4 differ from the exact ones by less than the last power has changed them.

    The lower fold's motion swings past the touch of the back flank by little more than s, so that its powers begin
    late: it must come nearer with each width. So must the doubling, which lies 9e-4 behind a grazing and converges
    like s.
    """
    exact = special(start, "saddle-node")
    for (name, values), value in zip(FOLDS.items(), exact, strict=True):
        if "touch" in name:
            off = [abs(one - value) for one in values]
            assert all(fine < 0.4 * coarse for coarse, fine in itertools.pairwise(off)), name
            continue
        first = [(4 * fine - coarse) / 3 for coarse, fine in itertools.pairwise(values)]
        second = (16 * first[-1] - first[-2]) / 15
        assert abs(second - value) < abs(second - first[-1]) + SOLVED, name
    (doubling,) = special(start, "period-doubling")
    off = [one - doubling for one in DOUBLING]
    assert all(0.0 < fine < 0.6 * coarse for coarse, fine in itertools.pairwise(off))
