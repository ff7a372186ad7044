"""Loaded tooth contact over one base pitch: load share, approach, secant and tangent stiffness."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fem.compliance import Compliance, Cost
from fem.compliance import compliance as _compliance
from fem.errors import Fault, FemError
from fem.local_law import Film, FilmLaw, PairLaws, Table
from fem.tip_contact import edge_laws, lever_ratio

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["MeshCycle", "mesh_cycle"]

Array = NDArray[np.float64]

TIP_EDGE_MODEL = (
    "tip edges outside the path touch as sharp corners without friction; the shares that they take are "
    "uncertain by several per cent for real, rounded edges"
)


@dataclass(frozen=True, eq=False)
class MeshCycle:
    """One base pitch of a loaded pair; rows are positions, columns pairs in order of growing rho1.

    Attributes
    ----------
    torque, force : float
        Of the pinion [N m], and torque over base radius [N].
    position : (n,) array
        Way from A over the base pitch, of the pair that entered last: midpoints of equal intervals.
    pair_offset : (pairs,) array of int
        Base pitches that each column is ahead of that pair.
    rho1 : (n, pairs) array
        Curvature radius on the pinion [m]; nan where there is no contact between A and E.
    edge : (n, pairs) boolean array
        Candidates outside the path, where a tip edge touches if it carries force.
    flank_rho : (2, n, pairs) array
        Curvature radii of pinion's and wheel's flank at the contact, tip edges included [m].
    forces : (n, pairs) array
        Normal forces [N]; zero where unloaded.
    load_share : (n, pairs) array
        Share of the torque; rows sum to one.
    gaps : (n, pairs) array
        Unloaded gaps along the line of action [m]; inf for pairs that cannot touch.
    approach : (n,) array
        D [m]: turn of the pinion times its base radius, hubs' turn, the wheel's hub held. Positive when the
        teeth yield.
    stiffness : (n,) array
        Tangent dF/dD [N/m]: small vibration about the load.
    secant_stiffness : (n,) array
        F/D [N/m].
    plane : str
    beyond_path : bool
    error : float
        Estimated relative numerical error of stiffness and deflection.
    cost : Cost
        Of this cycle, and of the compliance if it was computed here.
    converged : bool
    message : str
    """

    torque: float
    force: float
    position: Array
    pair_offset: NDArray[np.int64]
    rho1: Array
    edge: NDArray[np.bool_]
    flank_rho: Array
    forces: Array
    load_share: Array
    gaps: Array
    approach: Array
    stiffness: Array
    secant_stiffness: Array
    plane: str
    beyond_path: bool
    error: float
    cost: Cost
    converged: bool
    message: str

    @property
    def transmission_error(self) -> Array:
        """Loaded static transmission error, the approach D along the line of action (n,) [m].

        It contains tip relief (as gaps) and all deflection; positive when the wheel lags.
        """
        return self.approach


def mesh_cycle(
    pair: GearPair,
    torque: float,
    positions: int = 40,
    compliance: Compliance | None = None,
    beyond_path: bool = True,
    film: Film | None = None,
    tolerance: float = 0.001,
    plane: str = "strain",
) -> MeshCycle:
    """Share the load among all pairs at midpoints of equal intervals of one base pitch, from A.

    For every loaded pair D = sum_j bulk_ij F_j + Hertz(F_i) - s_i(F_i) + gap_i, with sum F_i = torque/r_b1.

    Parameters
    ----------
    pair : gears.GearPair
    torque : float
        Of the pinion [N m], > 0.
    positions : int
        Intervals of the base pitch.
    compliance : Compliance, optional
        Of this pair; computed to ``tolerance`` in ``plane`` unless given.
    beyond_path : bool
        Whether tip edges may touch outside A..E (``fem.tip_contact``); they do under usual loads.
    film : Film, optional
        What the oil props the flanks apart, in series with each pair before the load is shared.
    tolerance, plane
        As for ``fem.compliance``.

    Returns
    -------
    MeshCycle

    Raises
    ------
    FemError
        Torque or positions that make no sense, or the compliance of another pair.
    """
    from gears.load_sharing import share_load

    faults = []
    if not (np.isfinite(torque) and torque > 0):
        faults.append(
            Fault("torque", f"{torque!r}", "finite and > 0 (N m)", "the pinion drives; give its torque")
        )
    if isinstance(positions, bool) or not isinstance(positions, (int, np.integer)) or positions < 1:
        faults.append(
            Fault("positions", f"{positions!r}", "a whole number >= 1", "40 resolve the usual harmonics")
        )
    if compliance is not None and compliance.pair != pair:
        faults.append(Fault("compliance", "of another pair", "of this pair", "compute it anew"))
    if faults:
        raise FemError(*faults)
    began = perf_counter()
    bodies = compliance if compliance is not None else _compliance(pair, tolerance, plane)
    ready = perf_counter()
    force = torque / pair.base_radii[0]
    where = _candidates(pair, int(positions), beyond_path)
    rho1, rho2, edge = where.rho1.copy(), where.rho2.copy(), where.edge
    lever, gaps, table = _edge_contacts(bodies, where, rho1, rho2)
    first, second = pair.teeth_profiles
    on_path = where.touchable & ~edge
    gaps[on_path] = first.relief(rho1[on_path]) + second.relief(rho2[on_path])
    matrix = bodies.bulk(rho1, rho2)
    _leave_out_corner(bodies, matrix, where)
    matrix /= lever[..., :, None] * lever[..., None, :]
    middle = pair.points.A + 0.5 * (pair.points.E - pair.points.A)
    laws = PairLaws(bodies.hertz(np.where(on_path, rho1, middle)), edge, table)
    places = np.where(on_path, rho1, np.nan)
    share = share_load(force, matrix, laws, gaps, None if film is None else FilmLaw(film, places))
    message = bodies.message
    if np.any(share.forces[edge] > 0):
        message += "; " + TIP_EDGE_MODEL
    converged, deflection, forces = bodies.converged, share.approach, share.forces
    if table is not None and np.any(share.forces[edge] / lever[edge] > table.force[:, -1]):
        converged = False
        message = "a tip edge presses over more than the strips cover; reduce the torque"
        deflection, forces = np.full_like(deflection, np.nan), np.full_like(share.forces, np.nan)
    cost = Cost(
        perf_counter() - began,
        bodies.cost.unknowns,
        share.iterations,
        bodies.cost.annulus_unknowns,
        {**({} if compliance is not None else bodies.cost.parts), "contact": perf_counter() - ready},
    )
    return MeshCycle(
        torque=float(torque),
        force=float(force),
        position=where.position,
        pair_offset=where.offset,
        rho1=places,
        edge=edge,
        flank_rho=np.where(where.touchable, np.stack([rho1, rho2]), np.nan),
        forces=forces / lever,
        load_share=forces / force,
        gaps=gaps,
        approach=deflection,
        stiffness=np.where(np.isfinite(deflection), share.tangent, np.nan),
        secant_stiffness=force / deflection,
        plane=bodies.plane,
        beyond_path=beyond_path,
        error=bodies.error,
        cost=cost,
        converged=converged,
        message=message,
    )


@dataclass(frozen=True, eq=False)
class _Candidates:
    """Pairs that might touch: places on the line of action of the unlimited involutes."""

    position: Array
    offset: NDArray[np.int64]
    rho1: Array
    rho2: Array
    touchable: NDArray[np.bool_]
    edge: NDArray[np.bool_]

    def corners(self, start: float) -> tuple[tuple[int, NDArray[np.bool_]], ...]:
        """Which gear's tip edge touches where: the wheel's (1) before A, the pinion's (0) after E."""
        before = self.edge & (self.rho1 < start)
        return (1, before), (0, self.edge & ~before)


def _candidates(pair: GearPair, positions: int, beyond_path: bool) -> _Candidates:
    position = (np.arange(positions) + 0.5) / positions
    last = ceil(pair.contact_ratio)
    offset = np.arange(-1, last + 1) if beyond_path else np.arange(last)
    points = pair.points
    rho1 = points.A + (position[:, None] + offset) * pair.base_pitch
    outside = (rho1 < points.A) | (rho1 > points.E)
    near = np.maximum(points.A - rho1, rho1 - points.E) < 0.6 * pair.base_pitch
    edge = outside & near if beyond_path else np.zeros_like(outside)
    touchable = ~outside | edge
    centre = 0.5 * (points.A + points.E)
    # places of pairs that cannot touch are never used, but must be places
    rho1 = np.where(touchable, rho1, centre)
    return _Candidates(position, offset, rho1, pair.line_of_action - rho1, touchable, edge)


def _edge_contacts(
    bodies: Compliance, where: _Candidates, rho1: Array, rho2: Array
) -> tuple[Array, Array, Table | None]:
    """Levers, gaps and laws of tip edges; ``rho1`` and ``rho2`` are moved to where the flanks are touched.

    A force along another normal than the line of action has another lever about the pinion's axis, kappa
    r_b1. With F' = kappa F the equations keep their form: gap/kappa, bulk_ij/(kappa_i kappa_j) and
    law(F'/kappa)/kappa.
    """
    pair, points = bodies.pair, bodies.pair.points
    gaps = np.where(where.touchable, 0.0, np.inf)
    lever = np.ones_like(gaps)
    if not where.edge.any():
        return lever, gaps, None
    places: list[NDArray[np.int64]] = []
    forces: list[Array] = []
    approaches: list[Array] = []
    for corner, chosen in where.corners(points.A):
        touched = (bodies.pinion, bodies.wheel)[1 - corner].law
        law = edge_laws(pair, bodies.tips[corner], corner, where.rho1[chosen], touched)
        kappa = lever_ratio(pair, law.where, where.rho1[chosen]) if corner == 0 else np.ones(len(law.where))
        end = pair.teeth_profiles[corner].flank_rho[1]
        rho1[chosen], rho2[chosen] = (law.where, end) if corner == 1 else (end, law.where)
        lever[chosen] = kappa
        gaps[chosen] = law.approach[:, 0] / kappa
        places.append(np.flatnonzero(chosen).astype(np.int64))
        forces.append(law.force * kappa[:, None])
        approaches.append((law.approach - law.approach[:, :1]) / kappa[:, None])
    order = np.argsort(np.concatenate(places))
    force, approach = np.concatenate(forces)[order], np.concatenate(approaches)[order]
    return lever, gaps, Table.through(force, approach)


def _leave_out_corner(bodies: Compliance, matrix: Array, where: _Candidates) -> None:
    """Keep only the touched flank's flexibility: the edge's law holds its own tooth already."""
    points = bodies.pair.points
    width = bodies.pair.face_width
    for corner, chosen in where.corners(points.A):
        gear = (bodies.pinion, bodies.wheel)[corner]
        at_end = float(gear.own(np.array([gear.rho_end]))[0]) / width
        position, column = np.nonzero(chosen)
        matrix[position, column, column] -= at_end
