"""Share of the load that asperities carry by the film ratio, of surfaces whose asperities are not known.

Zhou and Hoeprich computed contacts of measured profiles of run-in steel, elastic and perfectly plastic, and found the
asperities' share of the load to be a function of the film ratio L, film over the standard deviation of heights of both
surfaces: ``s = exp(-B L^C)``. B and C belong to the profile: a rougher surface carries at larger film ratios.
"""

from __future__ import annotations

import math
from typing import NamedTuple

PROFILES = ((0.16e-6, 2.32, 0.97), (0.24e-6, 1.90, 0.99))
"""sigma [m], B and C of ground steel: raceway and rib of a tapered roller bearing."""


class RatioShare(NamedTuple):
    """Share s of the asperities at a gap."""

    share: float  # [-]
    steep: float  # derivative of ln s by the gap [1/m]
    odds: float  # ln[s/(1-s)]
    odds_steep: float  # and its derivative by the gap [1/m]


def constants(deviation: float) -> tuple[float, float]:
    """B and C of ground steel by sigma [m], straight between the two published profiles and held beyond.

    Examples
    --------
    >>> [constants(sigma) for sigma in (0.1e-6, 0.16e-6, 0.7e-6)]
    [(2.32, 0.97), (2.32, 0.97), (1.9, 0.99)]
    """
    (fine, B_fine, C_fine), (coarse, B_coarse, C_coarse) = PROFILES
    part = min(max((deviation - fine) / (coarse - fine), 0.0), 1.0)
    return B_fine + part * (B_coarse - B_fine), C_fine + part * (C_coarse - C_fine)


def share_by_ratio(gap: float, deviation: float) -> RatioShare:
    """Share of the load that asperities carry beside a film, after Zhou and Hoeprich.

    It depends on the load by the film alone, is 1 without a film, and its odds are exact near 1 and 0.

    Parameters
    ----------
    gap : float
        Central mean gap, more than 0 [m].
    deviation : float
        sigma of both surfaces together [m].

    References
    ----------
    R. S. Zhou and M. R. Hoeprich, Torque of tapered roller bearings, J. Tribol. 113 (1991) 590-597,
    doi:10.1115/1.2920664, equation (29). Constants: P. Wingertszahn, O. Koch, L. Maccioni, F. Concli and B. Sauer,
    Lubricants 11 (2023) 369, doi:10.3390/lubricants11090369, whose bearings' measured torque they serve.

    Examples
    --------
    >>> [round(share_by_ratio(ratio * 4e-7, 4e-7).share, 3) for ratio in (0.01, 0.1, 0.5, 1.0, 2.0, 4.0)]
    [0.98, 0.823, 0.384, 0.15, 0.023, 0.001]
    """
    B, C = constants(deviation)
    bare = B * (gap / deviation) ** C
    steep = C * bare / gap
    film_share = -math.expm1(-bare)
    return RatioShare(math.exp(-bare), -steep, -bare - math.log(film_share), -steep / film_share)
