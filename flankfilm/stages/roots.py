"""Root stress along the mesh cycle by finite elements, beside ISO 6336-3."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from base import SolverError
from flankfilm.build import gear_pair, pinion_torque
from flankfilm.stages.teeth import plain_flanks

if TYPE_CHECKING:
    from fem import Fillets, MeshCycle, RootStress
    from flankfilm.scene import Scene
    from flankfilm.stages.engine import Engine
    from gears.closed_form import Iso6336RootStress


@dataclass(frozen=True)
class RootStage:
    """Root stress of both gears.

    Attributes
    ----------
    stress : RootStress
        By finite elements, along the mesh cycle.
    iso : Iso6336RootStress or None
        Nominal stress by ISO 6336-3; None where it has no answer.
    iso_fault : str
        Why it has none.
    """

    stress: RootStress
    iso: Iso6336RootStress | None
    iso_fault: str


def fillets(engine: Engine) -> Fillets:
    """What loads anywhere on the flanks do to the fillets, by a mesh made for them."""
    import fem

    scene = engine.scene
    found = fem.fillets(
        gear_pair(held_on_hubs(plain_flanks(scene))), tolerance=scene.tolerance, plane=scene.stiffness.plane
    )
    if not found.converged:
        raise SolverError(f"root stress: {found.message}")
    return found


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


def root_stress(engine: Engine) -> RootStage:
    """Stress at the fillets with the forces of the mesh cycle, with the film where there is one."""
    from dataclasses import replace

    import fem
    from gears import GeometryError
    from gears.closed_form import iso6336_3

    pair = engine["pair"]
    cycle: MeshCycle = engine["mesh"].contact
    found = fem.root_stress(pair, cycle, replace(engine["fillets"], pair=pair))
    iso, fault = None, ""
    try:
        iso = iso6336_3(pair, pair.normal_force(pinion_torque(engine.scene)))
    except GeometryError as error:
        fault = str(error)
    return RootStage(found, iso, fault)
