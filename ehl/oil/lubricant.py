"""The lubricant: viscosity and density at ambient pressure, and their laws under pressure."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Faults, Limit, RangeWarning
from ehl.oil.measured import MeasuredViscosity
from ehl.oil.rheology import (
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

_POLE = 138.0  # temperature at which Roelands' viscosity is infinite [K]

LIMITS = {
    "viscosity": Limit.above(0.0, 1e100, "Pa s", "give eta0 in Pa s"),
    "pressure_viscosity": Limit(0.0, 1e-6, "1/Pa", "give alpha in 1/Pa, near 2e-8 for mineral oil"),
    "density": Limit.above(0.0, 1e5, "kg/m3", "give rho0 in kg/m3"),
    "roelands_z": Limit.above(0.0, 2.0, remedy="leave it out to derive it from alpha"),
    "temperature": Limit(150.0, 1000.0, "K", "give it in K: 353.15 is 80 degC"),
    "viscosity_slope": Limit(0.0, 0.5, "1/K", "give -d ln(eta)/dT in 1/K, near 0.04"),
    "conductivity": Limit.above(0.0, 10.0, "W/(m K)", "near 0.14 for oils"),
    "heat_capacity": Limit.above(0.0, 1e5, "J/(kg K)", "near 2000 for oils"),
    "expansion": Limit(0.0, 0.01, "1/K", "near 6.5e-4 for oils"),
}
"""What the numbers of a lubricant may be."""

STRESS_LIMITS = {
    "eyring_stress": Limit.above(0.0, 1e12, "Pa", "5e6 to 1e7 is usual; leave it out for a Newtonian oil"),
    "limiting_shear_ratio": Limit.above(0.0, 1.0, remedy="0.03 to 0.06 is usual; leave it out for no limit"),
}
"""What its numbers of shear may be, where they are given."""


@dataclass(frozen=True)
class Lubricant:
    """A lubricant: viscosity and density under pressure, and what shear and heat make of them.

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
        Another law; its slope at ambient pressure has to be ``pressure_viscosity``. A table: see `measured`.
    density_law : DensityLaw, optional
        Another law than Dowson and Higginson's.
    temperature : float
        T0 at which viscosity and density are given [K].
    viscosity_slope : float
        beta = -d ln(eta)/dT at T0 and ambient pressure [1/K]; 0 for none.
    conductivity : float
        k [W/(m K)].
    heat_capacity : float
        c at constant pressure [J/(kg K)].
    expansion : float
        Thermal expansion by volume [1/K].
    eyring_stress : float, optional
        tau0 of sinh shear thinning [Pa]; Newtonian when not given. Like all of these but the laws it is
        read by :func:`ehl.solve_thermal` alone: :func:`ehl.solve` is isothermal and Newtonian.
    limiting_shear_ratio : float, optional
        Maximum mean shear stress over the pressure [-]; no limit when not given.

    Raises
    ------
    InputError
        With every fault at once.

    Warns
    -----
    RangeWarning
        If z lies outside 0.2 to 1, where mineral and synthetic oils are not found.

    Examples
    --------
    >>> oil = Lubricant(viscosity=0.06, pressure_viscosity=22.6e-9, density=910.0)
    >>> round(oil.z, 3)
    0.646
    """

    viscosity: float
    pressure_viscosity: float
    density: float = 870.0
    roelands_z: float | None = None
    compressible: bool = True
    viscosity_law: ViscosityLaw | None = None
    density_law: DensityLaw | None = None
    temperature: float = field(default=313.15, repr=False)
    viscosity_slope: float = field(default=0.04, repr=False)
    conductivity: float = field(default=0.14, repr=False)
    heat_capacity: float = field(default=2000.0, repr=False)
    expansion: float = field(default=6.5e-4, repr=False)
    eyring_stress: float | None = field(default=None, repr=False)
    limiting_shear_ratio: float | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        """Check every field."""
        with Faults.of(self, LIMITS) as faults:
            if not isinstance(self.compressible, bool | np.bool_):
                faults.add("compressible", self.compressible, "must be True or False")
            for name, limit in STRESS_LIMITS.items():
                if getattr(self, name) is not None:
                    faults.number(name, getattr(self, name), limit)
            self._check_laws(faults)
            derived = not faults.found and self.viscosity_law is None and self.roelands_z is None
            if derived and self.pressure_viscosity > 0 and math.log(self.viscosity) <= ROELANDS_LN_VISCOSITY:
                allowed = "must be more than 6.3e-5 Pa s where Roelands' index is derived from it"
                faults.add("viscosity", self.viscosity, allowed, "give roelands_z")
        if isinstance(self.law, Roelands) and not 0.2 <= self.z <= 1.0:
            warnings.warn(
                f"Roelands index z = {self.z:.3g} lies outside 0.2 to 1, where oils are found; "
                "check viscosity and pressure_viscosity",
                RangeWarning,
                stacklevel=3,
            )

    def _check_laws(self, faults: Faults) -> None:
        """Note the faults of given laws."""
        if self.viscosity_law is not None:
            if self.roelands_z is not None:
                allowed = "must be left out beside a given law"
                faults.add("roelands_z", self.roelands_z, allowed, "put the index into the law")
            slope = self.viscosity_law.slope
            if not math.isclose(slope, self.pressure_viscosity, rel_tol=1e-6):
                allowed = f"must be {slope!r}, the slope of the given law at ambient pressure"
                remedy = "the film's groups are built on it"
                faults.add("pressure_viscosity", self.pressure_viscosity, allowed, remedy)
        if self.density_law is not None and not self.compressible:
            allowed = "must be True beside a given density law"
            faults.add("compressible", False, allowed, "leave one of them out")

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

    @property
    def table(self) -> MeasuredViscosity | None:
        """Table that the viscosity is read from; None with a law."""
        return self.viscosity_law if isinstance(self.viscosity_law, MeasuredViscosity) else None

    @classmethod
    def measured(cls, table: MeasuredViscosity, density: float = 870.0, **others: Any) -> Lubricant:
        """Build an oil from a table of its viscosity; numbers and slopes at the table's reference temperature follow.

        Parameters
        ----------
        table : MeasuredViscosity
            Over pressure and temperature.
        density : float
            rho0 at ambient pressure and the table's reference temperature [kg/m^3].
        **others
            As of the constructor: conductivity, heat_capacity, expansion, eyring_stress and so on.

        Examples
        --------
        >>> from ehl import MeasuredViscosity
        >>> rows = ((0.1, 0.02), (20.0, 1.5), (900.0, 40.0))
        >>> oil = Lubricant.measured(MeasuredViscosity((0.0, 5e8, 1e9), (313.15, 353.15), rows, at=353.15))
        >>> round(oil.viscosity, 4), round(oil.at_temperature(313.15).viscosity, 4)
        (0.02, 0.1)
        """
        return cls(
            table.ambient,
            table.slope,
            density,
            viscosity_law=table,
            temperature=table.reference,
            viscosity_slope=table.cooling,
            **others,
        )

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

    def hot_log_viscosity(self, p: ArrayLike, T: ArrayLike) -> tuple[Array, Array]:
        """Return ln(eta/eta0) and its derivative by p [1/Pa] at pressures [Pa] and temperatures [K].

        ``ln eta = -9.67 + (ln eta(p, T0) + 9.67) [(T - 138)/(T0 - 138)]^-S0``, S0 = beta (T0 - 138)/(ln eta0 + 9.67):
        Roelands' law where eta(p, T0) is, and the same fan of lines for other laws of pressure.

        References
        ----------
        C. J. A. Roelands, thesis, Delft (1966).
        """
        ratio, slope = self.law.log_ratio(p)
        hot, cooling, _ = self.warmed(ratio, T, p)
        return hot, slope * cooling

    def warmed(self, ratio: ArrayLike, T: ArrayLike, p: ArrayLike) -> tuple[Array, Array, Array]:
        """Take ln(eta/eta0) at T0 to temperatures [K]; also its derivative by itself and -d ln(eta)/dT [1/K].

        A table is read at the pressures p [Pa]; a law needs them not.
        """
        if self.table is not None:
            hot, here = self.table.read(p, T), self.table.read(p, self.temperature)
            ln_ratio = hot.ln_viscosity - math.log(self.viscosity)
            return ln_ratio, hot.by_pressure / here.by_pressure, -hot.by_temperature
        above = math.log(self.viscosity) - ROELANDS_LN_VISCOSITY
        exponent = self.viscosity_slope * (self.temperature - _POLE) / above
        from_pole = np.asarray(T, dtype=float) - _POLE
        cooling = (from_pole / (self.temperature - _POLE)) ** -exponent
        above_warm = (above + np.asarray(ratio, dtype=float)) * cooling
        return above_warm - above, cooling, exponent * above_warm / from_pole

    def at_temperature(self, T: float) -> Lubricant:
        """Return the same oil by its numbers at another temperature [K].

        Viscosity, its slopes by pressure and temperature and the density follow the laws that `hot_log_viscosity` and
        the expansion state; heat capacity, conductivity and stresses stay.

        Examples
        --------
        >>> oil = Lubricant(0.075, 19.6e-9, 910.0, temperature=353.15)
        >>> round(oil.at_temperature(363.15).viscosity, 4)
        0.0513
        """
        if self.temperature == T:
            return self
        if self.table is not None:
            law = self.table.at_temperature(T)
            return replace(
                self,
                viscosity=law.ambient,
                pressure_viscosity=law.slope,
                viscosity_law=law,
                density=self.density * (1.0 - self.expansion * (T - self.temperature)),
                temperature=T,
                viscosity_slope=law.cooling,
            )
        ratio, pressure_viscosity = (float(value) for value in self.hot_log_viscosity(0.0, T))
        above = math.log(self.viscosity) - ROELANDS_LN_VISCOSITY
        steeper = (1.0 + ratio / above) * (self.temperature - _POLE) / (T - _POLE)
        return replace(
            self,
            viscosity=self.viscosity * math.exp(ratio),
            pressure_viscosity=pressure_viscosity,
            density=self.density * (1.0 - self.expansion * (T - self.temperature)),
            temperature=T,
            viscosity_slope=self.viscosity_slope * steeper,
        )

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
        ehl.oil.oil_grades.graded_oil : equations, ranges and sources.
        """
        from ehl.oil.oil_grades import graded_oil

        oil = graded_oil(vg, temperature, viscosity_index, base, density_15)
        return cls(
            oil.viscosity,
            oil.pressure_viscosity,
            oil.density,
            compressible=compressible,
            temperature=temperature,
            viscosity_slope=oil.viscosity_slope,
            conductivity=oil.conductivity,
            heat_capacity=oil.heat_capacity,
            expansion=oil.expansion,
            limiting_shear_ratio=oil.limiting_shear_ratio,
        )
