"""Fillets as lines of sample points, and the stress along a free edge from displacements.

An edge without load is in uniaxial stress along itself, so that its stress needs the tangential strain alone:

    sigma_t = E* d(u . t)/ds   with t the tangent and s the arc length (u here the vector, t taken at its place).

The derivative of a second-order element's displacement is most accurate at the two Gauss points of its edge
(points of superconvergence; O. C. Zienkiewicz and J. Z. Zhu, Int. J. Numer. Methods Eng. 33, 1992); a cubic is
fitted through those of three neighbouring edges and taken at the sample points.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.elasticity.plane_elasticity import MIRROR, PlaneElasticity
from meshes import SectorMesh

if TYPE_CHECKING:
    from scipy.sparse import csr_array

    from gears import ToothProfile

__all__ = [
    "FilletEdges",
    "FilletLine",
    "edge_strain_matrix",
    "fillet_edges",
    "fillet_line",
    "fillet_stress_matrix",
    "local_cubic",
]

SAMPLES = 81
"""Points on a fillet and its half of the root land; the stress between them is a parabola."""

GAUSS: Array = np.array([0.5 - 0.5 / 3**0.5, 0.5 + 0.5 / 3**0.5])


@record
class FilletLine:
    """Half of the root land and the fillet on the right of a tooth; the left ones are its mirror image.

    Attributes
    ----------
    arc : (n,) array
        Arc length from the middle of the gap between two teeth [m].
    points, tangents, normals : (n, 2) arrays
        In the tooth's frame [m]; unit vectors, the tangent away from the gap, the normal out of the material.
    tangent_angle : (n,) array
        Angle between the fillet's tangent and the tooth's centre line [rad], 30 degrees at ISO 6336-3's place.
    foot : float
        Arc length at which the root circle ends and the fillet begins [m].
    """

    arc: Array
    points: Array
    tangents: Array
    normals: Array
    tangent_angle: Array
    foot: float

    def side(self, left: bool) -> tuple[Array, Array, Array]:
        """Points, tangents and normals on the right or, mirrored, on the left of the tooth."""
        if not left:
            return self.points, self.tangents, self.normals
        return self.points * MIRROR, self.tangents * MIRROR, self.normals * MIRROR


def _arc_of_fillet(profile: ToothProfile) -> tuple[Array, Array]:
    """Fillet parameter t and arc length from the root circle, finely tabulated with Simpson's rule."""
    curve = profile.fillet_curve
    t = np.linspace(0.0, 1.0, 401)
    speed = curve.speed(np.linspace(0.0, curve.end, 801))
    step = (speed[:-1:2] + 4 * speed[1::2] + speed[2::2]) * curve.end / 2400
    return t, np.concatenate([[0.0], np.cumsum(step)])


def fillet_line(profile: ToothProfile, samples: int = SAMPLES) -> FilletLine:
    """Sample points at equal arc lengths from the middle of the gap to the form circle.

    Parameters
    ----------
    profile : gears.ToothProfile
    samples : int
    """
    radius, half_pitch = profile.root_radius, 0.5 * profile.pitch_angle
    foot = max(radius * (half_pitch - profile.root_half_angle), 0.0)
    t, along = _arc_of_fillet(profile)
    arc = np.linspace(0.0, foot + along[-1], samples)
    on_fillet = arc >= foot
    place = np.interp(arc - foot, along, t)
    angle = half_pitch - np.minimum(arc, foot) / radius
    land = np.stack([np.sin(angle), np.cos(angle)], axis=1)
    points = np.where(on_fillet[:, None], profile.fillet(place), radius * land)
    normals = np.where(on_fillet[:, None], profile.fillet_normal(place), land)
    tangents = np.stack([-normals[:, 1], normals[:, 0]], axis=1)
    lean = np.arctan2(np.abs(tangents[:, 0]), tangents[:, 1])
    return FilletLine(arc, points, tangents, normals, lean, foot)


def edge_strain_matrix(points: Array, edges: Integers) -> csr_array:
    """Matrix (2 edges, 2 nodes) from nodal displacements to tangential strains at the edges' Gauss points.

    Parameters
    ----------
    points : (n, 2) array
        Nodes [m].
    edges : (k, 3) array
        First node, last node, middle.
    """
    from scipy.sparse import coo_array

    slopes = np.stack([4 * GAUSS - 3, 4 * GAUSS - 1, 4 - 8 * GAUSS], axis=-1)
    along = np.einsum("qk,eka->eqa", slopes, points[edges])
    along /= np.sum(along**2, axis=2, keepdims=True)
    values = np.einsum("qk,eqa->eqka", slopes, along)
    rows = np.broadcast_to(np.arange(2 * len(edges)).reshape(-1, 2, 1, 1), values.shape)
    columns = np.broadcast_to(2 * edges[:, None, :, None] + np.arange(2), values.shape)
    shape = (2 * len(edges), 2 * len(points))
    return coo_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsr()


def local_cubic(known: Array, wanted: Array, points: int = 6, degree: int = 3) -> Array:
    """Weights (wanted, known) that fit a polynomial through the nearest points and evaluate it.

    Parameters
    ----------
    known : (n,) array
        Growing places of the values.
    wanted : (k,) array
    points, degree : int
        Points of each fit, fewer where there are fewer, and its degree.
    """
    points = min(points, len(known))
    degree = min(degree, points - 1)
    first = np.clip(np.searchsorted(known, wanted) - points // 2, 0, len(known) - points)
    window = first[:, None] + np.arange(points)
    near = known[window]
    scale = near[:, -1:] - near[:, :1]
    # value at x of the least-squares polynomial in (place - x): its constant term
    powers = np.polynomial.polynomial.polyvander((near - wanted[:, None]) / scale, degree)
    weights = np.zeros((len(wanted), len(known)))
    np.put_along_axis(weights, window, np.linalg.pinv(powers)[:, 0], axis=1)
    return weights


@record
class FilletEdges:
    """Edges of the elements along half of the root land and a fillet.

    Attributes
    ----------
    nodes : (k, 3) array
        First node, last node, middle.
    outward : (k,) array
        1 where an edge runs away from the gap as the fillet's samples do, else -1.
    weights : (samples, 2k) array
        From values at the edges' Gauss points to such at the samples.
    """

    nodes: Integers
    outward: Array
    weights: Array


def fillet_edges(mesh: SectorMesh, profile: ToothProfile, line: FilletLine, side: str) -> FilletEdges:
    """Find the edges of a fillet and interpolate between their Gauss points.

    Parameters
    ----------
    mesh : meshes.SectorMesh
    profile : gears.ToothProfile
    line : FilletLine
    side : {"left", "right"}
    """
    t, along = _arc_of_fillet(profile)
    edges, arcs = [], []
    for name in (f"root_{side}", f"fillet_{side}"):
        if name not in mesh.facets:
            continue
        ends = mesh.parameters[name]
        # as the element's own coordinate runs, through the parameter of its middle
        bend = 4 * mesh.curves[name].middles(ends)[:, None] - 2 * ends.sum(axis=1, keepdims=True)
        place = ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * GAUSS + bend * GAUSS * (1 - GAUSS)
        if name.startswith("root"):
            arcs.append(profile.root_radius * (0.5 * profile.pitch_angle - place))
        else:
            arcs.append(line.foot + np.interp(place, t, along))
        edges.append(mesh.facets[name])
    gauss_arcs = np.concatenate(arcs)
    arc = gauss_arcs.ravel()
    order = np.argsort(arc)
    weights = np.zeros((len(line.arc), len(arc)))
    weights[:, order] = local_cubic(arc[order], line.arc)
    return FilletEdges(np.concatenate(edges), np.sign(gauss_arcs[:, 1] - gauss_arcs[:, 0]), weights)


def fillet_stress_matrix(
    mesh: SectorMesh, profile: ToothProfile, line: FilletLine, law: PlaneElasticity, side: str
) -> csr_array:
    """Matrix (samples, unknowns) from a sector's displacements to E* eps_t along one of its fillets.

    Parameters
    ----------
    mesh : meshes.SectorMesh
    profile : gears.ToothProfile
    line : FilletLine
    law : PlaneElasticity
    side : {"left", "right"}
    """
    from scipy.sparse import csr_array

    edges = fillet_edges(mesh, profile, line, side)
    strain = edge_strain_matrix(mesh.points, edges.nodes)
    return csr_array(law.plane_modulus * (csr_array(edges.weights) @ strain))
