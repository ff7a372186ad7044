"""Viscosity as it was measured: a table over pressure and temperature, interpolated where oils are straight."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Faults, InputError, Limit
from ehl.oil.rheology import ROELANDS_LN_VISCOSITY, ROELANDS_PRESSURE

if TYPE_CHECKING:
    from scipy.interpolate import NdBSpline

_POLE = 138.0  # [K]
_AMBIENT = 2e5  # a table's first pressure is at most this [Pa]
_LIMITS = {
    "pressure": Limit(0.0, 1e11, "Pa", "0 or 1e5 first, ambient"),
    "temperature": Limit(150.0, 1000.0, "K", "353.15 is 80 degC"),
    "viscosity": Limit.above(1e-4, 1e100, "Pa s", "measured values in Pa s"),
}


class Measured(NamedTuple):
    """What a table says at pressures and temperatures."""

    ln_viscosity: Array  # ln(eta) [ln(Pa s)]
    by_pressure: Array  # its derivative [1/Pa]
    by_temperature: Array  # likewise [1/K], negative


@dataclass(frozen=True)
class MeasuredViscosity:
    """Viscosity interpolated in a table over pressure and temperature.

    ``G = ln(ln eta + 9.67)`` is interpolated over ``ln(1 + p/p0)``, p0 = 1/5.1e-9 Pa, and ``ln(T - 138 K)``, by cubic
    splines through all values (of lower order where a table has fewer than four rows or columns). An oil of Roelands'
    law is a plane there, so that any table of it gives it back exactly. Slopes are those of the splines.

    Range: that of the table. Contacts and bulk temperatures outside are refused; a pressure spike or hot oil that
    leaves it in places goes on along the last slope.

    Parameters
    ----------
    pressure : tuple of float
        Increasing, the first one ambient [Pa].
    temperature : tuple of float
        Increasing [K].
    viscosity : tuple of tuple of float
        A row for each pressure, a column for each temperature [Pa s].
    at : float, optional
        Temperature at which the law of pressure stands [K]; the first one unless given.

    Raises
    ------
    InputError
        With every fault of the table.

    Examples
    --------
    >>> rows = ((0.1, 0.02), (20.0, 1.5), (900.0, 40.0))
    >>> table = MeasuredViscosity((0.0, 5e8, 1e9), (313.15, 353.15), rows, at=353.15)
    >>> f"{table.viscosity_at(0.0, 353.15):.3f} {table.viscosity_at(5e8, 333.15):.2f} Pa s"
    '0.020 4.76 Pa s'
    """

    pressure: tuple[float, ...]
    temperature: tuple[float, ...]
    viscosity: tuple[tuple[float, ...], ...]
    at: float | None = None

    def __post_init__(self) -> None:
        """Check the table."""
        with Faults() as faults:
            for name, values in (("pressure", self.pressure), ("temperature", self.temperature)):
                for value in values:
                    faults.number(f"table.{name}", value, _LIMITS[name])
                if len(values) < 2 or not (np.diff(values) > 0.0).all():
                    faults.add(
                        f"table.{name}", values, "must be two or more increasing values", "sort the table"
                    )
            shape = (len(self.pressure), len(self.temperature))
            if np.shape(self.viscosity) != shape:
                allowed = f"must have {shape[0]} rows, one for each pressure, of {shape[1]}, one for each temperature"
                faults.add("table.viscosity", np.shape(self.viscosity), allowed, "leave no value out")
                return
            for value in np.ravel(self.viscosity).tolist():
                faults.number("table.viscosity", value, _LIMITS["viscosity"])
            if self.pressure[0] > _AMBIENT:
                faults.add(
                    "table.pressure", self.pressure[0], "must begin at ambient pressure", "add a row for 0 Pa"
                )
            rows = np.array(self.viscosity)
            if not ((np.diff(rows, axis=0) > 0.0).all() and (np.diff(rows, axis=1) < 0.0).all()):
                allowed = "must rise with every pressure and fall with every temperature"
                faults.add("table.viscosity", "", allowed, "look for a swapped or mistyped value")
            if self.at is not None and not self.knows(self.at):
                faults.add("table.at", self.at, self._range(), "take a temperature of the table")

    @classmethod
    def from_csv(cls, path: Any, at: float | None = None) -> MeasuredViscosity:
        """Read a table with the columns pressure_MPa, temperature_C and viscosity_Pa_s, a line for each value.

        Parameters
        ----------
        path : path
            The file.
        at : float, optional
            As in the constructor [K].

        Raises
        ------
        InputError
            Where a column or a value is missing.
        """
        import csv
        from pathlib import Path

        names = ("pressure_MPa", "temperature_C", "viscosity_Pa_s")
        with Path(path).open(encoding="utf-8", newline="") as file:
            lines = list(csv.DictReader(file))
        try:
            values = {
                (1e6 * float(line[names[0]]), float(line[names[1]]) + 273.15): float(line[names[2]])
                for line in lines
            }
            pressure, temperature = (tuple(sorted({key[i] for key in values})) for i in (0, 1))
            rows = tuple(tuple(values[p, T] for T in temperature) for p in pressure)
        except (KeyError, TypeError, ValueError) as reason:
            allowed = (
                f"must have the columns {', '.join(names)} and a line for each pressure at each temperature"
            )
            raise InputError.at("table", str(path), allowed, f"missing or no number: {reason}") from None
        return cls(pressure, temperature, rows, at)

    @property
    def reference(self) -> float:
        """Temperature at which the law of pressure stands [K]."""
        return self.temperature[0] if self.at is None else self.at

    @property
    def ambient(self) -> float:
        """Viscosity at ambient pressure and the reference temperature [Pa s]."""
        return float(np.exp(self.read(0.0, self.reference).ln_viscosity))

    @property
    def slope(self) -> float:
        """D ln(eta)/dp at ambient pressure and the reference temperature, alpha [1/Pa]."""
        return float(self.read(0.0, self.reference).by_pressure)

    @property
    def cooling(self) -> float:
        """-d ln(eta)/dT there, beta [1/K]."""
        return -float(self.read(0.0, self.reference).by_temperature)

    @property
    def reliable_below(self) -> float:
        """Maximum pressure of the table [Pa]."""
        return self.pressure[-1]

    def knows(self, T: float) -> bool:
        """Whether a temperature [K] lies in the table."""
        return self.temperature[0] - 1e-9 <= T <= self.temperature[-1] + 1e-9

    def at_temperature(self, T: float) -> MeasuredViscosity:
        """Return the law with another reference temperature [K]; InputError outside the table."""
        if not self.knows(T):
            raise InputError.at("temperature", T, self._range(), "measure the oil there, or take a law")
        return replace(self, at=T)

    def log_ratio(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return ln(eta/eta0) and its derivative by p [1/Pa] at the pressures p [Pa] and the reference temperature."""
        reading = self.read(p, self.reference)
        return reading.ln_viscosity - math.log(self._ambient), reading.by_pressure

    def viscosity_at(self, p: float, T: float) -> float:
        """Viscosity [Pa s] at a pressure [Pa] and a temperature [K]."""
        return float(np.exp(self.read(p, T).ln_viscosity))

    def read(self, p: ArrayLike, T: ArrayLike) -> Measured:
        """Read the table at pressures [Pa] and temperatures [K], which broadcast."""
        p, T = np.broadcast_arrays(np.asarray(p, dtype=float), np.asarray(T, dtype=float))
        x, y = np.log1p(np.maximum(p, 0.0) / ROELANDS_PRESSURE), np.log(np.maximum(T, _POLE + 1.0) - _POLE)
        spline, (left, right), (low, high) = self._spline
        inside_x, inside_y = np.clip(x, left, right), np.clip(y, low, high)
        at = np.stack([inside_x, inside_y], axis=-1)
        by_x, by_y = spline(at, nu=(1, 0)), spline(at, nu=(0, 1))
        G = spline(at) + by_x * (x - inside_x) + by_y * (y - inside_y)
        above = np.exp(G)
        return Measured(
            above + ROELANDS_LN_VISCOSITY,
            above * by_x / (ROELANDS_PRESSURE + np.maximum(p, 0.0)),
            above * by_y / np.exp(y),
        )

    @cached_property
    def _ambient(self) -> float:
        return self.ambient

    @cached_property
    def _spline(self) -> tuple[NdBSpline, tuple[float, float], tuple[float, float]]:
        """Splines through G and the ends of both variables."""
        from scipy.interpolate import NdBSpline, make_interp_spline

        x = np.log1p(np.array(self.pressure) / ROELANDS_PRESSURE)
        y = np.log(np.array(self.temperature) - _POLE)
        G = np.log(np.log(np.array(self.viscosity)) - ROELANDS_LN_VISCOSITY)
        k, m = min(3, x.size - 1), min(3, y.size - 1)
        along = make_interp_spline(x, G, k)
        across = make_interp_spline(y, along.c.T, m)
        spline = NdBSpline((along.t, across.t), across.c.T, (k, m))
        return spline, (float(x[0]), float(x[-1])), (float(y[0]), float(y[-1]))

    def _range(self) -> str:
        return f"must lie in the table, {self.temperature[0]:g} to {self.temperature[-1]:g} K"
