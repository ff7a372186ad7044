"""Flash temperature of a line contact in closed form, after Blok."""

from __future__ import annotations

import math

from ehl.discrete.contact import LineContact
from ehl.discrete.solids import STEEL, Solid

_SHAPE = 1.11
"""Maximum rise under an elliptic (Hertz) source over 1/sqrt(width): max of int sqrt(1-s^2)/sqrt(x-s) ds, scaled."""


def blok_flash_temperature(
    contact: LineContact, friction: float, solids: tuple[Solid, Solid] = (STEEL, STEEL)
) -> float:
    """Blok's flash temperature, the maximum rise of the surfaces above their common bulk temperature [K].

    ``1.11 mu w |u1 - u2| / [(B_1 sqrt(u1) + B_2 sqrt(u2)) sqrt(2 b)]``, B = sqrt(k rho c), b the Hertz half-width:
    all heat of friction arises on the surfaces in proportion to the Hertz pressure, and parts so that both are as hot.
    Oil in which the heat arises is hotter, and the surfaces cooler.

    Range: fast sources, u b rho c/(2 k) above some 5 for both surfaces, that move in the same direction.

    Parameters
    ----------
    contact : LineContact
        Load, sliding and both surface speeds.
    friction : float
        Coefficient of friction [-].
    solids : tuple of Solid
        The first and the second body.

    References
    ----------
    H. Blok, The flash temperature concept, Wear 6 (1963) 483-494, doi:10.1016/0043-1648(63)90283-7.

    Examples
    --------
    >>> from ehl import Lubricant
    >>> oil = Lubricant(0.075, 19.6e-9, 860.0)
    >>> contact = LineContact(2e5, 2.5, 6e-3, 2.26e11, oil, sliding=1.0)
    >>> f"{blok_flash_temperature(contact, 0.03):.1f} K"
    '10.7 K'
    """
    taken = sum(
        math.sqrt(solid.conductivity * solid.density * solid.heat_capacity * abs(speed))
        for solid, speed in zip(solids, contact.surface_speeds, strict=True)
    )
    heat = abs(friction) * contact.load * abs(contact.sliding)
    return _SHAPE * heat / (taken * math.sqrt(2.0 * contact.half_width)) if heat > 0.0 else 0.0
