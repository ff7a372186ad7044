"""Errors of a mesh cycle by fits along flanks beside their own compliance: of their motion and of back flanks."""

from __future__ import annotations

import numpy as np

from base import Array
from fem.contact.contact_state import ContactState
from fem.contact.moving_contact import contact_moves
from fem.influence.flank_motion import FIT, WIDTH
from fem.pair.pair_compliance import PairCompliance

__all__ = ["doubts", "fit_error"]


def fit_error(
    bodies: PairCompliance, contact: ContactState, number: int, force: Array, moving: bool, behind: bool
) -> float:
    """Relative error of deflection and stiffness under one torque by those fits, largest over the positions.

    Parameters
    ----------
    bodies : PairCompliance
    contact : ContactState
    number : int
        Of the torque.
    force : (cells, ..., pairs) array
        Of whole faces at the line loads of the cells [N].
    moving, behind : bool
        Whether contacts move, and whether flanks on the other side bear.
    """
    error = _of_motion(bodies, contact, number, force) if moving else 0.0
    return error + (bodies.back_error if behind else 0.0)


def doubts(moving: bool, behind: bool) -> tuple[str, ...]:
    """What fits leave doubtful where contacts move, and where flanks on the other side bear."""
    return (FIT, WIDTH) if moving else (FIT,) if behind else ()


def _of_motion(bodies: PairCompliance, contact: ContactState, number: int, force: Array) -> float:
    """By third-order energies: Delta U'(F) over D, or Delta U''(F) over what the mesh yields more under more load."""
    known = contact_moves(bodies, contact.candidates).thrust(force)
    thrust, slope = np.zeros_like(force), np.zeros_like(force)
    for doubt in doubts(True, False):
        changed = contact_moves(bodies.doubtful(doubt), contact.candidates).thrust(force)
        thrust, slope = thrust + np.abs(changed[0] - known[0]), slope + np.abs(changed[1] - known[1])
    part, share = force / force.sum(axis=(0, -1), keepdims=True), contact.share
    deflection = np.sum(part * thrust, axis=(0, -1)) / share.transmission_error[number]
    yielding = len(force) * np.sum(part**2 * slope, axis=(0, -1)) * share.stiffness[number]
    return float(np.max(np.maximum(np.abs(deflection), yielding)))
