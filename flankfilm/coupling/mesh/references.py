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
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

MEANINGS: Mapping[str, str] = {
    "body": "the rotation of the bodies, whose inertia balances the torque",
    "bore": "the rotation of the bores: all wind-up of the hubs included",
    "teeth": "the rotation of the root circles: no wind-up of the hubs",
}
"""What a deflection is measured against, in words."""

RELATIVE: Mapping[str, str] = {
    "body": "relative to the gear bodies",
    "bore": "relative to the bores",
    "teeth": "relative to the root circles",
}
"""The same as it stands beside a number."""


def relative_to(name: str, reference: str) -> str:
    """Name of a figure with its reference in the parentheses at its end, or in separate ones.

    Examples
    --------
    >>> relative_to("mean mesh stiffness (secant)", "body")
    'mean mesh stiffness (secant, relative to the gear bodies)'
    """
    if not (words := RELATIVE.get(reference, "")):
        return name
    return f"{name[:-1]}, {words})" if name.endswith(")") else f"{name} ({words})"


PARTS: Mapping[str, str] = {
    "hertz": "Hertz contact",
    "pinion": "pinion, tooth and body under it",
    "wheel": "wheel, tooth and body under it",
    "coupling": "coupling of teeth through the bodies",
    "body_windup": "wind-up of the bodies by their own inertia",
    "support": "supports, their translation",
    "rest": "gaps, tip edges, contacts that move and loads that vary along the face",
    "hub_windup": "wind-up of the hubs, from the bodies to the bores",
}
"""Parts of a deflection, in words; all but the last are those of the deflection against the bodies."""


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
        called="mean_tangent_stiffness",
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
        "mean over the cycle of a part of the deflection; all but hub_windup are of that against the bodies",
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
    compliance: fem.PairCompliance,
    bore_inertia: tuple[float, float] = (0.0, 0.0),
) -> StiffnessReferences:
    """Measure the deflection of a loaded contact against bodies, bores and teeth; the forces are the same.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
        Of coupled pairs by finite elements, dry.
    compliance : fem.PairCompliance
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
    (('body', 'bore', 'teeth'), [24.3, 21.4, 24.7])
    """
    from fem.cycle.breakdown import deflection_parts
    from gears.closed_form import iso6336

    watch = Stopwatch()
    if cycle.contact is None:
        allowed = "requires a loaded contact by finite elements of coupled pairs"
        raise InputError.at("cycle", cycle.label, allowed, "take a mesh cycle by finite elements")
    each = [cycle.against(name, bore_inertia) for name in MEANINGS]
    errors = np.array([measured.mean_error for measured in each], dtype=float)
    parts = deflection_parts(cycle.contact, compliance)
    return StiffnessReferences(
        reference=tuple(MEANINGS),
        mean_stiffness=np.array([measured.mean_stiffness for measured in each]),
        mean_secant_stiffness=np.array([measured.mean_secant_stiffness for measured in each]),
        mean_error=errors,
        iso_mesh_stiffness=1e9 * pair.face_width * iso6336(pair, force=abs(cycle.contact.force)).c_gamma,
        deflection=_with_hubs_apart(parts, *each),
        error=float(np.max(errors)),  # nan where a contact between the positions has no solution
        cost=Cost(watch.seconds),
    )


def _with_hubs_apart(
    parts: Mapping[str, Array], body: MeshCycle, bore: MeshCycle, teeth: MeshCycle
) -> dict[str, float]:
    """Means of the parts of a deflection against the bores [m], the wind-up split at the bodies."""
    means = {name: float(part.mean()) for name, part in parts.items()}
    on_teeth, on_body, on_bore = (
        float(np.mean(abs(cycle.contact.force) / cycle.contact.secant_stiffness))
        for cycle in (teeth, body, bore)
        if cycle.contact is not None
    )
    windup, hubs = means.pop("windup"), on_bore - on_body
    means["body_windup"] = on_body - on_teeth
    # springs at the bores turn as well: what they turn is the hubs'
    means["support"] += windup - means["body_windup"] - hubs
    return {name: means[name] for name in PARTS if name != "hub_windup"} | {"hub_windup": hubs}
