"""Tooth compliance by finite elements, and the dry mesh cycle by the scene's model."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from base import SolverError
from flankfilm.build import deviations, gear_pair, pinion_torque, supports, tip_roundings
from flankfilm.mesh_stiffness import MeshStiffness, peak_to_peak_error, sampling_error
from flankfilm.stages.separate_pairs import separate_pairs_cycle

if TYPE_CHECKING:
    from fem import Compliance, MeshCycle
    from flankfilm.scene import Scene
    from flankfilm.stages.engine import Engine
    from gears import GearPair

POSITIONS = (120, 360, 1080)
"""Numbers of positions tried, the cheapest first; each holds every third of the next one."""


def pair(engine: Engine) -> GearPair:
    """Geometry of the scene's pair."""
    return gear_pair(engine.scene)


def bodies(engine: Engine) -> Compliance:
    """Compliance of the pair with plain flanks: no mesh shows relief, deviations or rounded edges."""
    import fem

    scene = engine.scene
    found = fem.compliance(
        gear_pair(plain_flanks(scene)),
        tolerance=engine["plan"].compliance,
        plane=scene.stiffness.plane,
        supports=supports(scene),
    )
    if not found.converged:
        raise SolverError(f"tooth compliance: {found.message}")
    return found


def compliance(engine: Engine) -> Compliance:
    """Everything about the teeth that does not depend on load, by finite elements."""
    nominal: Compliance = engine["bodies"]
    return replace(nominal, pair=engine["pair"])


def plain_flanks(scene: Scene) -> Scene:
    """Give the scene with gears that have no relief, deviations or rounded edges."""
    if scene.pair is None:
        return scene
    plain = {"tip_relief": None, "deviations": None, "tip_rounding_um": 0.0}
    gears = {name: getattr(scene.pair, name).model_copy(update=plain) for name in ("pinion", "wheel")}
    return scene.model_copy(update={"pair": scene.pair.model_copy(update=gears)})


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
        **flanks(engine),
    )


def flanks(engine: Engine, *, pitch: bool = False) -> dict[str, Any]:
    """What the scene says of deviations, edges and friction, as `fem.mesh_cycle` takes it."""
    scene, pair = engine.scene, engine["pair"]
    return {
        "deviations": deviations(scene, pair, pitch=pitch),
        "tip_rounding": tip_roundings(scene),
        "friction": scene.operating.friction if scene.operating else 0.0,
    }


def from_fem(cycle: MeshCycle, label: str) -> MeshStiffness:
    """Bring a cycle by finite elements into the common form."""
    return MeshStiffness(
        label=label,
        phase=cycle.position,
        rho1=cycle.rho1,
        forces=cycle.forces,
        load_share=cycle.load_share,
        secant=cycle.secant_stiffness,
        tangent=cycle.stiffness,
        transmission_error=cycle.transmission_error,
        error=cycle.error,
        seconds=cycle.cost.seconds,
        contact=cycle,
    )


def dry_cycle(engine: Engine) -> MeshStiffness:
    """Mesh stiffness without film, at as few positions as mean stiffness and transmission error need."""
    allowed = engine["plan"].sampling
    cycle = cycle_at(engine, POSITIONS[0])
    for positions in POSITIONS[1:]:
        enough = sampling_error(cycle.secant) <= allowed
        if enough and peak_to_peak_error(cycle.transmission_error) <= engine.scene.tolerance:
            break
        cycle = cycle_at(engine, positions)
    return cycle


def cycle_at(engine: Engine, positions: int, film: Any = None) -> MeshStiffness:
    """Mesh stiffness by the scene's model at a number of positions, with a film law or dry."""
    model, pairs = engine["plan"].stiffness.choice, engine.scene.stiffness.pairs
    if (model, pairs) == ("fem", "coupled"):
        cycle = fem_cycle(engine, positions, film)
        if not cycle.converged:
            raise SolverError(f"loaded tooth contact: {cycle.message}")
        return from_fem(cycle, "finite elements")
    return separate_pairs_cycle(engine, model, pairs, positions, film)
