"""Mesh stiffness by ross-rotordynamics."""

from collections.abc import Iterator
from importlib import import_module
from typing import Any

import numpy as np

ross: Any = import_module("ross")
elements: Any = import_module("ross.gear_element")

PEER, VERSION, NOTE = "ross-rotordynamics", ross.__version__, ""


def settings(given: dict[str, Any]) -> Iterator[tuple[Any, ...]]:
    """The one way of the program."""
    steel = ross.Material(
        name="steel", rho=given["density"], E=given["youngs_modulus"], Poisson=given["poisson_ratio"]
    )
    gears = [
        elements.GearElementTVMS(
            n=0,
            material=steel,
            width=given["width"],
            bore_diameter=2 * bore,
            module=given["module"],
            n_teeth=teeth,
            pr_angle=np.pi / 9,
        )
        for teeth, bore in zip(given["teeth"], given["bores"], strict=True)
    ]
    mesh = elements.Mesh(*gears)
    steps = (np.arange(given["positions"]) + 0.5) / given["positions"]
    angles = 2 * np.pi / given["teeth"][0] * steps

    def mean() -> list[float]:
        return [float(np.mean([mesh.get_variable_stiffness(angle) for angle in angles]))]

    yield "GearElementTVMS", mean, mean, 1
