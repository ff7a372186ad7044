"""How far shafts give way under the face in a mesh cycle, as figures of records."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fem.contact.shared_contacts import SharedContacts
    from fem.laws.mesh_setup import MeshSetup

__all__ = ["shaft_figures"]


def shaft_figures(setup: MeshSetup, over: SharedContacts, number: int) -> dict[str, Any]:
    """Deflection, tilt and their parts of the transmission error under one torque, by names; nothing of rigid shafts.

    Parameters
    ----------
    setup : MeshSetup
    over : SharedContacts
    number : int
        Of the torque.
    """
    if over.shafts is None:
        return {}
    held, sign = over.shafts.at(number), -1.0 if setup.back else 1.0
    return {
        "shaft_misalignment": held.tilt.T * setup.pair.face_width,
        "shaft_deflection": held.deflection.T,
        "shaft_transmission_error": sign * held.deflection.sum(axis=-1),
        "tilt_transmission_error": sign * held.tilt_touch,
        "shaft_error": float(over.errors.shafts[number]),
        "tilt_error": float(over.errors.tilt[number]),
    }
