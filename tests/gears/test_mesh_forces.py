"""Forces of a mesh at the reference cylinders, and where the lines of contact lie."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gears import Gear, GearPair, GeometryError, contact_lines, mesh_forces

ANGLES = (0.0, 1e-9, 0.2, -0.2, math.radians(45.0))


def pair(helix_angle: float, **more: float) -> GearPair:
    return GearPair(Gear(19, profile_shift=0.3), Gear(31), 2.5e-3, 30e-3, helix_angle=helix_angle, **more)


@pytest.mark.parametrize("angle", ANGLES)
def test_components_add_up_to_the_normal_force(angle):
    found = mesh_forces(pair(angle), 240.0)
    whole = math.sqrt(found.tangential**2 + found.radial**2 + found.axial**2)
    assert whole == pytest.approx(found.normal, rel=1e-12)
    assert found.axial == pytest.approx(found.tangential * math.tan(angle), rel=1e-12)
    assert found.tangential * pair(angle).reference_radii[0] == pytest.approx(240.0, rel=1e-12)


@pytest.mark.parametrize("angle", ANGLES)
def test_axial_force_and_its_moments_follow_hand_and_torque(angle):
    one, back = mesh_forces(pair(angle), 240.0), mesh_forces(pair(angle), -240.0)
    other = mesh_forces(pair(-angle), 240.0)
    assert back.axial == -one.axial
    assert other.axial == -one.axial
    assert other.radial == one.radial
    # the virtual power of the mesh: an axial shift by the lead of a turn does what the turn does
    assert one.axial * pair(angle).reference_radii[0] == pytest.approx(240.0 * math.tan(angle), rel=1e-12)
    for moment, radius in zip(one.tilting_moment, pair(angle).pitch_radii, strict=True):
        assert moment == pytest.approx(one.axial * radius, rel=1e-15)


def test_halves_of_a_double_helical_pair_push_against_each_other():
    halves = [mesh_forces(pair(angle), 120.0) for angle in (0.5, -0.5)]
    assert sum(half.axial for half in halves) == 0.0
    assert sum(half.tilting_moment[0] for half in halves) == 0.0
    assert sum(half.tangential for half in halves) == pytest.approx(
        240.0 / pair(0.5).reference_radii[0], rel=1e-12
    )


@pytest.mark.parametrize("torque", [math.nan, math.inf, 1e10, "600"])
def test_a_torque_is_a_number(torque):
    with pytest.raises(GeometryError, match="torque"):
        mesh_forces(pair(0.2), torque)


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("width", [1e-3, 30e-3, 0.3])
def test_segments_are_as_long_as_the_sum_and_stay_within_the_field(angle, width):
    wide = GearPair(Gear(19, profile_shift=0.3), Gear(31), 2.5e-3, width, helix_angle=angle)
    lines = contact_lines(wide)
    for position in (0.0, 0.113, 0.5, 0.87, 3.113):
        path, along = lines.segments(position)
        length = np.hypot(wide.base_pitch * np.diff(path), width * np.diff(along)).sum()
        assert length == pytest.approx(float(lines.length(position)), rel=1e-9)
        assert np.all((path > -1e-9) & (path < lines.contact_ratio + 1e-9))
        assert np.all(np.abs(along) <= 0.5)
        # lines are a base pitch apart
        middle = path[:, 0] - lines.overlap_ratio * along[:, 0]
        assert np.diff(middle) == pytest.approx(np.ones(middle.size - 1), abs=1e-9)
