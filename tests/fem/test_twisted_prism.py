"""The twisted solid of a helical gear: rigid motions, spur as its limit, reciprocity, and bodies in fixed axes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve

from base import Array
from fem.elasticity.dissection import unknowns_of
from fem.elasticity.free_ends import HalfFace, half_face
from fem.elasticity.line_load import FlankPoints, flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity, physical_gradients
from fem.elasticity.prism import prism
from fem.elasticity.section import Face, Section, section
from gears import Gear, GearPair
from meshes import SectorMesh, Sizes, mesh_sector
from meshes.triangle import shape

LAW = PlaneElasticity("strain", 206e9, 0.3)
TWIST = 9.0
"""[rad/m]: 18 degrees on the base circle of this gear."""


class _Case(NamedTuple):
    mesh: SectorMesh
    over: Section
    at: FlankPoints


@pytest.fixture(scope="module")
def case() -> _Case:
    pair = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=40e-3)
    profile = pair.teeth_profiles[0]
    mesh = mesh_sector(profile, Sizes().scaled(2.0), 0)
    low, high = profile.flank_rho
    at = flank_points(mesh, low + np.array([0.2, 0.5, 0.9]) * (high - low))
    return _Case(mesh, section(mesh, LAW, TWIST), at)


def _across(over: Section, face: Face, at: FlankPoints) -> Array:
    """Answers (teeth, loads, psi, points, psi) on the loaded tooth and its neighbours."""
    return prism(over, face).across(at, at, [0, 1, -1])


def _by_node(face: Face, motions: list[tuple[Array, Array, Array]]) -> Array:
    """Unknowns (6 n, motions) of motions (u, v, w), each (6, functions)."""
    columns = []
    for u, v, w in motions:
        pairs = np.stack([u, v], axis=2).reshape(len(u), 2 * face.psi)
        columns.append(np.concatenate([pairs, w], axis=1).ravel())
    return np.array(columns).T


def test_rigid_motions_cost_nothing(case: _Case) -> None:
    """Turns about the axis and shifts along it as constants; shifts across it turn back as the section turns."""
    x, y = case.mesh.points[case.mesh.triangles[0]].T
    nil = np.zeros_like(x)
    still = Face.wave(0.0, twisted=True)
    turn = (-y[:, None], x[:, None], nil[:, None])
    along = (nil[:, None], nil[:, None], np.ones((6, 1)))
    # (1, 0) and (0, 1) in fixed axes are (cos, -sin) and (sin, cos) of twist z in those that turn
    across = Face.wave(TWIST, twisted=True)
    one = np.ones(6)
    shifts = [
        (np.stack([one, nil], 1), np.stack([nil, -one], 1), np.zeros((6, 2))),
        (np.stack([nil, one], 1), np.stack([one, nil], 1), np.zeros((6, 2))),
    ]
    for face, motions in ((still, [turn, along]), (across, shifts)):
        matrix = case.over.elements(face, np.array([0]))[0]
        moved = _by_node(face, motions)
        forces = np.abs(matrix @ moved)
        assert forces.max() < 1e-13 * (np.abs(matrix) @ np.abs(moved)).max()


def test_nothing_but_rigid_motions_is_free(case: _Case) -> None:
    """A wave of the wrong hand bends the solid."""
    face = Face.wave(TWIST, twisted=True)
    one, nil = np.ones(6), np.zeros(6)
    moved = _by_node(face, [(np.stack([one, nil], 1), np.stack([nil, one], 1), np.zeros((6, 2)))])
    matrix = case.over.elements(face, np.array([0]))[0]
    assert np.abs(matrix @ moved).max() > 1e-5 * (np.abs(matrix) @ np.abs(moved)).max()


@pytest.mark.parametrize("wavenumber", [0.0, 300.0])
def test_no_twist_is_the_prism(case: _Case, wavenumber: float) -> None:
    """All three directions with cosines and sines know no more than u, v ~ cos and w ~ sin."""
    straight = section(case.mesh, LAW)
    few = _across(straight, Face.wave(wavenumber), case.at)
    many = _across(straight, Face.wave(wavenumber, twisted=True), case.at)
    size = np.abs(few).max()
    assert np.abs(many[:, :, 0, :, 0] - few[:, :, 0, :, 0]).max() < 1e-12 * size
    if wavenumber:
        assert np.abs(many[:, :, 0, :, 1]).max() < 1e-12 * size
        assert np.abs(many[:, :, 1, :, 1] - many[:, :, 0, :, 0]).max() < 1e-12 * size


def test_a_small_twist_is_near_none(case: _Case) -> None:
    """The answer is even in the twist at the load itself, where a wave has no direction along the axis."""
    none, small, back = (
        _across(section(case.mesh, LAW, twist), Face.wave(300.0, twisted=True), case.at)
        for twist in (0.0, 1e-3, -1e-3)
    )
    own = np.arange(len(case.at.rho))
    size = np.abs(none).max()
    assert np.abs(small - none).max() < 1e-4 * size
    assert np.abs(small[0, own, 0, own, 0] - back[0, own, 0, own, 0]).max() < 1e-12 * size


def test_answers_are_reciprocal_and_hermitian(case: _Case) -> None:
    """c(b, a; k) = c(a, b; -k), conjugate: [[Re, -Im], [Im, Re]] over cosine and sine; the load's own is real."""
    answer = _across(case.over, Face.wave(300.0, twisted=True), case.at)
    own = answer[0]
    size = np.abs(own).max()
    assert np.abs(own[:, 0, :, 0] - own[:, 1, :, 1]).max() < 1e-12 * size
    assert np.abs(own[:, 0, :, 1] + own[:, 1, :, 0]).max() < 1e-12 * size
    assert np.abs(own[:, 0, :, 0] - own[:, 0, :, 0].T).max() < 1e-12 * size
    assert np.abs(own[:, 0, :, 1] + own[:, 0, :, 1].T).max() < 1e-12 * size
    assert np.abs(own[:, 0, :, 1]).max() > 1e-3 * size
    # the neighbour on one side feels what the loaded tooth feels from the neighbour on the other side
    assert np.abs(answer[1] - np.moveaxis(answer[2], (0, 1), (2, 3))).max() < 1e-12 * size


def test_the_other_hand_is_the_mirror_image(case: _Case) -> None:
    """Seen in the plane through the tooth's middle: the other flank, the other hand, neighbours the other way."""
    right = flank_points(case.mesh, case.at.rho, "right")
    mine = _across(case.over, Face.wave(300.0, twisted=True), case.at)
    other = _across(section(case.mesh, LAW, -TWIST), Face.wave(300.0, twisted=True), right)
    # on the loaded tooth the elements at the load decide, which are not each other's mirror images
    for tooth, mirrored in ((mine[1], other[2]), (mine[2], other[1])):
        assert np.abs(tooth - mirrored).max() < 5e-3 * np.abs(tooth).max()


def test_one_sector_is_the_body_in_fixed_axes() -> None:
    """A sector with free cuts and ends under a line load, placed in space where the helix has it.

    Displacements along fixed axes are polynomials of z there, and along turning ones here: both come near the same
    answer as pieces grow short.
    """
    pair = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=40e-3)
    profile = pair.teeth_profiles[0]
    mesh = mesh_sector(profile, Sizes().scaled(4.0), 0)
    at = flank_points(mesh, np.array([np.mean(profile.flank_rho)]))
    half = half_face(6e-3, 2e-3, last=1.5, growth=1.0)
    energies = _energy_in_turning_axes(mesh, half, at), _energy_in_fixed_axes(mesh, half, at)
    assert energies[0] == pytest.approx(energies[1], rel=2e-6)


def _energy_in_turning_axes(mesh: SectorMesh, half: HalfFace, at: FlankPoints) -> float:
    """Twice the energy of one sector by a unit line load [N m per (N/m)^2], by the integrals of the section."""
    count, over = len(half.mass), section(mesh, LAW, TWIST)
    functions = np.ix_(*2 * [np.tile(np.arange(count), 2)])
    face = Face(count, count, *(table[functions] for table in (half.mass, half.mixed, half.stiffness)))
    elements = over.elements(face, np.arange(len(mesh.triangles)))
    force = prism(over, face)._nodal(at) @ _whole_face(half)
    return _twice_the_energy(mesh, elements, 3 * count, force)


def _energy_in_fixed_axes(mesh: SectorMesh, half: HalfFace, at: FlankPoints) -> float:
    count, force = len(half.mass), np.zeros((len(mesh.points), len(half.mass), 3))
    s, share = legendre.leggauss(6)
    (x, y), inward = at.points[0], at.direction[0]
    for start, stop in zip(half.ends[:-1], half.ends[1:], strict=True):
        for z, part in zip(
            0.5 * (start + stop + (stop - start) * s), 0.5 * (stop - start) * share, strict=True
        ):
            turn = _turned(TWIST * z)
            profile = np.append(turn @ [-inward[1], inward[0]], 0.0)
            normal = np.cross(profile, np.append(TWIST * (turn @ [-y, x]), 1.0))
            normal *= np.sign(normal[:2] @ turn @ inward) / np.linalg.norm(normal)
            along = half.values(np.array([z]))[:, 0]
            force[at.nodes[0]] += part * at.weights[0][:, None, None] * along[:, None] * normal
    return _twice_the_energy(mesh, _elements_in_fixed_axes(mesh, half), 3 * count, force.ravel())


def _turned(angle: float) -> Array:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _whole_face(half: HalfFace) -> Array:
    """What a load that is 1 all along gives each function."""
    s, share = legendre.leggauss(6)
    middle, reach = 0.5 * (half.ends[1:] + half.ends[:-1]), 0.5 * np.diff(half.ends)
    places = (middle[:, None] + reach[:, None] * s).ravel()
    return np.asarray(half.values(places) @ (reach[:, None] * share).ravel())


def _twice_the_energy(mesh: SectorMesh, elements: Array, n: int, force: Array) -> float:
    unknown = unknowns_of(mesh.triangles.ravel(), n).reshape(len(mesh.triangles), -1)
    rows, columns = np.repeat(unknown, unknown.shape[1], axis=1), np.tile(unknown, unknown.shape[1])
    size = n * len(mesh.points)
    matrix = coo_array((elements.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsc()
    free = np.setdiff1d(np.arange(size), unknowns_of(np.unique(mesh.facets["bore"]), n))
    return float(force[free] @ spsolve(matrix[free][:, free], force[free]))


def _elements_in_fixed_axes(mesh: SectorMesh, half: HalfFace) -> Array:
    """Stiffness of triangles times pieces in space, placed where the helix has them, Cartesian displacements."""
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefTri

    (xi, eta), weight = get_quadrature(RefTri, 6)
    values = shape(xi, eta)
    gradient, determinant = physical_gradients(mesh.points, mesh.triangles, xi, eta)
    places = np.einsum("qi,mia->mqa", values, mesh.points[mesh.triangles])
    n, lam, mu = len(half.mass), *LAW.lame
    elements = np.zeros((len(mesh.triangles), 6, n, 3, 6, n, 3))
    s, share = legendre.leggauss(6)
    for start, stop in zip(half.ends[:-1], half.ends[1:], strict=True):
        for z, part in zip(
            0.5 * (start + stop + (stop - start) * s), 0.5 * (stop - start) * share, strict=True
        ):
            along, slope = half.values(np.array([z]))[:, 0], half.slopes(np.array([z]))[:, 0]
            turn = _turned(TWIST * z)
            there = places @ turn.T
            # gradients in space of N(x, y) f(z), x and y turned back from where the point is
            flat = gradient @ turn.T
            deep = -TWIST * (there[..., :1] * flat[..., 1] - there[..., 1:] * flat[..., 0])
            slopes = np.empty((*gradient.shape[:3], n, 3))
            slopes[..., :2] = flat[..., None, :] * along[:, None]
            slopes[..., 2] = deep[..., None] * along + values[:, :, None] * slope
            by = np.einsum(
                "mqipc,mqjrd,mq->mipcjrd", slopes, slopes, determinant * weight * part, optimize=True
            )
            # lambda d_a N_i d_b N_j + mu (d_b N_i d_a N_j + delta_ab grad . grad)
            elements += lam * by + mu * np.swapaxes(by, 3, 6)
            trace = mu * np.einsum("mipcjrc->mipjr", by)
            for a in range(3):
                elements[:, :, :, a, :, :, a] += trace
    return elements.reshape(len(mesh.triangles), 18 * n, 18 * n)
