"""Sets of orbits against brute force: what the index cannot see is found, or said to be missing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator, find_orbits, period_map
from dynamics.flow.exact_flow import exact_flow
from dynamics.model.states import apart

# eight orbits with all sums of indices right, and others of period 3 in pairs of opposite index
PAIRS = GearOscillator(
    FourierStiffness(1.0, (0.08010601692892227,), (0.6752376256381849,)), 0.005545516578415041, 0.02999047808,
    0.5633999382442333, 0.9060678329228757, 0.9337342185542818,
)  # fmt: skip


def random_oscillator(seed: int) -> GearOscillator:
    r = np.random.default_rng(seed)
    return GearOscillator(
        FourierStiffness(1.0, (r.uniform(0, 0.5),), (r.uniform(-3, 3),)), 10 ** r.uniform(-2.3, -0.8),
        r.uniform(0, 0.3), r.uniform(0, 1.0), r.uniform(0.3, 1.5), r.uniform(0, 1),
    )  # fmt: skip


def newton(osc: GearOscillator, start: np.ndarray, n: int) -> np.ndarray | None:
    """Plain Newton's method from one start, by the period map alone."""
    at, flow = start, exact_flow(osc)
    for _ in range(30):
        image = period_map(flow, at, n)
        gap = image.state - at
        if np.max(np.abs(gap)) < 1e-12 * max(1.0, np.max(np.abs(image.jacobian))):
            return at
        slope = np.eye(2) - image.jacobian
        if abs(np.linalg.det(slope)) < 1e-300:  # between the flanks nothing holds the position
            return None
        step = np.linalg.solve(slope, gap)
        at = at + step * min(1.0, 1.0 / max(np.max(np.abs(step)), 1e-300))
        if np.max(np.abs(at)) > 1e3:
            return None
    return None


def missing(found, osc: GearOscillator, n: int, side: int) -> int:
    """Starts of a grid that lead to an orbit which is not in a set."""
    (x0, x1), (v0, v1) = found.region
    grid = np.stack(np.meshgrid(np.linspace(x0, x1, side), np.linspace(v0, v1, side)), -1).reshape(-1, 2)
    points = (newton(osc, start, n) for start in grid)
    known = [o.points for o in found.orbits if n % o.periods == 0]
    return sum(p is not None and not any(apart(p, o) < 1e-6 for o in known) for p in points)


def test_what_the_index_alone_passed_over_is_found():
    by_index = find_orbits(PAIRS, (1, 2, 3), batches=0)
    assert by_index.converged  # all sums are right
    found = find_orbits(PAIRS, (1, 2, 3))
    assert found.converged or "met once" in found.message
    assert len(found) >= len(by_index) + 4
    assert [c.points for c in found.counts] == [3, 13, 27]
    assert missing(found, PAIRS, 3, 12) == 0


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(40, 45))
def test_random_oscillators_against_brute_force(seed: int):
    """Sixty by sixty starts: none leads to an orbit that is missing and not said to be."""
    osc = random_oscillator(seed)
    found = find_orbits(osc, (1, 2, 3))
    gaps = sum(missing(found, osc, n, 60) for n in (1, 2, 3))
    assert gaps == 0 or not found.converged


# a 1-1-1 of ten times the size of the 1-1-0 that motions from rest come to
RESONANT = GearOscillator(
    FourierStiffness(1.0, (0.2266,), (2.7565,)), 0.0088, 0.367, (0.3634, 0.1604), 0.9497, 0.8619,
    free_damping_ratio=0.0708,
)  # fmt: skip


def later(osc: GearOscillator, angle: float) -> GearOscillator:
    """The same oscillator, tau = 0 an angle of the excitation later."""
    errors, stiffness = osc.error_series, osc.stiffness
    turned = tuple(p + j * angle for j, p in enumerate(stiffness.phases, 1))
    phases = errors[1] + angle * np.arange(1, errors.shape[1] + 1)
    moved = replace(osc, stiffness=replace(stiffness, phases=turned))
    return replace(moved, error_amplitude=tuple(errors[0]), error_phase=tuple(phases))


@pytest.fixture(scope="module")
def resonant():
    return find_orbits(RESONANT, (1, 2, 3))


@pytest.mark.parametrize("part", [0.125, 0.5, "half a cell"])
def test_orbits_do_not_hang_on_where_the_period_begins(resonant, part):
    """The region covers motions at all times of the period, and grows with the orbits found."""
    angle = np.pi / np.ceil(RESONANT.cells) if part == "half a cell" else 2.0 * np.pi * part
    here, there = resonant, find_orbits(later(RESONANT, angle), (1, 2, 3))
    assert here.converged
    assert there.converged
    assert sorted(o.label for o in here.orbits) == ["1-1-0", "1-1-1", "U1-1-1"]
    assert sorted(o.label for o in there.orbits) == ["1-1-0", "1-1-1", "U1-1-1"]
    assert np.array(there.region) == pytest.approx(np.array(here.region), rel=1e-2)
    for mine, other in zip(*(sorted(r.orbits, key=lambda o: o.label) for r in (here, there)), strict=True):
        assert mine.multipliers == pytest.approx(other.multipliers, abs=1e-9)


def test_a_region_that_is_given_stays():
    found = find_orbits(RESONANT, 1, ((-0.3, 0.3), (-0.3, 0.3)), starts=3, batches=0)
    assert found.region == ((-0.3, 0.3), (-0.3, 0.3))
