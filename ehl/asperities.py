"""Rough surfaces: the pressure that asperities carry at a separation of the mean planes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Faults, Limit

LAWS = ("greenwood-tripp", "greenwood-williamson")
LIMITS = {
    "deviation": Limit.above(0.0, 1e-3, "m", "sigma in m, 1e-7 is a tenth of a micrometre"),
    "density": Limit.above(0.0, 1e18, "1/m2", "1e10 to 1e12 are usual"),
    "tip_radius": Limit.above(0.0, 1.0, "m", "1e-6 to 1e-4 are usual"),
    "offset": Limit(0.0, 3.0, remedy="1.15 is usual"),
}
"""What the numbers of a roughness may be."""

_FAR = 8.0  # standard deviations beyond which no asperity is met


def height_integral(n: float, x: ArrayLike) -> Array:
    """Greenwood's F_n(x), the integral of (s - x)^n phi(s) over s > x, phi the normal density.

    ``F_n(x) = Gamma(n+1)/sqrt(2 pi) exp(-x^2/4) D_{-n-1}(x)`` with the parabolic cylinder function D.

    Parameters
    ----------
    n : float
        3/2 for one rough surface (Greenwood and Williamson), 5/2 for two (Greenwood and Tripp).
    x : array_like
        Separation of the planes over the standard deviation of heights [-].
    """
    from scipy.special import pbdv

    x = np.asarray(x, dtype=float)
    inside = np.minimum(x, _FAR)
    value = (
        math.gamma(n + 1.0) / math.sqrt(2.0 * math.pi) * np.exp(-0.25 * inside**2) * pbdv(-n - 1.0, inside)[0]
    )
    return np.where(x < _FAR, value, 0.0)


@dataclass(frozen=True)
class Roughness:
    """Both surfaces together, as statistical asperity models see them.

    Pressure of the asperities at a separation h of the mean planes of heights, x = (h - c sigma)/sigma:

    - ``"greenwood-tripp"``: ``(8 sqrt(2)/15) pi (n beta sigma)^2 sqrt(sigma/beta) E' F_5/2(x)``, two rough
      surfaces;
    - ``"greenwood-williamson"``: ``(2/3) n sqrt(beta) sigma^(3/2) E' F_3/2(x)``, one rough surface on a smooth one.

    Elastic asperities with heights of normal distribution. Typical of ground steel: sigma 0.05 to 0.5 um,
    n beta sigma 0.03 to 0.05, sigma/beta 1e-4 to 1e-2.

    Parameters
    ----------
    deviation : float
        sigma, standard deviation of heights, sqrt(sigma1^2 + sigma2^2) [m].
    density : float
        n, asperities per area [1/m^2].
    tip_radius : float
        beta, radius of the asperities' tips [m].
    law : str
        ``"greenwood-tripp"`` or ``"greenwood-williamson"``.
    offset : float
        c, distance between the planes of mean height and of mean asperity height over sigma [-]; 1.15.

    References
    ----------
    J. A. Greenwood and J. B. P. Williamson, Proc. R. Soc. Lond. A 295 (1966) 300-319. J. A. Greenwood and
    J. H. Tripp, The contact of two nominally flat rough surfaces, Proc. Inst. Mech. Engrs 185 (1970-71) 625-633.

    Examples
    --------
    >>> ground = Roughness(deviation=0.3e-6, density=1e11, tip_radius=1e-5)
    >>> pressure, slope = ground.pressure(0.6e-6, reduced_modulus=2.2e11)
    >>> bool(pressure > 0.0), bool(slope < 0.0)
    (True, True)
    """

    deviation: float
    density: float
    tip_radius: float
    law: str = "greenwood-tripp"
    offset: float = 1.15

    def __post_init__(self) -> None:
        """Check every field."""
        with Faults.of(self, LIMITS, "roughness.") as found:
            found.choice("roughness.law", self.law, LAWS)

    def pressure(self, separation: ArrayLike, reduced_modulus: float) -> tuple[Array, Array]:
        """Pressure of the asperities [Pa] and its derivative by the separation [Pa/m].

        Parameters
        ----------
        separation : array_like
            h, distance of the mean planes [m], any shape.
        reduced_modulus : float
            E' [Pa].
        """
        sigma, beta = self.deviation, self.tip_radius
        x = np.asarray(separation, dtype=float) / sigma - self.offset
        if self.law == "greenwood-tripp":
            order = 2.5
            scale = 8.0 * math.sqrt(2.0) / 15.0 * math.pi * (self.density * beta * sigma) ** 2
            scale *= math.sqrt(sigma / beta)
        else:
            order = 1.5
            scale = 2.0 / 3.0 * self.density * math.sqrt(beta) * sigma**1.5
        scale *= reduced_modulus
        # dF_n/dx = -n F_{n-1}
        return (
            scale * height_integral(order, x),
            -scale * order / sigma * height_integral(order - 1.0, x),
        )
