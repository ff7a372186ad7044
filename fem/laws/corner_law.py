"""Law of contacts at or beside a tip corner: one surface of an energy over place and force, on the path and outside it.

Psi(F, z) = F^2 e(ln F, z) is the energy of the strips' law over the force and over the place z, the contact's distance
beyond the end of the flank in curvature radii, less those of Hertz's law and of the corner's own tooth: a contact
approaches further by

    dPsi/dF = F q,        q = 2 e + de/dlnF.

Inside (z < 0) the corner cuts off its pressure (``fem.laws.cut_off``), outside the tip edge touches the other flank
(``fem.laws.tip_contact``), and nothing steps between. Contacts that stay have the surface at their places, as laws of
the force alone; those that move take its derivatives by the place as well. Below the minimum force e is linear in ln F,
as it is where only the corner and the opening of the flanks count; beyond the maximum, which strips do not cover, q
stays.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, record
from fem.pair.hertz_approach import LEAST_FORCE

if TYPE_CHECKING:
    from scipy.interpolate import BSpline, CubicSpline, RectBivariateSpline

__all__ = ["CornerLaw", "CornerSurface", "Pushed"]


@record
class Pushed:
    """Terms of an energy of forces (n,) that knows the turn D: its derivatives by F and D.

    Attributes
    ----------
    approach, slope : (..., n) arrays
        By F, and again by F [m], [m/N].
    push, less : (..., n) arrays
        By D [N], and by F and D.
    stiff : (..., n) array
        Twice by D [N/m].
    """

    approach: Array
    slope: Array
    push: Array
    less: Array
    stiff: Array


@record
class CornerLaw:
    """What a near tip corner adds to the law of contacts that stay, over the force.

    Cubic between even steps of the force's logarithm, and below and beyond these as ``CornerSurface``.

    Attributes
    ----------
    at : boolean array
        Which contacts (positions, pairs), n of them in row-major order.
    log_force : (k,) array
        Logarithms of forces [N], evenly apart.
    quotient, slope : (n, k) arrays
        Further deflection over the force [m/N], and its derivative by the logarithm.
    """

    at: Booleans
    log_force: Array
    quotient: Array
    slope: Array

    def of(self, position: int) -> CornerLaw:
        """Laws at a single position."""
        rows = np.nonzero(self.at)[0] == position
        contacts = self.at[position : position + 1]
        return CornerLaw(contacts, self.log_force, self.quotient[rows], self.slope[rows])

    def with_others(self, others: CornerLaw) -> CornerLaw:
        """Laws of these and of other contacts, over the same forces."""
        at = self.at | others.at
        quotient, slope = np.empty((2, int(at.sum()), len(self.log_force)))
        for law in (self, others):
            rows = law.at[at]
            quotient[rows], slope[rows] = law.quotient, law.slope
        return CornerLaw(at, self.log_force, quotient, slope)

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Further deflection [m] and its derivative [m/N] under forces (..., n) [N], one of each contact."""
        first, step, last = (
            self.log_force[0],
            self.log_force[1] - self.log_force[0],
            len(self.log_force) - 1,
        )
        log, row = np.log(np.maximum(force, LEAST_FORCE)), np.arange(force.shape[-1])
        steps = (log - first) / step
        cell = np.minimum(np.maximum(steps.astype(np.int64), 0), last - 1)
        place, after = np.minimum(steps - cell, 1.0), cell + 1
        t, before = np.maximum(place, 0.0), np.minimum(place, 0.0)
        u, square = 1 - t, t**2
        left = u**2
        q0, q1 = self.quotient[row, cell], self.quotient[row, after]
        s0, s1 = self.slope[row, cell] * step, self.slope[row, after] * step
        quotient = q0 * (1 + 2 * t) * left + q1 * square * (3 - 2 * t)
        quotient = quotient + s0 * t * left - s1 * square * u + s0 * before
        rise = (6 * t * u * (q1 - q0) + s0 * u * (1 - 3 * t) + s1 * t * (3 * t - 2)) / step
        rise = np.where((log > np.log(LEAST_FORCE)) & (log < self.log_force[-1]), rise, 0.0)
        return force * quotient, quotient + rise


@record
class CornerSurface:
    """Energy of contacts beside a corner over place and force.

    Attributes
    ----------
    unit : float
        Distance below which places are even [m].
    origin : float
        Place about which they are [m].
    energy : RectBivariateSpline
        e over asinh((z - origin)/unit) and ln F, without the gaps [m/N].
    gaps : CubicSpline
        Over the first of these [m].
    reach : (float, float)
        Smallest and largest asinh of these; beyond nothing changes.
    log_force : (k,) array
        Logarithms of forces [N], evenly apart.
    largest : (2, places) array
        First coordinates of the edges, and forces that their laws cover [N].
    sliding : float
        Growth of z per force by the tilt of the touched flank [m/N].
    """

    unit: float
    origin: float
    energy: RectBivariateSpline
    gaps: CubicSpline
    reach: tuple[float, float]
    log_force: Array
    largest: Array
    sliding: float

    @property
    def first(self) -> float:
        """Place from which on the corner has an effect [m]."""
        return float(self.origin + self.unit * np.sinh(self.reach[0]))

    def _xi(self, place: Array) -> tuple[Array, Array, Array, Booleans]:
        """Coordinate, its two derivatives by the place, and whether places are covered."""
        away = (place - self.origin) / self.unit
        slope = 1 / (self.unit * np.sqrt(1 + away**2))
        xi, (low, high) = np.arcsinh(away), self.reach
        return np.clip(xi, low, high), slope, -away * self.unit * slope**3, (xi > low) & (xi < high)

    def gap(self, place: Array) -> Array:
        """What is open at places without a force [m]."""
        return np.asarray(self.gaps(self._xi(place)[0]))

    def covered(self, place: Array) -> Array:
        """Forces up to which laws of edges at places hold [N]; 0 farther out than laws are."""
        edges, largest = self.largest
        at = np.arcsinh((place - self.origin) / self.unit)
        return np.asarray(np.interp(at, edges, largest, right=0.0))

    def held(self, at: Booleans, place: Array, further: Array) -> CornerLaw:
        """Law of contacts that stay.

        Parameters
        ----------
        at : boolean array
            Which contacts these are, n of them.
        place : (n,) array
            z [m].
        further : (n,) array
            What they yield in proportion to the force [m/N].
        """
        quotient, slope = np.moveaxis(self._over_place(self._xi(place)[0]), 1, 0)
        return CornerLaw(at, self.log_force, quotient + further[:, None], slope)

    @cached_property
    def _over_place(self) -> BSpline:
        """Quotient q and its derivative by ln F at the forces of laws (2, k), over the coordinate of places."""
        from scipy.interpolate import BSpline

        places, forces, flat = (np.asarray(values) for values in self.energy.tck)
        p, q = self.energy.degrees
        coefficients = flat.reshape(len(places) - p - 1, len(forces) - q - 1).T
        by_force = BSpline(forces, coefficients, q)
        energy, rise, bend = (by_force(self.log_force, n).T for n in range(3))
        return BSpline(places, np.stack([2 * energy + rise, 2 * rise + bend], axis=1), p)

    def at(self, place: Array, force: Array) -> Pushed:
        """Derivatives by forces [N] and by shifts of places [m], the gap among them."""
        xi, by_place, curved, covered = self._xi(place + self.sliding * force)
        log, (least, most) = np.log(np.maximum(force, LEAST_FORCE)), self.log_force[[0, -1]]
        within = np.clip(log, least, most)
        below, inside = np.minimum(log - least, 0.0), log < most

        def energy(dx: int = 0, dy: int = 0) -> Array:
            derivative = np.asarray(self.energy.ev(xi, within, dx=dx, dy=dy))
            return np.where(covered, derivative, 0.0) if dx else derivative

        def open_(order: int) -> Array:
            return np.where(covered, self.gaps(xi, order), 0.0)

        e_f, e_xf = energy(dy=1), energy(1, 1)
        e, e_x = energy() + below * e_f, energy(dx=1) + below * e_xf
        quotient, bend = 2 * e + e_f, np.where(below < 0.0, 0.0, energy(dy=2))
        by_x, by_xx = force * e_x + open_(1), force * energy(dx=2) + open_(2)
        push, less = force * by_x * by_place, (force * (2 * e_x + e_xf) + open_(1)) * by_place
        stiff = force * (by_xx * by_place**2 + by_x * curved)
        return Pushed(
            force * quotient + self.gaps(xi) + self.sliding * push,
            quotient
            + np.where(inside, 2 * e_f + bend, 0.0)
            + self.sliding * (2 * less + self.sliding * stiff),
            push,
            less + self.sliding * stiff,
            stiff,
        )
