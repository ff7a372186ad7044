"""Deviations of each tooth of helical gears: pitches, profiles, unequal base pitches, several pitches."""

from __future__ import annotations

from dataclasses import replace
from math import cos, radians

import numpy as np
import pytest

from fem import PairCompliance, compliance, mesh_cycle, unloaded_transmission_error
from fem.laws.contact_candidates import contact_candidates
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import face_setting
from gears import Gear, GearDeviations, GearPair, PitchDeviations, ProfileDeviation, TipRelief

SMALL = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=radians(18.0))
TORQUE = 8.0
ALONG = SMALL.helix.transverse_cosine
"""Of a pitch deviation on a circle, along the transverse line of action."""


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(SMALL, tolerance=0.02)


def _pitch(values: np.ndarray) -> GearDeviations:
    return GearDeviations(pitch=PitchDeviations(tuple(values.tolist())))


def _touch(
    deviations: tuple[GearDeviations | None, GearDeviations | None], pitches: int, back: bool = False
) -> np.ndarray:
    face = face_setting(SMALL, None, 16, "free-ends")
    assert face is not None
    setup = MeshSetup(SMALL, 5, False, deviations, pitches, face=face, back=back)
    return contact_candidates(setup).gap


def test_the_pitch_is_that_of_the_transverse_section() -> None:
    assert pytest.approx(cos(SMALL.helix.transverse_pressure_angle), rel=1e-15) == ALONG
    spur = replace(SMALL, helix_angle=0.0)
    assert spur.helix.transverse_cosine == cos(spur.rack.alpha)


def test_gaps_of_lines_are_those_of_their_teeth() -> None:
    """A late tooth of the pinion opens its own line, one of the wheel closes it; lines ahead are earlier teeth."""
    rng = np.random.default_rng(3)
    late = 1e-6 * rng.standard_normal(18), 1e-6 * rng.standard_normal(23)
    gaps = _touch((_pitch(late[0]), _pitch(late[1])), 4)
    offset = np.arange(-1, gaps.shape[-1] - 1)
    for pitch in range(4):
        step = pitch - offset
        expected = ALONG * (late[0][step % 18] - late[1][step % 23])
        for gap in gaps[pitch]:
            known = np.isfinite(gap)
            np.testing.assert_allclose(gap[known], expected[known], atol=1e-18)
    # the same teeth press with their other flanks, which come late the other way
    behind = _touch((_pitch(np.full(18, 1e-6)), None), 1, back=True)
    np.testing.assert_allclose(behind[np.isfinite(behind)], -1e-6 * ALONG, rtol=1e-12)


def test_without_load_the_first_tooth_touches() -> None:
    late = 1e-6 * np.sin(2.0 * np.pi * np.arange(18) / 18.0)
    found = unloaded_transmission_error(SMALL, 3, deviations=(_pitch(late), None), pitches=18)
    gaps = MeshSetup(SMALL, 3, False, (_pitch(late), None), 18)
    np.testing.assert_allclose(found, contact_candidates(gaps).gap.min(axis=-1).ravel(), atol=1e-18)
    assert found.max() <= ALONG * late.max() * (1.0 + 1e-12)
    assert found.min() == pytest.approx(ALONG * late.min(), rel=1e-12)


@pytest.mark.slow
def test_pitches_of_gears_without_deviations_are_alike(bodies: PairCompliance) -> None:
    one, three = (mesh_cycle(SMALL, TORQUE, 5, bodies, cells=16, pitches=n) for n in (1, 3))
    assert one.lines is not None
    assert three.lines is not None
    for name in ("stiffness", "transmission_error", "secant_stiffness"):
        np.testing.assert_allclose(getattr(three, name), np.tile(getattr(one, name), 3), rtol=1e-9)
    np.testing.assert_allclose(three.position, np.concatenate([one.position + n for n in range(3)]))
    for name in ("line_load", "gap", "z"):
        found, first = getattr(three.lines, name), getattr(one.lines, name)
        np.testing.assert_allclose(found, np.tile(first, (3, 1, 1)), rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(three.lines.load_centre, np.tile(one.lines.load_centre, 3), atol=1e-9)


@pytest.mark.slow
def test_gears_that_come_late_as_a_whole_only_turn(bodies: PairCompliance) -> None:
    late = _pitch(np.full(18, 2e-6)), _pitch(np.full(23, -1e-6))
    plain = mesh_cycle(SMALL, TORQUE, 5, bodies, cells=16)
    found = mesh_cycle(SMALL, TORQUE, 5, bodies, cells=16, deviations=late)
    np.testing.assert_allclose(found.forces, plain.forces, rtol=1e-9)
    turned = found.transmission_error - plain.transmission_error
    np.testing.assert_allclose(turned, 3e-6 * ALONG, rtol=1e-9)


@pytest.mark.slow
def test_unequal_base_pitches_are_pitches_that_grow_by_them(bodies: PairCompliance) -> None:
    """But for a turn of all lines together, the same at every position of a pitch but for the position itself."""
    by = 1.5e-6
    growing = by / ALONG * (np.arange(18) - 18.0 * (np.arange(18) >= 9))
    rolled = mesh_cycle(SMALL, TORQUE, 5, bodies, cells=16, base_pitch_difference=by)
    pitched = mesh_cycle(SMALL, TORQUE, 5, bodies, cells=16, deviations=(_pitch(growing), None))
    np.testing.assert_allclose(rolled.forces, pitched.forces, rtol=1e-6, atol=1e-6 * rolled.force)
    plain = mesh_cycle(SMALL, TORQUE, 5, bodies, cells=16)
    assert np.abs(rolled.forces - plain.forces).max() > 0.05 * rolled.force
    turned = rolled.transmission_error - pitched.transmission_error + by * rolled.position
    np.testing.assert_allclose(turned, turned[0], atol=1e-5 * by)


@pytest.mark.parametrize("back", [False, True])
def test_unequal_base_pitches_without_load_are_those_of_a_spur_pair_at_a_slight_helix(back: bool) -> None:
    """Smallest gaps of both flanks; and along a line of a steep helix nothing changes, while lines differ."""
    slight, spur = (replace(SMALL, helix_angle=angle).with_backlash(40e-6) for angle in (1e-9, 0.0))
    face = face_setting(slight, None, 16, "free-ends")
    assert face is not None
    given = {"positions": 7, "beyond_path": False, "base_pitch_difference": 1.5e-6, "back": back}
    helical = contact_candidates(MeshSetup(slight, face=face, **given))
    plain = contact_candidates(MeshSetup(spur, **given))
    np.testing.assert_allclose(helical.gap.min(axis=-1), plain.gap.min(axis=-1), atol=1e-14)
    np.testing.assert_allclose(helical.back_gap, plain.back_gap, atol=1e-14)
    assert np.ptp(plain.back_gap) > 0.5e-6
    steep = contact_candidates(MeshSetup(SMALL, face=face, **given)).gap
    step = np.diff(steep, axis=-1)
    np.testing.assert_allclose(step[np.isfinite(step)], -1.5e-6, rtol=1e-9)


@pytest.mark.slow
def test_a_profile_of_each_tooth_is_that_of_all_where_they_are_alike(bodies: PairCompliance) -> None:
    """And a trace that lacks what a tip relief lacks is one."""
    relief = TipRelief(5e-6, 6e-4)
    relieved = replace(SMALL, pinion=replace(SMALL.pinion, tip_relief=relief))
    low, high = SMALL.teeth_profiles[0].flank_rho
    rho = np.array([low, high - relief.length, high])
    trace = ProfileDeviation(tuple(rho.tolist()), (0.0, 0.0, -relief.amount), "linear")
    each = (trace,) * 18
    one, many = (
        mesh_cycle(
            SMALL, TORQUE, 5, bodies, deviations=(GearDeviations(profile=p), None), cells=16, pitches=2
        )
        for p in (trace, each)
    )
    np.testing.assert_allclose(many.forces, one.forces, rtol=1e-9)
    by_relief = mesh_cycle(relieved, TORQUE, 5, replace(bodies, pair=relieved), cells=16, pitches=2)
    np.testing.assert_allclose(one.transmission_error, by_relief.transmission_error, rtol=1e-6)


@pytest.mark.slow
def test_one_bad_tooth_is_felt_while_it_meshes(bodies: PairCompliance) -> None:
    """One that lacks more than teeth deflect carries nothing: its neighbours do, and no others feel it."""
    low, high = SMALL.teeth_profiles[0].flank_rho
    bad = ProfileDeviation((low, high), (-60e-6, -60e-6), "linear")
    good = ProfileDeviation((low, high), (0.0, 0.0), "linear")
    teeth = [good] * 18
    teeth[9] = bad
    deviations = GearDeviations(profile=tuple(teeth)), None
    plain = mesh_cycle(SMALL, TORQUE, 3, bodies, cells=16)
    found = mesh_cycle(SMALL, TORQUE, 3, bodies, cells=16, deviations=deviations, pitches=18)
    whole = np.tile(plain.forces, (18, 1))
    here = found.candidates.teeth[0] == 9
    assert np.all(found.forces[here] == 0.0)
    assert found.forces.sum(axis=1) == pytest.approx(found.force / SMALL.helix.base_cosine, rel=1e-9)
    meshes = np.any(here & (whole > 0.0), axis=1)
    assert meshes.sum() == pytest.approx(3.0 * SMALL.total_contact_ratio, abs=1.0)
    # traces of single teeth are taken apart into the mean and the rest
    np.testing.assert_allclose(found.forces[~meshes], whole[~meshes], rtol=1e-6, atol=1e-6 * found.force)
