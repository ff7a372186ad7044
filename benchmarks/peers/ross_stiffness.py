"""Mesh stiffness by ross-rotordynamics."""

from collections.abc import Iterator
from importlib import import_module
from typing import Any

import numpy as np

ross: Any = import_module("ross")
elements: Any = import_module("ross.gear_element")

PEER, VERSION, NOTE = "ross-rotordynamics", ross.__version__, ""


def settings(inputs: dict[str, Any]) -> Iterator[tuple[Any, ...]]:
    """The one way of the program."""
    steel = ross.Material(
        name="steel", rho=inputs["density"], E=inputs["youngs_modulus"], Poisson=inputs["poisson_ratio"]
    )
    gears = [
        elements.GearElementTVMS(
            n=0,
            material=steel,
            width=inputs["width"],
            bore_diameter=2 * bore,
            module=inputs["module"],
            n_teeth=teeth,
            pr_angle=np.pi / 9,
        )
        for teeth, bore in zip(inputs["teeth"], inputs["bores"], strict=True)
    ]
    mesh = elements.Mesh(*gears)
    steps = (np.arange(inputs["positions"]) + 0.5) / inputs["positions"]
    angles = 2 * np.pi / inputs["teeth"][0] * steps

    def mean() -> list[float]:
        return [float(np.mean([mesh.get_variable_stiffness(angle) for angle in angles]))]

    yield "GearElementTVMS", mean, mean, 1
