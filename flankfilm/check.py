"""Checks a scene as far as possible without computing it."""

from __future__ import annotations

import warnings

from flankfilm.build import gear_pair
from flankfilm.build_film import lubricant
from flankfilm.cache import Cache
from flankfilm.scene import Scene
from flankfilm.stages.catalogue import DRY_CYCLE, FOURIER, PLAN, goals
from flankfilm.stages.engine import Engine


def check_scene(scene: Scene) -> list[str]:
    """Check what only the built geometry and the oil's laws show, and say what a run would decide and compute.

    Returns
    -------
    list of str
        Lines for a person.

    Raises
    ------
    InputError
        With every fault of the geometry, or of the oil.
    """
    lines = [f"{scene.title or 'The scene'} is valid."]
    if scene.pair is not None:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            pair = gear_pair(scene)
        lines.append(
            f"Contact ratio {pair.contact_ratio:.4f}, base pitch {1e3 * pair.base_pitch:.4f} mm, "
            f"normal backlash {round(1e6 * pair.backlash, 1) + 0.0:.1f} µm."
        )
        lines += [f"Warning: {warning.message}" for warning in caught]
    if scene.lubricant is not None:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            oil = lubricant(scene)
        lines.append(
            f"Oil: {oil.viscosity:.4g} Pa s, {1e9 * oil.pressure_viscosity:.4g} /GPa, {oil.density:.4g} kg/m³."
        )
        lines += [f"Warning: {warning.message}" for warning in caught]
    if DRY_CYCLE in (wanted := goals(scene)) or (scene.stiffness.model != "given" and FOURIER in wanted):
        plan = Engine(scene, Cache(None))[PLAN]  # models and shares, from cheap estimates
        lines += [decision.line for decision in plan.decisions]
        lines.append(plan.line)
    lines.append("A run computes: " + ", ".join(stage.title for stage in wanted) + ".")
    return lines
