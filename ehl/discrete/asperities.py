"""Rough surfaces: mean gap and distance of the mean planes, and the pressure that asperities carry at either."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Faults, InputError, Limit, RangeWarning
from ehl.discrete.film_ratio import share_by_ratio

LAWS = ("greenwood-tripp", "greenwood-williamson", "zhou-hoeprich")
LIMITS = {
    "deviation": Limit.above(0.0, 1e-3, "m", "sigma in m, 1e-7 is a tenth of a micrometre"),
    "density": Limit.above(0.0, 1e18, "1/m2", "1e10 to 1e12 are usual"),
    "tip_radius": Limit.above(0.0, 1.0, "m", "1e-6 to 1e-4 are usual"),
    "offset": Limit(0.0, 3.0, remedy="1.15 is usual"),
}
"""What the numbers of a roughness may be."""

DRAWN = Limit.above(0.0, 1e-3, "m", "Ra or Rz in m, 4e-7 is Ra 0.4")
"""What a roughness on a drawing may be."""

ROUGHNESS_NUMBER = (0.03, 0.05)
"""n beta sigma of ground and honed steel, after Greenwood and Tripp."""

USUAL_NUMBER = 0.04
"""n beta sigma where the density of asperities is not known."""

USUAL_SLENDERNESS = 1e-3
"""sigma/beta where the asperities' tip radius is not known; 1e-4 to 1e-2 are found."""

MEAN_OVER_DEVIATION = math.sqrt(2.0 / math.pi)
"""Ra over the standard deviation, of heights with normal distribution."""

PEAKS_OVER_MEAN = 6.0
"""Rz over Ra after ISO 6336-2; 4 to 10 are measured."""

_FAR = 8.0  # standard deviations beyond which no asperity is met
_NO_GAP = 1e-250  # mean gap over sigma below which the distance of the planes stays
_TOUCHING = 1.0 / math.sqrt(2.0 * math.pi)  # mean gap over sigma of mean planes that meet
_ROUNDS = 60


def height_integral(n: float, x: ArrayLike) -> Array:
    """Greenwood's F_n(x), the integral of (s - x)^n phi(s) over s > x, phi the normal density.

    ``F_n(x) = Gamma(n+1)/sqrt(2 pi) exp(-x^2/4) D_{-n-1}(x)`` with the parabolic cylinder function D.

    Parameters
    ----------
    n : float
        3/2 for one rough surface (Greenwood and Williamson), 5/2 for two (Greenwood and Tripp).
    x : array_like
        Separation of the planes over the standard deviation of heights [-], any sign.
    """
    return _height_integral(n, x)[0]


def _height_integral(n: float, x: ArrayLike) -> tuple[Array, Array]:
    """F_n(x) and its derivative -n F_{n-1}(x), 0 where no asperity is met."""
    from scipy.special import pbdv

    x = np.asarray(x, dtype=float)
    near = np.minimum(x, _FAR)
    cylinder, slope = pbdv(-n - 1.0, near)
    scale = math.gamma(n + 1.0) / math.sqrt(2.0 * math.pi) * np.exp(-0.25 * near * near) * (x < _FAR)
    return scale * cylinder, scale * (slope - 0.5 * near * cylinder)


def plane_distance(gap: float) -> tuple[float, float]:
    """Distance t of the mean planes at a mean gap, both over sigma [-], and its derivative by the gap.

    ``gap = int_-t^inf (t + z) phi(z) dz = t Phi(t) + phi(t)``: the volume that normal heights leave between the mean
    planes, truncated where they touch. The gap is positive, the distance any number; above three sigma they are one.

    References
    ----------
    N. Patir and H. S. Cheng, An average flow model for determining effects of three-dimensional roughness on partial
    hydrodynamic lubrication, J. Lubr. Technol. 100 (1978) 12-17, doi:10.1115/1.3453103.

    Examples
    --------
    >>> [round(value, 3) for value in plane_distance(0.4)]
    [0.002, 1.997]
    """
    if gap >= _FAR:
        return gap, 1.0
    gap = max(gap, _NO_GAP)
    # ln of the gap is concave: Newton's method climbs to the root from below, where 0 leaves phi(0)
    t = gap - _TOUCHING if gap > _TOUCHING else -math.sqrt(-2.0 * math.log(gap))
    for _ in range(_ROUNDS):
        opening, free = _open(t)
        step = math.log(gap / opening) * opening / free
        t += step
        if abs(step) < 1e-12:
            break
    return t, 1.0 / _open(t)[1]


def _open(t: float) -> tuple[float, float]:
    """Mean gap of planes at a distance, over sigma, and the share of the area where there is one."""
    density = math.exp(-0.5 * t * t) / math.sqrt(2.0 * math.pi)
    if t >= 0.0:
        free = 0.5 * math.erfc(-t / math.sqrt(2.0))
        return t * free + density, free
    from scipy.special import erfcx

    mills = math.sqrt(0.5 * math.pi) * float(erfcx(-t / math.sqrt(2.0)))  # area over density
    return density * (1.0 + t * mills), density * mills


@dataclass(frozen=True)
class Roughness:
    """Both surfaces together, as statistical asperity models see them.

    Pressure of the asperities at a distance d of the mean planes of heights, x = (d - c sigma)/sigma:

    - ``"greenwood-tripp"``: ``(8 sqrt(2)/15) pi (n beta sigma)^2 sqrt(sigma/beta) E' F_5/2(x)``, two rough
      surfaces;
    - ``"greenwood-williamson"``: ``(2/3) n sqrt(beta) sigma^(3/2) E' F_3/2(x)``, one rough surface on a smooth one.

    - ``"zhou-hoeprich"``: by no asperities, but by the share of the load that measured profiles were found to carry at
      a film ratio, see :func:`ehl.discrete.film_ratio.share_by_ratio`; density and tip radius are not read.

    Elastic asperities with heights of normal distribution, so that a given gap has a given pressure: their share falls
    as the load grows, where friction of gears is measured to rise; films with heat warn of it. d may be negative: the
    mean gap under an oil film is positive always, see `plane_distance`. Typical of ground steel: sigma 0.05 to 0.5 um,
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
        ``"greenwood-tripp"``, ``"greenwood-williamson"`` or ``"zhou-hoeprich"``.
    offset : float
        c, distance between the planes of mean height and of mean asperity height over sigma [-]; 1.15.

    Warns
    -----
    RangeWarning
        Where n beta sigma lies outside 0.03 to 0.05.

    References
    ----------
    J. A. Greenwood and J. B. P. Williamson, Proc. R. Soc. Lond. A 295 (1966) 300-319. J. A. Greenwood and
    J. H. Tripp, The contact of two nominally flat rough surfaces, Proc. Inst. Mech. Engrs 185 (1970-71) 625-633.

    Examples
    --------
    >>> ground = Roughness(deviation=0.3e-6, density=1e10, tip_radius=1e-5)
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
        with Faults.of(self, LIMITS, "roughness.") as faults:
            faults.choice("roughness.law", self.law, LAWS)
        low, high = ROUGHNESS_NUMBER
        if self.elastic and not low * (1.0 - 1e-9) <= self.number <= high * (1.0 + 1e-9):
            warnings.warn(
                f"roughness: sigma beta eta = {self.number:.3g} lies outside {low:g} to {high:g}, where ground steel "
                "is found; check density and tip radius of the asperities",
                RangeWarning,
                stacklevel=3,
            )

    @classmethod
    def from_drawing(
        cls,
        mean: float | tuple[float, float] | None = None,
        peaks: float | tuple[float, float] | None = None,
        *,
        density: float | None = None,
        tip_radius: float | None = None,
        law: str | None = None,
        offset: float = 1.15,
    ) -> Roughness:
        """Roughness from the values on drawings, Ra or Rz of each flank.

        sigma_i = Ra_i sqrt(pi/2), of normal heights, Ra_i = Rz_i/6; sigma = sqrt(sigma_1^2 + sigma_2^2). Drawings know
        no asperities: unless these or a law are given the load is shared by the film ratio (``"zhou-hoeprich"``). Where
        one of the asperities' numbers is not known, sigma/beta = 1e-3 and n beta sigma = 0.04. Found are 1e-4 to 1e-2
        and 0.03 to 0.05, so that the pressure of the asperities is uncertain by a factor of five up and down; Rz/Ra is
        4 to 10 in measurements.

        Parameters
        ----------
        mean, peaks : float or (float, float)
            Ra or Rz [m], one of them: of both flanks alike, or of either.
        density, tip_radius : float, optional
            n [1/m^2] and beta [m].
        law, offset
            As in the constructor.

        Raises
        ------
        InputError
            With every fault; where not exactly one of Ra and Rz is given.

        References
        ----------
        ISO 6336-2:2006, 12.3.1.3 (Ra = Rz/6). J. A. Greenwood and J. H. Tripp, as above (n beta sigma).

        Examples
        --------
        >>> ground = Roughness.from_drawing(mean=0.4e-6)
        >>> round(1e6 * ground.deviation, 3), round(ground.number, 3)
        (0.709, 0.04)
        """
        with Faults() as faults:
            if (mean is None) == (peaks is None):
                faults.add("roughness", "", "must have Ra or Rz, one of them", "give mean or peaks")
            drawn = peaks if mean is None else mean
            heights = drawn if isinstance(drawn, tuple) else (drawn, drawn)
            each = [faults.number("roughness", height, DRAWN) for height in heights if drawn is not None]
        scale = MEAN_OVER_DEVIATION * (PEAKS_OVER_MEAN if mean is None else 1.0)
        return cls.of_deviation(math.hypot(*each) / scale, density, tip_radius, law, offset)

    @classmethod
    def of_deviation(
        cls,
        deviation: float,
        density: float | None = None,
        tip_radius: float | None = None,
        law: str | None = None,
        offset: float = 1.15,
    ) -> Roughness:
        """Roughness with the usual asperities of its sigma [m] where these are not known; see `from_drawing`.

        Examples
        --------
        >>> Roughness.of_deviation(0.5e-6).tip_radius
        0.0005
        """
        radius = deviation / USUAL_SLENDERNESS if tip_radius is None else tip_radius
        known = deviation > 0.0 and radius > 0.0  # else the constructor refuses it
        usual = USUAL_NUMBER / (radius * deviation) if known else 1.0
        if law is None:
            law = "zhou-hoeprich" if density is None and tip_radius is None else "greenwood-tripp"
        return cls(deviation, usual if density is None else density, radius, law, offset)

    @property
    def elastic(self) -> bool:
        """Whether the load is shared by the asperities' pressure, not by the film ratio."""
        return self.law != "zhou-hoeprich"

    @property
    def number(self) -> float:
        """Roughness number n beta sigma [-]."""
        return self.density * self.tip_radius * self.deviation

    def pressure(self, separation: ArrayLike, reduced_modulus: float) -> tuple[Array, Array]:
        """Pressure of the asperities [Pa] and its derivative by the separation [Pa/m].

        Parameters
        ----------
        separation : array_like
            d, distance of the mean planes [m], any shape, of either sign.
        reduced_modulus : float
            E' [Pa].

        Raises
        ------
        InputError
            Of a law that knows no asperities.
        """
        if not self.elastic:
            raise InputError.at(
                "roughness.law", self.law, "must be a law of asperities", f"one of {LAWS[:2]}"
            )
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
        value, slope = _height_integral(order, x)
        return scale * value, scale / sigma * slope

    def planes(self, gap: float) -> tuple[float, float]:
        """Distance of the mean planes [m] at a mean gap [m], and its derivative by that."""
        distance, slope = plane_distance(gap / self.deviation)
        return self.deviation * distance, slope

    def under_film(self, gap: float, reduced_modulus: float, hertz: float) -> tuple[float, float]:
        """Pressure of the asperities [Pa] beside a film of a mean gap [m], and its derivative by the gap [Pa/m].

        Of E' [Pa]; where the film ratio decides, of the Hertz pressure [Pa].
        """
        if not self.elastic:
            ratio_share = share_by_ratio(gap, self.deviation)
            return hertz * ratio_share.share, hertz * ratio_share.share * ratio_share.steep
        distance, follow = self.planes(gap)
        pressure, slope = self.pressure(distance, reduced_modulus)
        return float(pressure), float(slope * follow)
