"""Stiffness of one pair of teeth along the path of contact by every model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from flankfilm.build import pinion_torque

if TYPE_CHECKING:
    from flankfilm.stages.engine import Engine
    from gears import GearPair

Array = NDArray[np.float64]

CLOSED_FORMS = {
    "ishikawa": "Ishikawa",
    "weber-banaschek": "Weber-Banaschek",
    "potential-energy": "potential energy, Sainsot body",
}


@dataclass(frozen=True)
class SinglePairs:
    """Stiffness of one pair of teeth along the path of contact by every model at hand.

    Attributes
    ----------
    position : ndarray, shape (n,)
        Travel from A [m].
    rho1 : ndarray, shape (n,)
        Curvature radius of the pinion's flank [m].
    curves : mapping
        Label to single-pair stiffness, shape (n,) [N/m].
    iso : object
        Mean stiffnesses by ISO 6336-1.
    """

    position: Array
    rho1: Array
    curves: Mapping[str, Array]
    iso: Any


def closed_form(model: str, pair: GearPair, path: Any, force: float) -> Any:
    """Evaluate the closed form of the scene's name `model` on a path of contact."""
    from gears import closed_form as forms

    functions: dict[str, Callable[[], Any]] = {
        "ishikawa": lambda: forms.ishikawa(pair, path),
        "weber-banaschek": lambda: forms.weber_banaschek(pair, path, force),
        "potential-energy": lambda: forms.potential_energy(pair, path, force=force),
    }
    return functions[model]()


def compares_with_finite_elements(engine: Engine) -> bool:
    """Tell whether finite elements are at hand anyway, to stand beside the closed forms."""
    return "stiffness" in engine.scene.wants and engine["plan"].stiffness.choice == "fem"


def closed_forms(engine: Engine, n: int = 81) -> SinglePairs:
    """Evaluate all closed forms along the path, beside finite elements where the scene has them."""
    from gears import closed_form as forms

    pair = engine["pair"]
    path = pair.path_of_contact(n=n)
    force = pair.normal_force(pinion_torque(engine.scene))
    curves = {label: np.asarray(closed_form(name, pair, path, force)) for name, label in CLOSED_FORMS.items()}
    if compares_with_finite_elements(engine):
        import fem

        k = fem.single_pair_stiffness(pair, force=force, rho1=path.rho1, compliance=engine["compliance"])
        curves = {"finite elements": k, **curves}
    return SinglePairs(
        position=path.position,
        rho1=path.rho1,
        curves=curves,
        iso=forms.iso6336(pair, force=force),
    )
