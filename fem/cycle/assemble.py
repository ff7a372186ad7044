"""The record of a mesh cycle, made of the contact's solution for one torque, with remarks for the reader."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np

from base import Array, Booleans, Cost, RangeWarning
from base.results import WORST
from fem.contact.cell_laws import FEW_CELLS
from fem.contact.contact_state import ContactState
from fem.contact.opposite_flanks import OppositeFlanks
from fem.cycle.events import ContactProblem
from fem.cycle.face_loads import face_loads
from fem.cycle.fit_errors import fit_error
from fem.cycle.line_edges import LoadedLines
from fem.cycle.line_loads import line_loads
from fem.cycle.model_error import LoadedContacts
from fem.cycle.result import MeshCycle
from fem.elasticity.flamant import hertz_half_width
from fem.elasticity.plane_elasticity import reduced_modulus
from fem.laws.corner_laws import CornerLaws
from fem.laws.local_law import Film
from fem.laws.mesh_setup import MeshSetup
from fem.pair.pair_compliance import PairCompliance
from fem.pair.references import held_turns

__all__ = ["cycle_of"]


def cycle_of(
    setup: MeshSetup,
    bodies: PairCompliance,
    film: Film | None,
    tolerance: float,
    corner_laws: CornerLaws,
    contact: ContactState,
    number: int,
    torque: float,
    cost: Cost,
) -> MeshCycle:
    """Put the figures of one torque of a solution together."""
    candidates, pairs = contact.candidates, len(contact.candidates.offset)
    force = torque / setup.pair.base_radii[0]
    opposite = contact.opposite
    deflection = contact.deflection(number).ravel()
    moved = contact.turn(number).ravel()
    stiffness = contact.share.stiffness[number].ravel()
    refusal = contact.refusal(number)
    bad = np.nan if refusal else 0.0
    errors = contact.contacts.errors
    by_cells = float(errors.relative[number] + errors.ends[number])
    forces = contact.share.forces[number].reshape(-1, pairs) + bad
    edge = np.tile(candidates.edge, (setup.pitches, 1))
    on_path = candidates.touchable & ~candidates.edge
    rho = contact.flank_rho(number).reshape(2, -1, pairs)
    lost = contact.lever_loss(number).reshape(2, 2, -1, pairs)
    large = [] if refusal else _large(setup, contact, number, forces, bodies.plane)
    if large:
        warnings.warn("; ".join(large), RangeWarning, stacklevel=5)
    held, supports = held_turns(bodies)
    unsettled = [] if refusal else _unbelieved(setup, bodies.error + by_cells)
    approach = contact.share.transmission_error[number]
    bearing = opposite if opposite is not None and np.any(opposite.share.forces[number] > 0.0) else None
    behind = None if bearing is None else (bearing.candidates, bearing.share.forces[number])
    on_faces = _on_faces(contact, number)
    by_fits = (
        0.0
        if refusal
        else fit_error(bodies, contact, number, on_faces, setup.moving_contact, behind is not None)
    )
    return MeshCycle(
        torque=torque,
        force=force,
        position=candidates.position,
        pair_offset=candidates.offset,
        rho1=np.tile(np.where(on_path, candidates.place, np.nan), (setup.pitches, 1)),
        edge=edge,
        flank_rho=np.where(np.tile(candidates.touchable, (setup.pitches, 1)), rho, np.nan),
        forces=forces,
        load_share=(
            contact.torques(number).reshape(-1, pairs) / abs(force) if force else np.full_like(forces, np.nan)
        )
        + bad,
        gaps=candidates.gap.reshape(-1, pairs),
        transmission_error=(-(setup.backlash + moved) if setup.back else moved) + bad,
        stiffness=stiffness + bad,
        secant_stiffness=(abs(force) / deflection if force else stiffness) + bad,
        pair_stiffness=contact.share.pair_stiffness[number].reshape(-1, pairs) + bad,
        plane=bodies.plane,
        beyond_path=setup.beyond_path,
        error=bodies.error + by_cells + by_fits,
        moving_contact=setup.moving_contact,
        strips_at_corners=setup.strips_at_corners,
        lever_loss=lost[0],
        further_lever_loss=lost[1],
        cost=cost,
        converged=bodies.converged and not refusal and not unsettled,
        message=refusal
        or "; ".join([bodies.message, *unsettled, *_remarks(setup, contact, number, forces, edge), *large]),
        pair=setup.pair,
        candidates=candidates,
        friction=float(setup.friction),
        supports=supports,
        reference=held,
        face=None if refusal else face_loads(setup, contact, number, bodies.plane),
        lines=None if refusal else line_loads(setup, contact, number, bodies.plane),
        loaded=None
        if refusal
        else LoadedLines(setup, bodies, candidates, contact.cell_forces(number), approach, force)
        if setup.helical
        else LoadedContacts(setup, bodies, candidates, on_faces, approach, force, behind),
        problem=None
        if refusal
        else ContactProblem(
            replace(setup, two_sided=bearing is not None),
            bodies,
            force,
            film,
            tolerance,
            corner_laws=corner_laws,
            scatter=errors.of(number),
            ends_scatter=errors.ends_of(number),
            ends_error=float(errors.ends[number]),
        ),
        flank="back" if setup.back else "front",
        opposite=None if bearing is None else _opposite(bearing, number),
    )


def _unbelieved(setup: MeshSetup, error: float) -> list[str]:
    """Why figures of a helical pair are not believed, as those of a compliance from as large an error on."""
    if not setup.helical or error < WORST:
        return []
    width = setup.pair.face_width / setup.pair.module
    return [
        f"the error of stiffness and deflection is {error:.0%} on a face of {width:.2g} modules; from {WORST:.0%} on "
        "no figure is believed: give a wider face, more cells, or a spur pair"
    ]


def _opposite(contact: ContactState, number: int) -> OppositeFlanks:
    """Flanks on the other side under one torque, where they bear; slopes by D, which opens their gaps."""
    candidates, forces = contact.candidates, contact.share.forces[number]
    pitches, positions, pairs = forces.shape
    rows = pitches * positions
    lost = contact.lever_loss(number).reshape(2, 2, rows, pairs)
    places = np.where(candidates.touchable, contact.flank_rho(number), np.nan)
    return OppositeFlanks(
        forces.reshape(rows, pairs),
        -contact.share.pair_stiffness[number].reshape(rows, pairs),
        places.reshape(2, rows, pairs),
        np.tile(candidates.edge, (pitches, 1)),
        candidates.teeth,
        candidates.lever,
        np.where(forces > 0.0, 0.0, contact.contacts.open[number]).reshape(rows, pairs),
        lost[0],
        lost[1],
    )


def _on_faces(contact: ContactState, number: int) -> Array:
    """Forces of whole faces at the cells' line loads (cells, ..., pairs) [N]."""
    forces = contact.contacts.forces[number]
    return np.asarray(forces.shape[-1] * np.moveaxis(forces, -1, 0))


def _large(setup: MeshSetup, contact: ContactState, number: int, forces: Array, plane: str) -> list[str]:
    """Deflections and contacts that are large for a law of the first order."""
    part = np.max(contact.share.transmission_error[number]) / setup.pair.module
    loaded = np.where(contact.candidates.edge, 0.0, forces.reshape(contact.share.forces[number].shape))
    rho1, rho2 = contact.candidates.rho
    radius = rho1 * rho2 / (rho1 + rho2)
    width = hertz_half_width(loaded / setup.pair.face_width, radius, reduced_modulus(setup.pair, plane))
    wide = np.max(width / radius)
    remarks, far = [], contact.shafts_give_way(number)
    if far > setup.options.large_shift:
        remarks.append(
            f"the shafts give way by {far:.2g} modules along the line of action; that the path of contact gets shorter "
            "by as much is left out"
        )
    if part > setup.options.large_deflection:
        remarks.append(
            f"the teeth deflect by {part:.2g} modules, where what the first order leaves out counts"
        )
    if wide > setup.options.wide_contact:
        remarks.append(
            f"the half-width of a contact is {wide:.2g} of its radius, not small as Hertz takes it"
        )
    return remarks + _short(contact.contacts.forces[number])


def _short(forces: Array) -> list[str]:
    """Contacts that are too short along the face for its cells (pitches, positions, pairs, cells)."""
    pairs = forces.sum(axis=-1)
    most = np.argmax(pairs, axis=-1)[..., None]
    bears = np.take_along_axis(np.count_nonzero(forces, axis=-1), most, axis=-1)
    least, cells = int(bears.min()), forces.shape[-1]
    if least >= FEW_CELLS or least == cells:
        return []
    return [
        f"the most loaded pair bears on {least} of {cells} cells of the face at some positions, where {FEW_CELLS} are "
        "needed to resolve how the load is spread; give more cells, or less slope and crowning"
    ]


def _remarks(
    setup: MeshSetup, contact: ContactState, number: int, forces: Array, edge: Booleans
) -> list[str]:
    """Remarks for a reader of the figures."""
    candidates, remarks = contact.candidates, []
    if np.any(forces[edge] > 0):
        sharp = [rounding.radius == 0.0 for rounding in setup.rounds]
        form = (
            "sharp corners" if all(sharp) else "rounded or sharp corners" if any(sharp) else "rounded corners"
        )
        tilted = ", tilted by the same friction as flanks" if setup.friction else " without friction"
        remarks.append(
            f"tip edges outside the path touch as {form}{tilted}; the shares that they take are uncertain by "
            "several per cent for real edges"
        )
    if setup.friction:
        remarks.append("friction changes the lever arms only, not the compliance")
    if (overlap := -1e6 * float(np.min(candidates.back_gap))) > 0.0:
        left_out = "" if setup.pair.tight else ", which is left out; give more backlash, or a tight pair"
        remarks.append(
            f"the teeth jam: without load their back flanks overlap by up to {overlap:.3g} um{left_out}"
        )
    closing = contact.closing[number] + contact.tilted(number)
    if setup.helical and (closed := 1e6 * float(np.max(closing.ravel() - candidates.back_gap))) > 0.0:
        remarks.append(
            f"the deflection exceeds the gap of the back flanks by up to {closed:.3g} um; with a helix these are not "
            "looked at: give more backlash where they would touch"
        )
    opposite = contact.opposite
    if opposite is not None and np.any(opposite.share.forces[number] > 0):
        bearing = np.any(opposite.share.forces[number] > 0, axis=-1)
        remarks.append(
            f"flanks on both sides of the teeth bear at {bearing.sum()} of {bearing.size} positions"
        )
    elif opposite is not None:
        clear = 1e6 * np.min(opposite.contacts.open[number])
        remarks.append(
            f"the backlash is less than the deflection, but back flanks stand clear by at least {clear:.3g} um"
            if clear >= 0.0
            else f"back flanks overlap by up to {-clear:.3g} um, which is left out"
        )
    return remarks
