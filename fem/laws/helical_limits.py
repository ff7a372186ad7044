"""What the loaded contact of helical pairs does not know, refused all at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from base import Faults
from fem.pair.face_setting import FREE_ENDS

if TYPE_CHECKING:
    from fem.pair.face_setting import FaceSetting
    from gears import GearPair

__all__ = ["check_helical"]

SPUR = "give helix_angle = 0 for a spur pair, or leave it out"


class Setting(Protocol):
    """What of a ``fem.laws.mesh_setup.MeshSetup`` helical pairs do not have."""

    @property
    def pair(self) -> GearPair:
        """Gears in mesh."""

    @property
    def radii(self) -> tuple[float, ...]:
        """Of rounded tip edges [m]."""

    @property
    def moving_contact(self) -> bool:
        """Whether contacts move."""

    @property
    def face(self) -> FaceSetting:
        """Cells, alignment, shafts."""


def check_helical(faults: Faults, setup: Setting) -> None:
    """Note what a setting asks for that lines of contact across the face do not have."""
    if setup.pair.tight:
        allowed = "must be False with a helix: flanks on one side of the teeth carry the load"
        faults.add("pair.tight", True, allowed, "give backlash")
    if any(radius != 0.0 for radius in setup.radii):
        faults.add("tip_rounding", setup.radii, "must be 0 with a helix", SPUR)
    if setup.moving_contact:
        allowed = "must be False with a helix: contacts stay where undeformed teeth touch"
        faults.add("moving_contact", True, allowed, "give moving_contact=False")
    if setup.face.cells > 1 and setup.face.model != FREE_ENDS:
        allowed = f'must be "{FREE_ENDS}" with a helix: there are no walls that it fits'
        faults.add("face_model", repr(setup.face.model), allowed, "leave it out")
