"""Loaded tooth contact over base pitches: load share, transmission error, secant and tangent stiffness."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import wraps
from typing import TYPE_CHECKING, Concatenate, ParamSpec, Protocol, overload

import numpy as np

from base import Array, Booleans, Cost, Faults, Limit, RangeWarning, Stopwatch
from fem.bodies import Compliance
from fem.contact_candidates import contact_candidates
from fem.cycle import MeshCycle
from fem.edge_tables import EdgeTables
from fem.elasticity import reduced_modulus
from fem.events import ContactProblem
from fem.face_loads import FaceLoads, face_load_factors
from fem.face_setting import FREE_ENDS, WALLS, face_setting
from fem.flamant import hertz_half_width
from fem.local_law import Film
from fem.model_error import LoadedContacts
from fem.pair_compliance import compliance as _compliance
from fem.references import REFERENCES, held_turns
from fem.setting import Deviations, Setting
from fem.sharing import Solution, solve

if TYPE_CHECKING:
    from gears import Alignment, GearPair

__all__ = ["MeshCycle", "mesh_cycle"]

TORQUE = Limit(unit="N m", remedy="give the pinion's torque, more than 0 where it drives")

LARGE_DEFLECTION = 0.03
"""Part of the module above which a deflection is told."""

WIDE_CONTACT = 0.07
"""Part of the radius of relative curvature above which a contact's half-width is told."""

ENDS_ERROR = 0.1
"""Part of what free ends do that their coarse section leaves uncertain."""

Options = ParamSpec("Options")


class _OneOrSeveral(Protocol[Options]):
    """A function of a torque that gives one cycle, of several torques that gives as many."""

    @overload
    def __call__(
        self, pair: GearPair, torque: float, *args: Options.args, **kwargs: Options.kwargs
    ) -> MeshCycle: ...

    @overload
    def __call__(
        self, pair: GearPair, torque: Sequence[float] | Array, *args: Options.args, **kwargs: Options.kwargs
    ) -> tuple[MeshCycle, ...]: ...


def _one_or_several(
    sweep: Callable[Concatenate[GearPair, Array, Options], tuple[MeshCycle, ...]],
) -> _OneOrSeveral[Options]:
    """Let a function of an array of torques take a single torque too, for which it returns a single cycle."""

    @wraps(sweep)
    def either(
        pair: GearPair, torque: float | Sequence[float] | Array, *args: Options.args, **kwargs: Options.kwargs
    ) -> MeshCycle | tuple[MeshCycle, ...]:
        cycles = sweep(pair, np.atleast_1d(np.asarray(torque, dtype=float)).ravel(), *args, **kwargs)
        return cycles if np.ndim(torque) else cycles[0]

    return either  # type: ignore[return-value]


@_one_or_several
def mesh_cycle(
    pair: GearPair,
    torque: Array,
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
    reference: str = "bore",
    moving_contact: bool = False,
    base_pitch_difference: float = 0.0,
    alignment: Alignment | None = None,
    cells: int | None = None,
    face_model: str = FREE_ENDS,
) -> tuple[MeshCycle, ...]:
    """Share the load among all pairs at midpoints of equal intervals of base pitches, from A.

    For every loaded pair D = sum_j bulk_ij F_j + Hertz(F_i) - s_i(F_i) + gap_i, with sum F_i = torque/r_b1. Where the
    deflection is more than the gap of the flanks on the other side, these are looked at, and both sides bear where
    they touch (``fem.opposite_flanks``). Of a pair that is not tight, overlap by deviations alone is left out.

    Parameters
    ----------
    pair : gears.GearPair
    torque : float or sequence of float
        Of the pinion [N m], negative where the wheel drives and back flanks bear. 0 has an answer only where the teeth
        are pressed together without it. A sequence, in any order, gives a tuple of cycles; all that does not depend on
        the torque is computed once.
    positions : int
        Intervals of a base pitch.
    compliance : Compliance, optional
        Of this pair; computed to ``tolerance`` in ``plane`` unless given.
    beyond_path : bool
        Whether tip edges may touch outside A..E (``fem.tip_contact``); they do under usual loads.
    film : Film, optional
        Separation of the flanks by the oil, in series with each pair before the load is shared.
    tolerance, plane
        As for `compliance`.
    deviations : (gears.GearDeviations or None, gears.GearDeviations or None), optional
        Profile and pitch deviations of pinion and wheel, and their wear, on top of tip relief.
    pitches : int
        Base pitches, one after another: the pinion's teeth for its revolution, the least common multiple of
        both numbers of teeth until all repeats. Without deviations of single teeth every pitch is the same.
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
    reference : {"bore", "body", "teeth"}
        What D is measured against: the turn of what holds the bores, of the bodies weighted by their inertia
        (what motion needs), or of the root circles (what closed forms describe). No force depends on it
        (``MeshCycle.against``). A compliance that leaves parts out measures its own way at "bore".
    moving_contact : bool
        Whether contacts on the path move under load (``fem.moving_contact``), to the first order in the
        deflection over the module; a position is then that of the wheel, and the pinion takes up D. Otherwise
        contacts stay where undeformed teeth touch. ``model_error`` holds what either leaves out.
    base_pitch_difference : float
        Base pitch of the pinion less that of the wheel, such as by unequal temperatures [m]; both have the pair's but
        for that (``gears.warm_pair``).

    Returns
    -------
    MeshCycle or tuple of MeshCycle
        One for each torque of a sequence; ``cost`` is that of all of them together.

    Raises
    ------
    base.InputError
        Input that makes no sense, or the compliance of another pair.

    Warns
    -----
    base.RangeWarning
        Deflections above 0.03 modules, half-widths above 0.07 of the radius of relative curvature.

    Examples
    --------
    >>> from fem import compliance, mesh_cycle
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> cycle = mesh_cycle(pair, torque=600.0, compliance=compliance(pair, tolerance=0.05))
    >>> round(cycle.mean_stiffness / 40e-3 / 1e9, 1)  # N/(mm um)
    21.4
    """
    given = Setting(
        pair,
        positions,
        beyond_path,
        deviations,
        pitches,
        first_teeth,
        tip_rounding,
        friction,
        moving_contact=moving_contact,
        base_pitch_difference=base_pitch_difference,
        face=face_setting(pair, alignment, cells, face_model),
    )
    _check(given, torque, compliance, reference, film, plane)
    watch = Stopwatch()
    bodies = (
        compliance if compliance is not None else _compliance(pair, tolerance, plane, tip_edges=beyond_path)
    )
    ready = watch.seconds
    tables = EdgeTables(given, bodies)
    found: dict[int, tuple[Setting, Solution, int]] = {}
    for back, chosen in ((False, torque > 0.0), (True, torque < 0.0), (False, torque == 0.0)):
        numbers = np.flatnonzero(chosen)
        if numbers.size:
            asked = np.abs(torque[numbers]) / pair.base_radii[0]
            for side, contact, which in _solved(replace(given, back=back), bodies, asked, film, tables):
                found.update({int(numbers[k]): (side, contact, n) for n, k in enumerate(which)})
    before = Cost(0.0) if compliance is not None else bodies.cost
    cost = Cost(
        watch.seconds,
        bodies.cost.unknowns,
        max(contact.share.iterations for _, contact, _ in found.values()),
        parts={**before.parts, "contact": watch.seconds - ready},
        counts=bodies.cost.counts,
    )
    cycles = tuple(
        _result(side, bodies, film, tolerance, tables, contact, number, float(torque[k]), cost)
        for k, (side, contact, number) in sorted(found.items())
    )
    return cycles if reference == "bore" else tuple(cycle.against(reference) for cycle in cycles)


def _solved(
    given: Setting, bodies: Compliance, force: Array, film: Film | None, tables: EdgeTables
) -> list[tuple[Setting, Solution, list[int]]]:
    """Solutions for forces (torques,) [N], each with the numbers of its own; contacts stay where both sides bear."""
    contact, every = solve(given, bodies, force, film, tables), list(range(len(force)))
    if not given.moving_contact or contact.opposite is None:
        return [(given, contact, every)]
    bears = np.any(contact.opposite.forces > 0.0, axis=(1, 2, 3))
    stay = replace(given, moving_contact=False)
    found = []
    for side, chosen in ((given, ~bears), (stay, bears)):
        if which := np.flatnonzero(chosen).tolist():
            found.append((side, solve(side, bodies, force[which], film, tables), which))
    return found


def _check(
    given: Setting,
    torque: Array,
    compliance: Compliance | None,
    reference: str,
    film: Film | None,
    plane: str,
) -> None:
    found = Faults()
    if given.face is not None:
        if film is not None:
            found.add("film", "given", "must be None where the face has cells", "leave cells and leads out")
        if (plane if compliance is None else compliance.plane) != "strain":
            found.add("plane", plane, 'must be "strain" where the face has cells', "leave plane out")
    found.choice("reference", reference, REFERENCES)
    if not torque.size:
        found.add("torque", "none", "must be at least one", "give torques in N m")
    for one in torque.tolist():
        found.number("torque", one, TORQUE)
    if compliance is not None and compliance.pair != given.pair:
        found.add("compliance", "of another pair", "must be of this pair", "compute it anew")
    if not np.isfinite(given.base_pitch_difference):
        found.add("base_pitch_difference", given.base_pitch_difference, "must be finite", "give metres")
    given.check(found)
    found.raise_if_any()
    if np.any(torque == 0.0):  # needs a setting without faults
        play = float(np.max(contact_candidates(given).back_gap))
        if play >= 0.0:
            allowed = (
                f"must not be 0 where no flank bears: there is play of {1e6 * play:.4g} um at some positions"
            )
            remedy = "leave it out, or give less backlash; unloaded_transmission_error is that of rigid gears"
            found.add("torque", "0", allowed, remedy)
    found.raise_if_any()


def _result(
    given: Setting,
    bodies: Compliance,
    film: Film | None,
    tolerance: float,
    tables: EdgeTables,
    contact: Solution,
    number: int,
    torque: float,
    cost: Cost,
) -> MeshCycle:
    where, pairs = contact.where, len(contact.where.offset)
    force = torque / given.pair.base_radii[0]
    opposite = contact.opposite
    turned = contact.share.forces[number]  # kappa F
    deflection = contact.deflection(number).ravel()
    moved = contact.share.transmission_error[number].ravel() + contact.touch.ravel()
    stiffness = contact.share.stiffness[number].ravel()
    refusal = contact.refusal(number)
    bad = np.nan if refusal else 0.0
    forces = (turned / contact.kappa).reshape(-1, pairs) + bad
    edge = np.tile(where.edge, (given.pitches, 1))
    on_path = where.touchable & ~where.edge
    rho = contact.flank_rho(given.pair, number).reshape(2, -1, pairs)
    lost = [one.reshape(2, -1, pairs) for one in contact.lever_loss(number)]
    large = [] if refusal else _large(given, contact, number, forces, bodies.plane)
    if large:
        warnings.warn("; ".join(large), RangeWarning, stacklevel=5)
    held, supports = held_turns(bodies)
    approach = contact.share.transmission_error[number]
    both = opposite is not None and bool(np.any(opposite.forces[number] > 0.0))
    return MeshCycle(
        torque=torque,
        force=force,
        position=where.position,
        pair_offset=where.offset,
        rho1=np.tile(np.where(on_path, where.place, np.nan), (given.pitches, 1)),
        edge=edge,
        flank_rho=np.where(np.tile(where.touchable, (given.pitches, 1)), rho, np.nan),
        forces=forces,
        load_share=(
            contact.torques(number).reshape(-1, pairs) / abs(force) if force else np.full_like(forces, np.nan)
        )
        + bad,
        gaps=where.gap.reshape(-1, pairs),
        transmission_error=(-(given.pair.backlash + moved) if given.back else moved) + bad,
        stiffness=stiffness + bad,
        secant_stiffness=(abs(force) / deflection if force else stiffness) + bad,
        pair_stiffness=(contact.share.pair_stiffness[number] / contact.kappa).reshape(-1, pairs) + bad,
        plane=bodies.plane,
        beyond_path=given.beyond_path,
        error=bodies.error,
        moving_contact=given.moving_contact,
        strips_at_corners=given.strips_at_corners,
        lever_loss=lost[0],
        further_lever_loss=lost[1],
        cost=cost,
        converged=bodies.converged and not refusal,
        message=refusal
        or "; ".join([bodies.message, *_remarks(given, contact, number, forces, edge), *large]),
        pair=given.pair,
        candidates=where,
        friction=float(given.friction),
        supports=supports,
        reference=held,
        face=None if refusal else _over_face(contact, number, bodies, force, film, tables),
        loaded=None
        if refusal or given.face is not None
        else LoadedContacts(given, bodies, where, turned, approach, force),
        problem=None
        if refusal
        else ContactProblem(replace(given, both=both), bodies, force, film, tolerance, tables=tables),
        flank="back" if given.back else "front",
        opposite=opposite.flanks(number) if opposite is not None and both else None,
    )


def _over_face(
    contact: Solution, number: int, bodies: Compliance, force: float, film: Film | None, tables: EdgeTables
) -> FaceLoads | None:
    """Line loads, with the error of the face-load factor by half as many cells, with free ends and without."""
    given, over = tables.given, contact.face
    if over is None or given.face is None:
        return None
    pair, cells = given.pair, given.face.cells
    forces = (over.forces[number] / contact.kappa[..., None]).reshape(-1, *over.forces.shape[-2:])
    factors = face_load_factors(forces)
    few = 2 * (cells // 4)
    greatest = []
    models = (FREE_ENDS, WALLS) if given.face.model == FREE_ENDS else (given.face.model,)
    for model in models:
        coarse = replace(given, face=replace(given.face, cells=few, model=model))
        other = solve(coarse, bodies, np.array([abs(force)]), film, tables).face
        greatest.append(np.nan if other is None else float(np.max(face_load_factors(other.forces))))
    most = float(np.max(factors))
    error = abs(most - greatest[0]) / (cells / few - 1) + ENDS_ERROR * abs(greatest[0] - greatest[-1])
    rho1, rho2 = contact.where.rho
    return FaceLoads(
        given.face.middles(pair.face_width),
        forces * cells / pair.face_width,
        factors,
        given.face,
        pair,
        bodies.plane,
        np.tile(rho1 * rho2 / (rho1 + rho2), (given.pitches, 1)),
        error / most,
    )


def _large(given: Setting, contact: Solution, number: int, forces: Array, plane: str) -> list[str]:
    """Deflections and contacts that are large for a law of the first order."""
    part = np.max(contact.share.transmission_error[number]) / given.pair.module
    loaded = np.where(contact.where.edge, 0.0, forces.reshape(contact.share.forces[number].shape))
    rho1, rho2 = contact.where.rho
    radius = rho1 * rho2 / (rho1 + rho2)
    width = hertz_half_width(loaded / given.pair.face_width, radius, reduced_modulus(given.pair, plane))
    wide = np.max(width / radius)
    found = []
    if part > LARGE_DEFLECTION:
        found.append(f"the teeth deflect by {part:.2g} modules, where what the first order leaves out counts")
    if wide > WIDE_CONTACT:
        found.append(f"the half-width of a contact is {wide:.2g} of its radius, not small as Hertz takes it")
    return found


def _remarks(given: Setting, contact: Solution, number: int, forces: Array, edge: Booleans) -> list[str]:
    """What a reader of the figures should know."""
    where, remarks = contact.where, []
    if np.any(forces[edge] > 0):
        sharp = [one.radius == 0.0 for one in given.rounds]
        form = (
            "sharp corners" if all(sharp) else "rounded or sharp corners" if any(sharp) else "rounded corners"
        )
        tilted = ", tilted by the same friction as flanks" if given.friction else " without friction"
        remarks.append(
            f"tip edges outside the path touch as {form}{tilted}; the shares that they take are uncertain by "
            "several per cent for real edges"
        )
    if given.friction:
        remarks.append("friction changes the lever arms only, not the compliance")
    if (overlap := -1e6 * float(np.min(where.back_gap))) > 0.0:
        left_out = "" if given.pair.tight else ", which is left out; give more backlash, or a tight pair"
        remarks.append(
            f"the teeth jam: without load their back flanks overlap by up to {overlap:.3g} um{left_out}"
        )
    opposite = contact.opposite
    if opposite is not None and np.any(opposite.forces[number] > 0):
        bearing = np.any(opposite.forces[number] > 0, axis=-1)
        remarks.append(
            f"flanks on both sides of the teeth bear at {bearing.sum()} of {bearing.size} positions, and contacts stay"
        )
    elif opposite is not None:
        clear = 1e6 * np.min(opposite.open[number])
        remarks.append(
            f"the backlash is less than the deflection, but back flanks stand clear by at least {clear:.3g} um"
        )
    return remarks
