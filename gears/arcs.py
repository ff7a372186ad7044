r"""Curves over the mesh cycle as smooth arcs between events: exact integrals, extremes and harmonics.

Between two events every curve of a mesh cycle is smooth, and a polynomial through Chebyshev points of the arc
converges geometrically with its degree (L. N. Trefethen, Approximation Theory and Approximation Practice, 2013,
doi:10.1137/1.9781611975949). Where a contact begins its stiffness starts as the inverse of a logarithm, which no
polynomial follows; the nodes of such an arc crowd towards that end, as the cubes of Chebyshev points, so that what is
left there has no weight. Each figure is computed twice: from all nodes of every arc and from every other one (as
quadrature by C. W. Clenshaw and A. R. Curtis estimates itself, Numer. Math. 2, 1960, doi:10.1007/BF01386223). Their
difference, times what coefficients have fallen by since the middle of the series, is the error that is left. It is
taken arc by arc, as if the arcs' errors were independent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, Integers, part, quantity, record

__all__ = ["FORCE", "SHARE", "Arc", "Arcs", "graded", "lobatto"]

SHARE, FORCE = 0, 1
"""Kinds of `Arc.pairs`; the curvature radii follow them."""


def lobatto(degree: int) -> Array:
    """Chebyshev points of a degree from -1 to 1, both ends included (degree + 1,)."""
    return np.asarray(-np.cos(np.pi * np.arange(degree + 1) / degree))


@lru_cache(maxsize=16)
def _to_series(degree: int) -> Array:
    """Matrix from values at Chebyshev points to Chebyshev coefficients."""
    matrix = np.linalg.inv(chebyshev.chebvander(lobatto(degree), degree))
    matrix.setflags(write=False)
    return np.asarray(matrix)


def graded(unit: Array, towards: int) -> tuple[Array, Array]:
    """Places of Chebyshev points in an arc, 0 to 1, and their derivative by half the unit.

    Parameters
    ----------
    unit : array
        -1 to 1.
    towards : {-1, 0, 1}
        End of the arc towards which places crowd, as cubes; 0 for neither.
    """
    if towards == 0:
        return 0.5 * (1 + unit), np.ones_like(unit)
    s = 0.5 * (1 - towards * unit)
    place = s**3
    return place if towards < 0 else 1.0 - place, 3 * s**2


@record
class Arc:
    """Curves between two events."""

    low: float = quantity("1", "where it begins, base pitches")
    high: float = quantity("1", "where it ends, base pitches")
    values: Array = quantity("", "curves at Chebyshev points of the arc, ends included", "curve node")
    towards: int = quantity("1", "end towards which its points crowd, -1 or 1; 0 for neither", default=0)
    pairs: Array | None = quantity(
        "",
        "at the same points of every pair: share of the torque, normal force [N], curvature radius of the pinion's "
        "and of the wheel's flank [m]; None where pairs are not told apart",
        "node pair kind",
        default=None,
    )

    @property
    def width(self) -> float:
        """Length in base pitches."""
        return self.high - self.low

    @property
    def position(self) -> Array:
        """Places of the values, base pitches."""
        return self.place(lobatto(self.values.shape[1] - 1))

    def place(self, unit: Array) -> Array:
        """Base pitches at arguments of the series, -1 to 1."""
        return np.asarray(self.low + self.width * graded(unit, self.towards)[0])

    def unit(self, position: Array) -> Array:
        """Arguments of the series at places in base pitches."""
        part = np.clip((position - self.low) / self.width, 0.0, 1.0)
        if self.towards == 0:
            return np.asarray(2 * part - 1)
        s = np.cbrt(part if self.towards < 0 else 1.0 - part)
        return np.asarray(self.towards * (1 - 2 * s))

    def weight(self, unit: Array) -> Array:
        """Base pitches per argument of the series."""
        return np.asarray(0.5 * self.width * graded(unit, self.towards)[1])

    @property
    def series(self) -> Array:
        """Chebyshev coefficients of all curves (curves, degree + 1)."""
        return np.asarray(self.values @ _to_series(self.values.shape[1] - 1).T)

    @property
    def tail(self) -> Array:
        """Largest of the last quarter of coefficients of every curve (curves,)."""
        series = self.series
        return np.asarray(np.max(np.abs(series[:, -max(2, series.shape[1] // 4) :]), axis=1))


def _half(values: Array) -> Array:
    """Series (n + 1,) through every other of n + 1 values at Chebyshev points, n even; zeros follow it."""
    short = np.zeros(len(values))
    some = values[::2]
    short[: len(some)] = _to_series(len(some) - 1) @ some
    return short


def _left(series: Array) -> float:
    """Error of a series over its difference from one of half the degree: what coefficients have fallen by, twice."""
    degree = len(series) - 1
    block, size = max(2, degree // 4), np.abs(series)
    middle = degree // 2 + 1
    after, before = float(np.max(size[-block:])), float(np.max(size[max(1, middle - block) : middle]))
    return min(2.0 * after / before, 1.0) if before > 0.0 else 1.0


@record
class _Series:
    """A curve on an arc: its series, that of half the degree, and the part of their difference that is left."""

    arc: Arc
    whole: Array
    short: Array
    left: float


@record
class Arcs:
    """Smooth arcs of curves over some base pitches, in order and without gaps."""

    names: tuple[str, ...] = part("of the curves")
    arcs: tuple[Arc, ...] = part("all of them")
    pitches: int = quantity("1", "base pitches that they cover, from 0 on")

    @property
    def ends(self) -> Array:
        """Where arcs meet, and both ends of all (arcs + 1,)."""
        return np.array([*(arc.low for arc in self.arcs), self.arcs[-1].high])

    def _series(self, name: str) -> list[_Series]:
        """Series of a curve on all arcs."""
        row, found = self.names.index(name), []
        for arc in self.arcs:
            whole = arc.series[row]
            found.append(_Series(arc, whole, _half(arc.values[row]), _left(whole)))
        return found

    def with_curves(self, prefix: str, values: Sequence[Array]) -> Arcs:
        """Arcs with other curves: their values at the nodes of every arc, (nodes, curves)."""
        names = tuple(f"{prefix} {number}" for number in range(values[0].shape[1]))
        arcs = tuple(replace(arc, values=rows.T) for arc, rows in zip(self.arcs, values, strict=True))
        return Arcs(names, arcs, self.pitches)

    def shares(self) -> Arcs | None:
        """Load shares of the pairs as curves; None where pairs are not told apart."""
        found = [arc.pairs[..., SHARE] for arc in self.arcs if arc.pairs is not None]
        return self.with_curves("share", found) if len(found) == len(self.arcs) else None

    def greatest_of_all(self) -> tuple[float, float]:
        """Greatest value of all curves, and its error by sampling."""
        found = [self.extremes(name)[1] for name in self.names]
        greatest = max(value for value, _ in found)
        return greatest, max(value + error for value, error in found) - greatest

    def curve(self, name: str, position: Array, before: bool = False) -> Array:
        """Value of a curve anywhere; at an event the value after it, or before it.

        Parameters
        ----------
        name : str
        position : (n,) array
            Base pitches; the curve repeats itself after the last.
        before : bool
            Which side of an event.
        """
        within = np.mod(np.asarray(position, dtype=float), self.pitches)
        starts = self.ends[:-1]
        which = np.clip(np.searchsorted(starts, within, side="left" if before else "right") - 1, 0, None)
        found, every = np.empty(within.shape), self._series(name)
        for number in np.unique(which):
            here, one = which == number, every[number]
            found[here] = chebyshev.chebval(one.arc.unit(within[here]), one.whole)
        return found

    def on_each(self, name: str, count: int) -> Array:
        """Values of a curve at so many equally spaced points of every arc, ends included, one after the other."""
        part = np.linspace(0.0, 1.0, count)
        values = [
            chebyshev.chebval(one.arc.unit(one.arc.low + one.arc.width * part), one.whole)
            for one in self._series(name)
        ]
        return np.asarray(np.concatenate(values))

    def mean(self, name: str, between: tuple[float, float] | None = None) -> tuple[float, float]:
        """Mean of a curve, all over or between two ends of arcs in every base pitch, and its error by sampling."""
        return self.moment(name, 1, between)

    def moment(
        self, name: str, power: int, between: tuple[float, float] | None = None
    ) -> tuple[float, float]:
        """Mean of a power of a curve, and its error by sampling; arguments as of `mean`."""
        total = square = width = 0.0
        for one in self._series(name):
            middle = (one.arc.low + 0.5 * one.arc.width) % 1.0
            if between is not None and not between[0] < middle < between[1]:
                continue
            width += one.arc.width
            t, weight = _gauss(power * len(one.whole) // 2 + 2)
            weight = weight * one.arc.weight(t)
            first, second = (
                float(weight @ chebyshev.chebval(t, series) ** power) for series in (one.whole, one.short)
            )
            total, square = total + first, square + (one.left * (first - second)) ** 2
        return (total / width, square**0.5 / width) if width > 0.0 else (float("nan"), float("nan"))

    def extremes(self, name: str) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and greatest value of a curve on closed arcs, each with its error by sampling.

        Ends of arcs are Chebyshev points, so that an extreme value there has none of its own; an arc whose extreme is
        less, but uncertain, may exceed it.
        """
        return self._greatest(name, -1.0), self._greatest(name, 1.0)

    def _greatest(self, name: str, sign: float) -> tuple[float, float]:
        """Greatest value of sign times a curve, times sign, and its error."""
        found = [_greatest_of(sign * one.whole, sign * one.short, one.left) for one in self._series(name)]
        greatest = max(value for value, _ in found)
        above, below = (max(value + side * error for value, error in found) for side in (1.0, -1.0))
        return float(sign * greatest), max(above - greatest, greatest - below)

    def harmonics(self, name: str, orders: Sequence[int] | Integers) -> tuple[Array, Array]:
        r"""Complex amplitudes :math:`c_j` of :math:`|c_j| \cos(2\pi j x + \arg c_j)`, and their errors by sampling.

        Parameters
        ----------
        name : str
        orders : sequence of int
            1 is once a base pitch.

        Returns
        -------
        c, error : (orders,) arrays
            Complex, and real.
        """
        order = np.asarray(orders, dtype=float)
        total, square = np.zeros(len(order), dtype=complex), np.zeros(len(order))
        for one in self._series(name):
            # nodes for the polynomial, and for the waves of the highest order over the arc
            waves = np.pi * float(order.max(initial=0.0)) * one.arc.width
            crowded = 1 if one.arc.towards == 0 else 3
            t, weight = _gauss(len(one.whole) + 12 + int(np.ceil(crowded * waves)))
            weight = weight * one.arc.weight(t) * 2 / self.pitches
            wave = np.exp(-2j * np.pi * order[:, None] * one.arc.place(t)) * weight
            first, second = (wave @ chebyshev.chebval(t, series) for series in (one.whole, one.short))
            total, square = total + first, square + np.abs(one.left * (first - second)) ** 2
        return total, np.sqrt(square)


@lru_cache(maxsize=64)
def _gauss(count: int) -> tuple[Array, Array]:
    """Gauss's nodes and weights."""
    t, weight = np.polynomial.legendre.leggauss(count)
    return np.asarray(t), np.asarray(weight)


def _greatest_of(series: Array, short: Array, left: float) -> tuple[float, float]:
    """Greatest value of a Chebyshev series between -1 and 1, and its error; 0 at an end.

    The error is what the series of half the degree differs by there times `left`, and no more than thrice what the
    greatest value exceeds those at the nodes by: these are exact, and a series may wave between them.
    """
    nodes = chebyshev.chebval(lobatto(len(series) - 1), series)
    ends = float(max(nodes[0], nodes[-1]))
    slope = np.trim_zeros(chebyshev.chebder(series), "b")
    if len(slope) < 2:
        return ends, 0.0
    roots = chebyshev.chebroots(slope)
    real = roots.real[(np.abs(roots.imag) < 1e-6) & (np.abs(roots.real) < 1.0)]
    values = chebyshev.chebval(real, series)
    if values.size == 0 or values.max() <= ends:
        return ends, 0.0
    place = real[int(np.argmax(values))]
    # the difference may vanish there by chance; the last coefficients do not both
    off = max(left * abs(float(chebyshev.chebval(place, series - short))), float(np.max(np.abs(series[-2:]))))
    return float(values.max()), min(off, 3.0 * max(float(values.max() - nodes.max()), 0.0))
