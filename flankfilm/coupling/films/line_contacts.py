"""Line contacts that flanks make at places of the path under line loads."""

from __future__ import annotations

from dataclasses import replace

import ehl
import gears
from base import Array
from gears.pair.spur_only import require_spur

__all__ = ["line_contacts", "with_sliding"]


def line_contacts(
    pair: gears.GearPair, rho1: Array, load: Array, speed: float, lubricant: ehl.Lubricant
) -> tuple[ehl.LineContact, ...]:
    """Contacts with the radii and speeds of their places.

    Parameters
    ----------
    pair : gears.GearPair
    rho1 : ndarray, shape (n,)
        Curvature radius of the pinion's flank [m].
    load : ndarray, shape (n,)
        Force per length of face [N/m].
    speed : float
        Of the pinion [rad/s].
    lubricant : ehl.Lubricant

    Raises
    ------
    gears.GeometryError
        Of helical pairs, whose radii are those of the section over cos(beta_b).
    """
    require_spur(pair, "films")
    path = pair.path_at(rho1)
    columns = load, path.entrainment(speed), path.radius
    return tuple(
        ehl.LineContact(
            load=w, entrainment=u, radius=r, reduced_modulus=pair.reduced_modulus, lubricant=lubricant
        )
        for w, u, r in zip(*(column.tolist() for column in columns), strict=True)
    )


def with_sliding(
    pair: gears.GearPair, rho1: Array, contacts: tuple[ehl.LineContact, ...], speed: float
) -> tuple[ehl.LineContact, ...]:
    """Contacts with the sliding speeds of their places (n,) [m] as well, which heat them."""
    slides = pair.path_at(rho1).sliding(speed).tolist()
    return tuple(replace(contact, sliding=slip) for contact, slip in zip(contacts, slides, strict=True))
