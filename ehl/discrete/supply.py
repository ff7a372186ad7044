"""How oil is supplied to the contact: flooded, from a meniscus that stays in place, or as a layer of given thickness.

Upstream of the meniscus the gap is only partly filled: the steady, mass-conserving (Jakobsson-Floberg-Olsson)
condition carries the layer unchanged, rho h (1 - theta) = rho0 h_oil with p = 0, up to the point where the gap is
full. In a steady line contact the flow is the same at every x, so the condition reduces to one free boundary: the
meniscus lies where the film that forms behind it carries away just what the layer brings.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from base import Array, Faults, Limit

_FLOODED = "leave the supply out for a flooded inlet"
_AHEAD = Limit(-1e6, 0.0, "m", f"x in m, ahead of the line of centres; {_FLOODED}", high_open=True)
_LAYER = Limit.above(0.0, 1.0, "m", f"h_oil in m; {_FLOODED}")


@dataclass(frozen=True)
class Meniscus:
    """The gap is full from here on, whatever the load does.

    Parameters
    ----------
    position : float
        x of the meniscus [m], negative: ahead of the line of centres.

    Examples
    --------
    >>> Meniscus(position=-0.3e-3)
    Meniscus(position=-0.0003)
    """

    position: float

    def __post_init__(self) -> None:
        """Check the position."""
        Faults.of(self, {"position": _AHEAD}, "supply.").raise_if_any()


@dataclass(frozen=True)
class OilLayer:
    """Both surfaces together bring this much oil, whatever the load does.

    Parameters
    ----------
    thickness : float
        h_oil, thickness of the layers on both surfaces together at ambient pressure [m], carried with the
        entrainment velocity. A layer thicker than what the flooded inlet takes leaves the contact flooded.

    Examples
    --------
    >>> OilLayer(thickness=0.2e-6)
    OilLayer(thickness=2e-07)
    """

    thickness: float

    def __post_init__(self) -> None:
        """Check the thickness."""
        Faults.of(self, {"thickness": _LAYER}, "supply.").raise_if_any()


Supply = Meniscus | OilLayer


def dry_gap(X: Array) -> Array:
    """Gap of the dry contact beside it [b^2/R], ``[|X| sqrt(X^2-1) - ln(|X| + sqrt(X^2-1))]/2``; X in b.

    References
    ----------
    K. L. Johnson, Contact Mechanics, Cambridge University Press (1985), section 4.2(c).
    """
    X = np.maximum(np.abs(X), 1.0)
    root = np.sqrt(X**2 - 1.0)
    gap: Array = 0.5 * (X * root - np.log(X + root))
    return gap


def _pumping(film: float) -> tuple[Array, Array]:
    """Pressure that Grubin's inlet pumps up over a distance: distances ahead of -1 and the integral to there.

    The integral of (H - q)/H^3 over the dry contact's gap laid on a film q.
    """
    scale = min(film ** (2.0 / 3.0), math.sqrt(film))
    distance = scale * np.geomspace(1e-7, 1e5, 400)
    gap = dry_gap(1.0 + distance)
    rise = gap / (film + gap) ** 3 * distance
    steps = 0.5 * (rise[1:] + rise[:-1]) * math.log(1e12) / 399
    return distance, np.concatenate([[0.0], np.cumsum(steps)])


def starved_film(flooded: float, distance: float) -> float:
    """Estimate of the film [b^2/R] behind a meniscus at a distance [b] ahead of the dry contact.

    Grubin's inlet: the same pressure has to be pumped up as in the flooded inlet, over a shorter distance.
    """
    need = _pumping(flooded)[1][-1]
    low, high = math.log(1e-12 * flooded), math.log(flooded)
    for _ in range(24):
        middle = 0.5 * (low + high)
        distances, pumped = _pumping(math.exp(middle))
        enough = float(np.interp(distance, distances, pumped)) > need
        low, high = (middle, high) if enough else (low, middle)
    return math.exp(low)


def inlet_of_layer(flooded: float, film: float) -> float:
    """Estimate of the distance [b] of the meniscus that leaves a film [b^2/R] thinner than the flooded one."""
    need = _pumping(flooded)[1][-1]
    distance, pumped = _pumping(film)
    return float(np.interp(need, pumped, distance))
