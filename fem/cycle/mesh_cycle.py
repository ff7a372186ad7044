"""Loaded tooth contact over base pitches: load share, transmission error, secant and tangent stiffness."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Cost, Faults, Limit, Stopwatch, shorten
from fem.contact.contact_state import ContactState
from fem.contact.moving_contact import contacts_move
from fem.contact.solver import solve_contact
from fem.cycle.assemble import cycle_of
from fem.cycle.result import MeshCycle
from fem.cycle.several_torques import one_or_several
from fem.laws.contact_candidates import contact_candidates
from fem.laws.corner_laws import CornerLaws, laws_of_corners
from fem.laws.local_law import Film
from fem.laws.mesh_setup import MeshSetup
from fem.pair.compliance import compliance as _compliance
from fem.pair.face_setting import EVEN, FREE_ENDS, face_setting
from fem.pair.options import USUAL_OPTIONS, Options
from fem.pair.pair_compliance import PairCompliance
from fem.pair.references import REFERENCES, default_reference

if TYPE_CHECKING:
    from fem.laws.flank_forms import Deviations
    from gears import Alignment, GearPair, Shaft

__all__ = ["MeshCycle", "mesh_cycle"]

TORQUE = Limit(unit="N m", remedy="give the pinion's torque, more than 0 where it drives")


@one_or_several
def mesh_cycle(
    pair: GearPair,
    torque: Array,
    positions: int = 40,
    compliance: PairCompliance | None = None,
    beyond_path: bool | None = None,
    film: Film | None = None,
    tolerance: float = 0.001,
    plane: str = "strain",
    *,
    deviations: Deviations | None = None,
    pitches: int = 1,
    first_teeth: tuple[int, int] = (0, 0),
    tip_rounding: float | tuple[float, float] = 0.0,
    friction: float = 0.0,
    reference: str | None = None,
    moving_contact: bool | None = None,
    base_pitch_difference: float = 0.0,
    alignment: Alignment | None = None,
    cells: int | None = None,
    face_model: str = FREE_ENDS,
    shafts: tuple[Shaft | None, Shaft | None] | None = None,
    shafts_held_under: float | None = None,
    options: Options = USUAL_OPTIONS,
) -> tuple[MeshCycle, ...]:
    """Share the load among all pairs at midpoints of equal intervals of base pitches, from A.

    For every loaded pair D = sum_j bulk_ij F_j + Hertz(F_i) - s_i(F_i) + gap_i, with sum F_i = torque/r_b1. Where the
    deflection is more than the gap of the flanks on the other side, these are looked at, and both sides bear where
    they touch (``fem.contact.opposite_flanks``). Of a pair that is not tight, overlap by deviations alone is left out.

    Parameters
    ----------
    pair : gears.GearPair
    torque : float or sequence of float
        Of the pinion [N m], negative where the wheel drives and back flanks bear. 0 has an answer only where the teeth
        are pressed together without it. A sequence, in any order, gives a tuple of cycles; all that does not depend on
        the torque is computed once.
    positions : int
        Intervals of a base pitch.
    compliance : PairCompliance, optional
        Of this pair; computed to ``tolerance`` in ``plane`` unless given.
    beyond_path : bool or None
        Whether tip edges may touch outside A..E (``fem.laws.tip_contact``); they do under usual loads. None lets
        those of spur pairs; lines of contact of helical pairs are held to the path.
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
    reference : {"body", "bore", "teeth"}, optional
        What D is measured against: the rotation of the bodies weighted by their inertia (what motion needs, and the
        default), of what holds the bores, or of the root circles (what closed forms describe). No force depends on it
        (``MeshCycle.against``). A compliance that leaves hubs or coupling out measures its own way at "bore" and
        where nothing is given.
    moving_contact : bool or None
        Whether contacts on the path move under load (``fem.contact.moving_contact``), to the first order in the
        deflection over the module; a position is then that of the wheel, and the pinion takes up D. Otherwise
        contacts stay where undeformed teeth touch. None decides by the softer material: plastics move, metals stay
        (``contacts_move``). ``model_error`` holds what either leaves out.
    base_pitch_difference : float
        Base pitch of the pinion less that of the wheel, such as by unequal temperatures [m]; both have the pair's but
        for that (``gears.warm_pair``).
    alignment : gears.Alignment, optional
        How the axes are out of parallel without load. Where it is given, or a lead, cells or shafts, loads are shared
        over the face (``cycle.face``).
    cells : int, optional
        Equal cells of the face, even, 4 to 512; 64 unless given.
    face_model : {"free-ends", "walls", "slices"}
        What couples the cells: bodies with free ends or between frictionless walls. Slices know of each other by their
        approach alone; they are there to compare with, for they bear too evenly, by 7 to 13 % of the face-load factor.
    shafts : (gears.Shaft or None, gears.Shaft or None), optional
        Shafts of pinion and wheel, left ends at the same side: they bend and twist under the loads on the cells, and
        open the flanks by as much (``gears.pair.shaft_face``). The transmission error counts it, stiffness is that of
        the mesh on shafts that are held where the load has brought them (``fem.pair.face_shafts``).
    shafts_held_under : float, optional
        Torque that has brought the shafts where they are held under all others, at each position [N m]: the
        transmission error then counts the give of the shafts under this torque alone, and its slope by the force is the
        stiffness. Every torque bends the shafts unless it is given.
    options : fem.Options
        Numerical settings: arcs, thresholds of warnings, and the mesh unless a compliance is given.

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
        Deflections above 0.03 modules, half-widths above 0.07 of the radius of relative curvature (`fem.Options`).

    Examples
    --------
    >>> from fem import compliance, mesh_cycle
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> cycle = mesh_cycle(pair, torque=600.0, compliance=compliance(pair, tolerance=0.05))
    >>> round(cycle.mean_stiffness / 40e-3 / 1e9, 1)  # N/(mm um)
    24.3
    """
    tip_edges = bool(pair.helix_angle == 0.0) if beyond_path is None else beyond_path
    setup = MeshSetup(
        pair,
        positions,
        tip_edges,
        deviations,
        pitches,
        first_teeth,
        tip_rounding,
        friction,
        moving_contact=contacts_move(pair, moving_contact),
        base_pitch_difference=base_pitch_difference,
        face=face_setting(pair, alignment, cells, face_model, shafts) or EVEN,
        options=options,
    )
    _check(setup, torque, compliance, film, reference, plane, shafts_held_under)
    if shafts_held_under is not None:
        held = replace(setup.face, held_under=abs(shafts_held_under) / pair.base_radii[0])
        setup = replace(setup, face=held)
    watch = Stopwatch()
    bodies = (
        compliance
        if compliance is not None
        else _compliance(pair, tolerance, plane, tip_edges=tip_edges, options=options)
    )
    ready = watch.seconds
    corner_laws = laws_of_corners(setup, bodies)
    solutions: dict[int, tuple[MeshSetup, ContactState, int]] = {}
    for back, chosen in ((False, torque > 0.0), (True, torque < 0.0), (False, torque == 0.0)):
        numbers = np.flatnonzero(chosen)
        if numbers.size:
            asked = np.abs(torque[numbers]) / pair.base_radii[0]
            side = replace(setup, back=back)
            for contact, which in _solved(side, bodies, asked, film, corner_laws):
                solutions.update({int(numbers[k]): (side, contact, n) for n, k in enumerate(which)})
    before = Cost(0.0) if compliance is not None else bodies.cost
    cost = Cost(
        watch.seconds,
        bodies.cost.unknowns,
        max(contact.share.iterations for _, contact, _ in solutions.values()),
        parts={**before.parts, "contact": watch.seconds - ready},
        counts=bodies.cost.counts,
    )
    cycles = tuple(
        cycle_of(side, bodies, film, tolerance, corner_laws, contact, number, float(torque[k]), cost)
        for k, (side, contact, number) in sorted(solutions.items())
    )
    named = reference or default_reference(bodies)
    if named == "bore":
        return cycles
    # arcs are solved for against what is asked for, not taken from others
    return tuple(replace(cycle.against(named), origin=None) for cycle in cycles)


def _solved(
    setup: MeshSetup, bodies: PairCompliance, force: Array, film: Film | None, corner_laws: CornerLaws
) -> list[tuple[ContactState, list[int]]]:
    """Solutions for forces (torques,) [N], each with separate numbers: one by one where one does not settle."""
    contact, numbers = solve_contact(setup, bodies, force, film, corner_laws), list(range(len(force)))
    if contact.settled or len(numbers) == 1:
        return [(contact, numbers)]
    return [(solve_contact(setup, bodies, force[n : n + 1], film, corner_laws), [n]) for n in numbers]


def _check(
    setup: MeshSetup,
    torque: Array,
    compliance: PairCompliance | None,
    film: Film | None,
    reference: str | None,
    plane: str,
    held_under: float | None,
) -> None:
    faults = Faults()
    ready = faults.instance("compliance", compliance, PairCompliance, "as of fem.compliance", optional=True)
    known = compliance if ready else None
    if setup.face is not EVEN and (plane if known is None else known.plane) != "strain":
        faults.add("plane", plane, 'must be "strain" where the face has cells', "leave plane out")
    if setup.helical and known is not None and known.left_out:
        allowed = "must be whole with a helix"
        faults.add(
            "compliance", f"without {', '.join(sorted(known.left_out))}", allowed, "take the whole compliance"
        )
    if setup.helical and np.any(torque == 0.0):
        allowed = (
            "must not be 0 with a helix: only teeth that are pressed together have an answer without a torque"
        )
        faults.add("torque", "0", allowed, "give the pinion's torque")
    if reference is not None:
        faults.choice("reference", reference, REFERENCES)
    if not torque.size:
        faults.add("torque", "none", "must be at least one", "give torques in N m")
    for moment in torque.tolist():
        faults.number("torque", moment, TORQUE)
    if known is not None and known.pair != setup.pair:
        faults.add("compliance", "of another pair", "must be of this pair", "compute it anew")
    faults.number("base_pitch_difference", setup.base_pitch_difference, Limit(unit="m", remedy="give metres"))
    if film is not None and not callable(film):
        faults.add("film", shorten(film), "must be a function of places and forces", "see fem.Film")
    setup.check(faults)
    if held_under is not None:
        _check_held(faults, setup, torque, faults.number("shafts_held_under", held_under, TORQUE))
    faults.raise_if_any()
    if np.any(torque == 0.0):  # needs a setting without faults
        play = float(np.max(contact_candidates(setup).back_gap))
        if play >= 0.0:
            allowed = f"must not be 0 where no flank bears: there is backlash of {1e6 * play:.4g} um at some positions"
            remedy = "leave it out, or give less backlash; unloaded_transmission_error is that of rigid gears"
            faults.add("torque", "0", allowed, remedy)
    faults.raise_if_any()


def _check_held(faults: Faults, setup: MeshSetup, torque: Array, held_under: float) -> None:
    """Note a torque that no shaft is bent by, or that bends it under other flanks than the torques load."""
    value = f"{held_under:g} N m"
    if not setup.face.on_shafts:
        faults.add("shafts_held_under", value, "requires shafts", "give shafts, or leave it out")
    elif held_under == 0.0 or np.any(torque * held_under <= 0.0):
        allowed = "must be of the sign of every torque, so that it loads the same flanks"
        faults.add("shafts_held_under", value, allowed, "give the mean torque")
