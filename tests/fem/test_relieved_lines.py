"""Lines of contact on relieved flanks: gaps against drawn flanks, and a small helix against the spur pair."""

from __future__ import annotations

import pickle
from dataclasses import replace
from math import radians

import numpy as np
import pytest

from base import Array
from fem import compliance, mesh_cycle, unloaded_transmission_error
from fem.laws.contact_candidates import SEEN_ALONG, contact_candidates, line_gaps
from fem.laws.line_friction import further_levers
from fem.laws.mesh_setup import MeshSetup
from fem.laws.relieved_flanks import SPAN, touch
from fem.laws.tip_edges import edges_at
from gears import Gear, GearPair, TipRelief

FORMS = [TipRelief(20e-6, 3e-3), TipRelief(20e-6, 2.5e-3), TipRelief(20e-6, 3e-3, "parabolic")]


def relieved(relief: TipRelief, helix_angle: float) -> GearPair:
    gears = Gear(36, tip_relief=relief), Gear(40, tip_relief=relief)
    return GearPair(*gears, 2e-3, 40e-3, helix_angle=helix_angle)


def small(relief: TipRelief, helix_angle: float) -> GearPair:
    gears = Gear(18, tip_relief=relief), Gear(23, tip_relief=relief)
    return GearPair(*gears, 1e-3, 5e-3, helix_angle=helix_angle)


def plain_flanks(pair: GearPair) -> GearPair:
    pinion, wheel = (replace(gear, tip_relief=None) for gear in (pair.pinion, pair.wheel))
    return replace(pair, pinion=pinion, wheel=wheel)


def drawn_flanks(pair: GearPair, place: float, points: int) -> list[Array]:
    """Flanks whose involutes touch at a place, as curves (2, points) in the section about the pinion's axis.

    The line of action is along x, from the foot of the pinion's axis.
    """
    line, removed, curves = pair.line_of_action, [profile.relief for profile in pair.teeth_profiles], []
    axes = np.zeros(2), np.array([line, sum(pair.base_radii)])
    for gear, (nominal, side) in enumerate(((place, 1.0), (line - place, -1.0))):
        base, tip = pair.base_radii[gear], pair.teeth_profiles[gear].flank_rho[1]
        rho = np.linspace(max(nominal - 2e-3, 1e-4), min(nominal + 2e-3, tip), points)
        turn, string = (rho - nominal) / base, rho - removed[gear](rho)
        # foot of the normal on the base circle, and the string from it, turned about the gear's axis
        x, y = side * string, side * np.full_like(rho, base)
        curve = np.stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)])
        curves.append(curve + axes[gear][:, None])
    return curves


def drawn_touch(flanks: list[Array]) -> tuple[float, int]:
    """Smallest angle between points of one radius about the pinion's axis, and where it is on the wheel's flank.

    By that angle the pinion turns until the flanks meet.
    """
    (radius, angle), (other, behind) = (
        (np.hypot(*curve), np.arctan2(curve[1], curve[0])) for curve in flanks
    )
    order = np.argsort(radius)
    between = np.interp(other, radius[order], angle[order]) - behind
    between[(other < radius.min()) | (other > radius.max())] = np.inf
    nearest = int(np.argmin(between))
    return float(between[nearest]), nearest


def drawn_gap(pair: GearPair, place: float) -> float:
    """Turn of the pinion, times its base radius, until flanks meet whose involutes touch at a place."""
    turn, _ = drawn_touch(drawn_flanks(pair, place, 6_001))
    return turn * pair.base_radii[0]


@pytest.mark.parametrize("relief", FORMS)
@pytest.mark.parametrize("angle", [1e-6, 1e-3, 0.3])
def test_with_no_load_lines_touch_where_drawn_flanks_do(relief: TipRelief, angle: float) -> None:
    """The transmission error is the smallest gap of all sections; nearly straight it is that of the spur pair."""
    pair, positions = relieved(relief, radians(angle)), 10
    found = unloaded_transmission_error(pair, positions, False)
    slope, steepness = pair.helix.base_tangent, relief.amount / relief.length
    place = np.linspace(pair.points.A, pair.points.E, 121)
    gap = np.array([drawn_gap(pair, each) for each in place])
    half, ahead = 0.5 * pair.face_width * slope, np.arange(-2, 4) * pair.base_pitch
    expected = []
    for position in (np.arange(positions) + 0.5) / positions:
        middle = pair.points.A + position * pair.base_pitch + ahead
        along = np.linspace(middle - half, middle + half, 1001)
        along = along[(along >= pair.points.A) & (along <= pair.points.E)]
        expected.append(np.interp(along, place, gap).min())
    # first touches are looked for at middles of parts of each line; kinks of linear relief are rounded over SPAN
    seen = half / SEEN_ALONG * steepness * (2.0 if relief.form == "parabolic" else 1.0)
    rounded = steepness * SPAN * pair.module / 4 if relief.form == "linear" else 5e-9
    assert found == pytest.approx(np.array(expected), abs=seen + rounded)
    assert found.max() > 3.0 * (seen + rounded)
    if angle < 0.1:
        spur = unloaded_transmission_error(relieved(relief, 0.0), positions, False)
        assert found == pytest.approx(spur, abs=2.0 * half * steepness + 1e-9)


@pytest.mark.parametrize("relief", FORMS)
def test_touched_flanks_slide_as_two_drawn_bodies(relief: TipRelief) -> None:
    """Velocities of both bodies at the point where drawn flanks meet, along these; the normal leans on relief.

    Gears turn evenly. Flanks are drawn before the pinion closes the gap, which moves the point by as much, and kinks of
    linear relief are not rounded.
    """
    pair = relieved(relief, 0.0)
    (first, second), setup = pair.base_radii, MeshSetup(pair, 4)
    assert setup.removed is not None
    place = np.linspace(pair.points.A + 0.1e-3, pair.points.E - 0.1e-3, 11)
    at, moved = touch(setup.flanks, place, setup.removed), []
    for each in place:
        flanks = drawn_flanks(pair, each, 60_001)
        _, nearest = drawn_touch(flanks)
        (x, y), along = flanks[1][:, nearest], np.gradient(flanks[1], axis=1)[:, nearest]
        away = np.array([x - pair.line_of_action, y - first - second])
        velocities = np.array([[-y, x], [away[1] * first / second, -away[0] * first / second]])
        moved.append(np.abs(velocities @ along) / np.hypot(*along))
    arms = at.arm * np.array([[1.0], [first / second]])
    assert arms == pytest.approx(np.array(moved).T, abs=0.1e-3 if relief.form == "linear" else 0.03e-3)
    sliding, nominal = arms[0] - arms[1], place - (pair.line_of_action - place) * first / second
    assert sliding == pytest.approx(nominal, abs=0.01e-3)  # as of the involutes there
    assert np.abs(at.rho[0] - at.rho[1] * first / second - nominal).max() > 0.4e-3


@pytest.mark.parametrize("relief", FORMS)
@pytest.mark.parametrize("edges", [False, True])
def test_sections_of_lines_are_those_of_a_spur_pair(relief: TipRelief, edges: bool) -> None:
    """Gap, places, levers and curvature on the flanks, beyond the path too; farther out those of edges."""
    pair = relieved(relief, radians(20.0))
    setup = MeshSetup(pair, 4, beyond_path=edges)
    lines = contact_candidates(setup).lines
    assert lines is not None
    assert setup.removed is not None
    start, end = setup.flanks.touching_ends if edges else setup.ends
    place = np.linspace(start, end, 2998)
    at, rho = touch(setup.flanks, place, setup.removed), lines.rho(place)
    gap = line_gaps(setup, np.zeros_like(place), rho) + lines.further_gaps(place)
    assert gap == pytest.approx(at.gap, abs=1e-9)
    assert rho == pytest.approx(at.rho, abs=5e-6)
    assert lines.levers(place) == pytest.approx(at.lever, abs=1e-4)
    assert lines.arms(place, pair.base_radii) == pytest.approx(at.arm, abs=5e-6)
    assert np.median(np.abs(lines.curvatures(place) - at.curvature)) < 1e-4
    assert not lines.edge_touches(place).any()
    if not edges:
        return
    assert start < setup.ends[0] < setup.ends[1] < end  # flanks touch on beyond the path
    for corner, outside in ((1, start - np.linspace(1e-9, 1e-3, 9)), (0, end + np.linspace(1e-9, 1e-3, 9))):
        edge = edges_at(setup.flanks, corner, outside)
        rho = lines.rho(outside)
        gap = line_gaps(setup, np.zeros_like(outside), rho) + lines.further_gaps(outside)
        assert gap == pytest.approx(edge.gap, abs=2e-9)
        assert lines.edge_touches(outside).all()
        assert lines.levers(outside)[corner] == pytest.approx(edge.lever, rel=1e-5)
        assert lines.arms(outside, pair.base_radii)[corner] == pytest.approx(edge.arm, rel=1e-3)
        # nothing steps where flanks give way to edges
        last = start if corner == 1 else end
        assert gap[0] == pytest.approx(
            float(touch(setup.flanks, np.array([last]), setup.removed).gap[0]), abs=5e-9
        )


def test_lengths_and_films_stay_on_the_path() -> None:
    """Where relieved flanks touch beyond A and E they are dry, and lengths are those between A and E."""
    plain, eased = (relieved(relief, radians(20.0)) for relief in (TipRelief(1e-15, 3e-3), FORMS[0]))
    lengths = []
    for pair in (plain, eased):
        setup = MeshSetup(pair, 5)
        lines = contact_candidates(setup).lines
        assert lines is not None
        cells = lines.divided(40)
        places, part = lines.film_places(cells), lines.on_path(cells)
        assert np.nanmin(places) >= setup.ends[0]
        assert np.nanmax(places) <= setup.ends[1]
        assert np.array_equal(np.isfinite(places), part > 0.0)
        lengths.append(lines.length_on_path.sum(axis=1))
    assert lengths[1] == pytest.approx(lengths[0], rel=1e-9)


def test_relief_of_nothing_is_the_plain_pair() -> None:
    """Gaps, places, levers and curvatures of lines by tables are those of involutes."""
    pair = relieved(TipRelief(1e-15, 2e-3, "parabolic"), radians(20.0))
    for edges in (False, True):
        setup = MeshSetup(pair, 4, beyond_path=edges, friction=0.1)
        plain, eased = (
            contact_candidates(replace(setup, pair=each)).lines for each in (plain_flanks(pair), pair)
        )
        assert plain is not None
        assert eased is not None
        reached = (pair.points.A, pair.points.E) if plain.edges is None else plain.edges.reached
        place = np.linspace(*reached, 99)
        assert eased.rho(place) == pytest.approx(plain.rho(place), abs=1e-9)
        assert eased.further_gaps(place) == pytest.approx(plain.further_gaps(place), abs=1e-11)
        assert eased.levers(place) == pytest.approx(plain.levers(place), abs=1e-7)
        assert eased.curvatures(place) == pytest.approx(1.0, abs=1e-6)
        arms = (each.arms(place, pair.base_radii) for each in (eased, plain))
        np.testing.assert_allclose(*arms, rtol=1e-7 if edges else 1e-10)
        further = (further_levers(setup, lines, 40) for lines in (eased, plain))
        # edges begin where a search finds the end of the flank, by which cells are shifted
        np.testing.assert_allclose(*further, rtol=1e-6 if edges else 1e-10)


@pytest.mark.parametrize("edges", [False, True])
def test_tables_are_found_once_for_all_positions(edges: bool) -> None:
    """Lines at any positions touch by the same tables; gears that differ have others, and so have copies."""
    pair = relieved(FORMS[0], radians(20.0))
    setup = MeshSetup(pair, 4, beyond_path=edges)
    lines = [
        contact_candidates(each, 0.3).lines
        for each in (setup.at(np.array([0.1])), setup.opposite.at(np.ones(2)))
    ]
    assert lines[0] is not None
    assert lines[1] is not None
    assert lines[0].relieved is lines[1].relieved is setup.relieved
    assert lines[0].edges is lines[1].edges
    other = relieved(TipRelief(15e-6, 3e-3), radians(20.0))
    for differs in (replace(setup, pair=other), replace(setup, tip_rounding=1e-5)):
        assert differs.flanks is not setup.flanks
        found, anew = (
            contact_candidates(differs).lines,
            contact_candidates(MeshSetup(differs.pair, 4, edges)).lines,
        )
        assert found is not None
        assert anew is not None
        assert found.relieved is not setup.relieved
        if not differs.tip_rounding:
            np.testing.assert_array_equal(found.rho(pair.points.E), anew.rho(pair.points.E))
    copy = pickle.loads(pickle.dumps(setup))
    assert copy.relieved is not setup.relieved
    np.testing.assert_array_equal(copy.relieved.gap, setup.relieved.gap)


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("edges", [False, True])
def test_a_small_helix_has_the_transmission_error_of_the_spur_pair(edges: bool) -> None:
    """With next to no load and with much, held to the path and beyond it, by another code for cells of the face."""
    relief = TipRelief(20e-6, 1.4e-3)
    straight, twisted = (
        mesh_cycle(pair, [1e-3, 8.0], 12, compliance(pair, tolerance=0.02), beyond_path=edges, cells=16)
        for pair in (small(relief, 0.0), small(relief, 1e-6))
    )
    for spur, helix in zip(straight, twisted, strict=True):
        error = (spur.error + helix.error) * spur.transmission_error.max()
        assert helix.transmission_error == pytest.approx(spur.transmission_error, abs=error)
        assert helix.stiffness == pytest.approx(spur.stiffness, rel=2.0 * (spur.error + helix.error))
        # relief turns the normal, which shifts torque to the wheel and back by some per cent
        assert np.ptp(spur.wheel_torque) > 0.01 * spur.wheel_torque.mean()
        assert helix.wheel_torque == pytest.approx(spur.wheel_torque, rel=5e-4)
    light = straight[0]
    assert np.ptp(light.transmission_error) > 100.0 * light.error * light.transmission_error.max()
