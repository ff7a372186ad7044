"""Curved second-order mesh of one tooth sector, and its refinement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from base import Array, InputError, Integers, record
from gears.tooth.rotation import polar
from meshes.gmsh_fill import triangulate
from meshes.outline import Curve, Sizes, arc, cut, sector_curves
from meshes.triangle import NODES, shape_gradients

if TYPE_CHECKING:
    from gears import ToothProfile

Steps = tuple[tuple[float, float], ...]

STEPS = ("rim_inner", "hub_outer")
"""Names of the circles at which the body's thickness changes, outer ones first."""


@record
class SectorMesh:
    """One pitch of a gear in second-order triangles; tooth along +y, gear axis at the origin.

    Attributes
    ----------
    points : (n, 2) array
        Nodes [m], corners and mid-side nodes.
    triangles : (m, 6) array
        Anticlockwise corners 0 1 2, then the middles of 01, 12 and 20 (VTK's order).
    facets : mapping of str to (k, 3) array
        Edges of each named boundary, material on the left: first node, last node, middle. The names are
        ``flank_left``, ``flank_right``, ``fillet_*``, ``root_*``, ``chamfer_*``, ``top``, ``bore`` and the
        cuts to the neighbouring sectors ``side_left``, ``side_right``; ``rim_inner`` and ``hub_outer`` where
        the thickness changes, outer material on the left.
    parameters : mapping of str to (k, 2) array
        The curve's parameter at both ends of each edge; its mean belongs to the middle node.
    curves : mapping of str to Curve
    teeth : int
    module, base_radius : float
        [m]
    steps : tuple of (float, float)
        Circles at which the body's thickness changes, outer ones first [m], each with the thickness below it over the
        face width. Triangles do not cross them.
    coarser : SectorMesh or None
        The mesh that this one refines: its nodes are the first nodes here.
    """

    points: Array
    triangles: Integers
    facets: Mapping[str, Integers]
    parameters: Mapping[str, Array]
    curves: Mapping[str, Curve]
    teeth: int
    module: float
    base_radius: float
    steps: Steps = ()
    coarser: SectorMesh | None = None

    @property
    def unknowns(self) -> int:
        """Displacement components of the sector."""
        return 2 * len(self.points)

    def scaled(self, factor: float) -> SectorMesh:
        """Mesh of a gear that is larger by a factor.

        Parameters
        ----------
        factor : float
            Of all lengths.

        Examples
        --------
        >>> from gears import Gear, GearPair
        >>> from meshes import mesh_sector
        >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
        >>> mesh_sector(pair.teeth_profiles[0]).scaled(0.5).module
        0.001
        """
        curves = {name: curve.scaled(factor) for name, curve in self.curves.items()}
        parameters = {
            name: t * (factor if name.startswith(("flank", "side")) else 1.0)
            for name, t in self.parameters.items()
        }
        return replace(
            self,
            points=self.points * factor,
            parameters=MappingProxyType(parameters),
            curves=MappingProxyType(curves),
            module=self.module * factor,
            base_radius=self.base_radius * factor,
            steps=tuple((radius * factor, thickness) for radius, thickness in self.steps),
            coarser=None if self.coarser is None else self.coarser.scaled(factor),
        )

    def thickness_at(self, points: Array) -> Array:
        """Thickness over the face width at points (n, 2), which lie on no step."""
        radii, thickness = np.linalg.norm(points, axis=1), np.ones(len(points))
        for radius, below in self.steps:
            thickness[radii < radius] = below
        return thickness

    @property
    def thickness(self) -> Array:
        """Thickness of each triangle over the face width (m,)."""
        return self.thickness_at(self.points[self.triangles[:, :3]].mean(axis=1))

    @property
    def free(self) -> Mapping[str, Integers]:
        """Boundaries of tooth and gaps: neither cuts nor circles inside the body."""
        inside = "bore", "side", *STEPS
        return {name: edges for name, edges in self.facets.items() if not name.startswith(inside)}

    def side_nodes(self, side: str) -> Integers:
        """Nodes of a cut to the neighbour (``"left"`` or ``"right"``) from the bore outwards."""
        return self._sides[side]

    @cached_property
    def _sides(self) -> Mapping[str, Integers]:
        """Nodes of both cuts, which drawings ask for at every tooth."""
        sides = {}
        for side in ("left", "right"):
            nodes = np.unique(self.facets[f"side_{side}"])
            sides[side] = nodes[np.argsort(np.linalg.norm(self.points[nodes], axis=1))]
        return sides


def mesh_sector(
    profile: ToothProfile, sizes: Sizes | None = None, refinements: int = 0, working: str = "left"
) -> SectorMesh:
    """Mesh one sector: gmsh fills tooth and rim, structured layers go down to the bore.

    Parameters
    ----------
    profile : gears.ToothProfile
        Checked geometry; one tooth along +y.
    sizes : Sizes, optional
        Edge lengths in modules.
    refinements : int
        How often every triangle is split in four, new boundary nodes on the exact curves.
    working : {"left", "right"}
        The loaded flank, whose tip corner is meshed finely. The working flanks of both gears are the left
        ones when the pinion drives anticlockwise.

    Returns
    -------
    SectorMesh

    Raises
    ------
    base.InputError
        Outline that cuts itself, or an element turned inside out.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from meshes import mesh_sector
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> mesh = mesh_sector(pair.teeth_profiles[0])
    >>> sorted(mesh.facets)[:3], mesh.unknowns > 1000
    (['bore', 'fillet_left', 'fillet_right'], True)
    """
    sizes = sizes or Sizes()
    m = profile.module
    rim = profile.root_radius - 0.8 * np.pi * m
    circles = [zone.inner for zone in profile.zones]  # the last is the bore
    bottom = rim if rim - circles[0] > 0.6 * sizes.rim * m else circles[0]
    curves = list(sector_curves(profile, sizes, bottom, working))
    cuts = [cut(curve) for curve in curves]
    polygon = np.concatenate([curve.at(t[:-1]) for curve, t in zip(curves, cuts, strict=True)])
    points, triangles = triangulate(polygon)
    ends: dict[str, tuple[Integers, Array]] = {}
    first = 0
    for curve, t in zip(curves, cuts, strict=True):
        nodes = np.arange(first, first + len(t)) % len(polygon)
        ends[curve.name] = (np.stack([nodes[:-1], nodes[1:]], axis=1), np.stack([t[:-1], t[1:]], axis=1))
        first += len(t) - 1
    named = {curve.name: curve for curve in curves}
    half, size = 0.5 * profile.pitch_angle, named.pop("bottom").size
    above = bottom
    for name, radius in zip((*STEPS[: len(circles) - 1], "bore"), circles, strict=True):
        if radius < above:
            radii = _layer_radii(above, radius, sizes, m)
            points, triangles = _add_layers(points, triangles, ends, cuts[-1], radii)
        ends[name], above = ends["bottom"], radius
        named[name] = arc(name, radius, -half, half, size)
    del ends["bottom"]
    steps = tuple(zip(circles[:-1], [zone.thickness for zone in profile.zones[1:]], strict=True))
    mesh = _second_order(points, triangles, ends, named, (profile.teeth, m, profile.base_radius, steps))
    for _ in range(refinements):
        mesh = refined(mesh)
    return mesh


def _layer_radii(rim: float, bore: float, sizes: Sizes, module: float) -> Array:
    """Radii from the rim to the bore: heights grow, but stay a part of the radius (strains grow inwards)."""
    heights = [sizes.rim * module]
    while sum(heights) < rim - bore:
        remaining = rim - sum(heights)
        heights.append(min(heights[-1] * sizes.layer_growth, 0.3 * remaining))
    if len(heights) > 1 and sum(heights) - (rim - bore) > 0.5 * heights[-1]:
        heights.pop()
    radii: Array = rim - (rim - bore) * np.concatenate([[0.0], np.cumsum(heights) / sum(heights)])
    radii[-1] = bore
    return radii


def _add_layers(
    points: Array,
    triangles: Integers,
    ends: dict[str, tuple[Integers, Array]],
    angles: Array,
    radii: Array,
) -> tuple[Array, Integers]:
    """Rings of split quadrilaterals under the rim; the cuts and the bottom are continued."""
    columns = len(angles) - 1
    above = np.append(ends["bottom"][0][:, 0], ends["bottom"][0][-1, 1])
    rows = [above]
    fresh = [points]
    start = len(points)
    for radius in radii[1:]:
        fresh.append(polar(float(radius), angles))
        rows.append(np.arange(start, start + columns + 1))
        start += columns + 1
    quads = []
    for upper, lower in pairwise(rows):
        a, b, c, d = upper[:-1], upper[1:], lower[1:], lower[:-1]  # angles grow to the right
        leaning = np.arange(columns) < columns / 2
        quads.append(np.where(leaning[:, None], np.stack([a, d, c], 1), np.stack([a, d, b], 1)))
        quads.append(np.where(leaning[:, None], np.stack([a, c, b], 1), np.stack([b, d, c], 1)))
    down = np.array(rows)
    left = np.stack([down[:-1, 0], down[1:, 0]], axis=1)
    right = np.stack([down[:0:-1, -1], down[-2::-1, -1]], axis=1)
    outward, inward = np.stack([radii[:0:-1], radii[-2::-1]], 1), np.stack([radii[:-1], radii[1:]], 1)
    ends["side_left"] = tuple(  # type: ignore[assignment]
        np.concatenate(pieces) for pieces in zip(ends["side_left"], (left, inward), strict=True)
    )
    ends["side_right"] = tuple(  # type: ignore[assignment]
        np.concatenate(pieces) for pieces in zip((right, outward), ends["side_right"], strict=True)
    )
    ends["bottom"] = (np.stack([rows[-1][:-1], rows[-1][1:]], axis=1), ends["bottom"][1])
    return np.concatenate(fresh), np.concatenate([triangles, *quads])


def _second_order(
    corners: Array,
    triangles: Integers,
    ends: Mapping[str, tuple[Integers, Array]],
    curves: Mapping[str, Curve],
    gear: tuple[int, float, float, Steps],
) -> SectorMesh:
    """Mid-side nodes: half-way on inner edges, in the middle of the piece on the curves."""
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2).reshape(-1, 2)
    keys = edges[:, 0] * len(corners) + edges[:, 1]
    unique, inverse = np.unique(keys, return_inverse=True)
    middle = np.stack(np.divmod(unique, len(corners)), axis=1)
    points = np.concatenate([corners, corners[middle].mean(axis=1)])
    facets, parameters = {}, {}
    for name, (nodes, t) in ends.items():
        low, high = np.sort(nodes, axis=1).T
        edge_numbers = np.searchsorted(unique, low * len(corners) + high)
        if not np.array_equal(unique[np.minimum(edge_numbers, len(unique) - 1)], low * len(corners) + high):
            allowed = "must keep every edge of the outline"
            raise InputError.at(name, "edges lost", allowed, "use smaller elements")
        points[len(corners) + edge_numbers] = curves[name].at(curves[name].middles(t))
        facets[name] = np.column_stack([nodes, len(corners) + edge_numbers])
        parameters[name] = t
    six = np.concatenate([triangles, len(corners) + inverse.reshape(-1, 3)], axis=1)
    _refuse_inverted(points, six)
    return SectorMesh(
        points,
        six,
        MappingProxyType(facets),
        MappingProxyType(parameters),
        MappingProxyType(dict(curves)),
        *gear,
    )


def _refuse_inverted(points: Array, triangles: Integers) -> None:
    gradients = shape_gradients(NODES[:, 0], NODES[:, 1])
    # derivatives of x and y by both reference coordinates, (triangles, nodes) each
    (x_xi, x_eta), (y_xi, y_eta) = (
        [points[triangles, axis] @ gradients[..., along].T for along in (0, 1)] for axis in (0, 1)
    )
    bad = np.flatnonzero((x_xi * y_eta - x_eta * y_xi).min(axis=1) <= 0)
    if len(bad):
        x, y = points[triangles[bad[0], :3]].mean(axis=0)
        inverted = f"{len(bad)} turned inside out, the first near ({x:g}, {y:g})"
        remedy = "use smaller elements on curved boundaries"
        raise InputError.at("elements", inverted, "must have positive Jacobians", remedy)


def refined(mesh: SectorMesh) -> SectorMesh:
    """Split every triangle in four; the middles become corners, new middles lie on the exact curves.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from meshes import mesh_sector, refined
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> mesh = mesh_sector(pair.teeth_profiles[0])
    >>> len(refined(mesh).triangles) == 4 * len(mesh.triangles)
    True
    """
    a, b, c, ab, bc, ca = mesh.triangles.T
    children = np.concatenate(
        [np.stack(three, axis=1) for three in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    )
    ends = {}
    for name, facets in mesh.facets.items():
        first, last, middle = facets.T
        t = mesh.parameters[name]
        half = mesh.curves[name].middles(t)
        nodes = np.stack([first, middle, middle, last], axis=1).reshape(-1, 2)
        ends[name] = (nodes, np.stack([t[:, 0], half, half, t[:, 1]], axis=1).reshape(-1, 2))
    gear = mesh.teeth, mesh.module, mesh.base_radius, mesh.steps
    finer = _second_order(mesh.points, children, ends, mesh.curves, gear)
    return replace(finer, coarser=mesh)
