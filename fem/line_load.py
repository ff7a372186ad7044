"""Line loads anywhere on a flank: the singular part in closed form, the regular part by finite elements.

In the loaded sector u = u_s + u_r with u_s Flamant's half-plane (``fem.flamant``), tangent to the flank's
element edge at the load. u_r is regular and solves the elasticity problem with the tractions -sigma_s n on
the edges and -u_s on the hub; in every other sector the unknown is u itself. On the cuts of the loaded
sector the unknown is u, so u_r = u - u_s there and sigma_s n of the cut enters the load. No element is
refined at the load, and one factorisation serves all loads.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem import flamant
from fem.errors import Fault, FemError
from fem.ring import Ring
from meshes import SectorMesh

__all__ = ["FlankPoints", "LineLoads", "flank_points", "line_loads"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

_GAUSS, _GAUSS_WEIGHT = np.polynomial.legendre.leggauss(5)
_GAUSS, _GAUSS_WEIGHT = 0.5 + 0.5 * _GAUSS, 0.5 * _GAUSS_WEIGHT


@dataclass(frozen=True, eq=False)
class FlankPoints:
    """Points of the finite-element flank.

    Attributes
    ----------
    rho : (n,) array
        Curvature radius of the involute there [m].
    points, inward : (n, 2) arrays
        Position [m] and unit normal into the material, of the element's edge.
    nodes, weights : (n, 3) arrays
        Nodes of the edge and values of their shape functions.
    """

    rho: Array
    points: Array
    inward: Array
    nodes: Index
    weights: Array

    def part(self, some: slice) -> FlankPoints:
        """Take some of the points."""
        return FlankPoints(
            self.rho[some], self.points[some], self.inward[some], self.nodes[some], self.weights[some]
        )

    def normal_part(self, displacement: Array) -> Array:
        """Component along the inward normal of nodal displacements (nodes, 2, ...), at every point."""
        there = np.einsum("nk,nka...->na...", self.weights, displacement[self.nodes])
        return np.asarray(np.einsum("na,na...->n...", self.inward, there))


def _edge_points(points: Array, edges: Index, t: Array) -> tuple[Array, Array, Array]:
    """Positions, derivatives by t and shape values on quadratic edges (first, last, middle)."""
    weights = np.stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)], axis=-1)
    slopes = np.stack([4 * t - 3, 4 * t - 1, 4 - 8 * t], axis=-1)
    corners = points[edges]
    return (
        np.einsum("...k,...ka->...a", weights, corners),
        np.einsum("...k,...ka->...a", slopes, corners),
        weights,
    )


def flank_points(mesh: SectorMesh, rho: Array, flank: str = "left") -> FlankPoints:
    """Points of a flank at curvature radii rho [m]; never on the top land or the fillet.

    Raises
    ------
    FemError
        When a radius lies outside the involute.
    """
    rho = np.atleast_1d(np.asarray(rho, dtype=float))
    edges, arc = mesh.facets[f"flank_{flank}"], mesh.parameters[f"flank_{flank}"]
    t = np.sqrt(2 * mesh.base_radius * arc)  # the flank's parameter is its arc length
    low, high = float(t.min()), float(t.max())
    slack = 1e-9 * high
    if not np.all((rho >= low - slack) & (rho <= high + slack)):
        raise FemError(
            Fault(
                "rho",
                f"{rho.min():g} to {rho.max():g} m",
                f"{low:g} to {high:g} m, the involute",
                "keep loads on the flank",
            )
        )
    rho = np.clip(rho, low, high)
    order = np.argsort(t.min(axis=1))
    which = order[np.clip(np.searchsorted(t.min(axis=1)[order], rho, side="right") - 1, 0, len(t) - 1)]
    place = rho**2 / (2 * mesh.base_radius)
    local = (place - arc[which, 0]) / (arc[which, 1] - arc[which, 0])
    points, along, weights = _edge_points(mesh.points, edges[which], local)
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    inward = np.stack([-along[:, 1], along[:, 0]], axis=1)  # the material is on the left hand
    return FlankPoints(rho, points, inward, edges[which], weights)


@dataclass(frozen=True, eq=False)
class LineLoads:
    """Unit line loads (1 N per metre of face, one at a time) on tooth 0 of a ring.

    Attributes
    ----------
    at : FlankPoints
        Where the loads act.
    cut_force : (cut, loads) array
        Forces that the loaded sector exerts on its cuts, polar components.
    own_inner : (inner, loads) array
        u_r of the inner unknowns with the cuts held [m per N/m].
    """

    ring: Ring
    at: FlankPoints
    cut_force: Array
    own_inner: Array

    def regular_at_load(self) -> Array:
        """u_r along the inward normal at each load itself [m per N/m]: (loads,)."""
        full = _nodal(self.ring, self._inner(0))
        own = full[self.at.nodes, :, np.arange(len(self.at.rho))[:, None]]  # (loads, 3, 2)
        regular: Array = np.einsum("lk,lka,la->l", self.at.weights, own, self.at.inward)
        return regular

    def on_tooth(self, tooth: int, where: FlankPoints) -> Array:
        """Displacement along the inward normal at points of another tooth's flank: (points, loads).

        On tooth 0 itself this is the regular part u_r, to which ``singular`` has to be added.
        """
        return where.normal_part(_nodal(self.ring, self._inner(tooth)))

    def singular(self, where: FlankPoints) -> Array:
        """u_s along the inward normal at points of tooth 0 (points, loads); zero at the loads themselves."""
        part = np.zeros((len(where.rho), len(self.at.rho)))
        for i, (load, inward) in enumerate(zip(self.at.points, self.at.inward, strict=True)):
            apart = np.any(where.points != load, axis=1)
            u = flamant.displacement(where.points[apart], load, inward, self.ring.law, self.ring.mesh.module)
            part[apart, i] = np.einsum("na,na->n", u, where.inward[apart])
        return part

    def _inner(self, tooth: int) -> Array:
        cuts = self.ring.polar @ self.ring.interfaces(self.cut_force, tooth)
        inner = -self.ring.inner_by_cut @ cuts
        return np.asarray(inner + self.own_inner if tooth == 0 else inner)


def _nodal(ring: Ring, inner: Array) -> Array:
    """Spread inner unknowns over (nodes, 2, ...); cuts and hub stay zero, no flank touches them."""
    full = np.zeros((ring.mesh.unknowns, *inner.shape[1:]))
    full[ring.inner] = inner
    return full.reshape(-1, 2, *inner.shape[1:])


def line_loads(ring: Ring, at: FlankPoints) -> LineLoads:
    """Solve for unit line loads at flank points, all with the ring's factorisation."""
    mesh, loads = ring.mesh, len(at.rho)
    edges = np.concatenate([facets for name, facets in mesh.facets.items() if name != "bore"])
    force = np.empty((mesh.unknowns, loads))
    cut_nodes, hub_nodes = ring.cut[::2] // 2, ring.hub[::2] // 2
    on_cut, on_hub = np.empty((len(ring.cut), loads)), np.empty((len(ring.hub), loads))
    for i in range(loads):
        load = at.points[i], at.inward[i]
        force[:, i] = -_traction_forces(mesh.points, edges, *load)
        on_cut[:, i] = flamant.displacement(mesh.points[cut_nodes], *load, ring.law, mesh.module).ravel()
        on_hub[:, i] = flamant.displacement(mesh.points[hub_nodes], *load, ring.law, mesh.module).ravel()
    inner = force[ring.inner] + ring.K_ic @ on_cut + ring.K_ih @ on_hub
    on_cuts = force[ring.cut] + ring.K_cc @ on_cut + ring.K_ch @ on_hub - ring.inner_by_cut.T @ inner
    return LineLoads(ring, at, ring.polar.T @ on_cuts, ring.factor.solve(inner))


def _traction_forces(points: Array, edges: Index, load: Array, inward: Array) -> Array:
    """Consistent nodal forces (2 nodes,) of Flamant's tractions on the edges.

    Edges near the load are cut dyadically towards their nearest point: the tractions change over the
    distance from the load, which near the tip corner is much less than an edge.
    """
    ends = points[edges[:, :2]]
    chord = ends[:, 1] - ends[:, 0]
    length2 = np.einsum("ea,ea->e", chord, chord)
    nearest = np.clip(np.einsum("ea,ea->e", load - ends[:, 0], chord) / length2, 0.0, 1.0)
    gap2 = np.sum((ends[:, 0] + nearest[:, None] * chord - load) ** 2, axis=1)
    near = gap2 < 4 * length2
    far = np.flatnonzero(~near)
    halves = 0.5 ** np.arange(14)
    halves[-1] = 0.0
    close = np.flatnonzero(near)
    centre = nearest[close, None]
    lower = np.concatenate([centre - centre * halves, centre + (1 - centre) * halves[1:][::-1]], axis=1)
    upper = np.concatenate([lower[:, 1:], np.ones((len(close), 1))], axis=1)
    width = upper - lower
    t = (lower[..., None] + width[..., None] * _GAUSS).reshape(len(close), -1)
    w = (width[..., None] * _GAUSS_WEIGHT).reshape(len(close), -1)
    forces = np.zeros((len(points), 2))
    for some, at, weight in (
        (far, np.broadcast_to(_GAUSS, (len(far), 5)), np.broadcast_to(_GAUSS_WEIGHT, (len(far), 5))),
        (close, t, w),
    ):
        corners = np.broadcast_to(edges[some][:, None, :], (*at.shape, 3))
        place, along, values = _edge_points(points, corners, at)
        normal = np.stack([along[..., 1], -along[..., 0]], axis=-1)  # outward, times ds/dt
        pull = flamant.traction(place.reshape(-1, 2), normal.reshape(-1, 2), load, inward)
        lumps = np.einsum("eqk,eqa,eq->eka", values, pull.reshape(place.shape), weight)
        np.add.at(forces, edges[some], lumps)
    return forces.ravel()
