"""Newton's method for contacts that move: forces and the turn D of one energy, whatever bears them.

With the overlap r(F, D) that forces want, J = dr/dF symmetric, reach = -dr/dD and the torque that forces carry,
further forces have the levers l - (1 - reach), as the energy demands. As in ``gears.share_load`` one active set runs
over all that may touch.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from base import Array, Booleans, record

if TYPE_CHECKING:
    from gears import LoadShare

__all__ = ["Linearised", "MovingForces", "moved_forces"]

ITERATIONS = 100
CLOSE = 1e-11
"""Change of forces, relative to the whole, at which Newton's method ends."""

ROUNDING = 1e-13
"""Overlap, relative to the deflection, that takes no contact in."""


@record
class Linearised:
    """Forces that move, about some state.

    Attributes
    ----------
    residual : (..., n) array
        Overlap wanting [m].
    reach : (..., n) array
        What is closed by a turn.
    further_lever_ratios : (..., n) array
        Levers of further forces.
    carried : (...) array
        Torque over the base radius [N].
    stiff : (...) array
        What a turn takes from it at held forces [N/m].
    own : (..., n) array
        Slopes of each force's own law [m/N]; 1 where it is zero.
    blocks : array or None
        What couples forces beyond that depends on the state, as ``solved`` of who made it knows it.
    """

    residual: Array
    reach: Array
    further_lever_ratios: Array
    carried: Array
    stiff: Array
    own: Array
    blocks: Array | None = None


class MovingForces(Protocol):
    """Forces of contacts that move."""

    @property
    def touchable(self) -> Booleans:
        """Which may bear (..., n)."""

    @property
    def start(self) -> float:
        """Part of the whole force with which one is taken in."""

    def linearised(self, loads: Array, approach: Array) -> Linearised:
        """Linearise about forces (..., n) [N] and the deflection D (...) [m]."""

    def solved(self, at: Linearised, approach: Array, active: Booleans) -> tuple[Array, Array]:
        """Answers of the forces in contact to the turn and to the residual (..., n)."""

    def unloaded(self, loads: Array, approach: Array) -> Array:
        """Gaps (..., n) [m] that are left where there is no force, under all others."""


def moved_forces(problem: MovingForces, whole: Array, loads: Array, approach: Array) -> LoadShare | None:
    """Solve for contacts that move.

    Parameters
    ----------
    problem : MovingForces
    whole : (...) array
        Torque over the base radius [N].
    loads, approach : (..., n) and (...) arrays
        Forces [N] and deflection [m] to begin with.

    Returns
    -------
    LoadShare or None
        None where Newton's method does not settle: the deflection is far beyond the first order.
    """
    from gears.sharing.load_sharing import LoadShare

    active, start = loads > 0, np.full(loads.shape, problem.start)
    size = np.maximum(
        whole, np.max(loads, axis=-1)
    )  # teeth that are pressed together have forces without a torque
    for iteration in range(1, ITERATIONS + 1):
        at = problem.linearised(loads, approach)
        unit, response = problem.solved(at, approach, active)
        tangent = np.sum(at.further_lever_ratios * unit, axis=-1) - at.stiff
        lift = (whole - at.carried + np.sum(at.further_lever_ratios * response, axis=-1)) / tangent
        step = np.where(active, unit * lift[..., None] - response, 0.0)
        moved = loads + step
        negative = active & (moved <= 0)
        kept = np.where(negative, 0.0, moved)
        approach = approach + lift
        # as in ``share_load``: a force is released if its contact stands clear without it, else it keeps a part of it;
        # one that comes back is taken in with less
        unloaded = problem.unloaded(kept, approach)
        released = negative & (unloaded >= 0)
        taken = problem.touchable & ~active & (unloaded < -ROUNDING * np.abs(approach)[..., None])
        settled = np.all(np.abs(step) <= CLOSE * size[..., None])
        loads = np.where(negative & ~released, 0.1 * loads, kept)
        loads = np.where(taken, start * size[..., None], loads)
        start = np.where(taken, 0.1 * start, start)
        active = (active & ~released) | taken
        if not (np.all(np.isfinite(loads)) and np.all(tangent > 0)):
            return None
        if settled and not (np.any(negative) or np.any(taken)):
            return LoadShare(loads, approach, tangent, np.where(active, unit, 0.0), iteration)
    return None
