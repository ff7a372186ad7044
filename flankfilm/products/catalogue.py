"""All products in the order of the report, and what follows from all of them."""

from __future__ import annotations

from typing import Any

from flankfilm.products import (
    closed_forms,
    diagram,
    drive,
    dynamic_map,
    face,
    fields,
    film,
    fourier,
    geometry,
    lines,
    losses,
    oscillator,
    revolution,
    root_stress,
    run_up,
    spectrum,
    stiffness,
    sweep,
    torques,
)
from flankfilm.products.product import Product
from flankfilm.scene import Scene
from flankfilm.stages.engine import Stage

__all__ = ["PRODUCTS", "goals"]

PRODUCTS: tuple[Product, ...] = tuple(
    module.PRODUCT
    for module in (
        geometry,
        closed_forms,
        stiffness,
        face,
        lines,
        film,
        losses,
        torques,
        revolution,
        root_stress,
        fields,
        fourier,
        oscillator,
        sweep,
        drive,
        diagram,
        spectrum,
        run_up,
        dynamic_map,
    )
)
"""In the order of the report."""


def goals(scene: Scene) -> tuple[Stage[Any], ...]:
    """Stages that the scene's wants ask for; those that these need follow by themselves."""
    wants = frozenset(scene.wants)
    return tuple(dict.fromkeys(stage for product in PRODUCTS for stage in product.goals(scene, wants)))
