"""What a contact itself adds to the regular field: Hertz (McEwen) close by, Flamant beyond, blended between."""

from __future__ import annotations

import numpy as np

from base import Array, record
from fem.elasticity import flamant
from fem.elasticity.line_load import FlankPoints
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.fields.tip_sector import TipSector

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
    unresolved : float
        Distance from ``corner`` within which stresses are only indicative [m].
    corner : (2,) array, optional
        Where a tip corner presses; the place itself unless given.
    strips : (3, k) array, optional
        Pressure other than Hertz's: middles of strips along the flank, from the place towards the left seen along the
        inward normal [m], their widths [m] and line loads [N/m]; the half-width is then half of what they cover.
    sector : TipSector, optional
        What the pressure stands on where the gear's own corner is near: that takes the place of the near field.
    """

    tooth: int
    at: FlankPoints
    line_load: float
    half_width: float
    unresolved: float = 0.0
    corner: Array | None = None
    strips: Array | None = None
    sector: TipSector | None = None

    @property
    def sharp(self) -> Array:
        """Place about which stresses may be only indicative (2,) [m]."""
        return self.at.points[0] if self.corner is None else self.corner


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
    if contact.strips is None:
        spread = _hertz_displacement(points[close], contact, law, length)
        pressed = flamant.hertz_stress(points[close], load, inward, a, 2 * w / (np.pi * a))
    else:
        spread = _strips_displacement(points[close], contact, contact.strips, law, length)
        pressed = flamant.strips_stress(points[close], load, inward, contact.strips)
    displacement[close] = (1 - share) * displacement[close] + share * spread
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


def _strips_displacement(
    points: Array, contact: Contact, strips: Array, law: PlaneElasticity, length: float
) -> Array:
    """Sum Flamant's displacement over strips, each taken from a little above its middle."""
    load, inward = contact.at.points[0], contact.at.inward[0]
    side = np.array([-inward[1], inward[0]])
    total = np.zeros_like(points)
    for middle, width, force in strips.T:
        apart = points + 0.2 * width * inward
        total += force * flamant.displacement(apart, load + middle * side, inward, law, length)
    return total
