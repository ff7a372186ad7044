"""Bearing forces over the speed: sums over bearings, statics, resonances, mirror, what the load's travel does alone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base import InputError, SolverError
from flankfilm.coupling import SpatialBearing, SpatialMesh, bearing_sweep
from flankfilm.coupling.drive.pair_in_space import SpatialPair, spatial_pair
from flankfilm.coupling.drive.spatial_bearings import bearing_stiffness
from flankfilm.coupling.speeds.bearing_sweep import BearingSweep
from tests.flankfilm.coupling.test_pair_in_space import PAIR, POSITIONS, SPUR, TORQUE, even_mesh

HELD = (SpatialBearing(-0.06, 3e8, 1e8), SpatialBearing(0.08, 2e8, 0.0, 1e4))
BOTH = (HELD, HELD)
SPEEDS = np.linspace(20.0, 600.0, 30)


def pair_of(mesh: SpatialMesh, damping_time: float = 0.0, damping_ratio: float = 0.05) -> SpatialPair:
    each = tuple(replace(one, damping_time=damping_time) for one in HELD)
    damping = sum((one.damping for one in each), np.zeros((6, 6)))
    stiffness = bearing_stiffness(each)
    return spatial_pair(mesh, (stiffness,) * 2, damping_ratio=damping_ratio, bearing_damping=(damping,) * 2)


def swept(mesh: SpatialMesh, **given: float) -> BearingSweep:
    return bearing_sweep(pair_of(mesh), BOTH, SPEEDS, **given)  # type: ignore[arg-type]


def test_bearings_together_carry_what_their_gear_does() -> None:
    """Springs and dampers of all bearings sum to the wrench of the whole, in every harmonic."""
    pair = pair_of(even_mesh(shake=0.1), damping_time=1e-5)
    held = tuple(replace(one, damping_time=1e-5) for one in HELD)
    moved = pair.bearing_forces(150.0)
    rate = 1j * 150.0 * 36 * np.arange(len(moved.motion))[:, None]
    for gear in (0, 1):
        motion = moved.motion[:, 6 * gear : 6 * gear + 6]
        each = [(1.0 + rate * 1e-5) * one.springs * (motion @ one.moves.T) for one in held]
        assert sum(each) == pytest.approx(moved.harmonics[:, gear, :3], rel=1e-9, abs=1e-9)
        arms = [
            np.cross(np.array([0.0, 0.0, one.place]), force) for one, force in zip(held, each, strict=True)
        ]
        couple = (1.0 + rate * 1e-5) * 1e4 * motion[:, 3:5]  # that of the bearing that resists tilt
        assert sum(arms)[:, :2] + couple == pytest.approx(moved.harmonics[:, gear, 3:5], rel=1e-9, abs=1e-9)


def test_means_are_the_static_load_shared_by_levers() -> None:
    """Firm bearings at -60 and 80 mm: radial forces by levers and the axial couple; the axial force on the first."""
    found = swept(even_mesh())
    assert found.bearings == ("pinion 1", "pinion 2", "wheel 1", "wheel 2")
    axial = abs(PAIR.axial_force(TORQUE))
    assert found.axial_force[0, 0] == pytest.approx(axial, rel=0.02)
    assert found.axial_force[0, 1] == 0.0
    firm = (SpatialBearing(-0.06, 1e12, 1e12), SpatialBearing(0.06, 1e12))
    stiffness = bearing_stiffness(firm)
    still = bearing_sweep(spatial_pair(even_mesh(), (stiffness,) * 2), (firm, firm), np.array([1e-2]))
    force, across = TORQUE / PAIR.base_radii[0], axial * PAIR.base_radii[0] / 0.12
    along = (
        axial * 0.5 * (PAIR.points.A + PAIR.points.E) / 0.12
    )  # the axial force acts off the axis both ways
    radial = np.hypot(0.5 * force + np.array([-along, along]), across)
    assert still.mean_force[:2] == pytest.approx(np.hypot(radial, [axial, 0.0]), rel=2e-3)


def test_modes_that_nothing_holds_are_left_out_and_the_torsion_is_the_meshs() -> None:
    found = swept(even_mesh())
    assert len(found.natural_frequencies) == 11
    assert np.all(found.natural_frequencies > 10.0)
    assert np.all((found.mesh_share >= 0.0) & (found.mesh_share <= 1.0))
    assert found.resonance_speeds == pytest.approx(2 * np.pi * found.natural_frequencies / 36)


def test_swings_peak_at_resonances_and_fall_with_damping_of_bearings() -> None:
    mesh = even_mesh(shake=0.1)
    plain = bearing_sweep(pair_of(mesh), BOTH, SPEEDS)
    damped = tuple(replace(one, damping_time=2e-5) for one in HELD)
    quiet = bearing_sweep(pair_of(mesh, damping_time=2e-5), (damped, damped), SPEEDS)
    assert quiet.greatest_swing < plain.greatest_swing
    near = np.abs(
        plain.resonance_speeds[:, None] * [[1.0, 0.5, 1.0 / 3.0]] / plain.greatest_swing_speed - 1.0
    )
    assert near.min() < 0.06


def test_the_travel_of_the_load_alone_swings_bearings() -> None:
    """One stiffness and one turn over the mesh, the centre goes to and fro by a millimetre: statics at slow speed."""
    mesh = even_mesh(SPUR)
    z = 1e-3 * np.cos(2.0 * np.pi * (np.arange(POSITIONS) + 0.5) / POSITIONS)
    force, load = TORQUE / SPUR.base_radii[0], mesh.load.copy()
    load[:, 4] += force * z
    load[:, 10] -= force * z
    firm = (SpatialBearing(-0.1, 1e14, 1e14), SpatialBearing(0.1, 1e14, 1e14))
    pair = spatial_pair(replace(mesh, load=load), (bearing_stiffness(firm),) * 2)
    found = bearing_sweep(pair, (firm, firm), np.array([1e-2]))
    assert found.bearing_swing[0] == pytest.approx(force * 1e-3 / 0.2 / np.sqrt(2.0), rel=1e-3)
    assert found.tilt[0].max() > 0.0
    assert found.axial_motion[0] == pytest.approx(0.0, abs=1e-15)


def test_hands_swing_alike() -> None:
    """With bearings on either side of the face mirrored."""
    mirrored = tuple(replace(one, place=-one.place) for one in HELD)
    other = even_mesh(replace(PAIR, helix_angle=-PAIR.helix_angle), shake=0.1)
    pair = spatial_pair(other, (bearing_stiffness(mirrored),) * 2)
    first = swept(even_mesh(shake=0.1))
    second = bearing_sweep(pair, (mirrored, mirrored), SPEEDS)
    for name in ("bearing_force", "bearing_swing", "axial_motion", "tilt", "natural_frequencies"):
        assert getattr(second, name) == pytest.approx(getattr(first, name), rel=1e-6, abs=1e-12), name


def test_an_error_of_the_flanks_drives_as_a_turn_does() -> None:
    """A constant one turns the pinion and moves nothing else; one that varies swings the bearings."""
    pair = pair_of(even_mesh())
    still, before = (pair.bearing_forces(200.0, error=error) for error in (np.full(POSITIONS, 5e-6), None))
    assert still.harmonics == pytest.approx(before.harmonics, rel=1e-9, abs=1e-6)
    wave = 2e-6 * np.cos(2.0 * np.pi * (np.arange(POSITIONS) + 0.5) / POSITIONS)
    half, whole = (pair.bearing_forces(200.0, error=part * wave).harmonics for part in (0.5, 1.0))
    assert whole - before.harmonics == pytest.approx(2.0 * (half - before.harmonics), rel=1e-6, abs=1e-6)
    driven, alone = (
        bearing_sweep(pair, BOTH, SPEEDS, transmission_error=error).greatest_swing for error in (wave, None)
    )
    assert driven > 2.0 * alone


def test_a_mesh_that_errs_counts() -> None:
    sure, unsure = (swept(even_mesh(shake=0.1), mesh_error=error) for error in (0.0, 0.02))
    assert unsure.error > sure.error
    assert 0.0 < unsure.frequency_error < 0.01  # at most half of the stiffness's
    mesh = even_mesh(shake=0.1)
    coarse = swept(replace(mesh, coarser=1.02 * mesh.stiffness))
    assert coarse.frequency_error > 0.0
    assert coarse.error > sure.error


def test_speeds_where_contact_would_be_lost_are_left_out_and_said() -> None:
    mesh = even_mesh(shake=0.6)
    pair = pair_of(mesh, damping_ratio=0.005)
    found = bearing_sweep(pair, BOTH, np.linspace(20.0, 1200.0, 40))
    lost = np.isnan(found.bearing_swing).all(axis=1)
    assert 0 < lost.sum() < 40
    assert f"contact would be lost at {lost.sum()} of 40 speeds" in found.message
    at = np.flatnonzero(lost)[0]
    with pytest.raises(SolverError, match="mesh would pull at every speed"):
        bearing_sweep(pair, BOTH, found.speed[at : at + 1])


def test_values_are_refused_together() -> None:
    with pytest.raises(InputError) as caught:
        bearing_stiffness([SpatialBearing(1e3, -1.0), (0.0, 1e8, 1e8, -1.0)])
    assert [fault.where for fault in caught.value.faults] == [
        "bearings[0].place",
        "bearings[0].radial",
        "bearings[1].tilting",
    ]
    with pytest.raises(InputError, match="speed"):
        bearing_sweep(pair_of(even_mesh()), BOTH, np.array([-1.0]))
