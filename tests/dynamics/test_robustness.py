"""Derivatives of special points against differences; forces of motions against exact ones."""

from __future__ import annotations

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator, continue_branch, find_orbit, special_sensitivities
from dynamics.flow.motions import force_range

OSC = GearOscillator(FourierStiffness(1.0, (0.18, 0.02), (0.1, -0.4)), 0.05, 0.1, 0.2, 0.5, 0.2, 0.05)


def points(osc: GearOscillator):
    branch = continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.5, 1.0))
    return {(p.kind, i): p for kind in ("saddle-node", "grazing") for i, p in enumerate(branch.special(kind))}


@pytest.mark.parametrize(
    "name",
    ["mean_force", "error_amplitude", "half_backlash", "stiffness.amplitudes[1]", "stiffness.phases[0]"],
)
def test_special_points_move_as_the_derivatives_say(name: str):
    """Grazing and folds of two neighbouring oscillators, differenced: 1e-6 of the parameter apart."""
    step, value = 1e-6, OSC.get(name)
    lower, upper = (points(OSC.with_parameter(name, value + s * step)) for s in (-1.0, 1.0))
    middle = points(OSC)
    assert len(middle) >= 3
    for key in list(middle)[:3]:
        slope = special_sensitivities(OSC, "frequency", middle[key], [name])[name]
        moved = (upper[key].parameter - lower[key].parameter) / (2.0 * step)
        assert slope == pytest.approx(moved, rel=2e-4, abs=2e-6)


def test_all_parameters_by_default():
    found = special_sensitivities(OSC, "frequency", next(iter(points(OSC).values())))
    assert set(found) == set(OSC.parameters) - {"frequency"}
    assert all(np.isfinite(v) for v in found.values())


def test_force_of_a_motion_at_rest():
    """kappa F_m = eps omega^2 in phase: X = D + F_m is at rest, and the force is F_m (1 + kappa cos)."""
    still = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.3, 0.2)
    found = force_range(still, (0.3, 0.0))
    assert (found.least, found.greatest) == pytest.approx((0.82, 1.18), abs=1e-12)
