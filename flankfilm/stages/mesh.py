"""The stages of the gears and their film, each from the scene to plain arguments; `stages.motion` goes on from there.

What a stage depends on stands with it: sections of the scene, other stages, decisions, packages.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

import fem
import gears
from fem.contact.moving_contact import contacts_move
from fem.pair.face_setting import FREE_ENDS
from flankfilm import coupling
from flankfilm.building.face import face, varies_by
from flankfilm.building.film import film_model, lubricant
from flankfilm.building.flanks import deviations
from flankfilm.building.overload import warn_of_overload
from flankfilm.building.pair import gear_pair, pinion_speed, pinion_torque, supports, tip_roundings, warm_pair
from flankfilm.coupling.mesh.require_converged import believed
from flankfilm.plan.decide import Plan, decide
from flankfilm.plan.film_choice import foreseen_change
from flankfilm.plan.options import FilmChange
from flankfilm.scene import Scene
from flankfilm.scene.plain_gears import plain_flanks
from flankfilm.scene.sections.ground import under_keys
from flankfilm.stages.engine import Engine, stage

TEETH = "stiffness.pairs tip_edges stiffness.moving_contact face operating heat tolerance"
"""Keys of all that is loaded; of [alignment] and [shafts] what the load over the face depends on."""


def decided(what: Callable[[Plan], Mapping[str, Any]]) -> Callable[[Engine], Mapping[str, Any]]:
    """Settings from the plan; a scene with a given stiffness has none."""
    return lambda run: {} if run.scene.stiffness.model == "given" else what(run[PLAN])


TEETH_DECIDED = decided(
    lambda plan: {"stiffness model": plan.stiffness.choice, "sampling": plan.resolution.sampling}
)


@stage("pair", "geometry", "pair material heat")
def PAIR(run: Engine) -> gears.GearPair:
    """Geometry of the scene's pair; curves that do not fit its flanks are refused before anything is computed."""
    pair = gear_pair(run.scene)
    deviations(run.scene, pair, every_tooth=True)
    return pair


@stage("heat", "growth by heat", "pair material heat")
def HEAT(run: Engine) -> gears.WarmPair:
    """The pair at its temperatures beside the cold one."""
    return warm_pair(run.scene)


@stage(
    "film foreseen",
    "what the film will change",
    "operating lubricant stiffness.pairs",
    PAIR,
    kept="gears ehl flankfilm",
)
def FILM_FORESEEN(run: Engine) -> FilmChange | None:
    """What the cheapest models say that a film changes."""
    return foreseen_change(run.scene)


@stage(
    "plan",
    "choice of models, split of the tolerance",
    "stiffness film lubricant roughness operating dynamics wants tolerance",
    PAIR,
    FILM_FORESEEN,
)
def PLAN(run: Engine) -> Plan:
    """Models of the run and shares of its tolerance."""
    warn_of_overload(run.scene, run[PAIR])
    return decide(run.scene, run[PAIR], lambda: run[FILM_FORESEEN])


@stage(
    "bodies",
    "tooth compliance by finite elements",
    "pair material heat stiffness.plane",
    kept="gears meshes fem",
    by_parts=True,
    of=plain_flanks,
    settings=decided(lambda plan: {"compliance": plan.resolution.compliance}),
)
def BODIES(run: Engine) -> fem.PairCompliance:
    """Compliance of the pair with plain flanks: no mesh shows relief, deviations or rounded edges.

    What the cache keeps are the gears: pairs of other mates, sizes or moduli have them too.
    """
    scene = run.scene
    pair, tolerance = gear_pair(plain_flanks(scene)), run[PLAN].resolution.compliance
    with under_keys(scene.pair, "pair"):
        compliance = fem.compliance(
            pair,
            tolerance=tolerance,
            plane=scene.stiffness.plane,
            supports=supports(scene),
            tip_edges=scene.tip_edges,
            motion=contacts_move(pair, scene.stiffness.moving_contact),
            kept=run.parts,
        )
    return believed(compliance, "tooth compliance")


@stage("compliance", "compliance with relief", "", PAIR, BODIES)
def COMPLIANCE(run: Engine) -> fem.PairCompliance:
    """Everything about the teeth that does not depend on load, by finite elements."""
    return replace(run[BODIES], pair=run[PAIR])


@stage(
    "gears along the face",
    "gears along the face, solved once and kept",
    "face",
    COMPLIANCE,
    kept="gears meshes fem",
    by_parts=True,
)
def FACE_GEARS(run: Engine) -> fem.FaceGears | None:
    """How both gears answer loads that vary along the face; with free ends this takes longer than all else."""
    return fem.face_gears(run[COMPLIANCE], face(run.scene).get("face_model", FREE_ENDS), run.parts)


def along_the_face(scene: Scene) -> bool:
    """Whether loads vary along the face: a scene makes them so, or lines of contact cross it."""
    return bool(varies_by(scene)) or (scene.pair is not None and scene.pair.helical)


def loaded_teeth(
    run: Engine, *, by_elements: bool = False, every_tooth: bool = False
) -> coupling.LoadedTeeth:
    """Pair under the scene's torque with its model; with the deviations of each where every tooth counts."""
    scene, pair = run.scene, run[PAIR]
    model = "fem" if by_elements else run[PLAN].stiffness.choice
    flanks = coupling.Flanks(
        scene.tip_edges,
        deviations(scene, pair, every_tooth=every_tooth),
        tip_roundings(scene),
        scene.operating.friction if scene.operating else 0.0,
        scene.stiffness.moving_contact,
        warm_pair(scene).base_pitch_difference,
        **face(scene),
    )
    compliance = run[COMPLIANCE] if model == "fem" else None
    if compliance is not None and along_the_face(scene):
        _ = run[FACE_GEARS]  # contacts find them in the process
    arguments = pair, pinion_torque(scene), model, scene.stiffness.pairs, compliance, flanks
    return coupling.LoadedTeeth(*arguments, scene.reference, scene.bore_inertia)


@stage("dry cycle", "mesh cycle without film", TEETH, COMPLIANCE, FACE_GEARS, settings=TEETH_DECIDED)
def DRY_CYCLE(run: Engine) -> coupling.MeshCycle:
    """Mesh stiffness without film, its figures by arcs between events."""
    asked = run[PLAN].resolution
    return loaded_teeth(run).sampled(asked.sampling, asked.transmission_error)


C = TypeVar("C", bound=coupling.MeshCycle)


def measured(run: Engine, cycle: C) -> C:
    """Cycle whose deflection is measured against what the scene says; one from the cache may be of another scene."""
    contact, scene = cycle.contact, run.scene
    if contact is None:
        return cycle
    reference = scene.reference or "body"
    inertia = scene.bore_inertia if reference == "body" else (0.0, 0.0)
    if (contact.reference, contact.bore_inertia) == (reference, inertia):
        return cycle
    return cycle.against(reference, inertia)


def with_arcs(cycle: C) -> C:
    """Cycle whose arcs are there: a contact without a solution between the positions fails here, not in its files."""
    _ = cycle.arcs
    return cycle


@stage(
    "film",
    "oil film in series with the teeth",
    "film lubricant roughness operating tolerance",
    DRY_CYCLE,
    kept="gears meshes fem ehl flankfilm",
    settings=decided(lambda plan: {"model": plan.film.choice, "film": plan.film_tolerance}),
    finish=measured,
)
def FILM(run: Engine) -> coupling.LubricatedCycle:
    """Films and load share in agreement, and the mesh cycle with them."""
    scene, plan, teeth, dry = run.scene, run[PLAN], loaded_teeth(run), run[DRY_CYCLE]
    model = film_model(scene, plan.film.choice)
    oil, speed = lubricant(scene), pinion_speed(scene)
    with under_keys(scene.film, "film"):
        cycle = coupling.lubricate(teeth, dry, speed, oil, plan.resolution, model)
    return with_arcs(cycle)


@stage(
    "mesh",
    "mesh stiffness of the motion",
    "",
    DRY_CYCLE,
    FILM,
    settings=decided(lambda plan: {"model": plan.film.choice}),
)
def MESH(run: Engine) -> coupling.MeshCycle:
    """Mesh stiffness that the motion uses: with the film where there is one."""
    return run[DRY_CYCLE] if run[PLAN].film.choice == "none" else run[FILM]


@stage("fields", "stress and displacement fields", TEETH, MESH)
def FIELDS(run: Engine) -> coupling.LoadedFields:
    """Fields with a pair at the pitch point."""
    return coupling.pitch_point_fields(run[PAIR], loaded_contact(run), run[COMPLIANCE])


def loaded_contact(run: Engine) -> fem.MeshCycle:
    """Loaded contact of the mesh cycle, with the film where there is one."""
    contact = run[MESH].contact
    assert contact is not None
    return contact
