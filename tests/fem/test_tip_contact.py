"""The law of a tip edge: exact gaps, the wedge's own scaling, and Hertz where the corner does not matter."""

from __future__ import annotations

import numpy as np
import pytest

import fem
from fem.elasticity.line_load import flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.ring import mesh_and_factor, ring_of
from fem.influence.strip_contact import flat_kernel, flat_kernels, from_the_corner, from_the_nearest
from fem.influence.tip_strips import tip_strips
from fem.laws.local_law import Table
from fem.laws.tip_contact import edge_laws
from fem.laws.tip_geometry import lever_ratio, opening, unloaded_gap
from gears.tooth.rotation import mirrored, turned
from meshes import Sizes, mesh_sector
from tests.fem.test_ring import whole_annulus

LAW = PlaneElasticity("strain", 206e9, 0.3)


def placed_flank(pair, gear, rho, rho1):
    """Left flank of a gear in the common frame, by the profile and the placement: no formula of ours."""
    place = pair.placement(float(pair.points.C))
    points = mirrored(pair.teeth_profiles[gear].involute(rho))
    # both gears turned back or forth from the pitch point by the travel along the line of action
    turn = (rho1 - pair.points.C) / pair.base_radii[gear]
    if gear == 0:
        return turned(points, place.pinion_angle + turn)
    return turned(points, place.wheel_angle - turn) + place.wheel_centre


@pytest.mark.parametrize("travel", [-0.3e-3, -1.1e-3])
def test_gap_before_A_is_that_of_the_placed_teeth(article_pair, travel):
    rho1 = article_pair.points.A + travel
    end = article_pair.teeth_profiles[1].flank_rho[1]
    rho2 = np.array([end, end - 1e-4, end - 5e-4])
    gap, where = unloaded_gap(article_pair.base_radii, article_pair.line_of_action, np.array([rho1]), rho2)
    corner = placed_flank(article_pair, 1, rho2, rho1)
    radius = np.linalg.norm(corner, axis=1)
    np.testing.assert_allclose(where[0], np.sqrt(radius**2 - article_pair.base_radii[0] ** 2), rtol=1e-9)
    flank = placed_flank(article_pair, 0, where[0], rho1)
    angle = np.arctan2(corner[:, 1], corner[:, 0]) - np.arctan2(flank[:, 1], flank[:, 0])
    # the pinion turns anticlockwise by this angle until its flank meets the corner
    np.testing.assert_allclose(gap[0], angle * article_pair.base_radii[0], rtol=1e-6)
    assert np.all(np.diff(gap[0]) > 0)  # the corner is nearest


def test_gap_on_the_path_is_a_parabola_around_the_contact(article_pair):
    line, C = article_pair.line_of_action, article_pair.points.C
    rho2 = line - C + np.array([-2e-4, 0.0, 2e-4])
    gap, where = unloaded_gap(article_pair.base_radii, line, np.array([C]), rho2)
    assert gap[0, 1] == pytest.approx(0.0, abs=1e-16)
    assert where[0, 1] == pytest.approx(C, rel=1e-12)
    arc = (line - C) / article_pair.base_radii[1] * 2e-4
    R = float(article_pair.path_at(C).radius[0])
    np.testing.assert_allclose(gap[0, [0, 2]], arc**2 / (2 * R), rtol=0.05)


def test_unloaded_gaps_at_the_pitch_point(article_pair):
    """17.9 and 19.7 um beyond A and E with a pair at C, from an independent study."""
    line, points = article_pair.line_of_action, article_pair.points
    ends = [profile.flank_rho[1] for profile in article_pair.teeth_profiles]
    radii = article_pair.base_radii
    before, _ = unloaded_gap(radii, line, np.array([points.C - article_pair.base_pitch]), np.array([ends[1]]))
    after, _ = unloaded_gap(
        radii[::-1], line, np.array([line - points.C - article_pair.base_pitch]), np.array([ends[0]])
    )
    assert before[0, 0] * 1e6 == pytest.approx(17.9, abs=0.05)
    assert after[0, 0] * 1e6 == pytest.approx(19.7, abs=0.05)


def test_lever_is_the_distance_of_the_flanks_normal_from_the_axis(article_pair):
    rho1, rho2 = article_pair.points.E + 8e-4, article_pair.line_of_action - article_pair.points.E + 3e-4
    kappa = lever_ratio(article_pair, np.array([rho2]), np.array([rho1]))[0]
    here, near = placed_flank(article_pair, 1, np.array([rho2, rho2 + 1e-8]), rho1)
    along = (near - here) / np.linalg.norm(near - here)
    assert kappa * article_pair.base_radii[0] == pytest.approx(abs(here @ along), rel=1e-6)
    # a force on the line of action itself has the base radius for lever
    unit = lever_ratio(article_pair, np.array([article_pair.line_of_action - rho1]), np.array([rho1]))[0]
    assert unit == pytest.approx(1.0, rel=1e-12)


@pytest.fixture(scope="module")
def wheel_tip(article_pair):
    rings = mesh_and_factor(article_pair, "strain", Sizes(), 1)
    return rings[1], tip_strips(rings[1], article_pair.teeth_profiles[1])


def test_opening_is_the_angle_between_the_normals_of_the_placed_flanks(article_pair):
    line, rho1 = article_pair.line_of_action, np.array([article_pair.points.A - 0.7e-3])
    rho2 = article_pair.teeth_profiles[1].flank_rho[1] - np.array([0.0, 2e-4])
    gap, where = unloaded_gap(article_pair.base_radii, line, rho1, rho2)
    angle = opening(article_pair.base_radii, line, rho1, where, rho2)[0]
    for k in (0, 1):
        tangents = []
        for gear, rho in ((0, where[0, k]), (1, rho2[k])):
            ahead, here = placed_flank(article_pair, gear, np.array([rho + 1e-8, rho]), float(rho1[0]))
            tangents.append((ahead - here) / np.linalg.norm(ahead - here))
        # tangents run to the tips, against one another
        assert angle[k] == pytest.approx(np.arccos(-tangents[0] @ tangents[1]), rel=1e-5)
    assert angle[1] > angle[0] > 0
    # the leaning force misses the axis of its own gear by the lever that the other formula gives
    ratio = rho2[0] / article_pair.base_radii[1]
    lever = lever_ratio(article_pair, where[:, 0], rho1, 1)[0]
    assert np.cos(angle[0]) - ratio * np.sin(angle[0]) == pytest.approx(
        lever, abs=gap[0, 0] / article_pair.base_radii[1]
    )


def test_kernel_is_symmetric_and_definite(wheel_tip):
    _, strips = wheel_tip
    mean = flat_kernel(strips.distance, strips.width, LAW, 2e-3)
    regular = strips.kernel - mean
    np.testing.assert_allclose(regular, regular.T, rtol=1e-3)
    both = strips.kernel + mean
    assert np.all(np.linalg.eigvalsh(0.5 * (both + both.T)) > 0)


def test_leaning_kernel_is_symmetric_and_without_leaning_the_normal_one(wheel_tip):
    _, strips = wheel_tip
    np.testing.assert_array_equal(strips.leaning(np.zeros((2, len(strips.rho)))), [strips.kernel] * 2)
    angle = 0.03 + np.linspace(0.0, 0.2, len(strips.rho))[None]
    leaning = strips.leaning(angle)[0]
    flat = flat_kernel(strips.distance, strips.width, LAW, 2e-3) * np.cos(angle - angle.T)
    np.testing.assert_allclose(leaning - flat, (leaning - flat).T, rtol=0, atol=2e-3 * leaning.max())
    assert np.all(np.linalg.eigvalsh(leaning + leaning.T) > 0)
    # leaning away from the tip the force bends the tooth less
    assert np.all(np.diag(leaning) < np.diag(strips.kernel))
    tangent = strips.leaning(np.full((1, len(strips.rho)), -0.5 * np.pi))[0]
    np.testing.assert_allclose(tangent, strips.tangential, rtol=1e-9)


def test_regular_parts_are_smooth_where_strips_pass_one_another_and_the_elements_end(wheel_tip):
    _, strips = wheel_tip
    flat = flat_kernels(strips.distance, strips.width, LAW, 2e-3)
    for whole, half_plane in zip((strips.kernel, strips.mixed, strips.tangential), flat, strict=True):
        regular = (whole - half_plane)[3:31, 3:31] * LAW.plane_modulus  # up to 0.1 modules
        for axis in (0, 1):
            assert np.abs(np.diff(regular, n=2, axis=axis)).max() < 0.03  # of 8 to 15


@pytest.mark.slow
def test_leaning_kernel_against_plain_finite_elements(article_pair):
    """A strip pulled obliquely on the whole annulus with fine elements at the tip, no singularity taken out."""
    profile = article_pair.teeth_profiles[1]
    fine = mesh_sector(profile, Sizes(flank=0.03), refinements=1)
    gear, solve = whole_annulus(mesh_sector(profile, refinements=1), {0: fine})
    edges, arcs = gear.nodes[0][fine.facets["flank_left"]], fine.parameters["flank_left"]
    end = profile.flank_rho[1] ** 2 / (2 * profile.base_radius)
    distance = end - arcs.mean(axis=1)
    order = np.argsort(distance)
    some = order[[np.searchsorted(distance[order], d) for d in (0.05e-3, 0.15e-3, 0.35e-3)]]
    strips = tip_strips(ring_of(mesh_sector(profile, refinements=2), LAW), profile)
    mine = strips.on(distance[some], np.ptp(arcs[some], axis=1))
    angle = np.array([0.1, 0.25, 0.4])
    kernel = mine.leaning(angle[None])[0]
    at = flank_points(fine, np.sqrt(2 * profile.base_radius * arcs[some].mean(axis=1)))
    along = np.cos(angle)[:, None] * at.inward - np.sin(angle)[:, None] * at.towards_tip().direction
    moved = np.empty((3, 3))
    for j, edge in enumerate(edges[some]):
        force = np.zeros_like(gear.points)
        force[edge] = np.array([1 / 6, 1 / 6, 2 / 3])[:, None] * along[j]
        moved[:, j] = np.einsum("na,na->n", solve(force)[edges[some, 2]], along)
    apart = ~np.eye(3, dtype=bool)
    np.testing.assert_allclose(kernel[apart], moved[apart], rtol=1e-3)
    # the directions do matter to that check
    assert np.abs(strips.on(mine.distance, mine.width).kernel[apart] / moved[apart] - 1).min() > 0.1


def test_kernel_far_from_the_corner_is_own_of_the_flank(article_pair, article_bodies, wheel_tip):
    _, strips = wheel_tip
    regular = np.diag(strips.kernel - flat_kernel(strips.distance, strips.width, LAW, 2e-3))
    some = strips.distance > 0.02 * 2e-3
    np.testing.assert_allclose(regular[some], article_bodies.wheel.own(strips.rho[some]), rtol=1e-3)


@pytest.mark.parametrize("wide_first", [True, False])
def test_contacts_from_the_corner_solve_each_extent(wide_first):
    """Each point is the solution on its first strips by itself, whether or not pivots are the largest beside them."""
    width = np.geomspace(1e-6, 3e-5, 12)
    place = np.cumsum(width) - 0.5 * width
    kernel = flat_kernel(place, width, LAW, 2e-3) * np.array([1.0, 2.0])[:, None, None]
    if wide_first:
        kernel = kernel[:, ::-1, ::-1]
    gaps = np.stack([30.0 * place**2, 1e-9 + 0.02 * place])
    levers = 1.0 - np.stack([20.0 * place, 300.0 * place])
    force, approach = from_the_corner(kernel, gaps, np.array([-1e-9, 2e-9]), levers)
    assert np.array_equal(approach[:, 0], [-1e-9, 2e-9])
    assert np.array_equal(force[:, 0], [0.0, 0.0])
    for one in range(2):
        for k in range(1, 12):  # the last strip bears nothing
            some = slice(k + 1)
            by_lever, by_gap = (
                np.linalg.solve(kernel[one, some, some], v[one, some]) for v in (levers, gaps)
            )
            level = by_gap[-1] / by_lever[-1]
            borne = levers[one, some] @ (level * by_lever - by_gap)
            np.testing.assert_allclose(approach[one, k], level, rtol=1e-9)
            np.testing.assert_allclose(force[one, k], borne, rtol=1e-9, atol=1e-9 * abs(force[one]).max())


def test_flat_kernel_is_the_mean_over_the_strip():
    distance, width = np.array([1.0, 3.0]), np.array([0.5, 1.0])
    kernel = flat_kernel(distance, width, LAW, 2.0)
    x = np.linspace(2.5, 3.5, 200001)
    mean = (
        -2
        / (np.pi * LAW.plane_modulus)
        * (np.mean(np.log(np.abs(1.0 - x) / 2.0)) + 0.5 * (1 + LAW.plane_poisson))
    )
    assert kernel[0, 1] == pytest.approx(mean, rel=1e-5)


def test_at_A_the_law_meets_hertz(article_pair, article_bodies):
    """Half of the contact is cut off there, so the two differ, but by a per cent or two at usual loads."""
    law = edge_laws(article_pair, article_bodies.tips[1], 1, np.array([article_pair.points.A - 1e-7]), LAW)
    force = np.array([2e3, 5e3, 1e4])
    edge = np.interp(force, law.force[0], law.approach[0])
    A = np.full(3, article_pair.points.A)
    wheel = article_bodies.wheel.own(article_pair.line_of_action - A) - article_bodies.wheel.hub_windup
    wheel = wheel / article_pair.face_width
    hertz = article_bodies.hertz(A).approach(force) + wheel * force
    np.testing.assert_allclose(edge, hertz, rtol=0.03)


def test_finer_strips_change_little(article_pair, article_bodies, monkeypatch):
    import sys

    tip = sys.modules["fem.influence.tip_strips"]
    rings = mesh_and_factor(article_pair, "strain", Sizes(), 1)
    place = np.array([article_pair.points.C - article_pair.base_pitch])
    approach = []
    for ratio in (1.25, 1.1):
        monkeypatch.setattr(tip, "RATIO", ratio)
        law = edge_laws(article_pair, tip_strips(rings[1], article_pair.teeth_profiles[1]), 1, place, LAW)
        table = Table.through(law.force, law.approach, law.smooth)
        approach.append(table.value_and_slope(np.array([1100.0]))[0][0] - law.approach[0, 0])
    assert approach[1] == pytest.approx(approach[0], rel=0.01)


def test_closing_strip_by_strip_gives_the_same_law_without_relief(article_pair, article_bodies):
    strips = article_bodies.tips[1]
    kernel = strips.kernel + flat_kernel(strips.distance, strips.width, LAW, 2e-3)
    places = article_pair.points.A - np.array([1e-4, 5e-4, 1.2e-3])
    gaps, _ = unloaded_gap(article_pair.base_radii, article_pair.line_of_action, places, strips.rho)
    force, approach = from_the_nearest(kernel, gaps, np.ones_like(gaps))
    other = from_the_corner(kernel, gaps, gaps[:, 0], np.ones_like(gaps))
    assert np.all(np.diff(force, axis=1) > 0)
    for row in range(3):
        same = np.interp(force[row, 3:-3], other[0][row], other[1][row])
        np.testing.assert_allclose(approach[row, 3:-3], same, rtol=2e-3)


def test_relieved_tips_touch_inside_the_corner(article_pair, article_bodies):
    """Any gap: the law is the solution of the contact conditions, checked by their signs."""
    strips = article_bodies.tips[1]
    kernel = strips.kernel + flat_kernel(strips.distance, strips.width, LAW, 2e-3)
    gaps = 1e-6 + 0.03 * np.abs(strips.distance - 0.1e-3)[None]
    force, approach = from_the_nearest(kernel, gaps, np.ones_like(gaps))
    level = approach[0, 12]
    closed = np.zeros(len(strips.rho), dtype=bool)
    # the strips that are closed at that level, found anew by a plain active-set search
    closed[gaps[0].argmin()] = True
    for _ in range(200):
        pressure = np.zeros(len(closed))
        pressure[closed] = np.linalg.solve(kernel[np.ix_(closed, closed)], level - gaps[0, closed])
        open_by = kernel @ pressure + gaps[0] - level
        new = (closed & (pressure > 0)) | (~closed & (open_by < -1e-15))
        if np.array_equal(new, closed):
            break
        closed = new
    # the strip that closes at this very level bears nothing yet
    assert pressure.sum() == pytest.approx(force[0, 12], rel=1e-9)


def test_law_grows_and_starts_at_the_gap(article_pair, article_bodies):
    places = article_pair.points.A - np.array([1e-4, 5e-4, 1.2e-3])
    law = edge_laws(article_pair, article_bodies.tips[1], 1, places, LAW)
    assert np.all(np.diff(law.force, axis=1) > 0)
    assert np.all(np.diff(law.approach, axis=1) > 0)
    end = np.array([article_pair.teeth_profiles[1].flank_rho[1]])
    gap, _ = unloaded_gap(article_pair.base_radii, article_pair.line_of_action, places, end)
    np.testing.assert_allclose(law.approach[:, 0], gap[:, 0])


def test_table_passes_through_its_points_and_its_slope_is_its_derivative():
    x = np.array([[0.0, 1.0, 2.5, 4.0], [0.0, 0.5, 3.0, 9.0]])
    table = Table.through(x, np.sqrt(x + 1))
    for k in range(4):
        np.testing.assert_allclose(table.value_and_slope(x[:, k])[0], np.sqrt(x[:, k] + 1))
    for at in (np.array([0.3, 1.7]), np.array([3.9, 20.0])):
        ahead, behind = (table.value_and_slope(at + h)[0] for h in (1e-6, -1e-6))
        np.testing.assert_allclose(table.value_and_slope(at)[1], (ahead - behind) / 2e-6, rtol=1e-6)


def test_cycle_uses_lever_and_gap(article_pair, article_bodies):
    cycle = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies)
    pressed = (cycle.forces > 0) & cycle.edge
    assert pressed.any()
    ahead = pressed & (cycle.pair_offset[None, :] > 0)
    # after E the lever is shorter, so the forces add up to more than the torque over the base radius
    assert np.all(cycle.forces[ahead.any(axis=1)].sum(axis=1) > cycle.force)
    behind = pressed & (cycle.pair_offset[None, :] < 0)
    rows = behind.any(axis=1) & ~ahead.any(axis=1)
    np.testing.assert_allclose(cycle.forces[rows].sum(axis=1), cycle.force, rtol=1e-12)


def test_edge_and_flank_deflect_as_the_pinion_turns(article_pair, article_bodies):
    """Way along each pair's own normal, kappa D, against forces and compliances put together anew."""
    cycle = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, reference="bore")
    pressed = (cycle.forces > 0) & cycle.edge & (cycle.pair_offset[None, :] > 0)
    rows = np.flatnonzero(pressed.any(axis=1) & ((cycle.forces > 0).sum(axis=1) == 2))
    assert len(rows) >= 4
    pinion = article_bodies.pinion
    corner = float(pinion.own(np.array([pinion.rho_end]))[0]) / article_pair.face_width
    for row in rows:
        on = np.flatnonzero(cycle.forces[row] > 0)
        edge = cycle.edge[row, on]
        first, second = (cycle.flank_rho[gear, row, on] for gear in (0, 1))
        force = cycle.forces[row, on]
        here = article_pair.points.A + (cycle.position[row] + cycle.pair_offset[on]) * article_pair.base_pitch
        law = edge_laws(article_pair, article_bodies.tips[0], 0, here[edge], LAW)
        kappa = np.ones(len(on))
        kappa[edge] = lever_ratio(article_pair, law.touched_rho, here[edge])
        line, end = article_pair.line_of_action, pinion.rho_end
        angle = opening(
            article_pair.base_radii[::-1], line, line - here[edge], law.touched_rho[:, None], end
        )[:, 0]
        leaning = np.zeros((2, len(on)))
        leaning[0, edge] = angle
        bulk = article_bodies.bulk(first, second, leaning)
        # the law of the edge has its own tooth in it, but not the turn on the hub
        lever = np.cos(angle) - np.sin(angle) * pinion.rho_range[1] / pinion.base_radius
        bulk[edge, edge] -= corner - pinion.hub_windup / article_pair.face_width * lever**2
        deflection = bulk @ force
        table = Table.through(law.force, law.approach, law.smooth)
        deflection[edge] += table.value_and_slope(force[edge])[0]
        deflection[~edge] += article_bodies.hertz(first[~edge]).approach(force[~edge])
        np.testing.assert_allclose(deflection, kappa * cycle.transmission_error[row], rtol=1e-6)
        assert np.all(kappa[edge] < 0.999)
        assert kappa @ force == pytest.approx(cycle.force, rel=1e-10)


def test_laws_of_sharp_corners_are_smooth_from_the_least_force_on(article_pair, article_bodies):
    """Only the corner and the opening count there: the compliance falls by as much in every decade of the force."""
    places = article_pair.points.A - np.array([1e-4, 5e-4, 1.2e-3])
    law = edge_laws(article_pair, article_bodies.tips[1], 1, places, LAW)
    assert law.smooth.all()
    table = Table.through(law.force, law.approach - law.approach[:, :1], law.smooth)
    decades = np.geomspace(1e-4, 1.0, 41)[:, None] * law.force[:, 8]
    value, slope = table.value_and_slope(decades)
    fall = np.diff(slope, axis=0) / np.mean(slope)
    # the strip at the corner is 1.25^-8 of the widest of these contacts
    np.testing.assert_allclose(fall, fall.mean(axis=0) + 0 * fall, rtol=1.25**-8)
    whole = np.diff(value / decades, axis=0)
    np.testing.assert_allclose(whole, whole[:1] + 0 * whole, rtol=1.25**-8)
