"""Line contacts that flanks make at places of the path under line loads."""

from __future__ import annotations

from dataclasses import replace

import ehl
import gears
from base import Array

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
        Force per length of face, of helical pairs per length of the line of contact [N/m].
    speed : float
        Of the pinion [rad/s].
    lubricant : ehl.Lubricant

    Notes
    -----
    A line of contact of a helical pair is straight, and at right angles to it the flanks have the radii of the section
    over cos(beta_b). Sliding and entrainment are those of the section: along the line both flanks move by
    w1 r_b1 sin(beta_b), which carries oil and pressure along, but slides nowhere. It is left out.
    """
    path = pair.path_at(rho1)
    columns = load, path.entrainment(speed), path.radius / pair.helix.base_cosine
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
