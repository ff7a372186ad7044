r"""Curves over the mesh cycle as smooth arcs between events: exact integrals, extremes and harmonics.

Between two events every curve of a mesh cycle is smooth, and a polynomial through Chebyshev points of the arc
converges geometrically with its degree (L. N. Trefethen, Approximation Theory and Approximation Practice, 2013,
doi:10.1137/1.9781611975949). Where a contact begins its stiffness starts as the inverse of a logarithm, which no
polynomial follows; the nodes of such an arc crowd towards that end, as the cubes of Chebyshev points, so that what is
left there has little weight. What a series of degree n leaves out is estimated in ``gears.sharing.arc_series`` and goes
through each figure, arc by arc, as if the arcs' errors were independent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, Integers, part, quantity, record
from gears.sharing.arc_series import ceiling, gauss, greatest_of, left_out, lobatto, to_series

__all__ = ["CELLS", "FORCE", "SHARE", "Arc", "Arcs", "graded"]

SHARE, FORCE, CELLS = 0, 1, 4
"""Kinds of `Arc.pairs`: the curvature radii follow the force, and them the cells of the face."""


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

    no_error = "what the estimates of a cycle are made of: MeshFigures has the errors"

    low: float = quantity("1", "where it begins, base pitches")
    high: float = quantity("1", "where it ends, base pitches")
    values: Array = quantity("", "curves at Chebyshev points of the arc, ends included", "curve node")
    towards: int = quantity("1", "end towards which its points crowd, -1 or 1; 0 for neither", default=0)
    pairs: Array | None = quantity(
        "",
        "at the same points of every pair: share of the torque, normal force [N], curvature radius of the pinion's "
        "and of the wheel's flank [m], and by finite elements the line load on each cell of the face [N/m]; None where "
        "pairs are not distinguished",
        "node pair kind",
        default=None,
    )

    @property
    def width(self) -> float:
        """Length in base pitches."""
        return self.high - self.low

    @property
    def crowded(self) -> bool:
        """Whether its points crowd towards an end."""
        return self.towards != 0

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
        return np.asarray(self.values @ to_series(self.values.shape[1] - 1).T)

    @property
    def tail(self) -> Array:
        """Largest of the last quarter of coefficients of every curve (curves,)."""
        series = self.series
        return np.asarray(np.max(np.abs(series[:, -max(2, series.shape[1] // 4) :]), axis=1))


@record
class Arcs:
    """Smooth arcs of curves over some base pitches, in order and without gaps."""

    no_error = "what the estimates of a cycle are made of: MeshFigures has the errors"

    names: tuple[str, ...] = part("of the curves")
    arcs: tuple[Arc, ...] = part("all of them")
    pitches: int = quantity("1", "base pitches that they cover, from 0 on")

    @property
    def ends(self) -> Array:
        """Where arcs meet, and both ends of all (arcs + 1,)."""
        return np.array([*(arc.low for arc in self.arcs), self.arcs[-1].high])

    def _series(self, name: str) -> list[tuple[Arc, Array]]:
        """Arcs with the series of a curve."""
        row = self.names.index(name)
        return [(arc, to_series(arc.values.shape[1] - 1) @ arc.values[row]) for arc in self.arcs]

    def with_curves(self, prefix: str, values: Sequence[Array]) -> Arcs:
        """Arcs with other curves: their values at the nodes of every arc, (nodes, curves)."""
        names = tuple(f"{prefix} {number}" for number in range(values[0].shape[1]))
        arcs = tuple(replace(arc, values=rows.T) for arc, rows in zip(self.arcs, values, strict=True))
        return Arcs(names, arcs, self.pitches)

    def shares(self) -> Arcs | None:
        """Load shares of the pairs as curves; None where pairs are not distinguished."""
        load_shares = [arc.pairs[..., SHARE] for arc in self.arcs if arc.pairs is not None]
        return self.with_curves("share", load_shares) if len(load_shares) == len(self.arcs) else None

    def greatest_of_all(self) -> tuple[float, float]:
        """Maximum value of all curves, and its error by sampling."""
        maxima = [self._greatest(name, 1.0) for name in self.names]
        greatest = max(value for value, _ in maxima)
        return greatest, max(value + error for value, error in maxima) - greatest

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
        values, all_series = np.empty(within.shape), self._series(name)
        for number in np.unique(which):
            here, (arc, series) = which == number, all_series[number]
            values[here] = chebyshev.chebval(arc.unit(within[here]), series)
        return values

    def on_each(self, name: str, count: int) -> Array:
        """Values of a curve at so many equally spaced points of every arc, ends included, one after the other."""
        part = np.linspace(0.0, 1.0, count)
        values = [
            chebyshev.chebval(arc.unit(arc.low + arc.width * part), series)
            for arc, series in self._series(name)
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
        for arc, series in self._series(name):
            middle = (arc.low + 0.5 * arc.width) % 1.0
            if between is not None and not between[0] < middle < between[1]:
                continue
            width += arc.width
            degree = len(series) - 1
            t, weight = gauss((power + 1) * degree // 2 + 3)
            weight, values = weight * arc.weight(t), chebyshev.chebval(t, series)
            total += float(weight @ values**power)
            off = left_out(series, t, power * weight * values ** (power - 1), arc.crowded)
            square += float(off @ off)
        return (total / width, square**0.5 / width) if width > 0.0 else (float("nan"), float("nan"))

    def extremes(self, name: str) -> tuple[tuple[float, float], tuple[float, float]]:
        """Minimum and maximum value of a curve on closed arcs, each with its error by sampling.

        Ends of arcs are Chebyshev points, so that an extreme value there has no separate one; an arc whose extreme is
        less, but uncertain, may exceed it.
        """
        return self._greatest(name, -1.0), self._greatest(name, 1.0)

    def _greatest(self, name: str, sign: float) -> tuple[float, float]:
        """Maximum value of sign times a curve, times sign, and its error."""
        series = [(sign * coefficients, arc.crowded) for arc, coefficients in self._series(name)]
        ceilings = [ceiling(coefficients) for coefficients, _ in series]
        greatest = above = below = -np.inf
        for number in np.argsort(ceilings)[::-1]:
            if ceilings[number] < below:
                break
            value, error = greatest_of(*series[number])
            greatest, above, below = (
                max(greatest, value),
                max(above, value + error),
                max(below, value - error),
            )
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
        amplitudes, parts = self.harmonics_and_parts(name, orders)
        return amplitudes, np.linalg.norm(parts, axis=1)

    def harmonics_and_parts(self, name: str, orders: Sequence[int] | Integers) -> tuple[Array, Array]:
        """Complex amplitudes, and their errors by sampling part by part: an arc's has the phase of its place.

        Parameters
        ----------
        name, orders
            As of `harmonics`.

        Returns
        -------
        c, parts : (orders,) and (orders, parts) arrays
            Complex; the parts of the errors but for their signs.
        """
        order = np.asarray(orders, dtype=float)
        total, parts = np.zeros(len(order), dtype=complex), []
        for arc, series in self._series(name):
            # nodes for the polynomial, and for the waves of the highest order over the arc
            waves = np.pi * float(order.max(initial=0.0)) * arc.width
            t, weight = gauss(len(series) + 12 + int(np.ceil((3 if arc.crowded else 1) * waves)))
            weight = weight * arc.weight(t) * 2 / self.pitches
            wave = np.exp(-2j * np.pi * order[:, None] * arc.place(t)) * weight
            total += wave @ chebyshev.chebval(t, series)
            parts.append(left_out(series, t, wave, arc.crowded))
        return total, np.concatenate(parts, axis=1)
