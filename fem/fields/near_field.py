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
    """Displacement (n, 2) [m] and xx, yy, xy of the stress (n, 3) [Pa] by the contact itself, in the tooth's frame."""
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
        sources, total = _hertz_sources(a), w
        pressed = flamant.hertz_stress(points[close], load, inward, a, 2 * w / (np.pi * a))
    else:
        middle, width, force = contact.strips
        # a little above the middle of each
        sources, total = np.stack([middle, 0.2 * width, force]), 1.0
        pressed = flamant.strips_stress(points[close], load, inward, contact.strips)
    spread = total * _spread(points[close], load, inward, sources, law, length)
    displacement[close] = (1 - share) * displacement[close] + share * spread
    stress[close] = (1 - share[..., None]) * stress[close] + share[..., None] * pressed
    return displacement, stress[:, [0, 1, 0], [0, 1, 1]]


def _hertz_sources(half_width: float, count: int = 24) -> Array:
    """Sources of Hertz's pressure by Gauss quadrature with weight sqrt(1 - t^2), as of ``_spread``."""
    angle = np.pi * np.arange(1, count + 1) / (count + 1)
    # a point that falls on a source is moved by much less than the sources are apart
    above = np.full(count, 1e-3 * half_width)
    return np.stack([np.cos(angle) * half_width, above, 2 / (count + 1) * np.sin(angle) ** 2])


def _spread(
    points: Array, load: Array, inward: Array, sources: Array, law: PlaneElasticity, length: float
) -> Array:
    """Flamant's displacement by several loads (3, k): places along the flank, distances above them, and sizes."""
    place, above, size = sources[:, :, None, None]
    side = np.array([-inward[1], inward[0]])
    each = flamant.displacement(points + above * inward, load + place * side, inward, law, length)
    return np.asarray(np.sum(size * each, axis=0))
