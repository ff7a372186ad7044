"""Friction on lines of contact: arms of cells, torques of both gears, power, mirrors, the spur limit."""

from __future__ import annotations

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from fem import MeshCycle, PairCompliance, compliance, mesh_cycle
from fem.contact.loaded_flanks import flanks_in_place
from fem.laws.contact_candidates import contact_candidates
from fem.laws.line_friction import further_levers, rubbed_arms
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import face_setting
from gears import Bearing, Gear, GearPair, Shaft, ShaftSegment, TipRelief

SMALL = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=radians(18.0))
TORQUE, MU = 8.0, 0.1


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(SMALL, tolerance=0.02)


def rubbed(
    bodies: PairCompliance, torque: float = TORQUE, friction: float = MU, **given: object
) -> MeshCycle:
    return mesh_cycle(bodies.pair, torque, 6, bodies, cells=24, friction=friction, **given)


def test_arms_are_means_over_cells_that_may_lie_across_the_pitch_point() -> None:
    points, line = SMALL.points, SMALL.line_of_action
    rho1, width = np.linspace(points.A, points.E, 9), np.full(9, 0.3e-3)
    rho1[4] = points.C + 0.1e-3  # a third of it lies before C
    found = rubbed_arms(SMALL, rho1, width, np.stack([rho1, line - rho1]))
    parts = rho1[:, None] + width[:, None] * ((np.arange(3000) + 0.5) / 3000 - 0.5)
    sign = np.sign(parts - points.C)
    np.testing.assert_allclose(found[0], (sign * parts).mean(axis=1), rtol=1e-3)
    np.testing.assert_allclose(found[1], (sign * (line - parts)).mean(axis=1), rtol=1e-3)
    turned = np.array([[1e-3], [2e-3]])  # normals that lean have other arms all over a cell
    leaning = rubbed_arms(SMALL, rho1, width, np.stack([rho1, line - rho1]) + turned)
    np.testing.assert_allclose(leaning - found, turned * sign.mean(axis=1), atol=1e-6)
    first = rubbed_arms(SMALL, rho1[:1], np.array([1e-12]), np.stack([rho1, line - rho1])[:, :1])
    np.testing.assert_allclose(first[0], -rho1[:1], rtol=1e-6)


def with_relief(pair: GearPair) -> GearPair:
    """Pair with much relief on both tips, on more than half of the path."""
    relief = TipRelief(20e-6, 1.4e-3)
    pinion, wheel = (replace(gear, tip_relief=relief) for gear in (pair.pinion, pair.wheel))
    return replace(pair, pinion=pinion, wheel=wheel)


@pytest.mark.parametrize("back", [False, True])
@pytest.mark.parametrize("friction", [0.06, 0.5])
@pytest.mark.parametrize("flanks", [SMALL, with_relief(SMALL)])
def test_levers_of_cells_are_those_of_a_spur_pair_at_a_slight_helix(
    friction: float, back: bool, flanks: GearPair
) -> None:
    slight, spur = (replace(flanks, helix_angle=angle) for angle in (1e-9, 0.0))
    face = face_setting(slight, None, 16, "free-ends")
    assert face is not None
    given = {"positions": 7, "beyond_path": False, "friction": friction, "back": back}
    setup = MeshSetup(slight, face=face, **given)
    lines = contact_candidates(setup).lines
    assert lines is not None
    placed = flanks_in_place(MeshSetup(spur, **given), None, 0.6)
    expected = (placed.tilted_lever_ratios - 1.0)[placed.candidates.touchable]
    found = further_levers(setup, lines, 16)[lines.touches]
    close = 1e-5 if flanks is SMALL else 1e-3  # tables are straight lines over kinks
    np.testing.assert_allclose(found, np.broadcast_to(expected[:, None], found.shape), rtol=close)
    assert np.unique(np.sign(expected)).size == 2


@pytest.mark.slow
@pytest.mark.parametrize("torque", [TORQUE, -TORQUE])
def test_torques_of_both_gears_differ_by_the_power_of_friction(bodies: PairCompliance, torque: float) -> None:
    """Levers by finer parts of each cell; T1 w1 = T2 w2 + sum mu N |u1 - u2|, the sense of turning stays."""
    found, speed = rubbed(bodies, torque), 300.0
    lines, (first, second) = found.lines, SMALL.base_radii
    assert lines is not None
    within = (np.arange(400) + 0.5) / 400 - 0.5
    width = lines.length[..., None] * abs(SMALL.helix.base_sine)
    rho1 = np.nan_to_num(lines.rho[0])[..., None] + width[..., None] * within
    sign = np.sign(rho1 - SMALL.points.C) * np.sign(torque)
    arms = [(sign * rho).mean(axis=-1) for rho in (rho1, SMALL.line_of_action - rho1)]
    turning, carried = (
        (lines.force * (SMALL.helix.base_cosine * radius + MU * arm)).sum(axis=(1, 2))
        for radius, arm in zip((first, second), arms, strict=True)
    )
    assert turning == pytest.approx(abs(torque), rel=2e-4)
    assert found.wheel_torque == pytest.approx(np.sign(torque) * carried, rel=2e-4)
    assert found.load_share.sum(axis=1) == pytest.approx(1.0, rel=1e-9)
    lost = torque * speed - found.wheel_torque * speed * first / second
    assert found.friction_loss(speed) == pytest.approx(lost, rel=1e-7)
    slip = np.abs(rho1 - (SMALL.line_of_action - rho1) * first / second).mean(axis=-1)
    assert found.friction_loss(speed) == pytest.approx(
        MU * speed * (lines.force * slip).sum(axis=(1, 2)), rel=1e-3
    )
    assert found.efficiency == pytest.approx(1.0 - lost.mean() / abs(torque * speed), rel=1e-9)
    assert 0.9 < found.efficiency < 1.0


@pytest.mark.slow
@pytest.mark.parametrize(("edges", "torque"), [(False, TORQUE), (True, 5.0 * TORQUE)])
def test_power_of_friction_is_what_the_wheel_does_not_get_on_relieved_flanks(
    bodies: PairCompliance, edges: bool, torque: float
) -> None:
    """But for what yielding teeth store where normals lean, which evens out; sliding is that of the involutes."""
    pair, speed = with_relief(SMALL), 300.0
    found = mesh_cycle(pair, torque, 12, replace(bodies, pair=pair), edges, cells=24, friction=MU)
    lines, (first, second) = found.lines, pair.base_radii
    assert lines is not None
    lost = torque * speed - found.wheel_torque * speed * first / second
    stored = (lines.turned[0] - lines.turned[1] * first / second) * speed
    assert found.friction_loss(speed) == pytest.approx(lost - stored, rel=1e-9)
    assert np.abs(stored).max() > 0.002 * torque * speed
    assert abs(stored.mean()) < 4e-4 * torque * speed
    assert found.load_share.sum(axis=1) == pytest.approx(1.0, rel=1e-9)
    rho1, rho2 = lines.unlimited_rho
    rolled = MU * speed * np.nansum(lines.force * np.abs(rho1 - rho2 * first / second), axis=(1, 2))
    assert found.friction_loss(speed) == pytest.approx(rolled, rel=5e-3)
    apart = np.abs(np.nan_to_num(rho1 - lines.arms[0]))
    assert apart[lines.force > 0.0].max() > 0.1e-3
    beyond = found.edge_sliding(speed)
    assert (beyond.max() > 0.0) == edges
    outside = np.nansum(
        (1.0 - lines.on_path) * lines.force * np.abs(rho1 - rho2 * first / second), axis=(1, 2)
    )
    assert beyond == pytest.approx(speed * outside, rel=0.02)


@pytest.mark.slow
def test_forces_change_by_what_friction_takes_of_the_torque(bodies: PairCompliance) -> None:
    """To the first order in mu their sum falls by mu sum N arm/(r_b1 cos beta_b), and so does the deflection."""
    plain, small = rubbed(bodies, friction=0.0), rubbed(bodies, friction=1e-4)
    assert plain.lines is not None
    changed = small.forces.sum(axis=1) / plain.forces.sum(axis=1) - 1.0
    expected = -1e-4 * plain.lines.rubbed[0] / TORQUE
    assert changed == pytest.approx(expected, rel=1e-2)
    assert np.sign(small.transmission_error - plain.transmission_error) == pytest.approx(np.sign(expected))
    assert np.ptp(plain.lines.across) < 1e-9 * plain.force
    assert plain.lines.axial_force == pytest.approx(SMALL.axial_force(TORQUE), rel=1e-9)


@pytest.mark.slow
def test_the_other_hand_is_the_mirror_with_friction_too(bodies: PairCompliance) -> None:
    other = compliance(replace(SMALL, helix_angle=-SMALL.helix_angle), tolerance=0.02)
    first, second = rubbed(bodies), rubbed(other)
    assert second.stiffness == pytest.approx(first.stiffness, rel=2e-3)
    assert second.forces.sum(axis=1) == pytest.approx(first.forces.sum(axis=1), rel=1e-3)
    assert first.lines is not None
    assert second.lines is not None
    assert second.lines.axial_force == pytest.approx(-first.lines.axial_force, rel=1e-3)


@pytest.mark.slow
def test_stiffness_is_the_slope_of_the_torque_with_friction(bodies: PairCompliance) -> None:
    ends = Bearing(0.0, 5e7), Bearing(0.06, 5e7)
    shaft = Shaft((ShaftSegment(0.06, 0.012),), ends, 0.02, 0.0)
    step = 1e-3
    low, high = (rubbed(bodies, TORQUE * (1.0 + by)) for by in (-step, step))
    risen = high.against("bore").transmission_error - low.against("bore").transmission_error
    slope = (high.force - low.force) / risen
    assert rubbed(bodies).against("bore").stiffness == pytest.approx(slope, rel=2e-3)
    bent = rubbed(bodies, shafts=(shaft, None))
    assert bent.lines is not None
    forces = bent.lines.bearing_forces(0)[..., 0].sum(axis=0)
    assert forces == pytest.approx(bent.lines.across, rel=1e-6)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize(
    ("helix_angle", "relief", "edges"),
    [(1e-6, False, False), (1e-3, False, False), (1e-6, True, False), (1e-6, True, True)],
)
def test_a_small_helix_has_the_friction_of_a_spur_face(helix_angle: float, relief: bool, edges: bool) -> None:
    spur = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3)
    spur = with_relief(spur) if relief else spur
    straight, twisted = (
        mesh_cycle(pair, TORQUE, 8, cells=16, beyond_path=edges, friction=MU)
        for pair in (spur, replace(spur, helix_angle=helix_angle))
    )
    error = straight.error + twisted.error
    assert twisted.secant_stiffness == pytest.approx(straight.secant_stiffness, rel=error)
    assert twisted.forces.sum(axis=1) == pytest.approx(straight.forces.sum(axis=1), rel=error)
    assert twisted.wheel_torque == pytest.approx(straight.wheel_torque, rel=5e-4 if relief else error * MU)
    assert twisted.friction_loss(1.0) == pytest.approx(straight.friction_loss(1.0), rel=error)
    assert 1.0 - twisted.efficiency == pytest.approx(1.0 - straight.efficiency, rel=error)
