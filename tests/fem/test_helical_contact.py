"""Loaded contact of helical pairs: balance, symmetry, the spur limit, and numbers of a solver written apart."""

from __future__ import annotations

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from base import Array, InputError
from fem import MeshCycle, PairCompliance, compliance, mesh_cycle
from fem.laws.line_candidates import LineCells
from gears import Alignment, Bearing, Gear, GearPair, Lead, Shaft, ShaftSegment

SMALL = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=radians(18.0))


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(SMALL, tolerance=0.02)


@pytest.fixture(scope="module")
def cycle(bodies: PairCompliance) -> MeshCycle:
    return mesh_cycle(SMALL, 8.0, 6, bodies, cells=24)


@pytest.mark.slow
def test_forces_carry_the_torque(cycle: MeshCycle) -> None:
    """T = r_b cos(beta_b) sum N, and the axial force is T tan(beta_b)/r_b."""
    assert cycle.converged
    assert cycle.lines is not None
    across = cycle.forces.sum(axis=1) * SMALL.helix.base_cosine
    assert across == pytest.approx(8.0 / SMALL.base_radii[0], rel=1e-9)
    assert cycle.lines.force.sum(axis=(1, 2)) == pytest.approx(cycle.forces.sum(axis=1), rel=1e-12)
    assert cycle.lines.axial_force == pytest.approx(SMALL.axial_force(8.0), rel=1e-9)
    assert cycle.load_share.sum(axis=1) == pytest.approx(1.0, rel=1e-9)


@pytest.mark.slow
def test_a_film_of_one_thickness_props_the_lines_apart(bodies: PairCompliance, cycle: MeshCycle) -> None:
    """By the thickness along the normal, which is more in the section; forces and stiffness stay."""

    def film(rho1: Array, force: Array) -> tuple[Array, Array]:
        return np.where(np.isfinite(rho1), 2e-6, 0.0), np.zeros_like(force)

    propped = mesh_cycle(SMALL, 8.0, 6, bodies, cells=24, film=film)
    apart = cycle.transmission_error - propped.transmission_error
    assert apart == pytest.approx(2e-6 / SMALL.helix.base_cosine, rel=1e-6)
    assert propped.forces == pytest.approx(cycle.forces, rel=1e-6, abs=1e-6)
    assert propped.stiffness == pytest.approx(cycle.stiffness, rel=1e-6)


@pytest.mark.slow
def test_films_are_asked_for_places_and_line_loads_of_cells(bodies: PairCompliance) -> None:
    """A film that gives way in proportion to the load per length of line is a spring of each cell, in series."""
    softness, asked = 2e-12, []

    def film(rho1: Array, force: Array) -> tuple[Array, Array]:
        asked.append(rho1[np.isfinite(rho1)])
        line_load = force / SMALL.face_width
        return 20e-6 - softness * line_load, np.full_like(force, -softness / SMALL.face_width)

    soft = mesh_cycle(SMALL, 8.0, 6, bodies, cells=24, film=film)
    lines = soft.lines
    assert lines is not None
    # what cells bear gives the work of the springs, whose part of the approach is their mean by the load
    load, force = np.nan_to_num(lines.line_load), lines.force
    yields = (softness * load * force).sum(axis=(1, 2)) / force.sum(axis=(1, 2))
    rigid = mesh_cycle(SMALL, 8.0, 6, bodies, cells=24)
    changed = (soft.transmission_error + 20e-6 / SMALL.helix.base_cosine) - rigid.transmission_error
    # loads move a little to where bodies and films together give way least, in the second order
    assert changed == pytest.approx(yields / SMALL.helix.base_cosine, rel=0.03)
    places = np.concatenate(asked)
    assert places.min() >= SMALL.points.A
    assert places.max() <= SMALL.points.E


@pytest.mark.slow
def test_cells_that_stand_clear_have_no_load(cycle: MeshCycle) -> None:
    lines = cycle.lines
    assert lines is not None
    load, gap = np.nan_to_num(lines.line_load), np.nan_to_num(lines.gap)
    assert load.min() >= 0.0
    assert np.abs(load * gap).max() == 0.0


@pytest.mark.slow
def test_lines_are_as_long_as_the_geometry_says(cycle: MeshCycle) -> None:
    from gears.pair.contact_lines import contact_lines

    assert cycle.lines is not None
    length = contact_lines(SMALL).length(cycle.position)
    assert cycle.lines.whole_length == pytest.approx(length, rel=1e-9)
    travel = cycle.lines.travel
    path = SMALL.points.E - SMALL.points.A
    assert np.nanmin(travel) > 0.0
    assert np.nanmax(travel) < path


@pytest.mark.slow
def test_the_other_hand_is_the_mirror(cycle: MeshCycle) -> None:
    """Ends of the other hand are solved by a half turn, which a coarse section shows to some thousandths of them."""
    left = replace(SMALL, helix_angle=-SMALL.helix_angle)
    other = mesh_cycle(left, 8.0, 6, compliance(left, tolerance=0.02), cells=24)
    assert other.lines is not None
    assert cycle.lines is not None
    assert other.stiffness == pytest.approx(cycle.stiffness, rel=2e-3)
    assert other.lines.load_centre == pytest.approx(-cycle.lines.load_centre, abs=2e-5)
    assert other.lines.axial_force == pytest.approx(-cycle.lines.axial_force, rel=1e-12)


@pytest.mark.slow
def test_back_flanks_are_those_of_the_other_hand(bodies: PairCompliance) -> None:
    """A braking pinion's flanks are the front ones in a mirror, of the other hand."""
    braking = mesh_cycle(SMALL, -8.0, 6, bodies, cells=24)
    left = replace(SMALL, helix_angle=-SMALL.helix_angle)
    other = mesh_cycle(left, 8.0, 6, compliance(left, tolerance=0.02), cells=24)
    assert braking.mean_secant_stiffness == pytest.approx(other.mean_secant_stiffness, rel=1e-3)
    assert braking.transmission_error_range == pytest.approx(other.transmission_error_range, rel=0.02)
    assert braking.lines is not None
    assert other.lines is not None
    assert braking.lines.axial_force == pytest.approx(SMALL.axial_force(-8.0), rel=1e-9)
    errors = braking.lines.line_load_error + other.lines.line_load_error  # at other positions, too
    assert braking.lines.greatest_line_load == pytest.approx(other.lines.greatest_line_load, rel=errors)
    assert np.all(braking.transmission_error < 0.0)


@pytest.mark.slow
def test_fewer_cells_are_off_by_the_estimate(bodies: PairCompliance) -> None:
    """Of the mean over the positions, against four times as many cells."""
    coarse, fine = (mesh_cycle(SMALL, 8.0, 6, bodies, cells=cells) for cells in (16, 64))
    print(coarse.secant_stiffness / fine.secant_stiffness - 1, coarse.error, fine.error)
    change = abs(coarse.secant_stiffness.mean() / fine.secant_stiffness.mean() - 1.0)
    assert change < min(coarse.error, 1e-3)  # the error holds what ends leave uncertain, too


@pytest.mark.slow
def test_crowning_brings_the_load_to_the_middle(bodies: PairCompliance, cycle: MeshCycle) -> None:
    crowned = replace(SMALL, pinion=replace(SMALL.pinion, lead=Lead(crowning=15e-6)))
    changed = replace(bodies, pair=crowned)
    loads = mesh_cycle(crowned, 8.0, 6, changed, cells=24).lines
    assert loads is not None
    assert cycle.lines is not None

    def spread(z: Array, force: Array) -> float:
        return float(np.sqrt((force * np.nan_to_num(z) ** 2).sum() / force.sum()))

    assert spread(loads.z, loads.force) < 0.85 * spread(cycle.lines.z, cycle.lines.force)
    assert loads.contact_pattern < 1.0
    assert cycle.lines.contact_pattern == pytest.approx(1.0)


@pytest.mark.slow
def test_misalignment_either_way_moves_the_load(bodies: PairCompliance) -> None:
    either = [
        mesh_cycle(SMALL, 8.0, 6, bodies, cells=24, alignment=Alignment(in_plane=by)).lines
        for by in (12e-6, -12e-6)
    ]
    first, second = (lines.load_centre.mean() for lines in either if lines is not None)
    assert first < 0.0 < second
    assert first == pytest.approx(-second, rel=0.15)


def test_the_largest_mean_is_that_of_a_window_slid_along() -> None:
    rng = np.random.default_rng(4)
    forces, used = rng.random((1, 1, 12)), np.ones((1, 1, 12), dtype=bool)
    used[..., 9:], forces[..., 9:] = False, 0.0
    cells = LineCells(
        np.zeros((1, 1, 12)), np.zeros((2, 1, 1, 12)), np.full((1, 1), 0.3), np.full((1, 1), 0.3), used
    )
    edges, carried = 0.3 * np.arange(10), np.concatenate([[0.0], np.cumsum(forces[0, 0, :9])])
    start = np.linspace(0.0, 2.7 - 0.7, 4001)
    slid = np.interp(start + 0.7, edges, carried) - np.interp(start, edges, carried)
    assert cells.largest_mean(forces, 0.7)[0, 0] == pytest.approx(slid.max() / 0.7, rel=1e-3)
    assert cells.largest_mean(forces, 5.0)[0, 0] == pytest.approx(carried[-1] / 5.0, rel=1e-12)


@pytest.mark.slow
def test_what_helices_do_not_have_is_refused_at_once(bodies: PairCompliance) -> None:
    with pytest.raises(InputError) as raised:
        mesh_cycle(
            SMALL,
            8.0,
            6,
            bodies,
            tip_rounding=1e-5,
            moving_contact=True,
            face_model="walls",
        )
    named = str(raised.value)
    for key in ("tip_rounding", "moving_contact", "face_model"):
        assert key in named


def test_teeth_that_are_pressed_together_are_refused(bodies: PairCompliance) -> None:
    """Back flanks would carry the load too, by operators of spur gears."""
    with pytest.raises(InputError, match="torque"):
        mesh_cycle(SMALL, 0.0, 6, bodies, alignment=Alignment(in_plane=50e-6))
    pressed = replace(SMALL, tight=True)
    with pytest.raises(InputError, match=r"pair\.tight"):
        mesh_cycle(pressed, 8.0, 6, replace(bodies, pair=pressed))


@pytest.mark.slow
def test_back_flanks_that_the_deflection_may_reach_are_said(cycle: MeshCycle) -> None:
    """Without backlash; with more of it than the deflection nothing is said."""
    assert "back flanks" in cycle.message
    apart = replace(SMALL, centre_distance=SMALL.centre_distance_of_backlash(100e-6))
    assert "back flanks" not in mesh_cycle(apart, 8.0, 6, compliance(apart, tolerance=0.02), cells=24).message


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("helix_angle", [1e-6, 1e-3])
def test_a_small_helix_is_spur_within_the_errors(helix_angle: float) -> None:
    spur = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3)
    nearly = replace(spur, helix_angle=helix_angle)
    straight, twisted = (mesh_cycle(pair, 8.0, 8, cells=16, beyond_path=False) for pair in (spur, nearly))
    # between double and single contact a line of contact is short
    ends = Bearing(0.0, 5e7), Bearing(0.06, 5e7)
    shaft = Shaft((ShaftSegment(0.06, 0.012),), ends, 0.02, 0.0)
    bent = [
        mesh_cycle(pair, 8.0, 8, cells=16, beyond_path=False, shafts=(shaft, None)) for pair in (spur, nearly)
    ]
    assert bent[1].transmission_error == pytest.approx(bent[0].transmission_error, rel=2e-3)
    assert np.all(np.abs(bent[1].stiffness / bent[0].stiffness - 1.0) < bent[0].error + bent[1].error)
    whole = np.abs(twisted.stiffness / straight.stiffness - 1.0) < straight.error + twisted.error
    print(twisted.stiffness / straight.stiffness - 1.0, straight.error, twisted.error)
    assert whole.all()


@pytest.mark.slow
@pytest.mark.long
def test_numbers_of_a_solver_written_apart() -> None:
    """36/40 teeth, module 2 mm, b 40 mm, 20 degrees, 600 N m: ends from two solids, cells fitted to lines."""
    pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, helix_angle=radians(20.0))
    whole = compliance(pair)
    cycle = mesh_cycle(pair, 600.0, 16, whole, reference="bore")
    per_width, lines = 40e-3 * 1e9, cycle.lines
    assert lines is not None
    assert cycle.secant_stiffness.mean() / per_width == pytest.approx(17.30, rel=0.01)
    assert cycle.stiffness.mean() / per_width == pytest.approx(17.90, rel=0.01)
    assert cycle.against("teeth").stiffness.mean() / per_width == pytest.approx(20.0, rel=0.01)
    assert 1e6 * np.ptp(cycle.transmission_error) == pytest.approx(0.58, rel=0.06)
    askew = mesh_cycle(pair, 600.0, 16, whole, reference="bore", alignment=Alignment(in_plane=20e-6))
    deflection = askew.transmission_error - askew.unloaded_transmission_error
    assert 1e6 * deflection.mean() == pytest.approx(34.2, rel=0.01)
    assert askew.secant_stiffness.mean() / per_width == pytest.approx(12.27, rel=0.01)
