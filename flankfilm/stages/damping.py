"""The stage of the damping ratio: as the scene gives it, or of its films."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from base import InputError
from flankfilm import coupling
from flankfilm.building.film import film_model, lubricant
from flankfilm.building.pair import pinion_speed, pinion_torque
from flankfilm.scene.sections.dynamics import BY_FILM
from flankfilm.scene.sections.ground import under_keys
from flankfilm.scene.sections.section import required
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.mesh import MESH, PAIR

_SECTIONS = ("film", "lubricant", "operating", "heat")


def _asked(run: Engine) -> Mapping[str, Any]:
    """Keys that decide the films' damping, where it is asked for."""
    scene, section = run.scene, run.scene.dynamics
    if section is None or section.damping_ratio != BY_FILM:
        return {}
    each = {name: getattr(scene, name) for name in _SECTIONS}
    sections = {name: part.model_dump() for name, part in each.items() if part is not None}
    own = section.extra_inertia_kg_m2.each, scene.reference
    return {**sections, "dynamics": own, "tolerance": scene.tolerance}


@stage(
    "film damping",
    "damping of the films",
    "",
    PAIR,
    MESH,
    kept="gears meshes fem ehl flankfilm",
    settings=_asked,
)
def FILM_DAMPING(run: Engine) -> coupling.FilmDamping | None:
    """What the films damp at the natural frequency of the pair; None where the scene gives a number."""
    scene = run.scene
    section = required(scene.dynamics, "[dynamics]", "the motion")
    if section.damping_ratio != BY_FILM:
        return None
    with under_keys(scene.film, "film"):
        damping = coupling.film_damping(
            run[MESH],
            run[PAIR],
            pinion_torque(scene),
            pinion_speed(scene),
            lubricant(scene),
            film=film_model(scene, "ehl"),
            extra_inertia=section.extra_inertia_kg_m2.each,
            reference=scene.reference or "body",
            tolerance=scene.tolerance,
        )
    if damping.damping_ratio <= 0.0 or damping.error >= 1.0:
        off = abs(damping.damping_ratio) * damping.error
        allowed = (
            f"gives {damping.damping_ratio:.2g} ± {off:.2g} at the natural frequency: loaded so, the films damp as "
            "good as nothing"
        )
        raise InputError.at("dynamics.damping_ratio", f'"{BY_FILM}"', allowed, "give a number, such as 0.05")
    return damping


def damping_ratio(run: Engine) -> float:
    """Damping ratio of the motion."""
    ratio = required(run.scene.dynamics, "[dynamics]", "the motion").damping_ratio
    if not isinstance(ratio, str):
        return ratio
    damping = run[FILM_DAMPING]
    assert damping is not None
    return damping.damping_ratio
