"""Base pitches that differ, under load: the sawtooth without load, what rounds it, motion and shares of pairs."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import fem
from base import InputError
from flankfilm.coupling import (
    Flanks,
    LoadedTeeth,
    UnequalPitches,
    loaded_factors,
    mesh_cycle,
    motion_factor,
    pair_oscillator,
    unequal_pitches,
)
from flankfilm.coupling.rating.loaded_factors import pressure_ratio, worst_share
from flankfilm.coupling.rating.pitch_excitation import pitch_errors, rounded_errors, with_stiffness
from gears import Gear, GearPair

PAIR = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3).with_backlash(50e-6)
F_PB = 6e-6


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, tolerance=0.01)


@pytest.fixture(scope="module")
def teeth(bodies) -> LoadedTeeth:
    return LoadedTeeth(PAIR, 250.0, compliance=bodies)


@pytest.fixture(scope="module")
def loaded(teeth) -> UnequalPitches:
    return unequal_pitches(teeth, teeth.cycle(120), F_PB)


def at_load(teeth: LoadedTeeth, torque: float, positions: int = 120, by: float = F_PB) -> UnequalPitches:
    under = replace(teeth, torque=torque)
    return unequal_pitches(under, under.cycle(positions), by)


def moving(pitches: UnequalPitches, torque: float = 250.0):
    return pair_oscillator(PAIR, pitches.even, torque, 200.0, fourier_order=10)


def test_without_load_it_is_the_sawtooth(teeth):
    """Its jump is at A or at E, and its height is the deviation; teeth hold to the path, as the sawtooth does."""
    held = replace(teeth, flanks=Flanks(beyond_path=False))
    light = at_load(held, 0.02, positions=960)
    for found, expected in zip(rounded_errors(light, 6), pitch_errors(PAIR, F_PB, 6), strict=True):
        assert found.range == pytest.approx(F_PB, rel=0.02)
        assert found.amplitude[:4] == pytest.approx(expected.amplitude[:4], rel=0.02)
        assert np.exp(1j * (found.phase - expected.phase))[:4] == pytest.approx(np.ones(4), abs=0.02)


def test_a_load_shortens_its_harmonics(teeth):
    """All loads are below the sawtooth, and the first harmonic falls with the load."""
    first = []
    for torque in (1.0, 10.0, 50.0, 250.0):
        for error in rounded_errors(at_load(teeth, torque), 10):
            assert np.all(error.amplitude < F_PB / (math.pi * np.arange(1, 11)))
            first.append(float(error.amplitude[0]))
    for sign in (0, 1):
        assert first[sign::2] == sorted(first[sign::2], reverse=True)


def test_without_a_deviation_nothing_changes(teeth):
    """The dynamic factor is that of equal pitches, and the load factors are."""
    none = at_load(teeth, 250.0, by=0.0)
    motion = moving(none)
    found = motion_factor(motion, 300.0, 0.0, pitches=none)
    assert found.K_v == pytest.approx(found.even, rel=1e-9)
    assert found.K_v == pytest.approx(motion_factor(motion, 300.0, 0.0).even, rel=1e-12)
    assert found.stiffness_change < 0.02  # by the harmonics that its series has more than the motion's
    assert found.rounded
    assert loaded_factors(none.even, none).K_Halpha == loaded_factors(none.even).K_Halpha
    assert worst_share(none).ratio == pytest.approx(1.0, abs=1e-9)


def test_slow_teeth_have_no_dynamic_force(loaded):
    """At rest the force of the mesh is the mean one, with the stiffness of equal and of unequal pitches."""
    motion = moving(loaded)
    factors = [motion_factor(motion, speed, F_PB, pitches=loaded).K_v - 1.0 for speed in (40.0, 5.0)]
    assert factors[0] > factors[1] > 0.0
    assert factors[1] < 0.02


def test_the_larger_force_of_both_signs_counts(loaded):
    motion = moving(loaded)
    early, late = replace(loaded, late=loaded.early), replace(loaded, early=loaded.late)
    for speed in (100.0, 209.0, 400.0):
        each = [motion_factor(motion, speed, F_PB, pitches=pitches).K_v for pitches in (early, late)]
        assert motion_factor(motion, speed, F_PB, pitches=loaded).K_v == max(each)
        assert each[0] != pytest.approx(each[1], rel=1e-3)


def test_the_load_takes_most_of_the_upper_estimate_away(loaded):
    motion = moving(loaded)
    found, sawtooth = motion_factor(motion, 209.4, F_PB, pitches=loaded), motion_factor(motion, 209.4, F_PB)
    assert found.even == sawtooth.even
    assert found.even < found.K_v < 0.9 * sawtooth.K_v
    assert found.stiffness_change < found.error < 0.1
    assert sawtooth.stiffness_change is None


def test_slow_teeth_stand_the_same_with_either_stiffness(loaded):
    """F/k + e is the loaded transmission error for both, but for a mean."""
    motion = moving(loaded)
    scales = motion.scales
    assert scales is not None
    place = loaded.even.position
    for sign, (cycle, plain) in enumerate(zip(loaded.unequal, rounded_errors(loaded, 59), strict=True)):
        changed, error = with_stiffness(motion, loaded, sign, 59)
        stands = []
        for which, curve in ((motion, plain), (changed, error)):
            stiffness = which.oscillator.stiffness(2.0 * np.pi * place)
            stands.append(scales.length * motion.mean_force / stiffness + curve.curve)
        assert stands[1] == pytest.approx(stands[0], abs=0.02 * np.ptp(cycle.transmission_error))


def test_over_a_sweep_both_signs_are_followed(loaded):
    motion = moving(loaded)
    assert motion.scales is not None
    speeds = np.linspace(0.7, 1.2, 11) * motion.scales.speed(1.0)
    found = motion_factor(motion, 209.4, F_PB, speeds, loaded)
    each = [
        motion_factor(motion, 209.4, F_PB, speeds, pitches).factor
        for pitches in (replace(loaded, late=loaded.early), replace(loaded, early=loaded.late))
    ]
    assert np.array_equal(found.factor, np.fmax(*each))
    assert found.greatest == found.factor.max()
    assert found.swept_error > 0.0


def followed(
    tables: dict[float, np.ndarray], torques: np.ndarray, motion, loaded, N: np.ndarray
) -> np.ndarray:
    """Maximum force over the mean one by steps in time on the law of the contact itself, (deviations, N)."""
    steps, periods = 1500, 60
    scales, force = motion.scales, motion.force
    grid = np.arange(steps) / steps
    place = loaded.even.position

    def on_grid(curve):
        return np.interp(grid, place, curve, period=1.0)

    laws = np.array(
        [[on_grid(column) for column in table] for table in tables.values()]
    )  # (deviations, torques, steps)
    cycles = {0.0: loaded.even, -F_PB: loaded.early, F_PB: loaded.late}
    added = np.array([on_grid(loaded.added_error(cycles[by])) for by in tables])
    dt = 2.0 * np.pi / (N * scales.omega_n * steps)
    slope = (np.roll(added, -1, axis=1) - np.roll(added, 1, axis=1))[:, None] / (2.0 * dt)[None, :, None]
    mass, damping = scales.equivalent_mass, 2.0 * 0.05 * scales.omega_n * scales.equivalent_mass
    x, v = np.full(slope.shape[:2], laws[:, torques.size // 2].mean()), np.zeros(slope.shape[:2])
    forces, greatest = torques / 250.0 * force, np.zeros_like(x)
    for step in range(periods * steps):
        now = step % steps
        pressed = np.array([np.interp(x[k], laws[k, :, now], forces) for k in range(len(laws))])
        v += (force - pressed - damping * (v - slope[:, :, now])) / mass * dt
        x += v * dt
        if step >= (periods - 15) * steps:
            greatest = np.maximum(greatest, pressed)
    return greatest / force


@pytest.mark.slow
def test_it_is_near_the_motion_on_the_contact_itself(bodies, teeth, loaded):
    """Independent route: pairs that come into contact as the motion goes, their force over position and deflection.

    The oscillator's stiffness depends on position alone; what that is worth without a deviation is allowed beside the
    error.
    """
    torques = np.concatenate([[1e-3, 1e-2, 0.03], np.geomspace(0.1, 6.0, 40)]) * 250.0
    tables = {}
    for by in (0.0, -F_PB, F_PB):
        cycles = fem.mesh_cycle(PAIR, tuple(torques), 120, bodies, base_pitch_difference=by, reference="body")
        tables[by] = np.array([cycle.transmission_error for cycle in cycles])
    motion = moving(loaded)
    N = np.array([0.1, 0.164, 0.3, 1.0])
    straight = followed(tables, torques, motion, loaded, N)
    for k, frequency in enumerate(N.tolist()):
        found = motion_factor(motion, motion.scales.speed(frequency), F_PB, pitches=loaded)
        by_model = abs(found.even / straight[0, k] - 1.0)
        assert found.K_v == pytest.approx(straight[1:, k].max(), rel=found.error + by_model)
        assert found.K_v == pytest.approx(straight[1:, k].max(), rel=0.05)


def test_without_load_a_single_pair_takes_over_at_a(teeth):
    """K_Halpha goes to the ratio of curvatures at B and A, where a single pair carries without a deviation."""
    points, line = PAIR.points, PAIR.line_of_action
    held = replace(teeth, flanks=Flanks(beyond_path=False))
    light = at_load(held, 0.02, positions=480)
    curvature = [rho * (line - rho) for rho in (points.A, points.B)]
    assert pressure_ratio(light) == pytest.approx(curvature[1] / curvature[0], rel=0.01)
    found = loaded_factors(light.even, light)
    assert found.K_Halpha == pytest.approx(pressure_ratio(light), rel=1e-6)
    assert found.share_error < 0.01


def test_the_worst_share_is_at_the_end_where_a_pair_takes_over(teeth, loaded):
    """Early at A or late at E; the load makes it less."""
    light, heavy = (worst_share(at_load(teeth, torque)) for torque in (100.0, 600.0))
    usual = worst_share(loaded)
    assert light.ratio > usual.ratio > heavy.ratio > 1.0
    ends = (PAIR.points.E - PAIR.points.A, 0.0)
    assert usual.place == pytest.approx(ends[usual.early], abs=0.1e-3)
    assert 0.5 < usual.share < 1.0
    assert usual.error < 0.1


@pytest.mark.slow
@pytest.mark.long
def test_lines_of_contact_carry_more_with_the_deviation():
    pair = GearPair(Gear(18), Gear(21), module=2e-3, face_width=12e-3, helix_angle=math.radians(15.0))
    teeth = LoadedTeeth(
        pair, 60.0, compliance=fem.compliance(pair, tolerance=0.1), flanks=Flanks(False, cells=16)
    )
    pitches = unequal_pitches(teeth, teeth.cycle(8), 8e-6)
    found, plain = loaded_factors(pitches.even, pitches), loaded_factors(pitches.even)
    assert found.K_H == plain.K_H > 1.0
    assert found.K_H_unequal > found.K_H
    assert found.deviation == 8e-6
    assert found.worst_share is None


def test_faults_say_what_is_wrong(teeth, loaded):
    with pytest.raises(InputError, match="at most"):
        unequal_pitches(teeth, loaded.even, 1.0)
    with pytest.raises(InputError, match="coupled finite elements"):
        unequal_pitches(teeth, mesh_cycle(PAIR, 250.0, model="ishikawa"), F_PB)
    with pytest.raises(InputError, match="must be of the deviation"):
        motion_factor(moving(loaded), 209.4, 1e-6, pitches=loaded)
