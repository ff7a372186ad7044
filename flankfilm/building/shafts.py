"""From the scene's shafts to the arguments of a drive train, in SI."""

from __future__ import annotations

from typing import Any

from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.section import required
from flankfilm.scene.sections.shafts import ShaftSection


def drive_arguments(scene: Scene) -> dict[str, Any]:
    """What `flankfilm.coupling.pair_drive` takes of [shafts]."""
    section = required(scene.shafts, "[shafts]", "a drive train")
    each = [ShaftSection() if shaft_section is None else shaft_section for shaft_section in section.each]
    damping: dict[str, Any] = {"shaft_damping_ratio": section.damping_ratio}
    if section.rayleigh is not None:
        damping = {"rayleigh": section.rayleigh.each}
    return {
        "shafts": tuple(shaft_section.shaft() for shaft_section in each),
        "end_inertias": tuple(shaft_section.inertia_kg_m2 for shaft_section in each),
        "couplings": tuple(shaft_section.value("coupling_stiffness_Nm_per_rad") for shaft_section in each),
        "damping_band": section.damping_band,
        "reduction_tolerance": section.reduction_tolerance,
        **damping,
    }
