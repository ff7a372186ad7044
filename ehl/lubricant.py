"""The lubricant: viscosity and density as functions of pressure."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehl.errors import EhlInputError, EhlWarning, Fault, number_fault

__all__ = ["Lubricant"]

Array = NDArray[np.float64]

ROELANDS_PRESSURE = 1.0 / 5.1e-9  # p0 [Pa]
ROELANDS_LN_VISCOSITY = -9.67  # ln of the viscosity at the pole of Roelands' law [ln(Pa s)]
_DENSITY_RISE = 0.6e-9  # 1/Pa
_DENSITY_LIMIT = 1.7e-9  # 1/Pa


@dataclass(frozen=True)
class Lubricant:
    """A Newtonian, isothermal lubricant.

    Viscosity (Roelands 1966) and density (Dowson and Higginson 1966):

    ``eta = eta0 exp{(alpha p0 / z) [(1 + p/p0)^z - 1]}``, ``p0 = 1/5.1e-9 Pa``,
    ``rho/rho0 = 1 + 0.6e-9 p / (1 + 1.7e-9 p)``.

    With the derived index ``z = alpha p0 / (ln eta0 + 9.67)`` the first is Roelands' law in its usual form;
    z = 1 is Barus' law, alpha = 0 a constant viscosity. A given z keeps alpha as the slope at ambient
    pressure.

    Parameters
    ----------
    viscosity : float
        eta0 at ambient pressure [Pa s].
    pressure_viscosity : float
        alpha = d ln(eta)/dp at ambient pressure [1/Pa]; 0 for a constant viscosity.
    density : float
        rho0 at ambient pressure [kg/m^3]. The steady film depends on rho/rho0 only.
    roelands_z : float, optional
        Roelands' index z [-]; derived from eta0 and alpha when not given.
    compressible : bool
        False keeps the density constant.

    Raises
    ------
    EhlInputError
        With every fault at once.

    Warns
    -----
    EhlWarning
        If z lies outside 0.2 to 1, where mineral and synthetic oils are not found.
    """

    viscosity: float
    pressure_viscosity: float
    density: float = 870.0
    roelands_z: float | None = None
    compressible: bool = True

    def __post_init__(self) -> None:
        """Check every field."""
        faults = number_fault("viscosity", self.viscosity, low=0.0, high=1e100, remedy="give eta0 in Pa s")
        faults += number_fault(
            "pressure_viscosity",
            self.pressure_viscosity,
            low=0.0,
            high=1e-6,
            open_low=False,
            remedy="give alpha in 1/Pa, near 2e-8 for mineral oil",
        )
        faults += number_fault("density", self.density, low=0.0, high=1e5, remedy="give rho0 in kg/m^3")
        if not isinstance(self.compressible, bool | np.bool_):
            faults.append(Fault("compressible", repr(self.compressible), "True or False", "choose one"))
        if self.roelands_z is not None:
            faults += number_fault(
                "roelands_z",
                self.roelands_z,
                low=0.0,
                high=2.0,
                remedy="leave it out to derive it from alpha",
            )
        elif not faults and self.pressure_viscosity > 0 and math.log(self.viscosity) <= ROELANDS_LN_VISCOSITY:
            faults.append(
                Fault(
                    "viscosity",
                    repr(self.viscosity),
                    "above 6.3e-5 Pa s where Roelands' index is derived",
                    "give roelands_z",
                )
            )
        if faults:
            raise EhlInputError(faults)
        if self.pressure_viscosity > 0 and not 0.2 <= self.z <= 1.0:
            warnings.warn(
                f"Roelands index z = {self.z:.3g} lies outside 0.2 to 1, where oils are found; "
                "check viscosity and pressure_viscosity",
                EhlWarning,
                stacklevel=3,
            )

    @property
    def z(self) -> float:
        """Roelands' index in use [-]; 1 for a constant viscosity, where it has no effect."""
        if self.roelands_z is not None:
            return self.roelands_z
        if self.pressure_viscosity == 0.0:
            return 1.0
        return (
            self.pressure_viscosity * ROELANDS_PRESSURE / (math.log(self.viscosity) - ROELANDS_LN_VISCOSITY)
        )

    def log_viscosity(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return ln(eta/eta0) and its derivative by p [1/Pa] at the pressures p [Pa], any shape."""
        base = 1.0 + np.asarray(p, dtype=float) / ROELANDS_PRESSURE
        z = self.z
        power = base**z
        exponent = self.pressure_viscosity * ROELANDS_PRESSURE / z * (power - 1.0)
        return exponent, self.pressure_viscosity * power / base

    def density_ratio(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return rho/rho0 and its derivative by p [1/Pa] at the pressures p [Pa], any shape."""
        p = np.asarray(p, dtype=float)
        if not self.compressible:
            return np.ones_like(p), np.zeros_like(p)
        limit = 1.0 + _DENSITY_LIMIT * p
        return 1.0 + _DENSITY_RISE * p / limit, _DENSITY_RISE / limit**2
