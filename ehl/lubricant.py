"""The lubricant: viscosity and density at ambient pressure, and their laws under pressure."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ehl.errors import EhlInputError, EhlWarning, Fault, number_fault
from ehl.rheology import (
    ROELANDS_LN_VISCOSITY,
    Barus,
    ConstantDensity,
    ConstantViscosity,
    DensityLaw,
    DowsonHigginson,
    Roelands,
    ViscosityLaw,
    roelands_index,
)

__all__ = ["Lubricant"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Lubricant:
    """A Newtonian, isothermal lubricant.

    Viscosity follows Roelands (1966), Barus (1893) or nothing, density Dowson and Higginson (1966) or
    nothing, unless another law is given:

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
    viscosity_law : ViscosityLaw, optional
        Another law; its slope at ambient pressure has to be ``pressure_viscosity``.
    density_law : DensityLaw, optional
        Another law than Dowson and Higginson's.

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
    viscosity_law: ViscosityLaw | None = None
    density_law: DensityLaw | None = None

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
            remedy = "leave it out to derive it from alpha"
            faults += number_fault("roelands_z", self.roelands_z, low=0.0, high=2.0, remedy=remedy)
        faults += self._law_faults()
        if not faults and self._needs_index() and math.log(self.viscosity) <= ROELANDS_LN_VISCOSITY:
            allowed = "above 6.3e-5 Pa s where Roelands' index is derived"
            faults.append(Fault("viscosity", repr(self.viscosity), allowed, "give roelands_z"))
        if faults:
            raise EhlInputError(faults)
        if isinstance(self.law, Roelands) and not 0.2 <= self.z <= 1.0:
            warnings.warn(
                f"Roelands index z = {self.z:.3g} lies outside 0.2 to 1, where oils are found; "
                "check viscosity and pressure_viscosity",
                EhlWarning,
                stacklevel=3,
            )

    def _needs_index(self) -> bool:
        """Whether Roelands' index has to be derived."""
        return self.viscosity_law is None and self.roelands_z is None and self.pressure_viscosity > 0

    def _law_faults(self) -> list[Fault]:
        """Faults of given laws."""
        faults = []
        if self.viscosity_law is not None:
            if self.roelands_z is not None:
                remedy = "put the index into the law"
                faults.append(Fault("roelands_z", repr(self.roelands_z), "absent beside a given law", remedy))
            if not math.isclose(self.viscosity_law.slope, self.pressure_viscosity, rel_tol=1e-6):
                allowed = f"the given law's slope at ambient pressure, {self.viscosity_law.slope!r}"
                remedy = "the film's groups are built on it"
                faults.append(Fault("pressure_viscosity", repr(self.pressure_viscosity), allowed, remedy))
        if self.density_law is not None and not self.compressible:
            allowed = "True beside a given density law"
            faults.append(Fault("compressible", "False", allowed, "leave one of them out"))
        return faults

    @cached_property
    def law(self) -> ViscosityLaw:
        """The viscosity law in use."""
        if self.viscosity_law is not None:
            return self.viscosity_law
        if self.pressure_viscosity == 0.0:
            return ConstantViscosity()
        z = self.roelands_z
        if z is None:
            z = roelands_index(math.log(self.viscosity), self.pressure_viscosity)
        return Barus(self.pressure_viscosity) if z == 1.0 else Roelands(self.pressure_viscosity, z)

    @cached_property
    def compression(self) -> DensityLaw:
        """The density law in use."""
        if self.density_law is not None:
            return self.density_law
        return DowsonHigginson() if self.compressible else ConstantDensity()

    @property
    def z(self) -> float:
        """Roelands' index in use [-]; 1 for Barus' law and a constant viscosity; NaN for other laws."""
        law = self.law
        if isinstance(law, Roelands):
            return law.z
        return 1.0 if isinstance(law, Barus | ConstantViscosity) else math.nan

    def log_viscosity(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return ln(eta/eta0) and its derivative by p [1/Pa] at the pressures p [Pa], any shape."""
        return self.law.log_ratio(p)

    def density_ratio(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return rho/rho0 and its derivative by p [1/Pa] at the pressures p [Pa], any shape."""
        return self.compression.ratio(p)

    @classmethod
    def from_iso_vg(
        cls,
        vg: float,
        temperature: float,
        *,
        viscosity_index: float = 95.0,
        base: str = "mineral",
        density_15: float | None = None,
        compressible: bool = True,
    ) -> Lubricant:
        """Build an oil from its ISO viscosity grade and temperature.

        Parameters
        ----------
        vg : float
            Grade: kinematic viscosity at 40 degC [mm^2/s], by ISO 3448 one of 2, 3, 5, 7, 10, 15, 22, ... 3200.
        temperature : float
            Of the oil at the inlet of the contact [K].
        viscosity_index : float
            By ISO 2909 [-].
        base : str
            ``"mineral"``, ``"pao"`` (polyalphaolefin), ``"ester"`` or ``"pag"`` (polyglycol).
        density_15 : float, optional
            Density at 15 degC [kg/m^3]; typical of the base if not given.
        compressible : bool
            As in the constructor.

        See Also
        --------
        ehl.grades.graded_oil : equations, ranges and sources.
        """
        from ehl.grades import graded_oil

        oil = graded_oil(vg, temperature, viscosity_index, base, density_15)
        return cls(oil.viscosity, oil.pressure_viscosity, oil.density, compressible=compressible)
