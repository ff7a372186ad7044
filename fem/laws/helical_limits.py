"""What the loaded contact of helical pairs does not know, refused all at once."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from base import Faults
from fem.pair.face_setting import FREE_ENDS

if TYPE_CHECKING:
    from fem.laws.flank_forms import FlankForms
    from fem.pair.face_setting import FaceSetting
    from gears import GearPair

__all__ = ["check_helical"]


class Setting(Protocol):
    """What of a ``fem.laws.mesh_setup.MeshSetup`` helical pairs do not have."""

    @property
    def pair(self) -> GearPair:
        """Gears in mesh."""

    @property
    def flanks(self) -> FlankForms:
        """Forms of the flanks."""

    @property
    def beyond_path(self) -> bool:
        """Whether tip edges may touch outside the path."""

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
    if not setup.beyond_path and any(radius != 0.0 for radius in setup.flanks.radii):
        allowed = "must be 0 with a helix whose lines of contact end with the path"
        faults.add(
            "tip_rounding", setup.flanks.radii, allowed, "give beyond_path=True, in which tip edges touch"
        )
    if setup.moving_contact:
        allowed = "must be False with a helix: contacts stay where undeformed teeth touch"
        faults.add("moving_contact", True, allowed, "give moving_contact=False")
    if setup.face.cells > 1 and setup.face.model != FREE_ENDS:
        allowed = f'must be "{FREE_ENDS}" with a helix: there are no walls that it fits'
        faults.add("face_model", repr(setup.face.model), allowed, "leave it out")
