"""Scenes with simpler gears, for results that do not depend on what is left out."""

from __future__ import annotations

from flankfilm.scene import Scene


def plain_flanks(scene: Scene) -> Scene:
    """Give the scene with gears that have no relief, deviations or rounded edges: no mesh shows them."""
    if scene.pair is None:
        return scene
    plain = {"tip_relief": None, "deviations": None, "tip_rounding_um": 0.0}
    gears = {name: getattr(scene.pair, name).model_copy(update=plain) for name in ("pinion", "wheel")}
    return scene.model_copy(update={"pair": scene.pair.model_copy(update=gears)})


def held_on_hubs(scene: Scene) -> Scene:
    """Give the scene with bores as large as the rigid hubs: what a hub fills carries no stress."""
    if scene.pair is None:
        return scene
    held = {}
    for name in ("pinion", "wheel"):
        gear = getattr(scene.pair, name)
        if gear.hub is not None and gear.hub.hub_mm is not None:
            held[name] = gear.model_copy(update={"bore_mm": gear.hub.hub_mm})
    return scene.model_copy(update={"pair": scene.pair.model_copy(update=held)})
