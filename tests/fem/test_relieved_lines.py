"""Lines of contact on relieved flanks: gaps against drawn flanks, and a small helix against the spur pair."""

from __future__ import annotations

import pickle
from dataclasses import replace
from math import radians

import numpy as np
import pytest

from fem import compliance, mesh_cycle, unloaded_transmission_error
from fem.laws.contact_candidates import SEEN_ALONG, contact_candidates, line_gaps
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


def drawn_gap(pair: GearPair, place: float) -> float:
    """Turn of the pinion, times its base radius, until flanks meet whose involutes touch at a place.

    Both flanks are curves in the section, with the line of action along x from the foot of the pinion's axis; the
    smallest angle between points of one radius about the pinion's axis is that by which it turns.
    """
    line, removed = pair.line_of_action, [profile.relief for profile in pair.teeth_profiles]
    axes, polar = (np.array([0.0, -pair.base_radii[0]]), np.array([line, pair.base_radii[1]])), []
    for gear, (nominal, side) in enumerate(((place, 1.0), (line - place, -1.0))):
        base, tip = pair.base_radii[gear], pair.teeth_profiles[gear].flank_rho[1]
        rho = np.linspace(max(nominal - 2e-3, 1e-4), min(nominal + 2e-3, tip), 6_001)
        turn, string = (rho - nominal) / base, rho - removed[gear](rho)
        # foot of the normal on the base circle, and the string from it, turned about the gear's axis
        x, y = side * string, side * np.full_like(rho, base)
        points = np.stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)])
        away = points + (axes[gear] - axes[0])[:, None]
        order = np.argsort(np.hypot(*away))
        polar.append((np.hypot(*away)[order], np.arctan2(away[1], away[0])[order]))
    (radius, pinion), (other, wheel) = polar
    both = (other >= radius[0]) & (other <= radius[-1])
    return float(np.min(np.interp(other[both], radius, pinion) - wheel[both]) * pair.base_radii[0])


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
        plain, eased = (
            contact_candidates(MeshSetup(each, 4, beyond_path=edges)).lines
            for each in (plain_flanks(pair), pair)
        )
        assert plain is not None
        assert eased is not None
        reached = (pair.points.A, pair.points.E) if plain.edges is None else plain.edges.reached
        place = np.linspace(*reached, 99)
        assert eased.rho(place) == pytest.approx(plain.rho(place), abs=1e-9)
        assert eased.further_gaps(place) == pytest.approx(plain.further_gaps(place), abs=1e-11)
        assert eased.levers(place) == pytest.approx(plain.levers(place), abs=1e-7)
        assert eased.curvatures(place) == pytest.approx(1.0, abs=1e-6)


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
