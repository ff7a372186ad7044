"""Refusal of helical pairs by models whose contacts lie along the face, as those of spur gears do."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from base import Faults
from gears.tooth.errors import GeometryError

if TYPE_CHECKING:
    from gears.pair.pair_geometry import PairGeometry

__all__ = ["check_spur", "require_spur"]

INSTEAD = (
    "give helix_angle = 0 for a spur pair; of helical pairs there are fem.mesh_cycle and, in gears, geometry, sizes, "
    "contact_lines and ISO 6336 (closed_form.iso6336, iso6336_2, iso6336_3, iso6336_face_load, iso6336_transverse_load)"
)
"""What there is of a helical pair."""


def check_spur(faults: Faults, pair: PairGeometry, what: str) -> None:
    """Note a helical pair where `what`, in words, knows spur gears alone."""
    if pair.helix_angle != 0.0:
        value = f"{pair.helix_angle:.6g} rad ({math.degrees(pair.helix_angle):.6g} deg)"
        faults.add("pair.helix_angle", value, f"must be 0 for {what}, made for spur gears", INSTEAD)


def require_spur(pair: PairGeometry, what: str) -> None:
    """Refuse a helical pair where `what`, in words, knows spur gears alone.

    Raises
    ------
    GeometryError
        Of a pair with a helix.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, helix_angle=0.25)
    >>> require_spur(pair, "films")
    Traceback (most recent call last):
    gears.tooth.errors.GeometryError: pair.helix_angle = 0.25 rad (14.3239 deg): must be 0 for films, made for spur ...
    """
    with Faults(GeometryError) as faults:
        check_spur(faults, pair, what)
