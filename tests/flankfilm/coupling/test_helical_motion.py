"""Torsional motion of helical pairs along the transverse line of action: formulas by hand, and the spur limit."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from flankfilm import coupling
from flankfilm.coupling.vibration.speed_ranges import standard_factors
from gears import Alignment, Gear, GearDeviations, GearPair, Lead, PitchDeviations, TipRelief
from gears.closed_form import iso6336_dynamic

BETA, ALPHA = math.radians(20.0), math.radians(20.0)
SPUR = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
PAIR = replace(SPUR, helix_angle=BETA).with_backlash(50e-6)
SERIES = coupling.given_series(7.4e8, [0.013], [0.4])
STRONG = coupling.given_series(7.4e8, [0.2], [0.4])
TORQUE, SPEED = 600.0, 150.0

# by hand
R_B1, R_B2 = (
    z * 1e-3 / math.cos(BETA) * math.cos(math.atan(math.tan(ALPHA) / math.cos(BETA))) for z in (36, 40)
)
BASE = math.asin(math.sin(BETA) * math.cos(ALPHA))


def motion(pair: GearPair = PAIR, **given: object) -> coupling.PairOscillator:
    return coupling.pair_oscillator(pair, SERIES, TORQUE, SPEED, **given)  # type: ignore[arg-type]


def test_force_backlash_and_mass_are_along_the_transverse_line_of_action() -> None:
    found = motion()
    scales = found.scales
    assert scales is not None
    assert found.force == pytest.approx(TORQUE / R_B1, rel=1e-12)
    assert found.backlash == pytest.approx(50e-6 / math.cos(BASE), rel=1e-9)
    transverse = PAIR.transverse_backlash * math.cos(PAIR.working_pressure_angle)
    assert found.backlash == pytest.approx(transverse, rel=1e-12)
    assert found.half_backlash * scales.length == pytest.approx(0.5 * found.backlash, rel=1e-12)
    assert found.mean_force * scales.length * scales.mean_stiffness == pytest.approx(found.force, rel=1e-12)
    inertia = PAIR.moments_of_inertia
    mass = 1.0 / (R_B1**2 / inertia[0] + R_B2**2 / inertia[1])
    assert scales.equivalent_mass == pytest.approx(mass, rel=1e-12)
    assert scales.natural_frequency == pytest.approx(math.sqrt(7.4e8 / mass) / (2 * math.pi), rel=1e-12)
    assert scales.rpm(1.0) == pytest.approx(60.0 / 36 * scales.natural_frequency, rel=1e-12)


def test_inertias_are_those_of_the_transverse_section() -> None:
    first, _ = PAIR.moments_of_inertia
    bore, outer = PAIR.bore_radii[0], 36e-3 / math.cos(BETA)
    assert first == pytest.approx(0.5 * math.pi * 7850.0 * 40e-3 * (outer**4 - bore**4), rel=1e-12)


def test_play_is_the_turn_of_the_pinion_between_its_flanks() -> None:
    """The pinion turns by j_bt/r_b1 = j_wt/r_w1 with the wheel held."""
    turn = motion().backlash / R_B1
    assert turn == pytest.approx(PAIR.transverse_backlash / PAIR.pitch_radii[0], rel=1e-12)


def test_the_primary_response_is_that_of_its_stiffness_harmonic() -> None:
    r"""About the static deflection k_1 cos(wt) of a stiffness answers with F k_1/(2 zeta k_m) at the natural frequency.

    What the oscillation makes of the varying stiffness is of the order k_1/(2 zeta k_m) smaller.
    """
    for harmonic in (0.013, 0.0013):
        found = coupling.pair_oscillator(
            PAIR, coupling.given_series(7.4e8, [harmonic], [0.4]), TORQUE, SPEED, damping_ratio=0.05
        )
        assert found.scales is not None
        swept = coupling.speed_sweep(found, frequency=np.array([0.99, 1.0, 1.01]))
        amplitude = math.sqrt(2.0) * swept.spread["up"][1] * found.scales.length
        closed = TORQUE / R_B1 / 7.4e8 * harmonic / (2 * 0.05)
        assert amplitude == pytest.approx(closed, rel=0.2 * harmonic / 0.1)


def test_hands_move_alike() -> None:
    other = motion(replace(PAIR, helix_angle=-BETA))
    assert other.scales == motion().scales
    assert other.oscillator == motion().oscillator


def test_a_small_helix_moves_as_a_spur_pair() -> None:
    values = np.linspace(0.45, 1.15, 15)
    swept = [
        coupling.speed_sweep(
            coupling.pair_oscillator(pair, STRONG, TORQUE, SPEED, damping_ratio=0.03),
            frequency=values,
        )
        for pair in (SPUR.with_backlash(50e-6), replace(SPUR, helix_angle=1e-6).with_backlash(50e-6))
    ]
    for way in ("up", "down"):
        assert swept[1].force_factor[way] == pytest.approx(swept[0].force_factor[way], rel=1e-7)
    assert max(swept[0].force_factor["up"]) > 2.0  # contact is lost


def test_contact_is_lost_where_the_swing_exceeds_the_static_deflection() -> None:
    """Half the backlash is a length of its own: the touch of the dead zone follows force and stiffness alone."""
    touches = [
        coupling.speed_sweep(
            coupling.pair_oscillator(PAIR.with_backlash(play), STRONG, TORQUE, SPEED),
            frequency=np.linspace(0.6, 1.2, 25),
        ).least_grazing
        for play in (20e-6, 80e-6)
    ]
    assert touches[0] is not None
    assert touches[1] == pytest.approx(touches[0], rel=1e-9)


def test_the_standard_takes_the_normal_force() -> None:
    found = motion(error_amplitude=5e-6)
    assert found.scales is not None
    at = np.array([0.3, 0.6])
    by_hand = iso6336_dynamic(
        PAIR, TORQUE / R_B1 / math.cos(BASE), found.scales.equivalent_mass, found.scales.speed(1.0) * at,
        pitch_deviation=10e-6,
    )  # fmt: skip
    assert standard_factors(found, at) == pytest.approx(by_hand.K_v, rel=1e-12)


class TestTwistingTrain:
    """Motor behind a coupling, pinion, wheel, load: four discs."""

    def train(self, pair: GearPair = PAIR) -> coupling.PairDrive:
        return coupling.pair_drive(
            pair, SERIES, TORQUE, SPEED, end_inertias=(0.02, 0.05), couplings=(2e4, 5e4), shafts=(None, None)
        )

    def test_frequencies_are_those_of_four_discs(self) -> None:
        """In angles: mesh stiffness k on r_b1 theta_1 - r_b2 theta_2, springs of the couplings."""
        inertia = np.diag([0.02, *PAIR.moments_of_inertia, 0.05])
        stiffness = np.zeros((4, 4))
        for row, spring in (([1, -1, 0, 0], 2e4), ([0, R_B1, -R_B2, 0], 7.4e8), ([0, 0, 1, -1], 5e4)):
            stiffness += spring * np.outer(row, row)
        squares = np.sort(np.linalg.eigvals(np.linalg.solve(inertia, stiffness)).real)
        assert abs(squares[0]) < 1e-6 * squares[1]
        assert self.train().natural_frequencies == pytest.approx(
            np.sqrt(squares[1:]) / (2 * math.pi), rel=1e-6
        )

    def test_a_small_helix_twists_as_a_spur_pair(self) -> None:
        first = self.train(SPUR.with_backlash(50e-6))
        other = self.train(replace(SPUR, helix_angle=1e-6).with_backlash(50e-6))
        assert other.natural_frequencies == pytest.approx(first.natural_frequencies, rel=1e-9)
        assert other.oscillator.half_backlash == pytest.approx(first.oscillator.half_backlash, rel=1e-9)

    def test_the_torque_of_the_coupling_swings_about_that_of_the_load(self) -> None:
        swept = coupling.drive_sweep(self.train(), frequency=np.array([0.4, 0.5]))
        assert swept.shafts == ("pinion coupling", "wheel coupling")
        outputs = {output.name: output for output in self.train().outputs}
        assert set(outputs) == {"pinion coupling", "wheel coupling"}
        for torque in swept.shaft_torque.values():
            assert torque[:, 0].min() > TORQUE
            assert torque[:, 0].max() < 1.5 * TORQUE
            assert torque[:, 1].min() > 40 / 36 * TORQUE


class TestUnloadedError:
    def relieved(self, width: float, beta: float = BETA, slope: float = 0.0) -> GearPair:
        relief = TipRelief(amount=20e-6, length=2.5e-3)
        return GearPair(
            Gear(36, tip_relief=relief, lead=Lead(slope=slope)),
            Gear(40, tip_relief=relief),
            module=2e-3,
            face_width=width,
            helix_angle=beta,
        )

    def test_it_is_the_least_over_the_face_of_sections_that_are_turned(self) -> None:
        """Every section is a spur pair, ahead by z tan(beta_b)/p_bt: the closest decides."""
        pair = self.relieved(2e-3)
        found = coupling.unloaded_error(pair, positions=512)
        narrow = coupling.unloaded_error(self.relieved(1e-6), positions=512)
        shifts = ((np.arange(128) + 0.5) / 128 - 0.5) * pair.overlap_ratio  # middles of the cells looked at
        place = (np.arange(512) + 0.5) / 512
        section = [np.interp(place + shift, place, narrow.curve, period=1.0) for shift in shifts]
        assert found.curve == pytest.approx(np.min(section, axis=0), abs=2e-8)
        assert 1e-6 < found.range < narrow.range

    def test_an_overlap_of_one_leaves_none(self) -> None:
        found = coupling.unloaded_error(self.relieved(math.pi * 2e-3 / math.sin(BETA)), positions=128)
        assert found.range < 2e-8

    def test_axes_and_leads_decide_where_it_touches(self) -> None:
        """With a slope the end that stands out touches: the error of its section, where the slope is steep."""
        steep = 5e-4
        pair = self.relieved(2e-3)
        end = coupling.unloaded_error(pair, positions=256, alignment=Alignment(in_plane=steep))
        narrow = coupling.unloaded_error(self.relieved(1e-6), positions=256)
        assert end.range == pytest.approx(narrow.range, rel=0.02)
        lead = coupling.unloaded_error(self.relieved(2e-3, slope=steep), positions=256)
        assert lead.curve - lead.curve.min() == pytest.approx(end.curve - end.curve.min(), abs=1e-9)

    def test_back_flanks_are_front_flanks_of_the_other_hand(self) -> None:
        pair = self.relieved(2e-3, slope=10e-6)
        back = coupling.unloaded_error(pair, positions=256, back=True)
        other = coupling.unloaded_error(replace(pair, helix_angle=-BETA), positions=256)
        assert back.range == pytest.approx(other.range, rel=1e-9)
        assert back.all_amplitudes[:8] == pytest.approx(other.all_amplitudes[:8], rel=0.02, abs=1e-9)

    def test_tip_edges_take_over_as_on_spur_pairs(self) -> None:
        """Teeth that come late leave the load to tip edges before and after them; held to the path it leaps."""
        late = GearDeviations(pitch=PitchDeviations((6e-6, -4e-6, 3e-6) + (0.0,) * 33))
        given = {"deviations": (late, None), "meshes": 4, "positions": 64}
        twisted = replace(SPUR, helix_angle=1e-6)
        spur, held, free = (
            coupling.unloaded_error(pair, beyond_path=edges, **given).curve
            for pair, edges in ((SPUR, True), (twisted, False), (twisted, True))
        )
        assert free == pytest.approx(spur, abs=1e-3 * np.ptp(spur))
        assert np.max(held - free) > 0.2 * np.ptp(spur)
        wide, wide_held = (
            coupling.unloaded_error(PAIR, beyond_path=edges, **given) for edges in (True, False)
        )
        steps = [float(np.abs(np.diff(each.curve)).max()) for each in (wide, wide_held)]
        assert steps[0] < 0.8 * steps[1]
