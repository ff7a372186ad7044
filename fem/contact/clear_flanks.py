"""Flanks on the other side of the teeth that surely do not bear, found without their laws.

The gap that the loaded side alone leaves there needs the places of the contacts and X, what loads on one side of the
teeth do to the other (``fem.contact.opposite_flanks``): not how the flanks of that side yield themselves. X of the mesh
before the last refinement, known with the flanks' own compliance, is within 0.2 %; where more than `DOUBT` of all that
loads close is left open by it, no flank bears.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans
from fem.contact.loaded_flanks import FlanksInPlace, flanks_in_place
from fem.contact.opposite_flanks import OppositeShare, between
from fem.laws.local_law import Film
from fem.laws.mesh_setup import MeshSetup

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance
    from gears import LoadShare

__all__ = ["stays_clear"]

DOUBT = 0.01
"""Part of what all loads do to the other side by which that is in doubt, whatever their signs."""

ROLLED = 0.2
"""Part of X by which a module of roll changes it; 0.16 at most with a pinion of POM."""


def stays_clear(
    given: MeshSetup,
    bodies: PairCompliance,
    force: Array,
    film: Film | None,
    flanks: FlanksInPlace,
    alone: LoadShare,
    apart: Booleans,
    reach: float,
) -> OppositeShare | None:
    """Gaps that are left on the other side at least, where nothing bears there under any torque; else None.

    Parameters
    ----------
    given, bodies, force, film, flanks, apart, reach
        As for ``share_with_opposite``.
    alone : LoadShare
        Solution without the other side.
    """
    other = flanks_in_place(given.opposite, film, reach)
    touch = flanks.where.gap.min(axis=-1, keepdims=True)
    behind = _less_film(given.pair.backlash + other.where.gap + touch, other)
    if np.any(_less_film(flanks.where.gap - touch, flanks).min(axis=-1) + behind.min(axis=-1) < 0.0):
        return None  # both sides are pressed without a torque
    matrix = np.swapaxes(between(given, bodies, flanks, other, before=True), 1, 2)
    moved, sizes = ((part @ alone.forces[..., None])[..., 0] for part in (matrix, np.abs(matrix)))
    doubt = np.full(sizes.shape, DOUBT)
    if given.moving_contact:  # both sides roll on, by D and by D + j
        turn = alone.transmission_error + max(given.pair.backlash, 0.0)
        doubt += (ROLLED / given.pair.module * turn)[..., None]
    left = behind + alone.transmission_error[..., None] + moved - doubt * sizes
    if not np.all((left > 0.0) | apart[:, None, None, None]):
        return None
    nothing, edges = np.zeros_like(left), np.zeros(int(other.where.edge.sum()))
    closing = bodies.turning * force[:, None, None] - alone.transmission_error - touch[..., 0]
    return OppositeShare(
        other.where,
        other.kappa,
        other.levers,
        edges,
        nothing,
        nothing,
        left,
        np.zeros(touch.shape[:-1]),
        given.face is not None,
        (closing - given.pair.backlash).max(axis=(1, 2)),
    )


def _less_film(gap: Array, flanks: FlanksInPlace) -> Array:
    return gap if flanks.oil is None else gap - flanks.oil.approach(np.zeros_like(gap))
