r"""Curves over the mesh cycle as smooth arcs between events: exact integrals, extremes and harmonics.

Between two events every curve of a mesh cycle is smooth, and a polynomial through Chebyshev points of the arc
converges geometrically with its degree (L. N. Trefethen, Approximation Theory and Approximation Practice, 2013,
doi:10.1137/1.9781611975949). Each figure is computed twice: from the whole series and without the last quarter of
its coefficients. The difference estimates what the series leaves out; it is taken arc by arc, so that errors of
opposite sign do not hide each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, Integers, part, quantity, record

__all__ = ["Arc", "Arcs", "lobatto"]


def lobatto(degree: int) -> Array:
    """Chebyshev points of a degree from -1 to 1, both ends included (degree + 1,)."""
    return np.asarray(-np.cos(np.pi * np.arange(degree + 1) / degree))


@lru_cache(maxsize=16)
def _to_series(degree: int) -> Array:
    """Matrix from values at Chebyshev points to Chebyshev coefficients."""
    matrix = np.linalg.inv(chebyshev.chebvander(lobatto(degree), degree))
    matrix.setflags(write=False)
    return np.asarray(matrix)


@record
class Arc:
    """Curves between two events."""

    low: float = quantity("1", "where it begins, base pitches")
    high: float = quantity("1", "where it ends, base pitches")
    values: Array = quantity("", "curves at Chebyshev points of the arc, ends included", "curve node")

    @property
    def width(self) -> float:
        """Length in base pitches."""
        return self.high - self.low

    @property
    def position(self) -> Array:
        """Places of the values, base pitches."""
        return np.asarray(self.low + 0.5 * self.width * (1 + lobatto(self.values.shape[1] - 1)))

    @property
    def series(self) -> Array:
        """Chebyshev coefficients of all curves (curves, degree + 1)."""
        return np.asarray(self.values @ _to_series(self.values.shape[1] - 1).T)

    @property
    def tail(self) -> Array:
        """Largest of the last quarter of coefficients of every curve (curves,)."""
        series = self.series
        return np.asarray(np.max(np.abs(series[:, -max(2, series.shape[1] // 4) :]), axis=1))


def _kept(length: int) -> int:
    """Coefficients of a series without its last quarter.

    Three at least, so that one that counts for the integral, of even degree, has a neighbour that counts too.
    """
    return max(1, length - max(3, length // 4))


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

    def _pairs(self, name: str) -> list[tuple[Arc, Array, Array]]:
        """Each arc with its series of a curve, whole and without the last quarter."""
        row, found = self.names.index(name), []
        for arc in self.arcs:
            whole = arc.series[row]
            short = whole.copy()
            short[_kept(len(whole)) :] = 0.0
            found.append((arc, whole, short))
        return found

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
        found, pairs = np.empty(within.shape), self._pairs(name)
        for number in np.unique(which):
            arc, series, _ = pairs[number]
            here = which == number
            unit = 2 * (within[here] - arc.low) / arc.width - 1
            found[here] = chebyshev.chebval(np.clip(unit, -1.0, 1.0), series)
        return found

    def on_each(self, name: str, count: int) -> Array:
        """Values of a curve at so many equally spaced points of every arc, ends included, one after the other."""
        unit = np.linspace(-1.0, 1.0, count)
        values = [chebyshev.chebval(unit, whole) for _, whole, _ in self._pairs(name)]
        return np.asarray(np.concatenate(values))

    def mean(self, name: str) -> tuple[float, float]:
        """Mean of a curve, and its error by sampling."""
        return self.moment(name, 1)

    def moment(self, name: str, power: int) -> tuple[float, float]:
        """Mean of a power of a curve, and its error by sampling."""
        total = error = 0.0
        for arc, whole, short in self._pairs(name):
            t, weight = _gauss(power * len(whole) // 2 + 1)
            first, second = (
                0.5 * arc.width * float(weight @ chebyshev.chebval(t, series) ** power)
                for series in (whole, short)
            )
            total, error = total + first, error + abs(first - second)
        return total / self.pitches, error / self.pitches

    def extremes(self, name: str) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and greatest value of a curve on closed arcs, each with its error by sampling.

        Ends of arcs are Chebyshev points, so that an extreme value there has none.
        """
        return self._greatest(name, -1.0), self._greatest(name, 1.0)

    def _greatest(self, name: str, sign: float) -> tuple[float, float]:
        """Greatest value of sign times a curve, times sign, and its error."""
        found = [_greatest_of(sign * whole, sign * short) for _, whole, short in self._pairs(name)]
        greatest = max(value for value, _ in found)
        return float(sign * greatest), max(error for value, error in found if value + error >= greatest)

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
        total, error = np.zeros(len(order), dtype=complex), np.zeros(len(order))
        for arc, whole, short in self._pairs(name):
            # nodes for the polynomial, and for the waves of the highest order over the arc
            waves = np.pi * float(order.max(initial=0.0)) * arc.width
            t, weight = _gauss(len(whole) + 12 + int(np.ceil(waves)))
            place = arc.low + 0.5 * arc.width * (1 + t)
            wave = np.exp(-2j * np.pi * order[:, None] * place) * (weight * arc.width / self.pitches)
            first, second = (wave @ chebyshev.chebval(t, series) for series in (whole, short))
            total, error = total + first, error + np.abs(first - second)
        return total, error


@lru_cache(maxsize=64)
def _gauss(count: int) -> tuple[Array, Array]:
    """Gauss's nodes and weights."""
    t, weight = np.polynomial.legendre.leggauss(count)
    return np.asarray(t), np.asarray(weight)


def _greatest_of(series: Array, short: Array) -> tuple[float, float]:
    """Greatest value of a Chebyshev series between -1 and 1, and what the shorter one differs by there; 0 at an end."""
    ends = float(np.max(chebyshev.chebval(np.array([-1.0, 1.0]), series)))
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
    off = abs(float(chebyshev.chebval(place, series - short)))
    return float(values.max()), max(off, float(np.max(np.abs(series[-2:]))))
