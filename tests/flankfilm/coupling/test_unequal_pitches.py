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
    contact_laws,
    given_series,
    loaded_factors,
    mesh_cycle,
    motion_factor,
    pair_oscillator,
    unequal_pitches,
)
from flankfilm.coupling.rating.contact_laws import ContactLaws
from flankfilm.coupling.rating.loaded_factors import pressure_ratio, worst_share
from flankfilm.coupling.rating.pitch_excitation import pitch_errors
from flankfilm.coupling.vibration.excitation import error_series
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


def rounded_errors(pitches: UnequalPitches, order: int):
    """Harmonics of what both signs of the deviation add to the loaded transmission error."""
    return [error_series(pitches.added_error(cycle), order=order) for cycle in pitches.unequal]


def moving(even, torque: float = 250.0):
    return pair_oscillator(PAIR, even, torque, 200.0, fourier_order=10)


@pytest.fixture(scope="module")
def laws(teeth, loaded) -> ContactLaws:
    return contact_laws(teeth, loaded.even, F_PB)


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
    found = motion_factor(moving(none.even), 300.0, 0.0, laws=contact_laws(teeth, none.even, 0.0))
    assert found.K_v == pytest.approx(found.even, rel=1e-9)
    assert found.by_contact
    assert loaded_factors(none.even, none).K_Halpha == loaded_factors(none.even).K_Halpha
    assert worst_share(none).ratio == pytest.approx(1.0, abs=1e-9)


def test_slow_teeth_have_no_dynamic_force(loaded, laws):
    """At rest the force of the mesh is the mean one."""
    motion = moving(loaded.even)
    factors = [motion_factor(motion, speed, F_PB, laws=laws).K_v - 1.0 for speed in (40.0, 5.0)]
    assert factors[0] > factors[1] > 0.0
    assert factors[1] < 0.02


def test_slow_teeth_stand_where_the_loaded_contact_has_them(loaded, laws):
    """Deflection of the law at the mean load, with what the deviation adds to the transmission error."""
    place = (np.arange(laws.secant.size) + 0.5) / laws.secant.size
    mean = int(np.argmin(np.abs(laws.shares - 1.0)))
    assert laws.shares[mean] == pytest.approx(1.0)
    stands = loaded.even.contact.force / laws.secant
    assert laws.even[mean] == pytest.approx(stands, rel=1e-12)
    for cycle, curve in zip(loaded.unequal, (laws.early, laws.late), strict=True):
        added = np.interp(place, loaded.even.position, loaded.added_error(cycle), period=1.0)
        assert curve[mean] - laws.even[mean] == pytest.approx(added, abs=0.15e-6)


def test_the_larger_force_of_both_signs_counts(loaded, laws):
    motion = moving(loaded.even)
    early, late = (
        replace(laws, **{name: getattr(laws, kept) for name in ("early", "late")}, added=laws.added[chosen])
        for kept, chosen in (("early", [0, 1, 1]), ("late", [0, 2, 2]))
    )
    for speed in (100.0, 209.0, 400.0):
        each = [motion_factor(motion, speed, F_PB, laws=law).K_v for law in (early, late)]
        assert motion_factor(motion, speed, F_PB, laws=laws).K_v == max(each)
        assert each[0] != each[1]


def test_the_load_takes_most_of_the_upper_estimate_away(loaded, laws):
    motion = moving(loaded.even)
    found, sawtooth = motion_factor(motion, 209.4, F_PB, laws=laws), motion_factor(motion, 209.4, F_PB)
    assert found.even == pytest.approx(sawtooth.even, rel=0.03)
    assert found.even < found.K_v < 0.9 * sawtooth.K_v
    assert 0.0 < found.error < 0.03
    assert not sawtooth.by_contact


def test_over_a_sweep_both_signs_are_followed(loaded, laws):
    motion = moving(loaded.even)
    assert motion.scales is not None
    speeds = np.linspace(0.7, 1.2, 6) * motion.scales.speed(1.0)
    found = motion_factor(motion, 209.4, F_PB, speeds, laws)
    assert found.greatest == found.factor.max()
    assert 0.0 < found.swept_error < 0.05
    alone = [motion_factor(motion, float(speed), F_PB, laws=laws).K_v for speed in speeds[:2]]
    assert np.all(found.factor[:2] >= 0.999 * np.array(alone))


def stepped(
    tables: dict[float, np.ndarray], torques: np.ndarray, motion, loaded, N: np.ndarray, torque: float
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
    forces, greatest = torques / torque * force, np.zeros_like(x)
    for step in range(periods * steps):
        now = step % steps
        pressed = np.array([np.interp(x[k], laws[k, :, now], forces) for k in range(len(laws))])
        v += (force - pressed - damping * (v - slope[:, :, now])) / mass * dt
        x += v * dt
        if step >= (periods - 15) * steps:
            greatest = np.maximum(greatest, pressed)
    return greatest / force


@pytest.mark.slow
@pytest.mark.parametrize("torque", [100.0, 250.0, 500.0])
def test_it_is_the_motion_on_the_contact_itself(bodies, torque):
    """Independent route: explicit steps of the first order, with other forces and positions.

    Both have an error by positions; that of the other route is taken to be as large as ours.
    """
    torques = np.concatenate([[1e-3, 1e-2, 0.03], np.geomspace(0.1, 6.0, 40)]) * torque
    teeth = LoadedTeeth(PAIR, torque, compliance=bodies)
    loaded = unequal_pitches(teeth, teeth.cycle(120), F_PB)
    tables = {}
    for by in (0.0, -F_PB, F_PB):
        cycles = fem.mesh_cycle(PAIR, tuple(torques), 120, bodies, base_pitch_difference=by, reference="body")
        tables[by] = np.array([cycle.transmission_error for cycle in cycles])
    motion, laws = moving(loaded.even, torque), contact_laws(teeth, loaded.even, F_PB)
    N = np.array([0.1, 0.164, 0.3, 1.0])
    steps = stepped(tables, torques, motion, loaded, N, torque)
    for k, frequency in enumerate(N.tolist()):
        found = motion_factor(motion, motion.scales.speed(frequency), F_PB, laws=laws)
        assert found.even == pytest.approx(steps[0, k], rel=0.01)
        assert found.K_v == pytest.approx(steps[1:, k].max(), rel=2.0 * found.error + 0.002)


def test_a_linear_law_has_the_motion_of_its_spring(laws, loaded):
    """A force in proportion to the deflection, the same at all positions, answers as the exact flow has it."""
    motion = moving(loaded.even)
    scales = motion.scales
    spring = laws.shares[:, None] * np.full(60, motion.force / scales.mean_stiffness)
    jump = 1e-6 * np.cos(2.0 * np.pi * (np.arange(60) + 0.5) / 60)
    even = np.full(60, scales.mean_stiffness)
    straight = ContactLaws(
        F_PB, laws.shares, spring, spring + jump, spring - jump, np.array([0 * jump, jump, -jump]), even, 0.0
    )
    motion = replace(motion, series=given_series(scales.mean_stiffness, [0.0]))
    for N in (0.3, 0.8, 1.3):
        found = motion_factor(motion, scales.speed(N), F_PB, laws=straight)
        swing = 1e-6 / scales.length / motion.mean_force * N**2 / math.hypot(1.0 - N**2, 0.1 * N)
        assert found.even == pytest.approx(1.0, abs=1e-6)
        assert found.K_v - 1.0 == pytest.approx(swing, rel=4e-3)


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


def test_faults_say_what_is_wrong(teeth, loaded, laws):
    with pytest.raises(InputError, match="at most"):
        unequal_pitches(teeth, loaded.even, 1.0)
    with pytest.raises(InputError, match="coupled finite elements"):
        unequal_pitches(teeth, mesh_cycle(PAIR, 250.0, model="ishikawa"), F_PB)
    with pytest.raises(InputError, match="must be of the deviation"):
        motion_factor(moving(loaded.even), 209.4, 1e-6, laws=laws)
