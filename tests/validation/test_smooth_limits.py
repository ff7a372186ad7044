"""The stepwise flow against values of others: Mathieu's equation, the exact flow as rounded corners sharpen."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import dynamics
from dynamics import (
    FourierStiffness,
    GearOscillator,
    PowerContact,
    SmoothedBacklash,
    SmoothOscillator,
    continue_branch,
    find_orbit,
    period_map,
)

TRACES = [  # mpmath at 30 digits, as in test_mathieu
    (1.0, 0.5, -2.61241890662466),
    (2.5, 1.0, -0.0967523027869283),
    (10.0, 5.0, -2.52325769871579),
    (25.0, 25.0, 68.4002947420419),
]
WIDTHS = (0.008, 0.004, 0.002)


@pytest.mark.parametrize(("a", "q", "trace"), TRACES)
def test_mathieu(a, q, trace):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        series = FourierStiffness(a, (2.0 * q,), (np.pi,))
    law = PowerContact(stiffness=series, half_backlash=0.0, exponent=1.0)
    osc = SmoothOscillator(law, 0.0, 0.0, 0.0, 2.0)
    done = period_map(osc, (0.3, 0.1), tolerance=1e-14)
    assert np.trace(done.jacobian) == pytest.approx(trace, rel=1e-11)
    assert np.linalg.det(done.jacobian) == pytest.approx(1.0, abs=1e-11)


def special(kind: str, start: float, guess, bounds) -> tuple[float, list[float]]:
    """Parameter of the first point of a kind, exact and with rounded corners."""
    series = FourierStiffness(1.0, (0.18,), (0.0,))
    osc = GearOscillator(series, 0.05, 0.1, 0.2, start, half_backlash=0.2)
    orbit = dynamics.find_orbit(osc, guess, transient=200)
    exact = dynamics.continue_branch(orbit, "frequency", bounds).special(kind)[0].parameter
    found = []
    for width in WIDTHS:
        law = SmoothedBacklash(stiffness=series, half_backlash=0.2, width=width)
        rounded = find_orbit(SmoothOscillator(law, 0.05, 0.1, 0.2, start), orbit.state, tolerance=1e-10)
        branch = continue_branch(rounded, "frequency", bounds, step=0.02, max_step=0.05)
        found.append(branch.special(kind)[0].parameter)
    return exact, found


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "start", "guess", "bounds", "value"),
    [
        ("saddle-node", 0.64, (0.42, 0.0), (0.63, 0.66), 0.655575963789112),
        ("period-doubling", 1.8, (0.3, 0.3), (1.75, 1.82), 1.768675048829),
    ],
)
def test_rounded_corners_converge_to_the_exact_flow(kind, start, guess, bounds, value):
    """The error of a fold or a period doubling falls with the square of the width; the rest extrapolates to nothing."""
    exact, found = special(kind, start, guess, bounds)
    assert exact == pytest.approx(value, abs=1e-11)
    errors = np.abs(np.array(found) - exact)
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=0.3)
    assert errors[1] / errors[2] == pytest.approx(4.0, abs=0.15)
    assert abs((4 * found[2] - found[1]) / 3 - exact) < 3e-6
