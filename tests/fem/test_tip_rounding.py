"""Rounded tips: geometry of the arc, the gap over it, Hertz on a small contact, the elasticity left out."""

from __future__ import annotations

import numpy as np
import pytest

import fem
from fem.elasticity.corner_singularity import corner_logarithm
from fem.laws.cut_off import along
from fem.laws.tip_contact import nearest_gap, rounded_law
from fem.laws.tip_geometry import chamfer_gap, corner_angle, tip_round, unloaded_gap
from gears import Gear, GearPair
from meshes import Sizes, mesh_sector


@pytest.mark.parametrize("chamfer", [0.0, 2e-4])
def test_corner_angle_is_that_of_the_mesh(chamfer, article_bodies):
    pair = GearPair(Gear(36, tip_chamfer=chamfer), Gear(40), 2e-3, 0.04)
    profile = pair.teeth_profiles[0]
    angle, _ = corner_logarithm(mesh_sector(profile, Sizes(), 1), article_bodies.pinion.law)
    assert corner_angle(profile) == pytest.approx(angle, rel=1e-6)


def test_the_arc_is_tangent_to_flank_and_top_land(article_pair):
    profile = article_pair.teeth_profiles[1]
    one = tip_round(profile, 60e-6)
    arc = (profile.flank_rho[1] ** 2 - one.rho**2) / (2 * profile.base_radius)
    assert arc == pytest.approx(one.start, rel=1e-12)
    along, out = one.offset(np.array([one.start, one.start * (1 - 1e-4)]))
    assert along[0] == out[0] == 0.0
    assert out[1] == pytest.approx(-(along[1] ** 2) / 120e-6, rel=1e-4)
    # in the tooth's frame: its highest point touches the tip circle but for the flank's own curvature
    turn = np.pi - corner_angle(profile)
    start, normal = profile.involute(one.rho), profile.normal(one.rho)
    tangent = np.array([-normal[1], normal[0]])
    end = start + 60e-6 * (np.sin(turn) * tangent + (np.cos(turn) - 1) * normal)
    assert np.linalg.norm(end) == pytest.approx(profile.tip_radius, abs=0.005 * 60e-6)


def test_gap_over_the_arc_is_that_of_the_nearest_point_of_a_circle(article_pair):
    """The distance from the arc's centre to the involute along its normal is a rotation, exactly."""
    profile = article_pair.teeth_profiles[1]
    one = tip_round(profile, 50e-6)
    radii, line = article_pair.base_radii, article_pair.line_of_action
    place = article_pair.points.A - np.array([2e-4, 8e-4, 1.5e-3])
    centre, _ = unloaded_gap(radii, line, place, np.array([one.rho]), 0.0, np.array([-one.radius]))
    gap = nearest_gap(article_pair, 1, place, one)
    np.testing.assert_allclose(gap, centre[:, 0] - one.radius, atol=5e-9)  # strips: 1 um wide
    assert np.all(gap > nearest_gap(article_pair, 1, place))


def test_a_small_contact_on_the_arc_is_hertz(article_pair, article_bodies):
    """r = 0.2 mm, 1 mm before A: flanks open by 0.09 rad, so the contact lies 18 um from the arc's end.

    The law adds a half-plane's answer to the wedge's regular part at that place; Hertz for the radii r and
    rho1 the same: they must agree while the contact is small against r and still wider than a strip.
    """
    radius = 0.2e-3
    profile = article_pair.teeth_profiles[1]
    one = tip_round(profile, radius)
    place = np.array([article_pair.points.A - 1e-3])
    force, approach = rounded_law(
        article_pair, article_bodies.tips[1], 1, place, article_bodies.pinion.law, np.ones(1), one
    )
    approach = approach - np.nanmin(approach)
    radii, line = article_pair.base_radii, article_pair.line_of_action
    touched_rho = unloaded_gap(radii, line, place, np.array([one.rho]))[1][0, 0]
    width, m = article_pair.face_width, article_pair.module
    modulus = article_bodies.pinion.law.plane_modulus
    star = article_bodies.pinion.law.plane_poisson
    # own compliance of the wheel's tip where the arc is nearest, distance by the flanks' angle
    turn = (profile.flank_rho[1] - (line - place[0])) / radii[1]
    flank = (touched_rho - place[0]) / radii[0]
    distance = one.start - radius * (flank - turn)
    strips = article_bodies.tips[1]
    from fem.influence.strip_contact import flat_kernel

    angle = np.full((1, len(strips.rho)), flank - turn)
    leaning = strips.leaning(angle)[0] - strips.hub_windup * strips.lever(angle[0]) ** 2
    regular = leaning - flat_kernel(strips.distance, strips.width, strips.law, m)
    own = np.interp(np.log(distance), np.log(strips.distance), np.diag(regular))
    R = 1 / (1 / radius + 1 / touched_rho)
    for load in (30e3, 100e3):  # N/m: half-widths of 6 and 10 um
        a = np.sqrt(8 * load * R / (np.pi * modulus))
        hertz = 2 * 2 / (np.pi * modulus) * (np.log(2 * m / a) + 0.5 - 0.5 * (1 + star))
        wanted = load * (hertz + own)
        got = along(force, approach, np.array([[load * width]]))[0][0, 0] * load * width
        assert got == pytest.approx(wanted, rel=0.01)


def test_vanishing_rounding_is_the_sharp_corner(article_pair, article_bodies):
    sharp = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies)
    off = []
    for radius in (8e-6, 2e-6, 0.5e-6):
        cycle = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, tip_rounding=radius)
        assert cycle.converged
        off.append(np.abs(cycle.transmission_error / sharp.transmission_error - 1).max())
    assert off[0] > off[1] > off[2]
    assert off[2] < 2e-3


def test_a_rounding_takes_the_tip_out_of_contact(article_pair, article_bodies):
    """It removes material: gaps grow, edges carry less, the cycle turns softer and its error larger."""
    cycles = [
        fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, tip_rounding=r)
        for r in (0.0, 20e-6, 50e-6, 100e-6)
    ]
    outside = cycles[0].edge  # a rounding makes a few more contacts, inside A and E, edge contacts
    edge = [c.forces[outside].sum() for c in cycles]
    assert np.all(np.diff(edge) < 0)
    assert np.all(np.diff([c.secant_stiffness.mean() for c in cycles]) < 0)
    assert np.all(np.diff([np.ptp(c.transmission_error) for c in cycles]) > 0)
    assert "rounded corners" in cycles[1].message
    solve_one_side = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, tip_rounding=(0.0, 20e-6))
    assert "rounded or sharp" in solve_one_side.message
    assert cycles[1].secant_stiffness.mean() < solve_one_side.secant_stiffness.mean()


def test_no_step_where_the_contact_moves_onto_the_arc(article_pair, article_bodies):
    cycle = fem.mesh_cycle(article_pair, 600.0, 2000, article_bodies, tip_rounding=50e-6)
    around = np.append(cycle.transmission_error, cycle.transmission_error[0])
    assert np.abs(np.diff(around)).max() < 3e-3 * cycle.transmission_error.mean()


def test_held_to_the_path_the_path_is_shorter(article_pair, article_bodies):
    one = fem.mesh_cycle(article_pair, 600.0, 400, article_bodies, False, tip_rounding=100e-6)
    first, second = (tip_round(p, 100e-6).rho for p in article_pair.teeth_profiles)
    ratio = (first + second - article_pair.line_of_action) / article_pair.base_pitch
    assert np.mean(np.isfinite(one.rho1).sum(axis=1)) == pytest.approx(ratio, abs=2 / 400)
    assert ratio < article_pair.contact_ratio - 0.03


def test_chamfer_stands_farther_off_than_its_corner_near_the_path():
    pair = GearPair(Gear(36, tip_chamfer=2e-4), Gear(40, tip_chamfer=2e-4), 2e-3, 0.04)
    travel = np.array([1e-5, 5e-4, 1.5e-3])
    for corner, place in (
        (1, pair.points.A - travel),
        (0, pair.line_of_action - pair.points.E - travel),
    ):
        radii = pair.base_radii if corner == 1 else pair.base_radii[::-1]
        end = np.array([pair.teeth_profiles[corner].flank_rho[1]])
        gap, _ = unloaded_gap(radii, pair.line_of_action, place, end)
        assert np.all(chamfer_gap(pair, corner, place) > gap[:, 0])
    assert fem.mesh_cycle(pair, 600.0, 10).converged
    assert np.all(np.isinf(chamfer_gap(GearPair(Gear(36), Gear(40), 2e-3, 0.04), 0, travel)))


def wedge_compliance(angle, rounded, place, half=0.05, far=300.0, fine=0.02, growth=0.12):
    """Regular part times E* of a wedge under a load spread over 2 half, by plain finite elements.

    Straight P2 triangles of scikit-fem, another program than the one under test; the arc has radius 1, the
    flank is the x axis, the apex of the unrounded wedge the origin, the far arc is held.
    """
    import gmsh
    import skfem
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    start = 1 / np.tan(0.5 * angle)
    gmsh.initialize(interruptible=False)
    try:
        for name in ("General.Terminal", "Mesh.MeshSizeExtendFromBoundary", "Mesh.MeshSizeFromPoints"):
            gmsh.option.setNumber(name, 0)
        geo = gmsh.model.geo
        side = np.array([np.cos(angle), -np.sin(angle)])
        apex, near = geo.addPoint(0, 0, 0), geo.addPoint(place - half, 0, 0)
        rest, end = geo.addPoint(place + half, 0, 0), geo.addPoint(far, 0, 0)
        other = geo.addPoint(*(far * side), 0)
        middle = geo.addPoint(far * np.cos(angle / 2), -far * np.sin(angle / 2), 0)
        if rounded:
            centre, last = geo.addPoint(start, -1, 0), geo.addPoint(*(start * side), 0)
            first = geo.addPoint(start, 0, 0)
            lead = [geo.addCircleArc(last, centre, first), geo.addLine(first, near)]
        else:
            last, lead = apex, [geo.addLine(apex, near)]
        lines = [
            *lead,
            geo.addLine(near, rest),
            geo.addLine(rest, end),
            geo.addCircleArc(end, apex, middle),
            geo.addCircleArc(middle, apex, other),
            geo.addLine(other, last),
        ]
        geo.addPlaneSurface([geo.addCurveLoop(lines)])
        geo.synchronize()

        def size(dim, tag, x, y, z, lc):
            around_load = fine + growth * max(np.hypot(x - place, y) - 1.5 * half, 0.0)
            return float(around_load if rounded else min(around_load, fine + growth * np.hypot(x, y)))

        gmsh.model.mesh.setSizeCallback(size)
        gmsh.model.mesh.generate(2)
        tags, points, _ = gmsh.model.mesh.getNodes()
        _, _, nodes = gmsh.model.mesh.getElements(2)
    finally:
        gmsh.finalize()
    number = dict(zip(tags.tolist(), range(len(tags)), strict=True))
    triangles = np.array([number[tag] for tag in nodes[0].tolist()]).reshape(-1, 3)
    used, local = np.unique(triangles, return_inverse=True)
    flat = points.reshape(-1, 3)[used, :2]
    mesh = skfem.MeshTri(flat.T.copy(), local.reshape(-1, 3).T.copy())
    nu = 0.3
    element = skfem.ElementVector(skfem.ElementTriP2())
    basis = skfem.Basis(mesh, element, intorder=4)
    matrix = linear_elasticity(*lame_parameters(1 - nu**2, nu)).assemble(basis)

    def loaded(x):
        return (np.abs(x[1]) < 1e-9) & (np.abs(x[0] - place) < half)

    def held(x):
        return np.hypot(x[0], x[1]) > 0.98 * far

    facets = mesh.facets_satisfying(loaded, boundaries_only=True)
    edge = skfem.FacetBasis(mesh, element, facets=facets, intorder=6)
    force = skfem.LinearForm(lambda v, w: -v[1] / (2 * half)).assemble(edge)
    fixed = basis.get_dofs(mesh.facets_satisfying(held, boundaries_only=True))
    mean = force @ skfem.solve(*skfem.condense(matrix, force, D=fixed))
    # less the half-plane's own mean: the mean of ln|x - x'| over a strip is ln(2 half) - 3/2
    return mean + 2 / np.pi * (np.log(2 * half) - 1.5 + 0.5 * (1 + nu / (1 - nu)))


def test_material_missing_from_the_round_hardly_matters(article_pair):
    """A wedge with its apex rounded off and a sharp one yield alike beside the arc, to 1e-3/E*.

    A pair of teeth yields about 15/E*, so leaving it out is worth less than 1e-4.
    """
    angle = corner_angle(article_pair.teeth_profiles[0])
    beside = 1 / np.tan(0.5 * angle) + 0.06
    sharp, rounded = (wedge_compliance(angle, some, beside) for some in (False, True))
    assert 0 < rounded - sharp < 1e-3  # less material, more flexible
    # the same elements see the wedge's logarithm, so they would have seen a difference
    half = 0.5 * angle
    lean = 0.5 * np.pi - half
    slope = 2 / np.pi - np.cos(lean) ** 2 / (half + 0.5 * np.sin(angle))
    slope -= np.sin(lean) ** 2 / (half - 0.5 * np.sin(angle))
    change = wedge_compliance(angle, False, 3 * beside) - sharp
    assert change == pytest.approx(slope * np.log(3), rel=0.03)
