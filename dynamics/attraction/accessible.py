"""Saddles that a chaotic attractor can reach: met by motions that escape just past its end."""

from __future__ import annotations

import numpy as np

from base import Array, InputError
from dynamics.attraction.covers import Cover
from dynamics.attraction.escapes import STRETCH
from dynamics.attraction.manifolds import is_direct_saddle
from dynamics.flow.protocol import Flow
from dynamics.model.options import OPTIONS
from dynamics.model.protocol import Oscillator
from dynamics.model.states import apart
from dynamics.motion.sweeps import long_flow
from dynamics.orbits.shooting import Orbit, find_orbit

MOTIONS = 24  # that have to leave
LONGEST = 32  # stretches that one of them is waited for
STAYING = 8  # motions that stay so long without one that leaves
BEFORE, BEHIND = 300, 60  # periods of a motion looked at before and after it leaves
RECURRENCE = 0.02  # of the attractor's size: near recurrence that Newton's method is tried from
TRIED = 2  # recurrences of each period that are tried in a motion
ENOUGH = 50_000  # samples that cover an attractor, so that what lies outside has left it
SAMPLED = 40  # samples of the attractor of which the distance to the next is looked at
SPACED = 3.0  # times this distance: nearer saddles count as on the attractor


def accessible_saddles(oscillator: Oscillator, states: Array, longest: int) -> list[Orbit]:
    """Saddles near the ways by which motions leave what was an attractor, the nearest to it first.

    Motions that escape pass the saddle with whose stable manifold the attractor has collided: near recurrences of their
    last periods are starts for Newton's method. Saddles with a multiplier above 1 are ranked by their distance from
    the attractor's samples. Those nearer than samples lie apart are on the attractor and left out; saddles farther
    out than the first touch nothing.

    Parameters
    ----------
    oscillator : Oscillator
        Just past the end of the attractor.
    states : (n, dimension) array
        Samples of the attractor before its end; the more, the better points on it are recognised.
    longest : int
        Longest period of a saddle.

    Raises
    ------
    InputError
        If no motion leaves, or there are too few samples to say so.
    """
    from scipy.spatial import cKDTree

    if len(states) < ENOUGH:
        allowed = f"must have {ENOUGH} samples of its chaos, or be periodic"
        raise InputError.at("attractor", f"{len(states)} samples", allowed, "take that of chaos_end")
    flow, cover = long_flow(oscillator, None), Cover.of(oscillator.in_plane(states))
    size = float(np.max(np.ptp(states, axis=0)))
    met: list[Orbit] = []
    escaped = stayed = 0
    for start in states[:: max(1, len(states) // (2 * MOTIONS))]:
        motion = _leaving(oscillator, flow, start, cover)
        if motion is None:
            stayed += 1
            if stayed >= STAYING and escaped == 0:
                break
            continue
        escaped += 1
        _saddles(oscillator, motion, size, longest, met)
        if escaped >= MOTIONS:
            break
    if escaped == 0:
        allowed = "must be just past the end of the chaotic attractor, whose motions stay"
        raise InputError.at(
            "oscillator", f"{LONGEST * STRETCH} periods", allowed, "take the value from chaos_end"
        )
    tree = cKDTree(states)
    apart_by: Array = np.asarray(tree.query(states[:: len(states) // SAMPLED], k=2)[0]).reshape(-1, 2)
    spacing = float(np.quantile(apart_by[:, 1], 0.9))
    ranked = sorted(
        ((float(np.min(tree.query(saddle.points)[0])), saddle) for saddle in met), key=lambda pair: pair[0]
    )
    return [saddle for distance, saddle in ranked if distance > SPACED * spacing]


def _leaving(oscillator: Oscillator, flow: Flow, start: Array, cover: Cover) -> Array | None:
    """States of a motion about where it leaves the cover; None if it stays."""
    at, before = start, start[None][:0]
    for _ in range(LONGEST):
        motion = flow.follow(at, STRETCH, derivatives=False)
        if motion.message:
            return None
        out = np.flatnonzero(cover.outside(oscillator.in_plane(motion.states)))
        states = np.vstack([before[-BEFORE:], motion.states])
        if len(out):
            gone = len(states) - STRETCH + int(out[0])
            return states[max(0, gone - BEFORE) : gone + BEHIND]
        at, before = motion.state, motion.states
    return None


def _saddles(oscillator: Oscillator, states: Array, size: float, longest: int, met: list[Orbit]) -> None:
    """Add the saddles that Newton's method finds from near recurrences of a motion."""
    for n in range(1, min(longest, len(states) - 1) + 1):
        gap = np.max(np.abs(states[n:] - states[:-n]), axis=1)
        for k in np.argsort(gap)[:TRIED].tolist():
            if gap[k] > RECURRENCE * size:
                break
            orbit = find_orbit(oscillator, states[k], periods=n)
            near = orbit.converged and apart(states[k], orbit.points) < 3.0 * RECURRENCE * size
            if not near or not is_direct_saddle(orbit.multipliers):
                continue
            if not any(same_orbit(saddle, orbit, size) for saddle in met):
                met.append(orbit)


def same_orbit(a: Orbit, b: Orbit, size: float) -> bool:
    """Whether two orbits are one, perhaps from another period on."""
    return a.periods == b.periods and apart(b.state, a.points) < OPTIONS.same_orbit * size
