"""The one solver of forces that share a load: Newton's method on the contacts that bear.

With the overlap r(F, D) that forces F leave at the turn D, its derivatives J = dr/dF and -dr/dD (the reach), and the
torque M(F, D) that forces carry,

    r_i = 0 of all that bear,   M = T,   F_i >= 0,   no overlap of those that do not bear:

J a = reach and J b = r give the step dF = a dD - b, with dD from the torque. Contacts that stay or move, in the plane
or on cells of the face, on one side of the teeth or both differ in r, J and M alone.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from base import Array, Booleans, quantity, record
from gears.sharing.load_coupling import Jacobian

__all__ = ["ContactForces", "Linearised", "LoadShare", "share_forces"]

ITERATIONS = 200

STEP = 1e-11
"""Change of forces, relative to their size, at which Newton's method ends."""

NEAR = 1e-7
"""Part of each force: a step so small is the last where the next will be below the bound, by its square."""

ROUNDING = 1e-14
"""Of deflections, relative to their size."""

BACKOFF = 0.1
"""Part of a force that is kept when a step would make it negative."""


@record
class LoadShare:
    """Forces of the tooth pairs at one mesh position, or at several."""

    no_error = "rounding of the iteration; that of the compliance is not known here"

    forces: Array = quantity("N", "normal forces F_i, zero where a pair does not touch", "... pair")
    transmission_error: Array = quantity(
        "m", "common approach D of the gears along the line of action", "...", shown="um"
    )
    stiffness: Array = quantity("N/m", "tangent dF/dD for the pairs in contact", "...")
    pair_stiffness: Array = quantity(
        "N/m", "slope dF_i/dD of each pair's force, zero where unloaded", "... pair"
    )
    iterations: int = quantity("1", "Newton steps")

    headline = ("transmission_error", "stiffness", "iterations")


@record
class Linearised:
    """Contacts about forces F and a turn D.

    Attributes
    ----------
    residual : (..., n) array
        Overlap that is left [m].
    reach : (..., n) array
        By how much a turn closes it; below 0 where it opens.
    further_lever_ratios : (..., n) array
        Levers of further forces, over that for which the whole is meant.
    carried : (...) array
        Torque over the base radius [N].
    own : (..., n) array
        Slopes of each force's own law [m/N]; 1 where it is zero.
    jacobian : Jacobian
        Of all else.
    stiff : (...) array or 0.0
        What a turn takes from the torque at held forces [N/m].
    """

    residual: Array
    reach: Array
    further_lever_ratios: Array
    carried: Array
    own: Array
    jacobian: Jacobian
    stiff: Array | float = 0.0


class ContactForces(Protocol):
    """Contacts whose forces are asked for, n at every position (...)."""

    @property
    def touchable(self) -> Booleans:
        """Which may bear (..., n)."""

    @property
    def start(self) -> float:
        """Part of the size of all forces with which one is taken in."""

    @property
    def apart(self) -> bool:
        """Whether positions are solved one by one, so that those that are settled are not solved again."""

    def bent(self, loads: Array, wanted: Booleans, known: Array | None) -> Array:
        """How forces (..., n) [N] bend the bodies, at positions (...) that are wanted; known at the others."""

    def linearised(self, loads: Array, approach: Array, bent: Array) -> Linearised:
        """Linearise about forces (..., n) [N] and the turn D (...) [m]."""

    def unloaded(self, loads: Array, approach: Array, bent: Array) -> Array:
        """Gaps (..., n) [m] that all other forces leave to a contact without a force."""


def share_forces(
    problem: ContactForces, whole: Array, loads: Array, approach: Array | None
) -> LoadShare | None:
    """Solve for the forces and the turn.

    A contact that would overlap is taken in with a small force. Local laws bend down, so that from too small a force
    Newton's method rises monotonically; a step that would make a force negative releases the contact only if it
    stands clear without a force, else keeps a tenth of it. One that comes back is taken in with a tenth of what it had:
    about to touch, it bears less than any start would leave it.

    Parameters
    ----------
    problem : ContactForces
    whole : (...) array
        Torque over the base radius [N].
    loads : (..., n) array
        Forces to begin with [N]; one at least is above 0 everywhere.
    approach : (...) array or None
        Turn to begin with [m]; None takes that with the smallest overlap of the contacts that bear.

    Returns
    -------
    LoadShare or None
        None where Newton's method does not settle on forces that grow with the turn.
    """
    active, everywhere = loads > 0.0, np.ones(loads.shape[:-1], dtype=bool)
    size = np.maximum(np.abs(whole), loads.max(axis=-1))
    start = np.full(loads.shape, problem.start)
    bent, wanted = problem.bent(loads, everywhere, None), everywhere
    if approach is None:
        at = problem.linearised(loads, np.zeros(loads.shape[:-1]), bent)
        asked = np.sum(at.reach * at.residual, axis=-1, where=active)
        approach = asked / np.sum(at.reach**2, axis=-1, where=active)
    slopes, before = np.zeros_like(loads), np.zeros(loads.shape[:-1])
    for iteration in range(1, ITERATIONS + 1):
        at = problem.linearised(loads, approach, bent)
        unit, response = at.jacobian.solved(at.own, at.reach, at.residual, active, wanted)
        slopes = np.where(wanted[..., None], unit, slopes)
        tangent = np.sum(at.further_lever_ratios * slopes, axis=-1) - at.stiff
        wanting = whole - at.carried + np.sum(at.further_lever_ratios * response, axis=-1)
        nowhere = np.full_like(tangent, np.nan)  # forces that no turn changes
        lift = np.where(wanted, np.divide(wanting, tangent, out=nowhere, where=tangent != 0.0), 0.0)
        deflection = np.abs(at.residual + at.reach * approach[..., None])
        approach = approach + lift
        if not np.all(np.isfinite(approach)):
            return None
        moved = np.where(active, loads + (unit * lift[..., None] - response), 0.0)
        negative = active & (moved <= 0.0)
        kept = np.where(negative, 0.0, moved)
        bent = problem.bent(kept, wanted, bent)
        unloaded = problem.unloaded(kept, approach, bent)
        length = deflection.max(where=active, initial=0.0, axis=-1) + np.abs(approach)
        released = negative & (unloaded >= 0.0)
        taken = problem.touchable & ~active & (unloaded < -ROUNDING * length[..., None])
        steps, least = np.abs(moved - loads), STEP * size + ROUNDING * length * tangent
        step = steps.max(axis=-1)
        # the next step falls at least as this one did, in truth by the square of that
        near = np.all(steps <= NEAR * np.abs(moved), axis=-1)
        settled = (step <= least) | (near & (step**2 <= least * before))
        loads = np.where(negative & ~released, BACKOFF * loads, kept)
        loads = np.where(taken, start * size[..., None], loads)
        start = np.where(taken, BACKOFF * start, start)
        active = (active & ~released) | taken
        changed = np.any(negative | taken, axis=-1)
        settled &= ~changed
        before = np.where(changed, 0.0, step)
        if settled.all():
            return LoadShare(loads, approach, tangent, slopes, iteration) if np.all(tangent > 0.0) else None
        bent = problem.bent(loads, changed, bent)
        wanted = ~settled if problem.apart else everywhere
    return None
