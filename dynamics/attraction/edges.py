"""Saddles on the boundary of a basin, found by staying on the boundary."""

from __future__ import annotations

import numpy as np

from base import Array, Booleans, Faults
from dynamics.attraction.accessible import accessible_saddles, same_orbit
from dynamics.attraction.basins import Attractor
from dynamics.attraction.known_attractors import KnownAttractors
from dynamics.attraction.manifolds import is_direct_saddle
from dynamics.flow.motions import period_map
from dynamics.model.protocol import Oscillator
from dynamics.motion.sweeps import long_flow
from dynamics.orbits.shooting import Orbit, find_orbit

SECTIONS = 16  # parts of the bracket tried at once
ROUNDS = 14  # of sections: the bracket shrinks to rounding
PIECES = 40  # longest period of a saddle beside chaos, at least
NEAR = 1e-2  # of the attractor's size: recurrence of the motion on the boundary that Newton's method is tried from


def edge_saddles(
    oscillator: Oscillator,
    attractor: Attractor,
    *,
    rays: int = 8,
    limit: int = 1000,
    radius: float = 1e-4,
    max_period: int = 16,
) -> list[Orbit]:
    """Saddles that motions on the boundary of an attractor's basin pass.

    From a point of the attractor rays go out until a start no longer comes back to it. The change is closed in on to
    rounding; the motion from there stays on the boundary as long as rounding allows, and comes close to the saddle
    whose stable manifold that part of the boundary is. No period need be known. Where the boundary is fractal the
    saddle is that of its part next to the attractor, on which the attractor is destroyed if it grows to reach it. Only
    saddles with a multiplier above 1 can part basins: one below -1 swaps the sides of the stable manifold. In several
    freedoms rays go out in the directions in which y and its rate move alone.

    A chaotic attractor is looked at where it has just ended, since it then is left by motions that pass the saddle with
    which it collided. The boundary may be fractal and the saddle have a multiple of the attractor's pieces. Near
    recurrences of these motions, up to several tens of periods, lead to saddles; the nearest that is not on the
    attractor is the one.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator.
    attractor : Attractor
        A periodic one of `basins`; or a chaotic one, such as `ChaosEnd.attractor`, for the oscillator past its end.
    rays : int
        Directions tried from each point of the attractor.
    limit : int
        Periods within which a start must come back.
    radius : float
        Nearness to the attractor, over its size, that counts as come back.
    max_period : int
        Longest period of a saddle.

    Returns
    -------
    list of Orbit
        Saddles with a multiplier above 1, each once, the most often met first; beside a chaotic attractor the nearest
        first.

    Raises
    ------
    InputError
        If an argument is out of range, or no motion leaves a chaotic attractor.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, basins, edge_saddles
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> reached = basins(osc, (-1.0, 1.0, 8), (-1.0, 1.0, 8), limit=500)
    >>> [saddle.label for saddle in edge_saddles(osc, reached.attractors[0], rays=2)]
    ['U1-1-0']
    """
    with Faults() as faults:
        number = faults.whole("rays", rays, 1, 1000, "8 is usual")
        wait = faults.whole("limit", limit, 1, 10**7, "1000 is usual")
        longest = faults.whole("max_period", max_period, 1, 1000, "16 is usual")
    if attractor.orbit is None:
        return accessible_saddles(oscillator, attractor.states, max(longest, PIECES))
    homes = KnownAttractors(long_flow(oscillator, None), [attractor.states], radius)
    plane = oscillator.start_plane()[0]
    met: list[tuple[Orbit, int]] = []
    angles = 2.0 * np.pi * (np.arange(number) + 0.5) / number
    for point in attractor.states:
        for along in np.column_stack([np.cos(angles), np.sin(angles)]) @ plane:
            edge = _edge(homes, wait, point, along)
            orbit = None if edge is None else _saddle(oscillator, homes, edge, longest)
            if orbit is None:
                continue
            same = [k for k, (known, _) in enumerate(met) if same_orbit(known, orbit, homes.size)]
            if same:
                met[same[0]] = (met[same[0]][0], met[same[0]][1] + 1)
            else:
                met.append((orbit, 1))
    return [orbit for orbit, _ in sorted(met, key=lambda m: -m[1])]


def _edge(homes: KnownAttractors, limit: int, point: Array, along: Array) -> Array | None:
    """State on the boundary on a ray from a point of the attractor, nearest to it; None if there is none."""

    def stay(distances: Array) -> Booleans:
        return np.asarray(homes.settle(point + distances[:, None] * along, limit) == 0)

    far = homes.size * np.geomspace(1e-4, 3.0, 2 * SECTIONS)
    inside = stay(far)
    out = int(np.argmin(inside))
    if inside[out]:
        return None
    low, high = (0.0 if out == 0 else float(far[out - 1])), float(far[out])
    for _ in range(ROUNDS):
        tried = np.linspace(low, high, SECTIONS + 1)
        back = stay(tried[1:-1])
        k = int(np.argmin(back)) if not np.all(back) else len(back)
        low, high = float(tried[k]), float(tried[k + 1])
    return np.asarray(point + 0.5 * (low + high) * along)


def _saddle(oscillator: Oscillator, homes: KnownAttractors, edge: Array, longest: int) -> Orbit | None:
    """Saddle that the motion from a state on the boundary comes closest to."""
    states = np.vstack([edge, period_map(homes.flow, edge, 40 + 2 * longest).states])
    best: list[tuple[float, int, int]] = []
    for n in range(1, longest + 1):
        gap = np.max(np.abs(states[n:] - states[:-n]), axis=1)
        k = int(np.argmin(gap))
        if gap[k] < NEAR * homes.size:
            best.append((float(gap[k]), n, k))
    for _, n, k in sorted(best)[:4]:
        orbit = find_orbit(oscillator, states[k], periods=n)
        near = float(np.max(np.abs(orbit.state - states[k]))) < 10.0 * NEAR * homes.size
        if orbit.converged and is_direct_saddle(orbit.multipliers) and near:
            return orbit
    return None
