"""Loaded tooth contact over base pitches: load share, approach, secant and tangent stiffness."""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fem.bodies import Compliance
from fem.compliance import compliance as _compliance
from fem.cost import Cost
from fem.cycle import MeshCycle
from fem.errors import Fault
from fem.local_law import Film
from fem.meshing import Meshing
from fem.setting import Deviations, Setting, setting
from fem.sharing import Solution, solve

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["MeshCycle", "mesh_cycle", "torque_sweep"]

Array = NDArray[np.float64]

MOST_FRICTION = 0.5


def mesh_cycle(
    pair: GearPair,
    torque: float,
    positions: int = 40,
    compliance: Compliance | None = None,
    beyond_path: bool = True,
    film: Film | None = None,
    tolerance: float = 0.001,
    plane: str = "strain",
    *,
    deviations: Deviations | None = None,
    pitches: int = 1,
    first_teeth: tuple[int, int] = (0, 0),
    tip_rounding: float | tuple[float, float] = 0.0,
    friction: float = 0.0,
) -> MeshCycle:
    """Share the load among all pairs at midpoints of equal intervals of base pitches, from A.

    For every loaded pair D = sum_j bulk_ij F_j + Hertz(F_i) - s_i(F_i) + gap_i, with sum F_i = torque/r_b1.

    Parameters
    ----------
    pair : gears.GearPair
    torque : float
        Of the pinion [N m], > 0.
    positions : int
        Intervals of a base pitch.
    compliance : Compliance, optional
        Of this pair; computed to ``tolerance`` in ``plane`` unless given.
    beyond_path : bool
        Whether tip edges may touch outside A..E (``fem.tip_contact``); they do under usual loads.
    film : Film, optional
        What the oil props the flanks apart, in series with each pair before the load is shared.
    tolerance, plane
        As for ``fem.compliance``.
    deviations : (gears.GearDeviations or None, gears.GearDeviations or None), optional
        Profile and pitch deviations of pinion and wheel, on top of tip relief.
    pitches : int
        Base pitches, one after another: the pinion's teeth for its revolution, the least common multiple of
        both numbers of teeth until all repeats. Without pitch deviations every pitch is the same.
    first_teeth : (int, int)
        Numbers of the teeth of pinion and wheel that meet at A first.
    tip_rounding : float or (float, float)
        Radius of the tip edges, of both gears or of each [m]; tangent to the flank, so the path is a little
        shorter. 0 is sharp.
    friction : float
        Coefficient of friction mu, 0 to 0.5. The pinion drives: before C (approach) its flank is the slower
        one and the friction on it points towards its root, after C (recess) towards its tip, so
        sum F_i (lever_i + mu sign(u1 - u2) arm_i) = torque. Only these lever arms are changed: that teeth
        also yield to the tangential forces is left out, up to 0.35 mu of a pair's deflection at A and E,
        nothing at C.

    Returns
    -------
    MeshCycle

    Raises
    ------
    FemError
        Input that makes no sense, or the compliance of another pair.
    """
    return torque_sweep(
        pair,
        (torque,),
        positions,
        compliance,
        beyond_path,
        film,
        tolerance,
        plane,
        deviations=deviations,
        pitches=pitches,
        first_teeth=first_teeth,
        tip_rounding=tip_rounding,
        friction=friction,
    )[0]


def torque_sweep(
    pair: GearPair,
    torques: ArrayLike,
    positions: int = 40,
    compliance: Compliance | None = None,
    beyond_path: bool = True,
    film: Film | None = None,
    tolerance: float = 0.001,
    plane: str = "strain",
    *,
    deviations: Deviations | None = None,
    pitches: int = 1,
    first_teeth: tuple[int, int] = (0, 0),
    tip_rounding: float | tuple[float, float] = 0.0,
    friction: float = 0.0,
) -> tuple[MeshCycle, ...]:
    """Mesh cycles at several torques; all that does not depend on the torque is computed once.

    Parameters
    ----------
    torques : (k,) array
        Of the pinion [N m], > 0, in any order; all other parameters as for ``mesh_cycle``.

    Returns
    -------
    tuple of MeshCycle
        One for each torque; ``cost`` is that of the whole sweep.

    Raises
    ------
    FemError
        Input that makes no sense, or the compliance of another pair.
    """
    wanted = np.atleast_1d(np.asarray(torques, dtype=float)).ravel()
    given = setting(
        pair,
        positions,
        pitches,
        first_teeth,
        beyond_path,
        tip_rounding,
        deviations,
        _faults(pair, wanted, compliance, friction),
    )
    began = perf_counter()
    bodies = compliance if compliance is not None else _compliance(pair, tolerance, plane)
    ready = perf_counter()
    contact = solve(given, bodies, wanted / pair.base_radii[0], film, friction)
    cost = Cost(
        perf_counter() - began,
        bodies.cost.unknowns,
        contact.share.iterations,
        bodies.cost.annulus_unknowns,
        {**({} if compliance is not None else bodies.cost.parts), "contact": perf_counter() - ready},
    )
    return tuple(_result(given, bodies, contact, k, float(t), friction, cost) for k, t in enumerate(wanted))


def _faults(
    pair: GearPair, torques: Array, compliance: Compliance | None, friction: float
) -> Sequence[Fault]:
    faults = []
    if not torques.size:
        faults.append(Fault("torques", "none", "at least one", "give torques in N m"))
    faults += [
        Fault("torque", f"{torque!r}", "finite and > 0 (N m)", "the pinion drives; give its torque")
        for torque in torques.tolist()
        if not (np.isfinite(torque) and torque > 0)
    ]
    if compliance is not None and compliance.pair != pair:
        faults.append(Fault("compliance", "of another pair", "of this pair", "compute it anew"))
    if not (np.isfinite(friction) and 0 <= friction <= MOST_FRICTION):
        allowed = f"0 to {MOST_FRICTION}"
        faults.append(Fault("friction", f"{friction!r}", allowed, "dry steel has about 0.2, oiled 0.05"))
    return faults


def _result(
    given: Setting,
    bodies: Compliance,
    contact: Solution,
    number: int,
    torque: float,
    friction: float,
    cost: Cost,
) -> MeshCycle:
    where, pairs = contact.where, len(contact.where.offset)
    force = torque / given.pair.base_radii[0]
    turned = contact.share.forces[number]  # kappa F
    deflection = contact.share.approach[number].ravel()
    touch = where.gap.min(axis=-1).ravel()
    closing = contact.closing[number].ravel()
    refusal = _refusal(contact, turned, closing + touch)
    bad = np.nan if refusal else 0.0
    forces = (turned / contact.kappa).reshape(-1, pairs) + bad
    edge = np.tile(where.edge, (given.pitches, 1))
    on_path = where.touchable & ~where.edge
    rho = np.where(where.touchable, where.rho, np.nan)
    return MeshCycle(
        torque=torque,
        force=force,
        position=where.position,
        pair_offset=where.offset,
        rho1=np.tile(np.where(on_path, where.rho[0], np.nan), (given.pitches, 1)),
        edge=edge,
        flank_rho=np.tile(rho, (1, given.pitches, 1)),
        forces=forces,
        load_share=(turned * contact.levers).reshape(-1, pairs) / force + bad,
        gaps=where.gap.reshape(-1, pairs),
        approach=deflection + touch + bad,
        stiffness=contact.share.tangent[number].ravel() + bad,
        secant_stiffness=force / deflection + bad,
        plane=bodies.plane,
        beyond_path=given.beyond_path,
        error=bodies.error,
        cost=cost,
        converged=bodies.converged and not refusal,
        message=refusal
        or "; ".join([bodies.message, *_remarks(given, where, forces, edge, closing, friction)]),
        pair=given.pair,
        meshing=where,
        friction=float(friction),
    )


def _refusal(contact: Solution, turned: Array, closing: Array) -> str:
    """Why a solution is not to be believed, empty if it is."""
    edge = contact.where.edge
    if edge.any() and np.any(turned[..., edge] > contact.largest):
        return "a tip edge presses over more than the strips cover; reduce the torque"
    if np.max(closing) > contact.where.reach_gap:
        return (
            "the approach closes gaps more than a base pitch outside the path, where no contact was looked for; "
            "reduce the torque or the deviations"
        )
    if np.any(turned[..., contact.where.chamfered] > 0):
        return "a chamfer's face touches before its corner does, for which there is no law; reduce the torque"
    return ""


def _remarks(
    given: Setting,
    where: Meshing,
    forces: Array,
    edge: NDArray[np.bool_],
    closing: Array,
    friction: float,
) -> list[str]:
    """What a reader of the figures should know."""
    remarks = []
    if np.any(forces[edge] > 0):
        sharp = [one.radius == 0.0 for one in given.rounds]
        form = (
            "sharp corners" if all(sharp) else "rounded or sharp corners" if any(sharp) else "rounded corners"
        )
        remarks.append(
            f"tip edges outside the path touch as {form} without friction; the shares that they take are "
            "uncertain by several per cent for real edges"
            if not friction
            else f"tip edges outside the path touch as {form}, tilted by the same friction as flanks; the shares "
            "that they take are uncertain by several per cent for real edges"
        )
    if friction:
        remarks.append("friction changes the lever arms only, not the flexibility")
    if np.min(where.back_gap) < 0:
        remarks.append("the teeth jam: their back flanks overlap by the deviations; give more backlash")
    elif np.min(where.back_gap - closing) < 0:
        remarks.append(
            "the backlash is less than the deflection, so back flanks might touch, which is left out"
        )
    return remarks
