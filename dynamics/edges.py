"""Saddles on the boundary of a basin, found by staying on the boundary."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from base import Faults
from dynamics.attraction import Attractor
from dynamics.flow import Tables, period_map, tables
from dynamics.oscillator import GearOscillator
from dynamics.passing import is_direct_saddle
from dynamics.shooting import Orbit, find_orbit

__all__ = ["edge_saddles"]

FloatArray = npt.NDArray[np.float64]
SECTIONS = 16  # parts of the bracket tried at once
ROUNDS = 14  # of sections: the bracket shrinks to rounding
NEAR = 1e-2  # of the attractor's size: recurrence of the motion on the boundary that Newton's method is tried from


def edge_saddles(
    oscillator: GearOscillator,
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
    saddles with a multiplier above 1 can part basins: one below -1 swaps the sides of the stable manifold.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator.
    attractor : Attractor
        A periodic one of `basins`.
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
        Saddles with a multiplier above 1, each once, the most often met first.

    Raises
    ------
    InputError
        If the attractor is not periodic, or an argument is out of range.
    """
    faults = Faults()
    if attractor.orbit is None:
        faults.add(
            "attractor", attractor.label, "must be a periodic one", "take it where it is still periodic"
        )
    number = faults.whole("rays", rays, 1, 1000, "8 is usual")
    wait = faults.whole("limit", limit, 1, 10**7, "1000 is usual")
    longest = faults.whole("max_period", max_period, 1, 1000, "16 is usual")
    faults.raise_if_any()
    home = _Home(oscillator, attractor, radius, wait)
    met: list[tuple[Orbit, int]] = []
    angles = 2.0 * np.pi * (np.arange(number) + 0.5) / number
    for point in attractor.states:
        for way in np.column_stack([np.cos(angles), np.sin(angles)]):
            edge = home.edge(point, way)
            orbit = None if edge is None else _saddle(oscillator, home.table, edge, home.size, longest)
            if orbit is None:
                continue
            same = [k for k, (o, _) in enumerate(met) if _same(home.table, o, orbit, home.size)]
            if same:
                met[same[0]] = (met[same[0]][0], met[same[0]][1] + 1)
            else:
                met.append((orbit, 1))
    return [orbit for orbit, _ in sorted(met, key=lambda m: -m[1])]


class _Home:
    """Tells whether starts come to an attractor."""

    def __init__(self, oscillator: GearOscillator, attractor: Attractor, radius: float, limit: int) -> None:
        n = len(attractor.states)
        self.table, self.limit = tables(oscillator), limit
        self.size = float(np.max(np.abs(attractor.states)))
        self.homes = np.column_stack([attractor.states, np.zeros(n), np.full(n, n)])
        self.radius = radius * self.size

    def holds(self, starts: FloatArray) -> npt.NDArray[np.bool_]:
        """Which of the starts come back."""
        from dynamics.kernels.searching import settle

        labels = np.full(len(starts), -1, dtype=np.int64)
        settle(self.table.arrays, starts.copy(), self.homes, self.radius, self.limit, labels)
        return np.asarray(labels == 0)

    def edge(self, point: FloatArray, way: FloatArray) -> FloatArray | None:
        """State on the boundary on a ray from a point of the attractor, nearest to it; None if there is none."""
        far = self.size * np.geomspace(1e-4, 3.0, 2 * SECTIONS)
        inside = self.holds(point + far[:, None] * way)
        out = int(np.argmin(inside))
        if inside[out]:
            return None
        low, high = (0.0 if out == 0 else float(far[out - 1])), float(far[out])
        for _ in range(ROUNDS):
            tried = np.linspace(low, high, SECTIONS + 1)[1:-1]
            back = self.holds(point + tried[:, None] * way)
            k = int(np.argmin(back)) if not np.all(back) else len(tried)
            low, high = (
                (low if k == 0 else float(tried[k - 1])),
                (high if k == len(tried) else float(tried[k])),
            )
        return np.asarray(point + 0.5 * (low + high) * way)


def _saddle(
    oscillator: GearOscillator, table: Tables, edge: FloatArray, size: float, longest: int
) -> Orbit | None:
    """Saddle that the motion from a state on the boundary comes closest to."""
    states = np.vstack([edge, period_map(table, edge, 40 + 2 * longest).states])
    best: list[tuple[float, int, int]] = []
    for n in range(1, longest + 1):
        gap = np.max(np.abs(states[n:] - states[:-n]), axis=1)
        k = int(np.argmin(gap))
        if gap[k] < NEAR * size:
            best.append((float(gap[k]), n, k))
    for _, n, k in sorted(best)[:4]:
        orbit = find_orbit(oscillator, states[k], periods=n)
        near = float(np.max(np.abs(orbit.state - states[k]))) < 10.0 * NEAR * size
        if orbit.converged and is_direct_saddle(orbit.multipliers) and near:
            return orbit
    return None


def _same(table: Tables, a: Orbit, b: Orbit, size: float) -> bool:
    """Tell whether two orbits are one, perhaps from another period on."""
    if a.periods != b.periods:
        return False
    points = period_map(table, a.state, a.periods).states
    return bool(np.min(np.max(np.abs(points - b.state), axis=1)) < 1e-7 * size)
