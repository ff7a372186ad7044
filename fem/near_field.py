"""What a contact itself adds to the regular field: Hertz (McEwen) close by, Flamant beyond, blended between."""

from __future__ import annotations

import numpy as np

from base import Array, record
from fem import flamant
from fem.elasticity import PlaneElasticity
from fem.line_load import FlankPoints

__all__ = ["Contact", "near_field"]

NEAR, FAR = 4.0, 8.0
"""Hertz within NEAR half-widths of a contact, Flamant beyond FAR."""


@record
class Contact:
    """One contact on a gear.

    Attributes
    ----------
    tooth : int
        Counted anticlockwise.
    at : FlankPoints
        Place on the loaded flank (one point).
    line_load : float
        [N/m]
    half_width : float
        Of the pressure [m].
    edge : bool
        Whether a tip edge touches: pressure and half-width are then only indicative.
    """

    tooth: int
    at: FlankPoints
    line_load: float
    half_width: float
    edge: bool = False


def near_field(points: Array, contact: Contact, law: PlaneElasticity, length: float) -> tuple[Array, Array]:
    """Displacement (n, 2) [m] and stress (n, 2, 2) [Pa] of the contact itself, in the tooth's frame."""
    load, inward = contact.at.points[0], contact.at.inward[0]
    a, w = contact.half_width, contact.line_load
    r = np.linalg.norm(points - load, axis=1)
    inside = np.clip((FAR - r / a) / (FAR - NEAR), 0.0, 1.0)
    far = r > 0.5 * a  # inside this Hertz alone counts
    displacement, stress = np.zeros_like(points), np.zeros((len(points), 2, 2))
    displacement[far] = w * flamant.displacement(points[far], load, inward, law, length)
    stress[far] = w * flamant.stress(points[far], load, inward)
    close = inside > 0
    share = inside[close, None]
    spread = _hertz_displacement(points[close], contact, law, length)
    displacement[close] = (1 - share) * displacement[close] + share * spread
    pressed = flamant.hertz_stress(points[close], load, inward, a, 2 * w / (np.pi * a))
    stress[close] = (1 - share[..., None]) * stress[close] + share[..., None] * pressed
    return displacement, stress


def _hertz_displacement(points: Array, contact: Contact, law: PlaneElasticity, length: float) -> Array:
    """Spread Flamant's displacement over the Hertz pressure by Gauss quadrature with weight sqrt(1 - t^2)."""
    n = 24
    angle = np.pi * np.arange(1, n + 1) / (n + 1)
    load, inward = contact.at.points[0], contact.at.inward[0]
    side = np.array([-inward[1], inward[0]])
    total = np.zeros_like(points)
    for t, weight in zip(np.cos(angle), 2 / (n + 1) * np.sin(angle) ** 2, strict=True):
        source = load + t * contact.half_width * side
        # a point that falls on a source is moved by much less than the sources are apart
        apart = points + 1e-3 * contact.half_width * inward
        total += weight * flamant.displacement(apart, source, inward, law, length)
    return contact.line_load * total
