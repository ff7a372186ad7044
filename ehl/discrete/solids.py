"""The bodies that take the film's heat: half-spaces under a heat source that moves over them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from base import Array, Faults, Limit

_LN_LEAST, _LN_STEP, _PLACES = math.log(1e-9), 0.02, 1900  # of the table of the line source, up to 3e7

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


def surface_heating(edges: Array, speed: float, solid: Solid, depth: float) -> Array:
    """Surface temperature in the middle of every cell per heat flux into the surface of every cell [K m2/W], (n, n).

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
    from ehl.kernels.heat_kernels import source_differences

    middle = 0.5 * (edges[1:] + edges[:-1])
    integrals: Array = source_differences(drift * middle, drift * edges, _source_table(), _LN_LEAST, _LN_STEP)
    return integrals / (drift * math.pi * solid.conductivity)


def oscillating_heating(
    still: Array, edges: Array, speed: float, solid: Solid, depth: float, omega: float
) -> Array:
    """Return :func:`surface_heating` (``still``) of fluxes that oscillate as exp(i omega t): complex, (n, n).

    ``exp(u s/2 kappa) K0(q |s|)/(pi k)`` with ``q^2 = (u/2 kappa)^2 + i omega/kappa``: what has passed a source carries
    the heat that it gave then. The ratio of both lines' temperatures is taken at the distance of the cells' middles, at
    a quarter of the cell in its own.
    """
    from scipy.special import kve

    capacity = solid.density * solid.heat_capacity / solid.conductivity
    drift = max(0.5 * abs(speed) * capacity, 1.0 / depth)
    middle = 0.5 * (edges[1:] + edges[:-1])
    far = np.abs(middle[:, None] - middle)
    np.fill_diagonal(far, 0.25 * np.diff(edges))
    fading = np.sqrt(drift**2 + 1j * omega * capacity)
    ratio = kve(0, fading * far) / kve(0, drift * far) * np.exp((drift - fading) * far)
    answer: Array = still * ratio
    return answer


@cache
def _source_table() -> Array:
    """Integral of exp(y) K0(|y|) from 0 to s over ln|s|, with its derivative by ln|s|: rows behind, ahead."""
    from scipy.special import k0e, k1e

    y = np.exp(_LN_LEAST + _LN_STEP * np.arange(_PLACES))
    fading = np.exp(-2.0 * y)
    behind = y * (k0e(y) + k1e(y)) - 1.0
    ahead = -(y * fading * (k0e(y) - k1e(y)) + 1.0)
    return np.array([behind, y * k0e(y), ahead, -y * fading * k0e(y)])
