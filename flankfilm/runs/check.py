"""Checks a scene as far as possible without computing it."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any, TypeVar

from flankfilm.building.film import lubricant
from flankfilm.building.pair import gear_pair, warm_pair
from flankfilm.files.cache import Cache
from flankfilm.runs.begin import begin
from flankfilm.scene import Scene
from flankfilm.stages.engine import Stage
from flankfilm.stages.mesh import PLAN
from gears import contact_lines

T = TypeVar("T")


def check_scene(scene: Scene) -> list[str]:
    """Check what only the built geometry and the oil's laws show, and say what a run would decide and compute.

    Returns
    -------
    list of str
        Lines for a person.

    Raises
    ------
    InputError
        With every fault that shows without solving.
    SolverError
        Where no models meet the tolerance.
    """
    (engine, wanted), foreseen = _built(lambda scene: begin(scene, Cache(None)), scene)
    lines = [f"{scene.title or 'The scene'} is valid."]
    if scene.pair is not None:
        pair, warned = _built(gear_pair, scene)
        lines.append(
            f"Contact ratio {pair.contact_ratio:.4f}, base pitch {1e3 * pair.base_pitch:.4f} mm, "
            f"normal backlash {round(1e6 * pair.backlash, 1) + 0.0:.1f} µm."
        )
        if pair.helix_angle:
            lengths = contact_lines(pair)
            hand = "right" if pair.helix_angle > 0.0 else "left"
            lines.append(
                f"Helix: {hand}-handed pinion, overlap ratio {pair.overlap_ratio:.4f}, total contact ratio "
                f"{pair.total_contact_ratio:.4f}, lines of contact {1e3 * lengths.minimum:.3f} to "
                f"{1e3 * lengths.maximum:.3f} mm."
            )
        lines += warned
        if scene.heat is not None:
            warm = warm_pair(scene)
            lines.append(
                f"Heat: backlash {1e6 * warm.cold_backlash:.1f} µm cold, {1e6 * warm.backlash:.1f} µm warm; the base "
                f"pitch of the pinion is {1e6 * warm.base_pitch_difference:+.2f} µm longer than that of the wheel."
            )
    if scene.lubricant is not None:
        oil, warned = _built(lubricant, scene)
        lines.append(
            f"Oil: {oil.viscosity:.4g} Pa s, {1e9 * oil.pressure_viscosity:.4g} /GPa, {oil.density:.4g} kg/m³."
        )
        lines += warned
    lines += foreseen
    if scene.stiffness.model != "given" and any(PLAN in needed(stage) for stage in wanted):
        plan = engine[PLAN]  # models and shares, from cheap estimates
        lines += [f"Warning: {text}" for text in engine.runs[PLAN.name].warnings]
        lines += [decision.line for decision in plan.decisions]
        lines.append(plan.line)
    lines.append("A run computes: " + ", ".join(stage.title for stage in wanted) + ".")
    return list(dict.fromkeys(lines))  # what several builders warn of is said once


def needed(stage: Stage[Any]) -> set[Stage[Any]]:
    """A stage and all that it may ask for."""
    return {stage}.union(*map(needed, stage.needs))


def _built(build: Callable[[Scene], T], scene: Scene) -> tuple[T, list[str]]:
    """What is built from a scene, and a line for each warning."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        built = build(scene)
    return built, [f"Warning: {warning.message}" for warning in caught]
