"""From the scene's shafts to the arguments of a drive train, in SI."""

from __future__ import annotations

from typing import Any

from flankfilm.scene.schema import Scene
from flankfilm.scene.section import required
from flankfilm.scene.shafts import ShaftSection


def drive_arguments(scene: Scene) -> dict[str, Any]:
    """What `flankfilm.coupling.pair_drive` takes of [shafts]."""
    section = required(scene.shafts, "[shafts]", "a drive train")
    each = [ShaftSection() if one is None else one for one in section.each]
    damping: dict[str, Any] = {"shaft_damping_ratio": section.damping_ratio}
    if section.rayleigh is not None:
        damping = {"rayleigh": section.rayleigh.each}
    return {
        "shafts": tuple(one.shaft() for one in each),
        "end_inertias": tuple(one.inertia_kg_m2 for one in each),
        "couplings": tuple(one.value("coupling_stiffness_Nm_per_rad") for one in each),
        "damping_band": section.damping_band,
        "reduction_tolerance": section.reduction_tolerance,
        **damping,
    }
