"""Rims on webs: exact rings of stepped thickness, what hardly moves, and what a thinner web must do."""

from __future__ import annotations

import pickle
import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse.linalg import splu

import fem
from base import InputError, RangeWarning
from fem.elasticity.plane_elasticity import PlaneElasticity, stiffness_matrix
from fem.elasticity.support import Support
from fem.fields.stress_fields import loaded_fields
from gears import Blank, Gear, GearPair
from gears.closed_form import body_wind_up, ring_wind_up
from meshes import gear_mesh, mesh_sector
from tests.fem.conftest import edge_load, quadratic_ring

M, WIDTH = 2e-3, 0.02
LAW = PlaneElasticity("strain", 206e9, 0.3)


def pair(rim=2.7, web=0.3, scale=1.0, **more):
    """Pinion 25 on a wheel 50 with a rim [modules], a web [face widths] and a hub."""
    blank = Blank(rim * M * scale, web * WIDTH * scale, hub_radius=0.018 * scale)
    wheel = Gear(50, bore_radius=0.012 * scale, blank=blank)
    return GearPair(Gear(25), wheel, M * scale, WIDTH * scale, **more)


def solved(points, triangles, thickness, held, force):
    stiffness = stiffness_matrix(points, triangles, LAW, thickness).tocsc()
    free = np.setdiff1d(np.arange(2 * len(points)), np.concatenate([2 * held, 2 * held + 1]))
    u = np.zeros(2 * len(points))
    options = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    u[free] = splu(stiffness[free][:, free], **options).solve(force.ravel()[free])
    return u.reshape(-1, 2)


def test_lame_in_rings_of_two_thicknesses():
    """u = A r + B/r in either ring, with u and t sigma_r the same on both sides of the step."""
    bore, step, outside, thin = 0.01, 0.02, 0.03, 0.3
    lam, mu = LAW.lame
    rows = []
    for a, b, t in ((bore, step, thin), (step, outside, 1.0)):
        points, triangles, inner, outer = quadratic_ring(a, b, 48, 12)
        rows.append((points, triangles, inner, outer, t))
    (p1, t1, _, o1, _), (p2, t2, i2, o2, _) = rows
    # the outer ring's first row of nodes is the inner ring's last one
    first, last = np.unique(i2), np.unique(o1)
    number = np.full(len(p2), -1)
    number[first] = last
    fresh = number < 0
    number[fresh] = len(p1) + np.arange(fresh.sum())
    points = np.concatenate([p1, p2[fresh]])
    triangles = np.concatenate([t1, number[t2]])
    thickness = np.concatenate([np.full(len(t1), thin), np.ones(len(t2))])
    np.testing.assert_allclose(points[number], p2, rtol=0, atol=1e-15)
    pull = edge_load(points, number[o2], lambda _, normal: normal)
    u = solved(points, triangles, thickness, np.unique(rows[0][2]), pull)
    stress = lambda r: (2 * (lam + mu), -2 * mu / r**2)  # noqa: E731  sigma_r of A and B
    system = np.array(
        [
            [bore, 1 / bore, 0, 0],
            [step, 1 / step, -step, -1 / step],
            [*(thin * s for s in stress(step)), *(-s for s in stress(step))],
            [0, 0, *stress(outside)],
        ]
    )
    a1, b1, a2, b2 = np.linalg.solve(system, [0, 0, 0, 1])
    r = np.linalg.norm(points, axis=1)
    exact = np.where(r < step, a1 * r + b1 / r, a2 * r + b2 / r)
    np.testing.assert_allclose(np.sum(u * points, axis=1) / r, exact, rtol=0, atol=1e-5 * exact.max())


@pytest.mark.parametrize(("rim", "web"), [(1.2, 0.2), (2.7, 0.5), (5.0, 0.1)])
def test_a_torque_on_the_rim_turns_web_and_hub_as_rings_do(rim, web):
    """An even traction along the rim's inside: all outside turns without strain, teeth and all."""
    blank = Blank(rim * M, web * WIDTH, hub_radius=0.012)
    wheel = Gear(32, bore_radius=0.008, blank=blank)  # all of its teeth are meshed
    profile = GearPair(Gear(25), wheel, M, WIDTH).teeth_profiles[1]
    gear = gear_mesh(mesh_sector(profile, refinements=1))
    assert sorted(set(gear.thickness.tolist())) == [web, 1.0]
    force = edge_load(
        gear.points,
        gear.facets["rim_inner"],
        lambda place, _: np.stack([-place[..., 1], place[..., 0]], axis=-1),
    )
    torque = float(np.sum(gear.points[:, 0] * force[:, 1] - gear.points[:, 1] * force[:, 0]))
    held = np.unique(gear.facets["bore"])
    u = solved(gear.points, gear.triangles, gear.thickness, held, force)
    r = np.linalg.norm(gear.points, axis=1)
    turn = (gear.points[:, 0] * u[:, 1] - gear.points[:, 1] * u[:, 0]) / r**2
    inside = profile.zones[1:]
    expected = body_wind_up(inside, 1.0, LAW.shear_modulus) * torque
    np.testing.assert_allclose(turn[r >= inside[0].outer * (1 - 1e-9)], expected, rtol=1e-4)
    hub = ring_wind_up(inside[1].outer, inside[1].inner, 1.0, LAW.shear_modulus) * torque
    np.testing.assert_allclose(turn[gear.facets["hub_outer"]].mean(), hub, rtol=1e-4)


def places(some):
    return np.linspace(some.points.A, some.points.E, 5)[1:-1, None] + np.array([0.0, 0.5]) * some.base_pitch


def test_a_web_as_wide_as_the_face_is_the_disc():
    webbed = pair(web=1.0)
    disc = replace(webbed, wheel=replace(webbed.wheel, blank=None))
    rho1 = places(disc)
    np.testing.assert_array_equal(fem.compliance(webbed).bulk(rho1), fem.compliance(disc).bulk(rho1))


def test_the_step_vanishes_with_its_height():
    """A web that is all but as wide as the face, on its own mesh."""
    webbed = pair(web=1.0 - 1e-7)
    disc = replace(webbed, wheel=replace(webbed.wheel, blank=None))
    one, other = (fem.compliance(some, 1e-4) for some in (webbed, disc))
    np.testing.assert_allclose(one.bulk(places(disc)), other.bulk(places(disc)), rtol=2e-4)
    assert one.hub_windup == pytest.approx(other.hub_windup, rel=1e-6)
    assert one.step_windup == (0.0, 0.0)


def test_size_does_not_matter_and_the_web_does():
    """Gears are kept by their shape: equal ones of other size agree, others are solved anew."""
    own = {web: fem.compliance(pair(web=web)).wheel.own(np.array([8e-3])) for web in (0.3, 0.31)}
    assert own[0.3] > 1.003 * own[0.31]
    larger = fem.compliance(pair(scale=5.0))
    np.testing.assert_allclose(larger.wheel.own(np.array([40e-3])), own[0.3], rtol=1e-12)
    back = pickle.loads(pickle.dumps(larger))
    np.testing.assert_array_equal(back.rings()[1].mesh.thickness, larger.rings()[1].mesh.thickness)


def test_the_estimated_error_is_that_of_a_finer_mesh():
    some = pair(rim=1.35, web=0.2)
    usual, fine = fem.compliance(some, 0.002), fem.compliance(some, 1e-5)
    rho1 = places(some)[:, 0]
    off = np.max(np.abs(usual.own(rho1) / fine.own(rho1) - 1))
    assert off < usual.error < 0.002


def test_thinner_rims_and_webs_yield_more_and_their_roots_bear_more():
    """On a web of a fifth of the face; held at a bore in its place, the same rims do the opposite."""
    on_web, held, stress = [], [], {"web": [], "bore": []}
    for rim in (4.0, 2.0, 1.2):
        webbed = pair(rim, 0.2)
        bore = webbed.root_radii[1] - rim * M
        bored = replace(webbed, wheel=Gear(50, bore_radius=bore))
        on_web.append(sum(fem.compliance(webbed).without("hub_windup").own([webbed.points.C])))
        held.append(sum(fem.compliance(bored).without("hub_windup").own([webbed.points.C])))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            for name, some in (("web", webbed), ("bore", bored)):
                influence = fem.fillets(some, 0.01).wheel
                stress[name].append(influence.stress(0, np.array([6e-3]))[0, 0].max())
    assert on_web == sorted(on_web)
    assert held == sorted(held, reverse=True)
    assert stress["web"][2] > 1.02 * stress["web"][0]
    assert stress["bore"][2] < 0.98 * stress["bore"][0]


def test_a_thin_disc_held_at_its_bore_warns_that_its_root_stress_is_unsafe():
    bored = GearPair(Gear(25), Gear(50, bore_radius=0.0435), M, WIDTH)
    assert bored.teeth_profiles[1].rim_ratio == pytest.approx(4 / 4.5)
    with pytest.warns(
        RangeWarning, match=r"wheel: its rim of 0\.889 tooth depths.*unsafe.*Y_B = 1\.48.*blank"
    ):
        fem.fillets(bored, 0.05)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fem.fillets(pair(rim=1.5), 0.05)


def test_fields_carry_the_torque_through_the_web():
    some = pair(web=0.25)
    torque = 100.0
    bodies = fem.compliance(some)
    cycle = fem.mesh_cycle(some, torque, 4, bodies)
    ring = bodies.rings()[1]
    _, wheel = loaded_fields(some, cycle, 1, bodies)
    centre = np.array([0.0, some.working_centre_distance])
    x, y = (wheel.points - centre).T
    r, angle = np.hypot(x, y), np.arctan2(y, x)
    xx, yy, _, xy = wheel.stress_Pa.T
    shear = xy * np.cos(2 * angle) - 0.5 * (xx - yy) * np.sin(2 * angle)
    for radius, thickness in ((0.018, 0.25), (ring.mesh.steps[0][0], 0.25), (0.012, 1.0)):
        on = np.abs(r - radius) < 1e-9
        order = np.argsort(angle[on])
        around, values = angle[on][order], shear[on][order]
        mean = np.trapezoid(np.append(values, values[0]), np.append(around, around[0] + 2 * np.pi)) / (
            2 * np.pi
        )
        carried = mean * 2 * np.pi * radius**2 * WIDTH * thickness
        assert abs(carried) == pytest.approx(torque * some.ratio, rel=0.02)


def test_a_rigid_hub_ends_inside_the_rim():
    some = pair(rim=2.7)
    inside = some.teeth_profiles[1].zones[0].inner
    hub = Support(hub_radius=0.5 * (0.018 + inside))
    held = fem.compliance(some, supports=(Support(), hub))
    web = some.teeth_profiles[1].zones[1]
    expected = body_wind_up(
        (some.teeth_profiles[1].zones[0], replace(web, inner=hub.hub_radius)),
        some.base_radii[1],
        LAW.shear_modulus,
    )
    assert held.plane_windup[1] * WIDTH == pytest.approx(expected, rel=1e-9)
    with pytest.raises(InputError, match=r"0\.25 modules of web"):
        fem.compliance(some, supports=(Support(), Support(hub_radius=inside * 1.001)))


@pytest.mark.parametrize(
    ("teeth", "rim", "web", "hub"),
    [(12, 0.5, 0.05, None), (17, 2.6, 0.9, 2.2), (120, 0.5, 0.05, 20.0), (400, 2.75, 0.2, 40.06)],
)
def test_extreme_blanks_are_solved_to_their_tolerance(capfd, teeth, rim, web, hub):
    """Rims at their least, rims that end where the gmsh part does, hubs of hardly any thickness; nothing is printed."""
    blank = Blank(rim * M, web * WIDTH, None if hub is None else hub * M)
    gear = Gear(teeth, 0.5 if teeth < 17 else 0.0, bore_radius=2 * M if teeth < 100 else 20 * M, blank=blank)
    some = GearPair(gear, Gear(40), M, WIDTH)
    bodies, fine = fem.compliance(some, 0.002), fem.compliance(some, 1e-4)
    assert bodies.converged
    rho1 = np.linspace(some.points.A, some.points.E, 7)
    assert np.max(np.abs(bodies.own(rho1) / fine.own(rho1) - 1)) < 0.002
    assert capfd.readouterr().out == ""
