"""Mesh stiffness for each reference of the deflection, beside ISO 6336-1, and the parts of the deflection."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

import fem
import gears
from base import Array, Cost, InputError, Stopwatch, quantity, record
from gears.closed_form.record import STANDARD

if TYPE_CHECKING:
    from flankfilm.coupling.cycle import MeshCycle

MEANINGS: Mapping[str, str] = {
    "bore": "the rotation of the bores: all wind-up of the hubs included",
    "body": "the rotation of the bodies, whose inertia balances the torque",
    "teeth": "the rotation of the root circles: no wind-up of the hubs",
}
"""What a deflection is measured against, in words."""

PARTS: Mapping[str, str] = {
    "hertz": "Hertz contact",
    "pinion": "pinion, tooth and body under it",
    "wheel": "wheel, tooth and body under it",
    "coupling": "coupling of teeth through the bodies",
    "windup": "wind-up of the hubs",
    "support": "supports",
    "rest": "gaps, tip edges, contacts that move and loads that vary along the face",
}
"""Parts of a deflection, in words."""


IN_PARTS = "not estimated in parts; the whole has the error of the mean secant stiffness"


@record
class StiffnessReferences:
    """Mean mesh stiffness of a dry pair by every reference of the deflection, and the parts of the latter."""

    headline = ("iso_mesh_stiffness",)

    reference: tuple[str, ...] = quantity("", "what the deflection is measured against", "reference")
    mean_stiffness: Array = quantity(
        "N/m",
        "mean mesh stiffness (tangent) for each reference of the deflection",
        "reference",
        error="mean_error",
    )
    mean_secant_stiffness: Array = quantity(
        "N/m",
        "mean mesh stiffness (secant) for each reference of the deflection",
        "reference",
        error="mean_error",
    )
    mean_error: Array = quantity(
        "1", "estimated relative numerical error of these means of the stiffness", "reference"
    )
    iso_mesh_stiffness: float = quantity(
        "N/m", "mesh stiffness c_gamma by ISO 6336-1, of the face width", no_error=STANDARD
    )
    deflection: Mapping[str, float] = quantity(
        "m",
        "mean over the cycle of a part of the deflection against the bores",
        shown="um",
        no_error=IN_PARTS,
    )
    error: float
    cost: Cost
    converged: bool = True
    message: str = ""


def stiffness_references(
    pair: gears.GearPair,
    cycle: MeshCycle,
    compliance: fem.Compliance,
    bore_inertia: tuple[float, float] = (0.0, 0.0),
) -> StiffnessReferences:
    """Measure the deflection of a loaded contact against bores, bodies and teeth; the forces are the same.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
        Of coupled pairs by finite elements, dry.
    compliance : fem.Compliance
        That it was computed with.
    bore_inertia : (float, float)
        What turns with the bores of pinion and wheel beside their own bodies [kg m2].

    Raises
    ------
    InputError
        For a cycle by another model.

    Examples
    --------
    >>> import fem
    >>> from flankfilm.coupling import mesh_cycle
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> bodies = fem.compliance(pair)
    >>> found = stiffness_references(pair, mesh_cycle(pair, 600.0, positions=40, compliance=bodies), bodies)
    >>> found.reference, [round(float(k) / 40e6, 1) for k in found.mean_stiffness]  # N/(mm um)
    (('bore', 'body', 'teeth'), [21.4, 24.3, 24.7])
    """
    from fem.breakdown import deflection_parts
    from gears.closed_form import iso6336

    watch = Stopwatch()
    if cycle.contact is None:
        allowed = "requires a loaded contact by finite elements of coupled pairs"
        raise InputError.at("cycle", cycle.label, allowed, "take a mesh cycle by finite elements")
    each = [cycle.against(name, bore_inertia) for name in MEANINGS]
    errors = np.array([one.mean_error for one in each], dtype=float)
    parts = deflection_parts(cycle.contact, compliance)
    return StiffnessReferences(
        reference=tuple(MEANINGS),
        mean_stiffness=np.array([one.mean_stiffness for one in each]),
        mean_secant_stiffness=np.array([one.mean_secant_stiffness for one in each]),
        mean_error=errors,
        iso_mesh_stiffness=1e9 * pair.face_width * iso6336(pair, force=abs(cycle.contact.force)).c_gamma,
        deflection={name: float(part.mean()) for name, part in parts.items()},
        error=float(np.max(errors)),  # nan where a contact between the positions has no solution
        cost=Cost(watch.seconds),
    )
