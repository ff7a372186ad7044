"""The central path of forces that share a load: which contacts bear, where all of them are looked at together.

On it every product of a force and the gap that is left has one size, F_i g_i = mu, which falls to nothing. No contact
is taken in or released on the way, so that none goes round in circles, as those do in Newton's method that each change
of the others frees and presses again: cells over shafts that give way by more than the teeth do. Where the energy is
convex the path leads to its one minimum.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from base import Array, Booleans
from gears.sharing.active_set import ContactForces, LoadShare, share_forces

__all__ = ["central_path", "share_forces_by_path"]

_PATH = 80
"""Most steps along the central path."""

_CENTRED = 1e-12
"""Mean product of force and gap, over force times deflection, at which the contacts that bear are known."""

_OPEN = 1e-9
"""Part of the gaps' size by which they may differ from their place on the path at its end."""

_SHORTEN = 0.9
"""Part of the way to the nearest bound that a step takes."""

_SIZES = 3
"""Sizes of forces and gaps that are tried."""


def central_path(
    problem: ContactForces, whole: Array, force: Array, length: Array
) -> tuple[Array, Array, int]:
    """Follow the central path by an interior-point method, down to where it shows which contacts bear.

    Parameters
    ----------
    problem : ContactForces
    whole : (...) array
        Torque over the base radius [N].
    force, length : (...) arrays
        Sizes of forces and gaps [N], [m].

    Returns
    -------
    (..., n) array
        Forces near the solution of contacts that bear, zero of the others [N].
    (...) array
        Turn [m].
    int
        Steps.
    """
    wanted = np.ones(length.shape, dtype=bool)
    touchable = np.broadcast_to(problem.touchable, (*length.shape, problem.touchable.shape[-1]))
    loads = np.where(touchable, force[..., None], 0.0)
    approach, count, size = np.zeros_like(length), touchable.sum(axis=-1), force * length
    at = problem.linearised(loads, approach, problem.bent(loads, wanted, None))
    slack = np.where(touchable, np.maximum(at.residual, length[..., None]), 1.0)
    steps = 0
    while steps < _PATH:
        centre = (np.where(touchable, loads * slack, 0.0).sum(axis=-1) / count)[..., None]
        wanting = np.where(touchable, at.residual - slack, 0.0)
        off = np.abs(wanting).max(axis=-1) / length
        if np.all(centre[..., 0] <= _CENTRED * size) and np.all(off <= _OPEN):
            break
        share = np.where(touchable, loads, 1.0)
        aim = slack + wanting - 0.1 * centre / share
        unit, response = at.jacobian.solved(at.own + slack / share, at.reach, aim, touchable, wanted)
        total = np.sum(at.further_lever_ratios * unit, axis=-1)
        lift = (whole - at.carried + np.sum(at.further_lever_ratios * response, axis=-1)) / total
        change = unit * lift[..., None] - response
        opening = np.where(touchable, (0.1 * centre - slack * change) / share - slack, 0.0)
        bounds = _room(loads, change, touchable), _room(slack, opening, touchable)
        part = np.minimum(1.0, _SHORTEN * np.minimum(*bounds))
        loads = loads + part[..., None] * change
        slack = slack + part[..., None] * opening
        approach, steps = approach + part * lift, steps + 1
        at = problem.linearised(loads, approach, problem.bent(loads, wanted, None))
    bears = touchable & (loads / force[..., None] > slack / length[..., None])
    return np.where(bears, loads, 0.0), approach, steps


def share_forces_by_path(problem: ContactForces, whole: Array, loads: Array) -> LoadShare | None:
    """Solve for the forces and the turn from the end of the central path, as ``share_forces``.

    Sizes of forces and gaps are those of the loads at hand, shared evenly, and then those at the end of the path where
    these are far from it: shafts that give way by more than the gears' size leave little of a load.

    Parameters
    ----------
    problem : ContactForces
    whole : (...) array
        Torque over the base radius [N].
    loads : (..., n) array
        Whose size that of the forces is [N].
    """
    touchable, everywhere = problem.touchable & (loads >= 0.0), np.ones(whole.shape, dtype=bool)
    count = touchable.sum(axis=-1)
    force = np.maximum(np.abs(whole), loads.sum(axis=-1)) / count
    near, approach, steps = np.where(touchable, force[..., None], 0.0), np.zeros(whole.shape), 0
    for _ in range(_SIZES):
        left = problem.linearised(near, approach, problem.bent(near, everywhere, None)).residual
        length = np.abs(left).max(axis=-1, where=touchable, initial=0.0)
        with np.errstate(divide="ignore", invalid="ignore"):  # of forces that fall to nothing: seen below
            near, approach, more = central_path(problem, whole, force, length)
        steps += more
        if not np.all(np.isfinite(approach)):
            return None
        share = share_forces(problem, whole, near, approach)
        if share is not None:
            return replace(share, iterations=share.iterations + steps)
        force = np.maximum(np.abs(whole), near.sum(axis=-1)) / count
    return None


def _room(values: Array, change: Array, touchable: Booleans) -> Array:
    """How much of a change takes the first of positive values to zero (...)."""
    falls = touchable & (change < 0.0)
    return np.asarray(np.where(falls, -values / np.where(falls, change, 1.0), np.inf).min(axis=-1))
