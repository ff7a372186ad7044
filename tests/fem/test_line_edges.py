"""Contact of helical pairs beyond the path: tip edges, corners of tip and end face, against sections and limits."""

from __future__ import annotations

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from base import Array, InputError
from fem import Film, MeshCycle, PairCompliance, compliance, mesh_cycle
from fem.laws.contact_candidates import contact_candidates
from fem.laws.mesh_setup import MeshSetup
from fem.laws.tip_edges import edges_at
from fem.stress.line_roots import LineRoots
from gears import Gear, GearPair, TipRelief, contact_lines

SMALL = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=radians(18.0))
SETUP = MeshSetup(SMALL, 5, beyond_path=True)


def test_lines_go_on_beyond_the_path_as_far_as_tip_edges_are_looked_for():
    """At each end by the same rho, clipped by the face; corners of tip and end face touch before any line does."""
    held, further = (
        contact_candidates(replace(SETUP, beyond_path=False)).lines,
        contact_candidates(SETUP, 0.1).lines,
    )
    assert held is not None
    assert further is not None
    assert further.edges is not None
    away, half = 0.1 * SMALL.base_pitch / SMALL.helix.base_tangent, 0.5 * SMALL.face_width
    both = held.touches
    columns = [int(np.argmin(np.abs(further.middle[0] - middle))) for middle in held.middle[0]]
    start, stop = further.start[:, columns], further.stop[:, columns]
    assert start[both] == pytest.approx(np.maximum(held.start - away, -half)[both], abs=1e-12)
    assert stop[both] == pytest.approx(np.minimum(held.stop + away, half)[both], abs=1e-12)
    assert further.touches.sum() >= both.sum()
    places = further.places(further.divided(40))
    assert places.min() >= SMALL.points.A - 0.1 * SMALL.base_pitch - 1e-12
    assert places.max() <= SMALL.points.E + 0.1 * SMALL.base_pitch + 1e-12


def test_tables_of_edges_are_the_edges_of_the_section():
    """Gap, touched radius and lever at places between those of the tables; on the path nothing changes."""
    edges, pitch = SETUP.flanks.edges(0.3), SMALL.base_pitch
    away = pitch * np.array([0.0, 0.0123, 0.0777, 0.211, 0.3])
    for corner, place in ((1, SMALL.points.A - away), (0, SMALL.points.E + away)):
        at = edges_at(SETUP.flanks, corner, place)
        largest = at.gap.max()
        assert edges.gaps(place) == pytest.approx(at.gap, abs=1e-5 * largest)
        rho = edges.rho(place, SMALL.line_of_action)
        assert rho[1 - corner] == pytest.approx(at.touched_rho, abs=2e-5 * SMALL.module)
        tip = SMALL.points.E if corner == 0 else SMALL.line_of_action - SMALL.points.A
        assert rho[corner] == pytest.approx(tip, rel=1e-12)
        levers = edges.levers(place)
        assert levers[corner] == pytest.approx(at.lever, rel=1e-6)
        assert levers[1 - corner] == pytest.approx(1.0, abs=0.0)
        assert edges.closed_by(0.5 * largest) < away.max()
    inside = np.linspace(SMALL.points.A, SMALL.points.E, 7)
    assert not edges.gaps(inside).any()
    assert edges.levers(inside) == pytest.approx(1.0, abs=0.0)
    assert edges.rho(inside, SMALL.line_of_action)[0] == pytest.approx(inside, abs=0.0)
    assert not edges.beyond(inside).any()


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(SMALL, tolerance=0.02)


def _of(bodies: PairCompliance, torque: float) -> MeshCycle:
    return mesh_cycle(bodies.pair, torque, 6, bodies, cells=24)


def _relative(cycle: MeshCycle) -> Array:
    beyond = cycle.beyond_path_change
    assert beyond is not None
    return np.asarray(beyond.deflection * cycle.secant_stiffness / cycle.force)


@pytest.mark.slow
def test_more_load_reaches_farther_and_no_load_nowhere(bodies: PairCompliance) -> None:
    cycles = [_of(bodies, torque) for torque in (1e-4, 2.0, 8.0, 32.0)]
    changes = [float(_relative(cycle).max()) for cycle in cycles]
    print(changes, [cycle.model_error for cycle in cycles])
    assert changes[0] < 1e-4
    assert np.all(np.diff(changes) > 0.0)
    assert np.all(np.diff([cycle.model_error for cycle in cycles]) > 0.0)
    beyond = cycles[-1].beyond_path_change
    assert beyond is not None
    assert 0.0 < beyond.share.mean() < 0.3
    for cycle in cycles:
        assert cycle.model_error == pytest.approx(cycle.flank_error + _relative(cycle).max(), rel=1e-12)


@pytest.mark.slow
def test_long_tip_relief_leaves_nothing_beyond_the_path(bodies: PairCompliance) -> None:
    """Both tips relieved by more than the deflection: no edge touches, and the model error is that of flanks."""
    relief = TipRelief(amount=30e-6, length=0.6e-3)
    pinion, wheel = (replace(gear, tip_relief=relief) for gear in (SMALL.pinion, SMALL.wheel))
    relieved = replace(SMALL, pinion=pinion, wheel=wheel)
    cycle = _of(replace(bodies, pair=relieved), 8.0)
    beyond = cycle.beyond_path_change
    assert beyond is not None
    assert cycle.transmission_error.max() < 30e-6
    assert not beyond.share.any()
    assert _relative(cycle).max() < 2e-3  # by other cells alone
    assert _relative(_of(bodies, 8.0)).max() > 1e-2


@pytest.mark.slow
def test_lines_beyond_the_path_in_the_model_change_what_the_model_error_says(bodies: PairCompliance) -> None:
    """Two ways to one solution: its cells end elsewhere, which errors of the cells hold."""
    held, free = (mesh_cycle(SMALL, 8.0, 6, bodies, beyond_path=edges, cells=24) for edges in (False, True))
    beyond, lines = held.beyond_path_change, free.lines
    assert beyond is not None
    assert lines is not None
    assert held.lines is not None
    change = held.transmission_error - free.transmission_error
    print(change, beyond.deflection, free.error, held.error)
    assert change == pytest.approx(
        beyond.deflection, abs=(free.error + held.error) * held.transmission_error.max()
    )
    assert free.beyond_path_change is None
    assert free.model_error == free.flank_error < 0.2 * held.model_error
    # the torque is carried by levers that are shorter at the pinion's edges alone
    across = lines.force.sum(axis=(1, 2)) * SMALL.helix.base_cosine * SMALL.base_radii[0] / 8.0
    assert np.all(across >= 1.0 - 1e-12)
    assert across.max() < 1.005
    # lengths are those between the ends of the path; cells go on beyond them, and those farthest out are clear
    assert lines.whole_length == pytest.approx(held.lines.whole_length, rel=1e-9)
    path = SMALL.points.E - SMALL.points.A
    assert np.nanmin(lines.travel) < 0.0
    assert np.nanmax(lines.travel) > path
    load = np.nan_to_num(lines.line_load)
    farthest = np.maximum(-np.nan_to_num(lines.travel), np.nan_to_num(lines.travel) - path)
    assert load[farthest >= 0.95 * farthest.max()].max() == 0.0
    assert load[farthest > 0.0].max() > 0.0
    assert lines.rho[0][np.isfinite(lines.rho[0])].max() <= SMALL.points.E


@pytest.mark.slow
def test_the_other_hand_and_back_flanks_have_the_same_edges(bodies: PairCompliance) -> None:
    """As on the path: mirrors, but for ends that are solved anew."""
    left = replace(SMALL, helix_angle=-SMALL.helix_angle)
    other = compliance(left, tolerance=0.02)
    one = mesh_cycle(SMALL, 8.0, 6, bodies, beyond_path=True, cells=24)
    two = mesh_cycle(left, 8.0, 6, other, beyond_path=True, cells=24)
    assert two.transmission_error == pytest.approx(one.transmission_error, rel=2e-3)
    assert two.stiffness == pytest.approx(one.stiffness, rel=4e-3)
    braking = mesh_cycle(SMALL, -8.0, 12, bodies, beyond_path=True, cells=24)
    driving = mesh_cycle(left, 8.0, 12, other, beyond_path=True, cells=24)
    assert braking.secant_stiffness.mean() == pytest.approx(driving.secant_stiffness.mean(), rel=0.01)


def test_films_are_on_the_part_of_each_cell_that_is_on_the_path():
    """Their parts add up to the lines' length there, so that none comes at once where a line moves on."""
    for setup in (SETUP, replace(SETUP, tip_rounding=0.03e-3)):
        lines = contact_candidates(setup, 0.1).lines
        assert lines is not None
        cells = lines.divided(40)
        part, places = lines.on_path(cells), lines.film_places(cells)
        length = (part * cells.length[..., None]).sum(axis=-1)[lines.touches]
        assert length == pytest.approx(lines.length_on_path[lines.touches], abs=1e-12)
        assert np.array_equal(np.isfinite(places), part > 0.0)
        wet = places[part > 0.0]
        assert wet.min() >= setup.ends[0]
        assert wet.max() <= setup.ends[1]
        assert np.count_nonzero(part == 0.0) > np.count_nonzero(~cells.used)
    held = contact_candidates(replace(SETUP, beyond_path=False)).lines
    assert held is not None
    assert np.array_equal(held.on_path(held.divided(40)), held.divided(40).used)


def test_tip_edges_slide_as_in_the_section():
    """Arms of both gears at places beyond the path; on it they are the curvature radii."""
    lines, pitch, line = contact_candidates(SETUP, 0.3).lines, SMALL.base_pitch, SMALL.line_of_action
    assert lines is not None
    away = pitch * np.array([0.0123, 0.0777, 0.211])
    for corner, place in ((1, SMALL.points.A - away), (0, SMALL.points.E + away)):
        at, arms = edges_at(SETUP.flanks, corner, place), lines.arms(place, SMALL.base_radii)
        assert arms[corner] == pytest.approx(at.arm, abs=1e-4 * SMALL.module)
        assert arms[1 - corner] == pytest.approx(at.touched_rho, abs=2e-5 * SMALL.module)
    inside = np.linspace(SMALL.points.A, SMALL.points.E, 7)
    assert np.array_equal(lines.arms(inside, SMALL.base_radii), np.stack([inside, line - inside]))


def _film(rho1: Array, forces: Array) -> tuple[Array, Array]:
    """Separation of .4 um at no load, which falls with the force of a whole face."""
    pressed = 1.0 + np.maximum(forces, 0.0) / 500.0
    return 0.4e-6 / np.sqrt(pressed), -0.4e-6 / (2.0 * 500.0 * pressed**1.5)


@pytest.mark.slow
def test_a_thick_film_keeps_dry_edges_apart(bodies: PairCompliance) -> None:
    """By an even film flanks on the path touch as much earlier, and edges no more: the pair held to the path."""
    thick, cosine = 50e-6, SMALL.helix.base_cosine

    def even(rho1: Array, forces: Array) -> tuple[Array, Array]:
        return np.full(forces.shape, thick), np.zeros(forces.shape)

    held, free = (mesh_cycle(SMALL, 8.0, 6, bodies, beyond_path=edges, cells=24) for edges in (False, True))
    apart = mesh_cycle(SMALL, 8.0, 6, bodies, beyond_path=True, cells=24, film=even)
    assert apart.lines is not None
    assert free.lines is not None
    beyond = (1.0 - apart.lines.on_path) * apart.lines.force
    carried = (1.0 - free.lines.on_path) * free.lines.force
    print(np.c_[held.transmission_error, free.transmission_error, apart.transmission_error + thick / cosine])
    assert beyond.sum() < 0.05 * carried.sum()
    allowed = (held.error + apart.error) * held.transmission_error.max()
    assert apart.transmission_error + thick / cosine == pytest.approx(held.transmission_error, abs=allowed)
    assert np.max(held.transmission_error - free.transmission_error) > 5.0 * allowed


@pytest.mark.slow
@pytest.mark.parametrize("film", [None, _film])
def test_the_tangent_is_the_slope_of_the_torque(bodies: PairCompliance, film: Film | None) -> None:
    """With tip edges, dry and with films: central differences of the deflection over 0.2 % of the torque."""
    torques = 8.0 * np.array([0.999, 1.0, 1.001])
    low, middle, high = mesh_cycle(SMALL, torques, 6, bodies, beyond_path=True, cells=24, film=film)
    slope = (high.force - low.force) / (high.transmission_error - low.transmission_error)
    print(slope / middle.stiffness - 1.0)
    assert middle.stiffness == pytest.approx(slope, rel=2e-3)
    assert middle.load_share.sum(axis=1) == pytest.approx(np.ones(6), abs=1e-12)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("angle", [1e-6, 1e-3])
def test_a_small_helix_has_what_tip_edges_of_the_spur_pair_change(angle: float) -> None:
    """Position by position, and the errors of flanks are those of the spur pair with cells.

    Left apart are the lean of forces at edges and the last modules of the face, where a helix solves free ends anew.
    """
    spur = replace(SMALL, helix_angle=0.0)
    known, helical = compliance(spur, tolerance=0.02), replace(SMALL, helix_angle=radians(angle))
    held, free = (mesh_cycle(spur, 8.0, 12, known, beyond_path=edges, cells=24) for edges in (False, True))
    cycle = mesh_cycle(helical, 8.0, 12, compliance(helical, tolerance=0.02), cells=24)
    beyond = cycle.beyond_path_change
    assert beyond is not None
    change = held.transmission_error - free.transmission_error
    print(np.c_[change, beyond.deflection] * 1e6, held.model_error, cycle.flank_error)
    assert change.max() > 0.1 * held.transmission_error.max()
    assert beyond.deflection == pytest.approx(change, rel=0.03, abs=2e-3 * held.transmission_error.max())
    assert cycle.flank_error == pytest.approx(held.model_error, rel=0.2)
    assert cycle.lines is not None
    assert cycle.lines.whole_length == pytest.approx(contact_lines(helical).length(cycle.position), rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_levers_of_edges_balance_torque_and_power(bodies: PairCompliance, friction: float) -> None:
    """Shares add up to 1 at each position; yielding teeth store energy, which evens out over the cycle."""
    cycle = mesh_cycle(SMALL, 8.0, 12, bodies, beyond_path=True, cells=24, friction=friction)
    assert cycle.load_share.sum(axis=1) == pytest.approx(np.ones(12), abs=1e-12)
    first, second = SMALL.base_radii
    given = (cycle.wheel_torque * first / second + cycle.friction_loss(1.0)) / 8.0
    print(given)
    assert np.ptp(given) > 1e-3
    assert given.mean() == pytest.approx(1.0, abs=2e-4)


@pytest.mark.slow
def test_roots_carry_lines_that_begin_beyond_the_path_where_they_are(bodies: PairCompliance) -> None:
    """Places of the forces on both flanks: along the line, and held to the path at edges."""
    free = mesh_cycle(SMALL, 8.0, 6, bodies, beyond_path=True, cells=24)
    lines = free.lines
    assert lines is not None
    (row, column), *_ = np.argwhere(
        (np.nan_to_num(lines.travel[..., 0]) < 0.0) & (lines.length > 0.0)
    ).tolist()
    used, start = np.isfinite(lines.z[row, column]), SMALL.points.A
    assert (lines.travel[row, column, used] > 0.0).any()
    for gear in (0, 1):
        roots = LineRoots(None, lines, gear, free.pair_offset, 0.0, 0.0)  # type: ignore[arg-type]
        load = roots._load(row, column, np.ones(24))
        assert load is not None
        rho1 = np.clip(lines.travel[row, column, used] + start, start, SMALL.points.E)
        rho = rho1 if gear == 0 else SMALL.line_of_action - rho1
        assert load.z == pytest.approx(lines.z[row, column, used], abs=1e-12)
        assert load.rho == pytest.approx(rho, abs=1e-12)


def test_rounded_edges_are_those_of_the_section():
    """A radius that goes to 0 is the sharp edge; a larger one begins earlier and opens less at once."""
    gaps = []
    for radius in (0.0, 1e-9, 0.05e-3):
        setup = replace(SETUP, tip_rounding=radius)
        edges = setup.flanks.edges(0.3)
        assert edges.ends == setup.ends
        gaps.append(edges.gaps(SMALL.points.E + SMALL.base_pitch * np.array([0.05, 0.1, 0.2])))
        at = edges_at(setup.flanks, 0, edges.ends[1] + SMALL.base_pitch * np.array([0.05, 0.1]))
        found = edges.gaps(edges.ends[1] + SMALL.base_pitch * np.array([0.05, 0.1]))
        assert found == pytest.approx(at.gap, rel=1e-3)
    assert gaps[1] == pytest.approx(gaps[0], rel=1e-4)
    assert np.all(gaps[2] > gaps[0])


@pytest.mark.slow
def test_a_small_radius_is_the_sharp_edge(bodies: PairCompliance) -> None:
    """And a larger one lets less of the load beyond the path."""
    sharp, small, large = (
        mesh_cycle(SMALL, 8.0, 6, bodies, beyond_path=True, cells=24, tip_rounding=radius)
        for radius in (0.0, 0.2e-6, 0.06e-3)
    )
    print(small.transmission_error / sharp.transmission_error - 1.0, large.transmission_error)
    assert small.transmission_error == pytest.approx(sharp.transmission_error, rel=2.0 * sharp.error)
    assert large.transmission_error.max() > sharp.transmission_error.max()
    for cycle in (small, large):
        assert cycle.load_share.sum(axis=1) == pytest.approx(np.ones(6), abs=1e-12)


def test_rounded_edges_ask_for_contact_beyond_the_path():
    with pytest.raises(InputError, match=r"tip_rounding.*beyond_path=True"):
        mesh_cycle(SMALL, 8.0, tip_rounding=1e-5)


@pytest.mark.slow
@pytest.mark.long
def test_a_small_helix_has_the_rounded_edges_of_the_spur_pair() -> None:
    """Deflections, shares and the paths' ends, by another code."""
    spur = replace(SMALL, helix_angle=0.0)
    found = [
        mesh_cycle(
            pair, 8.0, 12, compliance(pair, tolerance=0.02), beyond_path=True, cells=24, tip_rounding=0.05e-3
        )
        for pair in (spur, replace(spur, helix_angle=1e-6))
    ]
    straight, twisted = found
    error = straight.error + twisted.error
    print(twisted.transmission_error / straight.transmission_error - 1.0, error)
    assert twisted.transmission_error == pytest.approx(straight.transmission_error, rel=error)
    assert twisted.stiffness == pytest.approx(straight.stiffness, rel=2.0 * error)
    share = [np.sort(each.load_share, axis=1)[:, -2:] for each in found]
    assert share[1] == pytest.approx(share[0], abs=error)
