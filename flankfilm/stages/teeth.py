"""Pair, closed forms, tooth compliance by finite elements and the dry mesh cycle."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from flankfilm.build import gear_pair, pinion_torque
from flankfilm.mesh_stiffness import MeshStiffness, sampling_error
from flankfilm.stages.engine import Engine
from flankfilm.tolerance import ToleranceSplit

if TYPE_CHECKING:
    from fem import Compliance, MeshCycle
    from gears import GearPair

Array = NDArray[np.float64]

POSITIONS = (40, 120, 360)
"""Numbers of positions tried, the cheapest first; each but the first holds the one before it."""

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
    parts : mapping
        Parts of Ishikawa's deflection per force, each of shape (n,) [m/N].
    """

    position: Array
    rho1: Array
    curves: Mapping[str, Array]
    iso: Any
    parts: Mapping[str, Array]


def pair(engine: Engine) -> GearPair:
    """Geometry of the scene's pair."""
    return gear_pair(engine.scene)


def closed_form(model: str, pair: GearPair, path: Any, force: float) -> Any:
    """Evaluate the closed form of the scene's name `model` on a path of contact."""
    from gears import closed_form as forms

    functions: dict[str, Callable[[], Any]] = {
        "ishikawa": lambda: forms.ishikawa(pair, path),
        "weber-banaschek": lambda: forms.weber_banaschek(pair, path, force),
        "potential-energy": lambda: forms.potential_energy(pair, path, force=force),
    }
    return functions[model]()


def closed_forms(engine: Engine, n: int = 81) -> SinglePairs:
    """Evaluate all closed forms along the path."""
    from gears import closed_form as forms

    pair = engine["pair"]
    path = pair.path_of_contact(n=n)
    force = pair.normal_force(pinion_torque(engine.scene))
    curves = {label: np.asarray(closed_form(name, pair, path, force)) for name, label in CLOSED_FORMS.items()}
    return SinglePairs(
        position=path.position,
        rho1=path.rho1,
        curves=curves,
        iso=forms.iso6336(pair, force=force),
        parts=dict(forms.ishikawa(pair, path).parts),
    )


def compliance(engine: Engine) -> Compliance:
    """Everything about the teeth that does not depend on load, by finite elements."""
    import fem

    split = ToleranceSplit.of(engine.scene.tolerance)
    return fem.compliance(engine["pair"], tolerance=split.compliance, plane=engine.scene.stiffness.plane)


def fem_cycle(engine: Engine, positions: int, film: Any = None) -> MeshCycle:
    """Loaded contact over one base pitch from the kept compliance, dry or with a film law."""
    import fem

    scene = engine.scene
    return fem.mesh_cycle(
        engine["pair"],
        torque=pinion_torque(scene),
        positions=positions,
        compliance=engine["compliance"],
        beyond_path=scene.stiffness.contact_beyond_path,
        film=film,
    )


def from_fem(cycle: MeshCycle, label: str) -> MeshStiffness:
    """Bring a cycle by finite elements into the common form."""
    n = cycle.stiffness.size
    return MeshStiffness(
        label=label,
        phase=(np.arange(n) + 0.5) / n,
        rho1=cycle.rho1,
        forces=cycle.forces,
        secant=cycle.secant_stiffness,
        tangent=cycle.stiffness,
        transmission_error=cycle.transmission_error,
        error=cycle.error,
        seconds=cycle.cost.seconds,
    )


def dry_cycle(engine: Engine) -> MeshStiffness:
    """Mesh stiffness without film, at as few positions as the tolerance allows."""
    split = ToleranceSplit.of(engine.scene.tolerance)
    cycle = cycle_at(engine, POSITIONS[0])
    for positions in POSITIONS[1:]:
        if sampling_error(cycle.secant) <= split.sampling:
            break
        cycle = cycle_at(engine, positions)
    return cycle


def cycle_at(engine: Engine, positions: int, film: Any = None) -> MeshStiffness:
    """Mesh stiffness by the scene's model at a number of positions, with a film law or dry."""
    scene = engine.scene
    if scene.stiffness.model == "fem" and scene.stiffness.pairs == "coupled":
        return from_fem(fem_cycle(engine, positions, film), "finite elements")
    start = time.perf_counter()
    cycle = separate_pairs_cycle(engine, positions, film)
    from dataclasses import replace

    return replace(cycle, seconds=time.perf_counter() - start)
