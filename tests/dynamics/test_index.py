"""What the indices of fixed points add up to: turns counted on a circle against the linear equation and searches."""

from __future__ import annotations

import dataclasses

import pytest

from dynamics import FourierStiffness, GearOscillator, find_orbits
from dynamics.orbits.index import index_at_infinity, winding


def oscillator(frequency: float, kappa: float, **changes) -> GearOscillator:
    osc = GearOscillator(FourierStiffness(1.0, (kappa,), (0.0,)), 0.05, 0.1, 0.2, frequency, 0.2)
    return dataclasses.replace(osc, **changes)


@pytest.mark.parametrize(
    ("frequency", "kappa", "n", "index"), [(0.6, 0.18, 1, 1), (1.1, 0.18, 3, 1), (2.0, 0.6, 1, 1), (2.0, 0.6, 2, -1)]
)  # fmt: skip
def test_turns_on_a_circle_are_those_of_the_linear_equation(frequency, kappa, n, index):
    """With backlash on both sides; the last is in the principal resonance, where the multiplier is below -1."""
    osc = oscillator(frequency, kappa)
    assert index_at_infinity(osc, n) == index
    assert winding(osc, n, 1e3) == index


@pytest.mark.parametrize(("frequency", "kappa"), [(0.6, 0.18), (1.1, 0.18), (2.0, 0.6)])
def test_one_sided_backlash_with_force_has_index_one(frequency, kappa):
    """The force brings every motion back, so that Brouwer's theorem asks for 1; the orbits found add up to it."""
    osc = oscillator(frequency, kappa, one_sided=True)
    found = find_orbits(osc, (1, 2, 3))
    assert found.converged, found.message
    assert [c.expected for c in found.counts] == [1, 1, 1]
    if frequency == 0.6:
        assert len(found) == 3  # two nodes and a saddle: the count is not that of a lone orbit


def test_force_that_parts_the_flanks_leaves_no_orbit():
    osc = oscillator(0.6, 0.18, one_sided=True, mean_force=-0.1)
    assert index_at_infinity(osc, 1) == 0
    assert len(find_orbits(osc, (1,))) == 0


def test_without_force_there_is_no_index():
    assert index_at_infinity(oscillator(0.6, 0.18, one_sided=True, mean_force=0.0), 1) is None
