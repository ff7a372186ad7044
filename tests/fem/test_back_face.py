"""Loads that vary along the face, seen on the other side of the teeth: one gear, its waves and its free ends."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from scipy.sparse import csc_array
from scipy.sparse.linalg import spsolve

from base import Array
from fem.elasticity.flank_samples import sample_places
from fem.elasticity.free_ends import free_ends_across, half_face, over_cells
from fem.elasticity.line_load import FlankPoints, flank_points
from fem.elasticity.plane_elasticity import INTEGRATION, PlaneElasticity, physical_gradients
from fem.elasticity.prism import prism
from fem.elasticity.ring import ring_of
from fem.elasticity.section import Face, Section, section
from fem.influence.back_compliance import back_compliance
from fem.influence.back_face import BackHarmonics, back_end_correction, back_harmonics
from fem.influence.gear_face import section_of
from fem.influence.gear_shape import MeshedShape, shapes
from fem.influence.series import of_teeth
from gears import Gear, GearPair, ToothProfile
from meshes import SectorMesh, Sizes, gear_mesh, mesh_sector
from meshes.triangle import shape

LAW = PlaneElasticity("strain", 206e9, 0.3)
TEETH = range(-2, 3)


class _Case(NamedTuple):
    profile: ToothProfile
    mesh: SectorMesh
    over: Section
    left: FlankPoints
    right: FlankPoints


@pytest.fixture(scope="module")
def case() -> _Case:
    pair = GearPair(Gear(18, 0.2, bore_radius=0.008), Gear(24), 2e-3, 0.04)
    profile = pair.teeth_profiles[0]
    mesh = mesh_sector(profile, refinements=1)
    low, high = profile.flank_rho
    rho = low + np.array([0.1, 0.5, 0.9]) * (high - low)
    left, right = (flank_points(mesh, rho, flank) for flank in ("left", "right"))
    return _Case(profile, mesh, section(mesh, LAW), left, right)


@pytest.fixture(scope="module")
def meshed() -> MeshedShape:
    pair = GearPair(Gear(18, 0.2, bore_radius=0.008), Gear(24), 2e-3, 0.04)
    return MeshedShape(shapes(pair, pair.teeth_profiles, "strain")[0], Sizes(), 1)


@pytest.fixture(scope="module")
def harmonics(meshed: MeshedShape) -> BackHarmonics:
    return back_harmonics(meshed)


def _wave(over: Section, wavenumber: float, at: FlankPoints, seen: FlankPoints) -> Array:
    """On teeth TEETH (teeth, loads, points)."""
    return prism(over, Face.wave(wavenumber)).across(at, seen, TEETH)[:, :, 0, :, 0]


def _stiffness(points: Array, triangles: Array, thickness: Array, wavenumber: float) -> csc_array:
    """Of a solid u, v ~ cos k z and w ~ sin k z, by Hooke's law and the six strains at every integration point."""
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefTri

    (xi, eta), weight = get_quadrature(RefTri, INTEGRATION)
    gradient, determinant = physical_gradients(points, triangles, xi, eta)
    values = shape(xi, eta)
    strain = np.zeros((*gradient.shape[:2], 6, 6, 3))  # triangle, point, strain, node, displacement
    strain[..., 0, :, 0] = strain[..., 3, :, 1] = gradient[..., 0]
    strain[..., 1, :, 1] = strain[..., 3, :, 0] = gradient[..., 1]
    strain[..., 2, :, 2] = wavenumber * values
    strain[..., 4, :, 0] = strain[..., 5, :, 1] = -wavenumber * values
    strain[..., 4, :, 2], strain[..., 5, :, 2] = gradient[..., 0], gradient[..., 1]
    lam, mu = LAW.lame
    hooke = np.diag([2 * mu] * 3 + [mu] * 3)
    hooke[:3, :3] += lam
    strain = strain.reshape(*gradient.shape[:2], 6, 18)
    scale = determinant * weight * thickness[:, None]
    elements = np.einsum("mq,mqsi,st,mqtj->mij", scale, strain, hooke, strain, optimize=True)
    unknown = (3 * triangles[:, :, None] + np.arange(3)).reshape(len(triangles), 18)
    rows = np.broadcast_to(unknown[:, :, None], elements.shape)
    columns = np.broadcast_to(unknown[:, None, :], elements.shape)
    size = 3 * len(points)
    return csc_array((elements.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))


@pytest.mark.parametrize("wavenumber", [150.0, 900.0])
def test_a_wave_on_the_whole_annulus_solved_at_once(wavenumber: float) -> None:
    """The same elements in every sector, no condensation and no ring: load on a front flank, back flanks read."""
    profile = GearPair(Gear(12, 0.4, bore_radius=0.006), Gear(24), 2e-3, 0.04).teeth_profiles[0]
    sector = mesh_sector(profile, Sizes().scaled(2.0), 0)
    gear = gear_mesh(sector)
    low, high = profile.flank_rho
    left, right = (
        flank_points(sector, low + np.array([0.3, 0.8]) * (high - low), flank) for flank in ("left", "right")
    )
    force = np.zeros((len(gear.points), 3, 2))
    for load in range(2):
        nodal = left.weights[load][:, None] * left.inward[load]
        force[gear.nodes[0][left.nodes[load]], :2, load] += nodal
    stiffness = _stiffness(gear.points, gear.triangles, gear.thickness, wavenumber)
    free = np.setdiff1d(
        np.arange(stiffness.shape[0]), 3 * np.unique(gear.facets["bore"])[:, None] + np.arange(3)
    )
    moved = np.zeros((stiffness.shape[0], 2))
    moved[free] = spsolve(
        csc_array(stiffness[free][:, free]), force.reshape(-1, 2)[free], permc_spec="MMD_AT_PLUS_A"
    )
    moved = moved.reshape(-1, 3, 2)[:, :2]
    mine = _wave(section(sector, LAW), wavenumber, left, right)
    for tooth, there in zip(TEETH, mine, strict=True):
        angle = -tooth * profile.pitch_angle
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        sector_moved = np.einsum("ab,nbl->nal", turn, moved[gear.nodes[tooth % 12]])
        np.testing.assert_allclose(
            there.T, right.component(sector_moved), rtol=0, atol=1e-9 * np.abs(mine).max()
        )


def test_without_a_wave_it_is_the_plane(case: _Case) -> None:
    """Nodal forces against line loads in closed form: elements' errors; a wave without end is none."""
    plane = back_compliance(ring_of(case.mesh, LAW), sample_places(case.profile, 20), 2)
    none, long = (_wave(case.over, k, case.left, case.right) for k in (0.0, 1e-6))
    rho = case.left.rho
    for tooth, moved in zip(TEETH, none, strict=True):
        exact = plane.across(np.array(tooth), rho[:, None], rho)
        np.testing.assert_allclose(moved, exact, rtol=0, atol=5e-4 * np.abs(none).max())
    np.testing.assert_allclose(long, none, rtol=0, atol=1e-10 * np.abs(none).max())


def test_load_and_point_change_places(case: _Case) -> None:
    """Maxwell and Betti to rounding; in the mirror of the section but for the elements' errors."""
    solved = prism(case.over, Face.wave(300.0))
    forth = solved.across(case.left, case.right, TEETH)[:, :, 0, :, 0]
    back = solved.across(case.right, case.left, [-tooth for tooth in TEETH])[:, :, 0, :, 0]
    size = np.abs(forth).max()
    np.testing.assert_allclose(forth, np.swapaxes(back, 1, 2), rtol=0, atol=1e-11 * size)
    np.testing.assert_allclose(forth, back, rtol=0, atol=1e-3 * size)
    assert np.abs(forth[1] - forth[3]).max() > 0.01 * np.abs(forth[1]).max()


def test_short_waves_reach_no_back_flank(case: _Case) -> None:
    sizes = np.array(
        [
            np.abs(_wave(case.over, k, case.left, case.right)).max(axis=(1, 2))
            for k in (0.0, 300.0, 1200.0, 4000.0)
        ]
    )
    assert np.all(np.diff(sizes, axis=0) < 0.0)
    assert np.all(sizes[-1] < 2e-3 * sizes[0])
    assert np.all(sizes[2, [0, 1, 3, 4]] < 1e-2 * sizes[0, [0, 1, 3, 4]])


def test_series_between_the_solved_waves(meshed: MeshedShape, harmonics: BackHarmonics) -> None:
    over = section_of(meshed, meshed.sizes, meshed.refinements)
    low, high = harmonics.series[0].variable.span
    rho = low + np.array([0.13, 0.55, 0.94]) * (high - low)
    left, right = (flank_points(over.mesh, rho, flank) for flank in ("left", "right"))
    wavenumber, teeth = np.array([0.0, 0.08, 0.27, 0.7, 2.0, 6.0, 30.0]), np.array(TEETH)
    mine = harmonics.across(teeth[:, None, None], rho[:, None], rho, wavenumber)
    solved = np.stack([_wave(over, k, left, right) for k in wavenumber], axis=-1)
    size = np.abs(solved).max()
    assert np.abs(mine[..., 0]).max() < 1e-12 * size
    np.testing.assert_allclose(mine, solved - solved[..., :1], rtol=0, atol=4e-4 * size)
    assert harmonics.error < 4e-4 * size
    # no tooth is too far away to be asked for
    assert not harmonics.across(np.array([9]), rho[:1], rho[:1], wavenumber).any()


def test_what_ends_add_changes_places_too(case: _Case) -> None:
    over = section(mesh_sector(case.profile, Sizes().scaled(2.0), 0), LAW)
    half = half_face(3e-3, 2e-3)
    left, right = (flank_points(over.mesh, case.left.rho, flank) for flank in ("left", "right"))
    for added in free_ends_across(over, half, left, right, TEETH):
        mirrored = np.transpose(added, (0, 2, 1, 4, 3))
        np.testing.assert_allclose(added, mirrored, rtol=0, atol=2e-2 * np.abs(added).max())


def test_a_thin_face_with_free_ends_is_in_plane_stress(case: _Case) -> None:
    """Plane strain and what free ends add is plane stress where the face is thin."""
    mesh = mesh_sector(case.profile, Sizes().scaled(1.5), 0)
    left, right = (flank_points(mesh, case.left.rho, flank) for flank in ("left", "right"))
    stress = PlaneElasticity("stress", LAW.E, LAW.nu)
    strain_moved, stress_moved = (_wave(section(mesh, law), 0.0, left, right) for law in (LAW, stress))
    width = 1e-5
    ends = free_ends_across(section(mesh, LAW), half_face(0.5 * width, 2e-3), left, right, TEETH)
    added = over_cells(half_face(0.5 * width, 2e-3), *ends, np.array([-0.5, 0.5]) * width)[..., 0, 0] * width
    change = np.abs(stress_moved - strain_moved).max()
    np.testing.assert_allclose(strain_moved + added, stress_moved, rtol=0, atol=5e-3 * change)


def test_ends_of_cells(meshed: MeshedShape) -> None:
    """Both halves alike; most at the ends of the loaded tooth; no net push through mid-face on far teeth."""
    ends = back_end_correction(meshed, 6.0)
    assert ends.error < 2e-2
    cells = ends.over(np.linspace(-3.0, 3.0, 9))
    rho = np.array([0.4, 0.8]) * ends.place.span[1]
    teeth = np.array(TEETH)
    added = of_teeth(cells, teeth[:, None, None], rho[:, None], rho)
    size = np.abs(added).max()
    np.testing.assert_allclose(added, added[..., ::-1, ::-1], rtol=0, atol=1e-12 * size)
    np.testing.assert_allclose(added, np.transpose(added, (0, 2, 1, 4, 3)), rtol=0, atol=1e-12 * size)
    assert np.abs(added[2]).max() == size
    assert size == np.abs(added[..., [0, 0, -1, -1], [0, -1, 0, -1]]).max()
