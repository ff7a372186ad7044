"""All products in the order of the report, and what follows from all of them."""

from __future__ import annotations

from typing import Any

from flankfilm.products import (
    bearing_forces,
    closed_forms,
    diagram,
    drive,
    dynamic_map,
    face,
    fields,
    film,
    fourier,
    further_cycles,
    geometry,
    lines,
    losses,
    motion_in_time,
    oscillator,
    rating,
    root_stress,
    stiffness,
    sweep,
)
from flankfilm.products.product import Product
from flankfilm.scene import Scene
from flankfilm.stages.engine import Stage

__all__ = ["PRODUCTS", "goals"]

PRODUCTS: tuple[Product, ...] = (
    geometry.PRODUCT,
    closed_forms.PRODUCT,
    rating.PRODUCT,
    stiffness.PRODUCT,
    face.PRODUCT,
    lines.PRODUCT,
    film.PRODUCT,
    losses.PRODUCT,
    further_cycles.OVER_TORQUE,
    further_cycles.TOOTH_BY_TOOTH,
    root_stress.PRODUCT,
    fields.PRODUCT,
    fourier.PRODUCT,
    oscillator.PRODUCT,
    sweep.PRODUCT,
    drive.PRODUCT,
    bearing_forces.PRODUCT,
    diagram.PRODUCT,
    motion_in_time.LINES_OF_MOTION,
    motion_in_time.PASSAGE,
    dynamic_map.PRODUCT,
)
"""In the order of the report."""


def goals(scene: Scene) -> tuple[Stage[Any], ...]:
    """Stages that the scene's wants ask for; those that these need follow by themselves."""
    wants = frozenset(scene.wants)
    return tuple(dict.fromkeys(stage for product in PRODUCTS for stage in product.goals(scene, wants)))
