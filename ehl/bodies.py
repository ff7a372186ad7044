"""The bodies that take the film's heat: half-spaces under a heat source that moves over them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from base import Array, Faults, Limit

_LIMITS = {
    "conductivity": Limit.above(0.0, 1e5, "W/(m K)", "46 for steel"),
    "density": Limit.above(0.0, 1e5, "kg/m3", "7850 for steel"),
    "heat_capacity": Limit.above(0.0, 1e5, "J/(kg K)", "470 for steel"),
}


@dataclass(frozen=True)
class Solid:
    """What a body does with heat.

    Parameters
    ----------
    conductivity : float
        k [W/(m K)].
    density : float
        rho [kg/m3].
    heat_capacity : float
        c [J/(kg K)].

    Examples
    --------
    >>> Solid(46.0, 7850.0, 470.0)
    Solid(conductivity=46.0, density=7850.0, heat_capacity=470.0)
    """

    conductivity: float
    density: float
    heat_capacity: float

    def __post_init__(self) -> None:
        """Check every field."""
        Faults.of(self, _LIMITS, "solid.").raise_if_any()


STEEL = Solid(46.0, 7850.0, 470.0)


def surface_heating(x: Array, speed: float, solid: Solid, depth: float) -> Array:
    """Surface temperature at every node per heat flux into the surface around every node [K m2/W], (n, n).

    Jaeger's moving line source on a half-space, ``exp(u s/2 kappa) K0(|u s|/2 kappa)/(pi k)``, exact at any speed
    of the surface; far behind the source it is Blok's ``1/sqrt(pi k rho c u s)``. A surface slower than
    2 kappa/depth warms for ever in two dimensions: its temperature is then measured against that at the
    distance ``depth``.

    References
    ----------
    J. C. Jaeger, Moving sources of heat and the temperature at sliding contacts, Journal and Proceedings of the
    Royal Society of New South Wales 76 (1942) 203-224.
    """
    drift = 0.5 * speed * solid.density * solid.heat_capacity / solid.conductivity
    if abs(drift) * depth < 1.0:
        drift = float(np.copysign(1.0 / depth, drift))
    edges = np.concatenate([x[:1], 0.5 * (x[1:] + x[:-1]), x[-1:]])
    found: Array = -np.diff(_source_integral(drift * (x[:, None] - edges)), axis=1)
    return found / (drift * math.pi * solid.conductivity)


def _source_integral(s: Array) -> Array:
    """Integral of exp(y) K0(|y|) from 0 to s, of either sign."""
    from scipy.special import k0e, k1e

    y = np.maximum(np.abs(s), 1e-300)
    behind = y * (k0e(y) + k1e(y)) - 1.0
    ahead = -(y * np.exp(-2.0 * y) * (k0e(y) - k1e(y)) + 1.0)
    return np.where(s == 0.0, 0.0, np.where(s > 0.0, behind, ahead))
