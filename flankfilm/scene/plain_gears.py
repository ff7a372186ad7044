"""Scenes with simpler gears, for results that do not depend on what is left out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.gears import GearSection
from flankfilm.scene.sections.key import key_of


def plain_flanks(scene: Scene) -> Scene:
    """Give the scene with gears that have no relief, leads, deviations, wear or rounded edges: no mesh shows them."""
    fields = GearSection.model_fields.items()
    plain = {name: field.default for name, field in fields if not key_of(field).traits.meshed}
    return _changed(scene, lambda gear: plain)


def held_on_hubs(scene: Scene) -> Scene:
    """Give the scene with bores as large as the rigid hubs: what a hub fills carries no stress."""

    def held(gear: GearSection) -> dict[str, Any]:
        if gear.hub is None or gear.hub.hub_mm is None:
            return {}
        bore, blank = gear.hub.hub_mm, gear.blank
        if blank is not None and blank.hub_mm is not None and blank.hub_mm < bore:
            blank = blank.model_copy(update={"hub_mm": None})
        return {"bore_mm": bore, "blank": blank}

    return _changed(scene, held)


def _changed(scene: Scene, change: Callable[[GearSection], dict[str, Any]]) -> Scene:
    """Scene with other values of some keys of either gear."""
    if scene.pair is None:
        return scene
    pinion, wheel = (gear.model_copy(update=change(gear)) for gear in scene.pair.each)
    pair = scene.pair.model_copy(update={"pinion": pinion, "wheel": wheel})
    return scene.model_copy(update={"pair": pair})
