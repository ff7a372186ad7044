"""Cells of the face over the positions of a mesh cycle: where they are, and what they bear."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, ClassVar

from base import Array, part, quantity, record
from base.results import EXACT

if TYPE_CHECKING:
    from fem.contact.shared_contacts import SharedContacts
    from fem.laws.mesh_setup import MeshSetup
    from gears import GearPair

__all__ = ["HERTZ", "IN_SINGLE_CELLS", "FaceCells", "of_cells"]

HERTZ = "not estimated: Hertz's law of the cell's line load, whose error is not known in single cells"

IN_SINGLE_CELLS = "not estimated cell by cell; the face-load factor of the cycle has an error"


@record
class FaceCells:
    """Places on the face and their line loads, with which every record over the face begins."""

    headline: ClassVar[tuple[str, ...]] = ()

    face_position: Array = quantity(
        "m", "middles of the cells, 0 at mid-face", "cell", shown="mm", no_error=EXACT
    )
    travel: Array = quantity(
        "m",
        "travel of each pair along the path of contact from A, beyond it where a tip edge touches; nan where a pair "
        "cannot touch",
        "position pair",
        shown="mm",
        no_error=EXACT,
    )
    line_load: Array = quantity(
        "N/m",
        "line load: force per length of face; zero where flanks stand clear",
        "position pair cell",
        shown="N/mm",
        no_error=IN_SINGLE_CELLS,
    )
    pair: GearPair = part("the gears")

    @property
    def cells(self) -> dict[str, Any]:
        """These alone, as keyword arguments of another record of the same cells."""
        return {field.name: getattr(self, field.name) for field in fields(FaceCells)}


def of_cells(setup: MeshSetup, contacts: SharedContacts, number: int, plane: str) -> dict[str, Any]:
    """What records of line loads have in common, over the face and over lines of contact, as keyword arguments.

    Parameters
    ----------
    setup : MeshSetup
    contacts : SharedContacts
    number : int
        Of the torque.
    plane : {"strain", "stress"}
    """
    return {
        "pair": setup.pair,
        "setting": setup.face,
        "plane": plane,
        "error": float(contacts.errors.factor[number]),
        "line_load_error": float(contacts.errors.line_load[number]),
    }
