"""Line loads anywhere on a flank: the singular part in closed form, the regular part by finite elements.

In the loaded sector u = u_s + u_r with u_s Flamant's half-plane (``fem.elasticity.flamant``), tangent to the flank's
element edge at the load; the force may lean from the flank's normal. u_r is regular and solves the elasticity
problem with the tractions -sigma_s n on the edges and -u_s on the hub; in every other sector the unknown is u
itself. On the cuts of the loaded sector the unknown is u, so u_r = u - u_s there and sigma_s n of the cut
enters the load. Where the body's thickness steps from t to t', sigma_s n acts as on a free edge of thickness t - t'.
No element is refined at the load, and one factorisation serves all loads.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from base import Array, Fault, InputError, Integers, record
from fem.elasticity import flamant
from fem.elasticity.ring import Ring
from fem.elasticity.singular_tractions import LineForces, edge_points, nodal, traction_integrals
from meshes import SectorMesh
from meshes.sector import STEPS

__all__ = ["FlankPoints", "LineLoads", "flank_points", "joined", "line_loads"]


@record
class FlankPoints:
    """Points of the finite-element flank.

    Attributes
    ----------
    rho : (n,) array
        Curvature radius of the involute there [m].
    points, inward : (n, 2) arrays
        Position on the element's edge [m], and the involute's unit normal into the material.
    nodes, weights : (n, 3) arrays
        Nodes of the edge and values of their shape functions.
    lean : float or (n,) array
        Angle from the normal to the direction in which the points are loaded or observed [rad], anticlockwise.
    """

    rho: Array
    points: Array
    inward: Array
    nodes: Integers
    weights: Array
    lean: float | Array = 0.0

    def part(self, subset: slice) -> FlankPoints:
        """Take some of the points."""
        return replace(
            self,
            rho=self.rho[subset],
            points=self.points[subset],
            inward=self.inward[subset],
            nodes=self.nodes[subset],
            weights=self.weights[subset],
            lean=self.leans[subset],
        )

    def towards_tip(self) -> FlankPoints:
        """Return the same points in the direction of the flank's tangent towards the tip."""
        clockwise = self.inward[0, 1] * self.points[0, 0] > self.inward[0, 0] * self.points[0, 1]
        return replace(self, lean=-0.5 * np.pi if clockwise else 0.5 * np.pi)

    @property
    def leans(self) -> Array:
        """Angle of each point (n,) [rad]."""
        return np.broadcast_to(self.lean, self.rho.shape)

    @property
    def direction(self) -> Array:
        """Unit vectors along which the points are loaded or observed (n, 2): inward unless they lean."""
        return flamant.leaning(self.inward, self.lean)

    def component(self, displacement: Array) -> Array:
        """Component along ``direction`` of nodal displacements (nodes, 2, ...), at every point."""
        there = np.einsum("nk,nka...->na...", self.weights, displacement[self.nodes])
        return np.asarray(np.einsum("na,na...->n...", self.direction, there))


def flank_points(mesh: SectorMesh, rho: Array, flank: str = "left") -> FlankPoints:
    """Points of a flank at curvature radii rho [m]; never on the top land or the fillet.

    Raises
    ------
    base.InputError
        When a radius lies outside the involute.
    """
    rho = np.atleast_1d(np.asarray(rho, dtype=float))
    edges, arc = mesh.facets[f"flank_{flank}"], mesh.parameters[f"flank_{flank}"]
    t = np.sqrt(2 * mesh.base_radius * arc)  # the flank's parameter is its arc length
    low, high = float(t.min()), float(t.max())
    slack = 1e-9 * high
    if not np.all((rho >= low - slack) & (rho <= high + slack)):
        allowed = f"must be {low:g} to {high:g} m, the involute"
        span = f"{rho.min():g} to {rho.max():g} m"
        raise InputError([Fault("rho", span, allowed, "keep loads on the flank")])
    rho = np.clip(rho, low, high)
    order = np.argsort(t.min(axis=1))
    which = order[np.clip(np.searchsorted(t.min(axis=1)[order], rho, side="right") - 1, 0, len(t) - 1)]
    place = rho**2 / (2 * mesh.base_radius)
    local = (place - arc[which, 0]) / (arc[which, 1] - arc[which, 0])
    points, _, weights = edge_points(mesh.points, edges[which], local)
    # the involute's own normal touches the base circle; that of the element's edge errs by O(h^2)
    exact = mesh.curves[f"flank_{flank}"].at(place)
    hand = np.array([1.0, -1.0]) if flank == "left" else np.array([-1.0, 1.0])
    inward = mesh.base_radius * hand * exact[:, ::-1] - rho[:, None] * exact
    inward /= np.linalg.norm(inward, axis=1, keepdims=True)
    return FlankPoints(rho, points, inward, edges[which], weights)


def joined(*points: FlankPoints) -> FlankPoints:
    """Several points' lists one after the other."""
    return FlankPoints(
        *(
            np.concatenate([getattr(part, name) for part in points])
            for name in ("rho", "points", "inward", "nodes", "weights", "leans")
        )
    )


@record
class LineLoads:
    """Unit line loads (1 N per metre of face, one at a time) on tooth 0 of a ring.

    Attributes
    ----------
    at : FlankPoints
        Where the loads act.
    cut_force : (cut, loads) array
        Forces that the loaded sector exerts on its cuts, polar components.
    reduced : (unknowns, loads) array
        Forces inside the sector, as ``Condensation.down`` needs them.
    held : (loads,) array
        u_r at the load with the cuts held [m per N/m].
    """

    ring: Ring
    at: FlankPoints
    cut_force: Array
    reduced: Array
    held: Array

    @cached_property
    def own_inner(self) -> Array:
        """u_r of the inner unknowns with the cuts held (inner, loads) [m per N/m]."""
        down = self.ring.condensed.down(np.zeros_like(self.cut_force), self.reduced)
        return np.asarray(down[self.ring.inner])

    def part(self, subset: slice) -> LineLoads:
        """Some of the loads."""
        return replace(
            self,
            at=self.at.part(subset),
            cut_force=self.cut_force[:, subset],
            reduced=self.reduced[:, subset],
            held=self.held[subset],
        )

    def regular_at_load(self) -> Array:
        """u_r along each load at the load itself [m per N/m]: (loads,)."""
        return np.asarray(
            self.held + np.sum(self.cut_force * self.ring.interfaces(self.cut_force, 0), axis=0)
        )

    def on_neighbour(self, tooth: int, places: LineLoads | None = None) -> Array:
        """Displacement of loads' places on another tooth, along these loads: (points, loads).

        The places are those of the loads themselves, unless other loads of the same ring are given.
        """
        observed = self if places is None else places
        return np.asarray(observed.cut_force.T @ self.ring.interfaces(self.cut_force, tooth))

    def on_tooth(self, tooth: int, points: FlankPoints) -> Array:
        """Displacement along the points' directions on another tooth's flank: (points, loads).

        On tooth 0 itself this is the regular part u_r, to which ``singular`` has to be added.
        """
        nodes, local = np.unique(points.nodes, return_inverse=True)
        # no point of a flank is on a cut or on the hub
        asked = np.searchsorted(self.ring.inner, (2 * nodes[:, None] + np.arange(2)).ravel())
        moved = self.inner(tooth)[asked].reshape(len(nodes), 2, -1)
        return replace(points, nodes=local.reshape(points.nodes.shape)).component(moved)

    def singular(self, points: FlankPoints) -> Array:
        """u_s along the directions of points of tooth 0 (points, loads); zero at the loads themselves."""
        at, law, length = self.at, self.ring.law, self.ring.mesh.module
        there = points.points[:, None]
        apart = np.any(there != at.points, axis=2)
        there = np.where(apart[..., None], there, at.points + length * at.inward)
        u = flamant.displacement(there, at.points, at.inward, law, length, at.lean)
        return np.asarray(np.where(apart, np.sum(u * points.direction[:, None], axis=2), 0.0))

    def inner(self, tooth: int) -> Array:
        """Inner unknowns of a tooth's sector: (unknowns, loads)."""
        cuts = self.ring.polar @ self.ring.interfaces(self.cut_force, tooth)
        down = self.ring.condensed.down(cuts, self.reduced if tooth == 0 else None)
        return np.asarray(down[self.ring.inner])


def line_loads(ring: Ring, at: FlankPoints) -> LineLoads:
    """Solve for unit line loads at flank points, all with the ring's factorisation."""
    mesh, law, length = ring.mesh, ring.law, ring.mesh.module
    free, thickness = _free_edges(mesh)
    sides = np.concatenate([mesh.facets["side_right"], mesh.facets["side_left"]])
    held = np.concatenate([sides, mesh.facets["bore"]])
    thickness = np.concatenate([thickness, mesh.thickness_at(mesh.points[held[:, 2]])])
    loads = LineForces(at.points, at.inward, at.leans)
    pulls, work = traction_integrals(mesh.points, np.concatenate([free, held]), loads, law, length)
    pulls, work = pulls * thickness[:, None, None, None], work * thickness[:, None]
    on_free = nodal(free, pulls[: len(free)], len(mesh.points))
    on_sides = nodal(sides, pulls[len(free) : len(free) + len(sides)], len(mesh.points))
    bordering = np.concatenate([ring.cut, ring.hub])
    places = mesh.points[bordering[::2] // 2][:, None]
    singular = flamant.displacement(places, at.points, at.inward, law, length, at.lean)
    border = np.swapaxes(singular, 1, 2).reshape(len(bordering), -1)
    # what u_s on cuts and hub pulls at, less Flamant's tractions
    pulled = ring.by_border @ border
    force = pulled - (on_free + on_sides)
    reduced, cut_force, held = ring.condensed.up(force)
    known = work[len(free) + len(sides) :].sum(axis=0) - work[: len(free)].sum(axis=0)
    known -= np.sum(border * (force - on_free)[bordering], axis=0)
    return LineLoads(ring, at, ring.polar.T @ cut_force, reduced, held + known)


def _free_edges(mesh: SectorMesh) -> tuple[Integers, Array]:
    """Free edges (k, 3) with their thickness over the face width; a step counts with that by which it changes."""
    edges = [*mesh.free.values()]
    thickness = [np.ones(len(line)) for line in edges]
    outside = 1.0
    for name, (_, below) in zip(STEPS, mesh.steps, strict=False):
        edges.append(mesh.facets[name])
        thickness.append(np.full(len(edges[-1]), outside - below))
        outside = below
    return np.concatenate(edges), np.concatenate(thickness)
