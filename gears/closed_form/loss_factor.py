"""Tooth loss factor in closed form, after Ohlendorf."""

from __future__ import annotations

import math

from base import Faults
from gears.pair.gear_pair import GearPair
from gears.tooth.errors import GeometryError


def ohlendorf_loss_factor(pair: GearPair) -> float:
    """Tooth loss factor H_V by which power in, friction and power lost by sliding go together, P_V = mu P H_V.

    ``H_V = pi (1/z1 + 1/z2)/cos(beta_b) (1 - eps_alpha + eps_1^2 + eps_2^2)``, eps_1 and eps_2 the parts of the
    contact ratio after and before C: two pairs share the force evenly, one carries it alone, mu is the same everywhere.

    Range: contact ratio below 2, with C where one pair carries.

    Parameters
    ----------
    pair : GearPair

    Raises
    ------
    GeometryError
        For a contact ratio of 2 and more, or C where two pairs share.

    References
    ----------
    H. Ohlendorf, Verlustleistung und Erwaermung von Stirnraedern, thesis, Munich (1958); G. Niemann and H. Winter,
    Maschinenelemente, volume 2. It follows in a few lines: docs/theory/losses.md.

    Examples
    --------
    >>> from gears import Gear
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> f"{ohlendorf_loss_factor(pair):.4f}"
    '0.1239'
    """
    points, pitch = pair.points, pair.base_pitch
    after, before = (points.E - points.C) / pitch, (points.C - points.A) / pitch
    with Faults(GeometryError) as faults:
        if min(after, before) < 0.0 or max(after, before) > 1.0 or after + before >= 2.0:
            parts = f"{before:.3g} before and {after:.3g} after C"
            allowed = "must be 0 to 1 each, where C lies on the path and one pair carries there"
            remedy = "take the loss factor of a computed load share"
            faults.add("contact ratio", parts, allowed, remedy)
    teeth = 1.0 / pair.pinion.teeth + 1.0 / pair.wheel.teeth
    shared = 1.0 - after - before + after**2 + before**2
    return math.pi * teeth * shared / pair.helix.base_cosine
