"""Boundaries of basins, refined where the label changes; their dimension; shares with confidence intervals."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, Integers, Stopwatch, quantity, record
from dynamics.attraction.basins import Attractor, starting_states
from dynamics.attraction.known_attractors import KnownAttractors
from dynamics.model.limits import CONFIDENCE, RADIUS
from dynamics.model.protocol import Oscillator
from dynamics.model.reasons import OF_A_GRID
from dynamics.model.states import Region, checked_region
from dynamics.motion.sweeps import long_flow

CORNERS = np.array([(0, 0), (0, 1), (1, 0), (1, 1)])  # of a cell, in cells
COUNTED = 5  # last levels from which the dimension is taken


@record
class BasinBoundary:
    """Boundary between basins."""

    no_error = OF_A_GRID

    headline = ("dimension", "dimension_error")

    points: Array = quantity(
        "1",
        "X and V, or distances along the two directions, amid the smallest cells whose corners differ",
        "cell state",
    )
    cell: tuple[float, float] = quantity("1", "sides of these cells", "state")
    counts: Integers = quantity(
        "1", "cells with different corners at every level; from one to the next the sides are halved", "level"
    )
    dimension: float = quantity(
        "1", "box-counting dimension: slope of log2 of the counts over the level, from the last five levels"
    )
    dimension_error: float = quantity("1", "standard error of the slope")
    shares: Array = quantity(
        "1",
        "part of the region that reaches each attractor, from the areas of the cells; last, what reaches none",
        "attractor",
    )
    error: float = quantity(
        "1",
        "half the area of the smallest cells on the boundary, over the region: what the shares leave open",
    )
    cost: Cost
    converged: bool = quantity("1", "whether no level had more cells than allowed")
    message: str


def share_interval(hits: int, starts: int, confidence: float = 0.95) -> tuple[float, float]:
    r"""Confidence interval of a share from independent random starts (Wilson's score interval).

    .. math:: \frac{\hat p + z^2/2n \pm z\sqrt{\hat p (1 - \hat p)/n + z^2/4n^2}}{1 + z^2/n}

    Parameters
    ----------
    hits, starts : int
        Starts that reached the attractor, and all.
    confidence : float
        Between 0 and 1.

    Raises
    ------
    InputError
        If the numbers do not fit.

    Examples
    --------
    >>> low, high = share_interval(30, 100)
    >>> round(low, 4), round(high, 4)
    (0.2189, 0.3958)
    """
    from statistics import NormalDist

    with Faults() as faults:
        n = faults.whole("starts", starts, 1, 10**12, "give the number of starts")
        k = faults.whole("hits", hits, 0, n, "give at most the number of starts")
        level = faults.number("confidence", confidence, CONFIDENCE)
    z = NormalDist().inv_cdf(0.5 + 0.5 * level)
    share = k / n
    middle = share + z * z / (2 * n)
    half = z * math.sqrt(share * (1.0 - share) / n + z * z / (4.0 * n * n))
    whole = 1.0 + z * z / n
    return max((middle - half) / whole, 0.0), min((middle + half) / whole, 1.0)


def basin_boundary(
    oscillator: Oscillator,
    attractors: Sequence[Attractor],
    region: Region,
    *,
    plane: npt.ArrayLike | None = None,
    through: npt.ArrayLike | None = None,
    cells: int = 16,
    levels: int = 6,
    limit: int = 2000,
    radius: float = 1e-4,
    max_cells: int = 200_000,
) -> BasinBoundary:
    """Refine the cells of a grid whose corners reach different attractors.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator.
    attractors : sequence of Attractor
        Periodic ones, as `basins` finds them; what reaches none of them within `limit` is one further kind.
    region : ((x0, x1), (v0, v1))
        Starts: X and V; in several freedoms how far they are from `through` along the two directions of `plane`.
    plane, through : array_like, optional
        As of `basins`.
    cells : int
        Cells along each side at the first level. A tongue that passes between their corners is missed.
    levels : int
        Halvings.
    limit : int
        Periods that a start is given.
    radius : float
        Nearness to an attractor, over its size, as in `basins`.
    max_cells : int
        Cells of one level at most.

    Returns
    -------
    BasinBoundary
        The boundary and what follows from it.

    Raises
    ------
    InputError
        If an argument is out of range, or no attractor is periodic.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, basin_boundary, basins
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> reached = basins(osc, (-1.0, 1.0, 8), (-1.0, 1.0, 8), limit=500)
    >>> edge = basin_boundary(osc, reached.attractors, ((-1.0, 1.0), (-1.0, 1.0)), cells=4, levels=2)
    >>> edge.counts
    array([16, 45, 97])
    """
    watch = Stopwatch()
    with Faults() as faults:
        side = faults.whole("cells", cells, 2, 10_000, "16 is usual")
        halvings = faults.whole("levels", levels, 1, 20, "6 is usual")
        wait = faults.whole("limit", limit, 1, 10**7, "2000 is usual")
        near = faults.number("radius", radius, RADIUS)
        homes = [a.states for a in attractors if a.orbit is not None]
        if not homes:
            faults.add("attractors", len(attractors), "must hold a periodic one", "find them with basins")
        region = checked_region(faults, region)
    labeller = _Labeller(
        KnownAttractors(long_flow(oscillator, None), homes, near),
        wait,
        lambda places: starting_states(oscillator, places, plane, through),
    )
    origin, width = np.array(region)[:, 0], np.ptp(region, axis=1)
    corners = np.array([(i, j) for i in range(side) for j in range(side)], dtype=np.int64)
    counts, shares, fine = [], np.zeros(len(homes) + 1), True
    for level in range(halvings + 1):
        number = side * 2**level
        kinds = labeller.at(corners, origin, width / number, number)
        mixed = np.any(kinds != kinds[:, :1], axis=1)
        shares += np.bincount(kinds[~mixed, 0], minlength=len(shares)) / number**2
        boundary, at = kinds[mixed], corners[mixed]
        counts.append(len(at))
        if level == halvings or len(at) == 0:
            break
        if 4 * len(at) > max_cells:
            fine = False
            break
        corners = (2 * at[:, None, :] + CORNERS).reshape(-1, 2)
    for kind in range(len(shares)):
        shares[kind] += np.mean(boundary == kind, axis=1).sum() / number**2
    size = width / number
    slope, scatter = _slope(np.array(counts))
    cost = Cost(watch.seconds, 2, len(labeller.known), labeller.homes.periods)
    message = (
        f"{counts[-1]} boundary cells, {len(counts) - 1} halvings, dimension {slope:.3f} +- {scatter:.3f}"
    )
    return BasinBoundary(
        origin + (at + 0.5) * size, (float(size[0]), float(size[1])), np.array(counts), slope, scatter, shares,
        0.5 * counts[-1] / number**2, cost, fine, message + ("" if fine else ": raise max_cells"),
    )  # fmt: skip


class _Labeller:
    """Labels of corners, each followed once."""

    def __init__(self, homes: KnownAttractors, limit: int, starts: Callable[[Array], Array]) -> None:
        self.homes, self.limit, self.starts = homes, limit, starts
        self.known: dict[tuple[float, float], int] = {}

    def at(self, cells: Integers, low: Array, size: Array, number: int) -> Integers:
        """Labels of the four corners of cells, shape (any, 4)."""
        places = cells[:, None, :] + CORNERS
        unique, back = np.unique(places.reshape(-1, 2), axis=0, return_inverse=True)
        # exact: dyadic shares of the region
        keys = [(float(i) / number, float(j) / number) for i, j in unique]
        new = [k for k, key in enumerate(keys) if key not in self.known]
        labels = self.homes.settle(self.starts(low + unique[new] * size), self.limit)
        labels[labels < 0] = self.homes.number
        self.known.update((keys[k], int(label)) for k, label in zip(new, labels, strict=True))
        return np.array([self.known[key] for key in keys], dtype=np.int64)[back].reshape(-1, 4)


def _slope(counts: Integers) -> tuple[float, float]:
    """Slope of log2 of the counts per level and its standard error; nan from fewer than three levels."""
    used = counts[-COUNTED:]
    if len(used) < 3 or np.any(used == 0):
        return math.nan, math.nan
    level = np.arange(len(used)) - 0.5 * (len(used) - 1)
    height = np.log2(used)
    slope = float(level @ height / (level @ level))
    rest = height - height.mean() - slope * level
    return slope, math.sqrt(float(rest @ rest) / (len(used) - 2) / float(level @ level))
