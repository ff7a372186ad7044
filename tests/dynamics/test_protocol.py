"""One protocol: any oscillator is taken by what needs no more, and refused by name by the rest."""

from __future__ import annotations

import numpy as np
import pytest

import dynamics
from base import InputError, quantities
from dynamics import FourierStiffness, GearOscillator, PowerContact, SmoothOscillator
from dynamics.flow.flows import flow_of

SERIES = FourierStiffness(1.0, (0.18,), (0.0,))
EXACT = GearOscillator(SERIES, 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
STEPWISE = SmoothOscillator(
    PowerContact(stiffness=SERIES, half_backlash=0.2, exponent=1.0), 0.05, 0.1, 0.2, 0.6
)


@pytest.mark.slow
def test_basins_are_those_of_the_exact_flow():
    ours, theirs = (
        dynamics.basins(o, x=(-0.9, 0.9, 4), v=(-0.9, 0.9, 4), limit=60) for o in (STEPWISE, EXACT)
    )
    assert np.array_equal(ours.labels, theirs.labels)
    for mine, other in zip(ours.attractors, theirs.attractors, strict=True):
        assert mine.label == other.label
        assert mine.orbit.state == pytest.approx(other.orbit.state, abs=1e-7)


@pytest.mark.slow
def test_scan_of_exponents_is_that_of_the_exact_flow():
    ours, theirs = (
        dynamics.lyapunov_scan(o, "frequency", [0.5, 0.7], 60, transient=60) for o in (STEPWISE, EXACT)
    )
    assert ours.exponents == pytest.approx(theirs.exponents, abs=1e-5)
    assert ours.defect < 1e-6


@pytest.mark.parametrize("osc", [STEPWISE, EXACT], ids=["stepwise", "exact"])
def test_stretches_go_through_the_images_of_the_map(osc):
    """State after every period; the two growths together are those of areas, exp(-2 zeta T) a period."""
    sizes = [2, 3]
    found = flow_of(osc).stretches(np.array([0.5, 0.2]), sizes, keep=True)
    state, images = np.array([0.5, 0.2]), []
    for _ in range(sum(sizes)):
        state = dynamics.period_map(osc, state).state
        images.append(state)
    assert found.states == pytest.approx(np.array(images), abs=1e-7)
    assert found.logs.sum(axis=1) == pytest.approx(-2.0 * 0.05 * osc.period * np.array(sizes), abs=1e-7)
    last = flow_of(osc).stretches(np.array([0.5, 0.2]), sizes)
    assert last.states == pytest.approx(np.array(images[-1:]), abs=1e-7)


def test_states_at_rest_agree():
    assert STEPWISE.rest_state() == pytest.approx(EXACT.rest_state(), abs=1e-12)


@pytest.mark.parametrize(
    ("name", "more", "allowed"),
    [
        ("find_orbits", (), "GearOscillator or a DriveOscillator"),
        ("diagram", (), "GearOscillator or a DriveOscillator"),
        ("multi_sweep", ("frequency", [0.5]), "GearOscillator or a DriveOscillator"),
        ("contact_grazing", (), "GearOscillator or a DriveOscillator"),
        ("continue_locus", (None, ("frequency", "mean_force")), "GearOscillator or a DriveOscillator"),
    ],
)
def test_what_needs_the_exact_flow_says_so(name, more, allowed):
    with pytest.raises(InputError, match=f"must be a {allowed} in {name}") as raised:
        getattr(dynamics, name)(STEPWISE, *more)
    assert "SmoothOscillator" in str(raised.value)


def test_unstable_manifolds_are_those_of_the_exact_flow():
    ours, theirs = (
        dynamics.manifold(dynamics.find_orbit(o, (0.5, 0.2)), "unstable", length=0.1)
        for o in (STEPWISE, EXACT)
    )
    assert len(theirs.curves) == len(ours.curves) == 2
    by_end = [sorted(curves, key=lambda curve: curve[-1, 0]) for curves in (ours.curves, theirs.curves)]
    for mine, other in zip(*by_end, strict=True):
        assert mine == pytest.approx(other, abs=1e-6)


def test_a_stable_manifold_asks_for_the_flow_backwards():
    orbit = dynamics.find_orbit(STEPWISE, (0.5, 0.2))
    with pytest.raises(InputError, match="its flow backwards in time is missing"):
        dynamics.manifold(orbit)


def test_exact_flow_names_what_gives_derivatives_and_extrema():
    with pytest.raises(InputError, match="map_derivatives"):
        dynamics.period_map(EXACT, (0.5, 0.2), parameters=("frequency",))
    with pytest.raises(InputError, match="turning_points"):
        dynamics.period_map(EXACT, (0.5, 0.2), extrema=True)


def test_what_has_no_flow_is_refused():
    with pytest.raises(InputError, match="must be a GearOscillator, a SmoothOscillator or a DriveOscillator"):
        dynamics.find_orbit(SERIES, (0.5, 0.2))


@pytest.mark.parametrize("oscillator", [EXACT, STEPWISE], ids=["exact", "stepwise"])
def test_results_describe_their_figures(oscillator):
    orbit = dynamics.find_orbit(oscillator, (0.5, 0.2))
    results = (
        orbit,
        dynamics.period_map(oscillator, (0.5, 0.2)),
        dynamics.trajectory(oscillator, (0.5, 0.2), 1, 10),
        dynamics.continue_branch(orbit, "frequency", (0.59, 0.61)),
        dynamics.sweep(oscillator, "frequency", [0.6], transient=20),
        dynamics.lyapunov_exponents(oscillator, 20, transient=0),
    )
    for result in results:
        assert len(repr(result)) <= 200
        assert result.error is not None
        assert result.cost.seconds > 0.0
        assert isinstance(result.converged, bool)
        assert isinstance(result.message, str)
        assert all(q.figure.meaning for q in quantities(result).values())


def test_boundaries_are_those_of_the_exact_flow():
    counts = []
    for oscillator in (EXACT, STEPWISE):
        reached = dynamics.basins(oscillator, (-1.0, 1.0, 5), (-1.0, 1.0, 5), limit=300)
        box = ((-1.0, 1.0), (-1.0, 1.0))
        boundary = dynamics.basin_boundary(oscillator, reached.attractors, box, cells=2, levels=1, limit=300)
        counts.append(boundary.counts.tolist())
    assert counts[0] == counts[1]
    assert counts[0][-1] > 0
