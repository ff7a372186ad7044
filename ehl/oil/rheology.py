"""Laws of viscosity and density: what a lubricant does under pressure.

A law gives the logarithm of eta/eta0, or rho/rho0, together with the derivative by pressure, so that Newton's
method stays exact whatever the law. A new law is a new class with these two methods; nothing else changes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from base import Array

ROELANDS_PRESSURE = 1.0 / 5.1e-9  # p0 [Pa]
ROELANDS_LN_VISCOSITY = -9.67  # ln of the viscosity at the pole of Roelands' law [ln(Pa s)]
_DENSITY_RISE = 0.6e-9  # 1/Pa
_DENSITY_LIMIT = 1.7e-9  # 1/Pa


class ViscosityLaw(Protocol):
    """Rise of viscosity with pressure.

    Shear thinning and heat enter at the same place: the flux takes ln(1/fluidity) of each node and its slope,
    so a law that also takes a shear rate or a temperature adds arguments here and terms to that slope.
    """

    @property
    def slope(self) -> float:
        """D ln(eta)/dp at ambient pressure, alpha [1/Pa]."""

    @property
    def reliable_below(self) -> float:
        """Pressure above which the law is an extrapolation [Pa]."""

    def log_ratio(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return ln(eta/eta0) and its derivative by p [1/Pa] at the pressures p [Pa], any shape."""


class DensityLaw(Protocol):
    """Rise of density with pressure."""

    def ratio(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return rho/rho0 and its derivative by p [1/Pa] at the pressures p [Pa], any shape."""


def roelands_index(ln_viscosity: float, alpha: float) -> float:
    """Index z = alpha p0/(ln eta0 + 9.67) that makes alpha the slope of Roelands' law at ambient pressure."""
    return alpha * ROELANDS_PRESSURE / (ln_viscosity - ROELANDS_LN_VISCOSITY)


@dataclass(frozen=True)
class Roelands:
    """``ln(eta/eta0) = (alpha p0/z) [(1 + p/p0)^z - 1]``, p0 = 1/5.1e-9 Pa.

    With z from :func:`ehl.oil.rheology.roelands_index` this is Roelands' law in its usual form,
    ``(ln eta0 + 9.67) [(1 + 5.1e-9 p)^z - 1]``.

    Parameters
    ----------
    alpha : float
        d ln(eta)/dp at ambient pressure [1/Pa].
    z : float
        Index [-]; oils lie between 0.2 and 1.

    References
    ----------
    C. J. A. Roelands, Correlational aspects of the viscosity-temperature-pressure relationship of lubricating
    oils, thesis, Delft (1966).
    """

    reliable_below = 1e9  # [Pa]

    alpha: float
    z: float

    @property
    def slope(self) -> float:
        """Alpha [1/Pa]."""
        return self.alpha

    def log_ratio(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return ln(eta/eta0) and its derivative."""
        base = 1.0 + np.asarray(p, dtype=float) / ROELANDS_PRESSURE
        power = base**self.z
        return self.alpha * ROELANDS_PRESSURE / self.z * (power - 1.0), self.alpha * power / base


@dataclass(frozen=True)
class Barus:
    """``ln(eta/eta0) = alpha p``: good below some 0.2 GPa, far too viscous beyond.

    Parameters
    ----------
    alpha : float
        [1/Pa].

    References
    ----------
    C. Barus, Isothermals, isopiestics and isometrics relative to viscosity, American Journal of Science 45
    (1893) 87-96.
    """

    reliable_below = 5e8  # [Pa]

    alpha: float

    @property
    def slope(self) -> float:
        """Alpha [1/Pa]."""
        return self.alpha

    def log_ratio(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return ln(eta/eta0) and its derivative."""
        p = np.asarray(p, dtype=float)
        return self.alpha * p, np.full_like(p, self.alpha)


@dataclass(frozen=True)
class ConstantViscosity:
    """The viscosity does not change with pressure."""

    slope = 0.0
    reliable_below = math.inf  # no limit: a constant viscosity is a choice, not a fit

    def log_ratio(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return zeros."""
        p = np.asarray(p, dtype=float)
        return np.zeros_like(p), np.zeros_like(p)


@dataclass(frozen=True)
class DowsonHigginson:
    """``rho/rho0 = 1 + 0.6e-9 p/(1 + 1.7e-9 p)``, fitted to mineral oil.

    References
    ----------
    D. Dowson and G. R. Higginson, Elasto-hydrodynamic Lubrication, Pergamon (1966).
    """

    def ratio(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return rho/rho0 and its derivative."""
        p = np.asarray(p, dtype=float)
        limit = 1.0 + _DENSITY_LIMIT * p
        return 1.0 + _DENSITY_RISE * p / limit, _DENSITY_RISE / limit**2


@dataclass(frozen=True)
class ConstantDensity:
    """The density does not change with pressure."""

    def ratio(self, p: ArrayLike) -> tuple[Array, Array]:
        """Return ones and zeros."""
        p = np.asarray(p, dtype=float)
        return np.ones_like(p), np.zeros_like(p)
