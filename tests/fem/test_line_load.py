"""Line loads by singularity subtraction: symmetries that any error in sign, frame or quadrature breaks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from fem.elasticity.corner_singularity import corner_logarithm, wedge_logarithms
from fem.elasticity.flamant import hertz_indentation
from fem.elasticity.flank_samples import sample_places, sampled
from fem.elasticity.line_load import flank_points, line_loads
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.ring import ring_of
from fem.influence.gear_compliance import gear_compliance
from gears import Gear, GearPair
from meshes import mesh_sector

LAW = PlaneElasticity("strain", 206e9, 0.3)
PAIR = GearPair(Gear(24, profile_shift=0.3), Gear(31), 2e-3, 0.04)
PROFILE = PAIR.teeth_profiles[0]
RHO = np.linspace(PAIR.points.A, PROFILE.flank_rho[1] - 1e-4, 9)


@pytest.fixture(scope="module")
def ring():
    return ring_of(mesh_sector(PROFILE, refinements=1), LAW)


@pytest.fixture(scope="module")
def loads(ring):
    return line_loads(ring, flank_points(ring.mesh, RHO))


def test_flank_points_lie_on_the_involute_with_its_normal(ring):
    at = flank_points(ring.mesh, RHO)
    mirror = np.array([-1.0, 1.0])
    np.testing.assert_allclose(at.points, PROFILE.involute(RHO) * mirror, rtol=0, atol=1e-4 * PROFILE.module)
    np.testing.assert_allclose(at.inward, -PROFILE.normal(RHO) * mirror, rtol=0, atol=1e-12)
    np.testing.assert_allclose(at.weights.sum(axis=1), 1.0)


def test_the_tip_corner_stays_on_the_flank_and_beyond_it_is_refused(ring):
    end = PROFILE.flank_rho[1]
    at = flank_points(ring.mesh, np.array([end]))
    # the flank's normal there, not the top land's
    assert at.inward[0] @ (-PROFILE.normal(end) * [-1, 1]) > 0.999
    with pytest.raises(InputError, match="rho"):
        flank_points(ring.mesh, np.array([end * 1.001]))


def test_loads_that_all_but_stand_on_a_node_are_finite_and_equal(ring):
    """A node's two edges each see the load at their end, or a rounding error beside it."""
    start = PROFILE.flank_rho[0]
    # the first node of the flank, then one between two of its edges
    at = flank_points(ring.mesh, np.array([1.2 * start]))
    corner = np.linalg.norm(ring.mesh.points[at.nodes[0, :2]], axis=1)
    between = np.sqrt(corner.max() ** 2 - PROFILE.base_radius**2)
    for node in (start, between):
        rho = node * (1 + np.array([0.0, 1e-15, 1e-13, 1e-11, 1e-9, 1e-7, 1e-6]))
        own = line_loads(ring, flank_points(ring.mesh, rho)).regular_at_load()
        # two quadratic edges meet at an angle of their error, which the load sees as it passes the node
        np.testing.assert_allclose(own, own[-1], rtol=1e-4)


def test_reciprocity_of_neighbouring_teeth(loads):
    """Maxwell and Betti: load here and displacement there may be exchanged."""
    at = loads.at
    for k in (1, 2, 5):
        there, back = loads.on_tooth(k, at), loads.on_tooth(-k, at)
        np.testing.assert_allclose(there, back.T, rtol=2e-4)


def test_reciprocity_on_the_own_flank(loads):
    at = loads.at
    own = loads.on_tooth(0, at) + loads.singular(at)
    off = ~np.eye(len(RHO), dtype=bool)
    np.testing.assert_allclose(own[off], own.T[off], rtol=5e-4)


def test_normal_and_tangential_loads_are_reciprocal(ring, loads):
    normal = loads.at
    tangent = normal.towards_tip()
    assert np.all(np.einsum("na,na->n", tangent.direction, tangent.points) > 0)
    drag = line_loads(ring, tangent)
    by_tangent = drag.on_tooth(0, normal) + drag.singular(normal)
    by_normal = loads.on_tooth(0, tangent) + loads.singular(tangent)
    np.testing.assert_allclose(by_tangent, by_normal.T, rtol=0, atol=2e-4 * by_tangent.max())
    for tooth in (1, -2):
        exact = loads.on_neighbour(tooth, drag)
        np.testing.assert_allclose(exact, drag.on_neighbour(-tooth, loads).T, rtol=1e-9)
        np.testing.assert_allclose(
            loads.on_tooth(tooth, tangent), exact, rtol=0, atol=2e-4 * abs(exact).max()
        )


def test_a_load_between_normal_and_tangent_is_their_sum(ring, loads):
    """u_r as an energy, quadratic in the load's direction, against the mixed term of the field."""
    tangent = loads.at.towards_tip()
    drag, oblique = (
        line_loads(ring, replace(tangent, lean=lean)) for lean in (tangent.lean, 0.3 * tangent.lean)
    )
    cos, sin = np.cos(0.3 * np.pi / 2), np.sin(0.3 * np.pi / 2)
    mixed = np.diagonal(loads.on_tooth(0, tangent))
    both = cos**2 * loads.regular_at_load() + sin**2 * drag.regular_at_load() + 2 * sin * cos * mixed
    np.testing.assert_allclose(oblique.regular_at_load(), both, rtol=2e-4)


def test_right_and_left_flank_are_mirror_images(loads):
    mesh = mesh_sector(PROFILE, refinements=1, working="right")
    mirrored = line_loads(ring_of(mesh, LAW), flank_points(mesh, RHO, "right"))
    np.testing.assert_allclose(mirrored.regular_at_load(), loads.regular_at_load(), rtol=2e-4)
    at = flank_points(mesh, RHO, "right")
    np.testing.assert_allclose(mirrored.on_tooth(-1, at), loads.on_tooth(1, loads.at), rtol=2e-4)


def test_length_of_the_logarithm_does_not_matter(ring):
    """The near field's zero of displacement is arbitrary: u_r takes up what the indentation gives."""
    other = replace(ring, mesh=replace(ring.mesh, module=7 * ring.mesh.module))
    total = [
        line_loads(one, flank_points(one.mesh, RHO)).regular_at_load()
        + hertz_indentation(1e-4, LAW, one.mesh.module)
        for one in (ring, other)
    ]
    np.testing.assert_allclose(total[1], total[0], rtol=1e-5)


def test_displacement_scales_neither_with_size_nor_with_modulus(loads):
    """Per line load, displacement times modulus is a number of the shape alone."""
    big = GearPair(Gear(24, profile_shift=0.3), Gear(31), 1e-1, 2.0).teeth_profiles[0]
    law = PlaneElasticity("strain", 70e9, 0.3)
    mesh = mesh_sector(big, refinements=1)
    other = line_loads(ring_of(mesh, law), flank_points(mesh, 50 * RHO))
    np.testing.assert_allclose(other.regular_at_load() * 70e9, loads.regular_at_load() * 206e9, rtol=1e-4)


def test_the_displacement_as_an_energy_is_that_of_the_field_at_the_load(loads):
    """The field itself converges more slowly, and the two agree within its error."""
    full = np.zeros((loads.ring.mesh.unknowns, len(RHO)))
    full[loads.ring.inner] = loads.inner(0)
    field = np.diag(loads.at.component(full.reshape(-1, 2, len(RHO))))
    np.testing.assert_allclose(loads.regular_at_load(), field, rtol=3e-4)
    for tooth in (1, -1, 3):
        field = loads.on_tooth(tooth, loads.at)
        np.testing.assert_allclose(loads.on_neighbour(tooth), field, rtol=2e-4)


def test_neighbours_are_reciprocal_to_rounding(loads):
    """As energies, load and point may be exchanged exactly."""
    for tooth in (1, 2, 5):
        there, back = loads.on_neighbour(tooth), loads.on_neighbour(-tooth)
        np.testing.assert_allclose(there, back.T, rtol=1e-9)


def test_convergence_under_refinement():
    """Nearly fourth order, from below: finite elements are too stiff, and the error is an energy."""
    values = []
    for level in range(4):
        mesh = mesh_sector(PROFILE, refinements=level)
        values.append(line_loads(ring_of(mesh, LAW), flank_points(mesh, RHO)).regular_at_load())
    steps = np.diff(values, axis=0)
    assert np.all(steps > 0)
    assert np.all(np.log2(steps[:-1] / steps[1:])[:, :-1] > 3.3)  # the last load stands by the tip corner
    assert np.all(np.log2(steps[:-1] / steps[1:]) > 2.5)


def test_a_half_plane_is_a_wedge_without_logarithms():
    np.testing.assert_allclose(wedge_logarithms(np.pi, LAW), 0.0, atol=1e-25)


def test_loads_near_the_corner_grow_as_the_wedge_says(ring):
    angle, c = corner_logarithm(ring.mesh, LAW)
    # corner between flank and top land: a right angle plus the pressure angle at the tip, less half the land
    tip = np.arccos(PROFILE.base_radius / PROFILE.tip_radius)
    assert angle == pytest.approx(0.5 * np.pi + tip, abs=2e-3)
    assert c == wedge_logarithms(angle, LAW)[0]
    away = np.array([0.01, 0.02, 0.04]) * PROFILE.module  # arc length from the corner
    rho = np.sqrt(PROFILE.flank_rho[1] ** 2 - 2 * PROFILE.base_radius * away)
    normal = flank_points(ring.mesh, rho)
    push, drag = line_loads(ring, normal), line_loads(ring, normal.towards_tip())
    found = push.regular_at_load(), np.diagonal(drag.on_tooth(0, normal)), drag.regular_at_load()
    # what the tooth's turn adds is linear in the distance: 2 (u(2d) - u(d)) - (u(4d) - u(2d)) is free of it
    grown = [2 * (u[1] - u[0]) - (u[2] - u[1]) for u in found]
    np.testing.assert_allclose(grown, np.log(2) * np.array(wedge_logarithms(angle, LAW)), rtol=0.02)


@pytest.mark.parametrize(
    ("degrees", "number"),
    [(180.0, 0.0), (90.0, 2 / np.pi - 0.5 / (np.pi / 4 + 0.5) - 0.5 / (np.pi / 4 - 0.5))],
)
def test_wedge_coefficient(degrees, number):
    """Half-plane: nothing to add; right angle: by hand from Michell's solution."""
    half = np.radians(degrees) / 2

    class Corner:
        points = np.array(
            [
                [0.0, 0.0],
                [0.0, -2.0],
                [0.0, -1.0],
                2 * np.array([np.sin(2 * half), -np.cos(2 * half)]),
                np.array([np.sin(2 * half), -np.cos(2 * half)]),
            ]
        )
        facets = {"flank_right": np.array([[1, 0, 2]]), "top": np.array([[0, 3, 4]])}  # noqa: RUF012
        parameters = {"flank_right": np.array([[0.0, 1.0]])}  # noqa: RUF012

    angle, c = corner_logarithm(Corner, LAW, "right")
    assert angle == pytest.approx(2 * half, abs=1e-7)
    assert c * LAW.plane_modulus == pytest.approx(number, abs=1e-9)


def test_fit_along_the_flank(ring, loads):
    places = sample_places(PROFILE, 20)
    flexible = gear_compliance(ring, PROFILE, sampled(ring, places))
    own = loads.regular_at_load()
    least = own.min() + hertz_indentation(0.1 * PROFILE.module, LAW, PROFILE.module)
    assert flexible.fit_error < 1e-4 * least
    ripple = 2e-5 * least  # of the mesh itself, which no fit should follow
    assert np.max(np.abs(flexible.own(RHO) - own)) < flexible.fit_error + ripple
    load, point = np.meshgrid(RHO, RHO)
    cross = flexible.cross(1, load, point)
    assert np.max(np.abs(cross - loads.on_neighbour(1))) < flexible.fit_error + ripple
    # the body's turning is part of everything
    assert np.all(flexible.own(RHO) > flexible.hub_windup)
    assert np.all(cross > flexible.hub_windup)
