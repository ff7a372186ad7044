"""All stages, and which of them the wanted outputs ask for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from flankfilm.scene import Scene
from flankfilm.stages import (
    closed_forms,
    decide,
    diagram,
    fields,
    film,
    film_choice,
    loads,
    motion,
    roots,
    separate_pairs,
    sweep,
    teeth,
)
from flankfilm.stages.engine import Engine, Stage
from flankfilm.verify import compare


def _sections(*names: str) -> Any:
    def pick(scene: Scene) -> Mapping[str, Any]:
        found = {}
        for name in names:
            section, _, key = name.partition(".")
            value = getattr(scene, section)
            value = getattr(value, key) if key else value
            found[name] = value.model_dump() if hasattr(value, "model_dump") else value
        return found

    return pick


_TEETH = _sections("stiffness.pairs", "stiffness.contact_beyond_path", "operating", "tolerance")


def _decided(what: Callable[[decide.Plan], Mapping[str, Any]]) -> Callable[[Engine], Mapping[str, Any]]:
    """Settings from the plan; a scene with a given stiffness has none."""
    return lambda engine: {} if engine.scene.stiffness.model == "given" else what(engine["plan"])


_TEETH_DECIDED = _decided(lambda plan: {"stiffness model": plan.stiffness.choice, "sampling": plan.sampling})

STAGES: Mapping[str, Stage] = {
    stage.name: stage
    for stage in (
        Stage(
            "pair", "geometry", lambda e: teeth.pair(e), _sections("pair", "material"), packages=("gears",)
        ),
        Stage(
            "closed forms",
            "closed forms",
            lambda e: closed_forms.closed_forms(e),
            _sections("operating", "wants"),
            needs=("pair", "compliance"),
            packages=("gears",),
            settings=_TEETH_DECIDED,
        ),
        Stage(
            "film foreseen",
            "what the film will change",
            lambda e: film_choice.foreseen_change(e),
            _sections("operating", "lubricant", "stiffness.pairs"),
            needs=("pair",),
            packages=("gears", "ehl", "flankfilm"),
            kept=True,
        ),
        Stage(
            "plan",
            "choice of models, split of the tolerance",
            lambda e: decide.plan(e),
            _sections(
                "stiffness", "film", "lubricant", "roughness", "operating", "dynamics", "wants", "tolerance"
            ),
            needs=("pair", "film foreseen"),
            packages=("flankfilm",),
        ),
        Stage(
            "bodies",
            "tooth compliance by finite elements",
            lambda e: teeth.bodies(e),
            lambda scene: _sections("pair", "material", "stiffness.plane")(teeth.plain_flanks(scene)),
            packages=("gears", "meshes", "fem"),
            kept=True,
            settings=_decided(lambda plan: {"compliance": plan.compliance}),
        ),
        Stage(
            "compliance",
            "compliance with relief",
            lambda e: teeth.compliance(e),
            _sections(),
            needs=("pair", "bodies"),
            packages=("fem",),
        ),
        Stage(
            "verification",
            "closed forms against finite elements",
            lambda e: compare.verification(e),
            _sections("operating", "stiffness.contact_beyond_path"),
            needs=("compliance",),
            packages=("gears", "flankfilm"),
        ),
        Stage(
            "dry cycle",
            "mesh cycle without film",
            lambda e: teeth.dry_cycle(e),
            _TEETH,
            needs=("compliance",),
            settings=_TEETH_DECIDED,
        ),
        Stage(
            "torques",
            "mesh cycles over torque",
            lambda e: loads.torques(e),
            _TEETH,
            needs=("compliance", "dry cycle"),
        ),
        Stage(
            "revolution",
            "mesh cycle tooth by tooth",
            lambda e: loads.revolution(e),
            _TEETH,
            needs=("compliance",),
        ),
        Stage(
            "fillets",
            "root stress per load by finite elements",
            lambda e: roots.fillets(e),
            lambda scene: _sections("pair", "material", "stiffness.plane", "tolerance")(
                teeth.plain_flanks(scene)
            ),
            packages=("gears", "meshes", "fem"),
            kept=True,
        ),
        Stage(
            "root stress",
            "root stress over the mesh cycle",
            lambda e: roots.root_stress(e),
            _sections(),
            needs=("mesh", "fillets", "pair"),
        ),
        Stage(
            "other cycles",
            "mesh cycle by the other models",
            lambda e: separate_pairs.other_cycles(e),
            _TEETH,
            needs=("dry cycle",),
            packages=("gears",),
        ),
        Stage(
            "film",
            "oil film in series with the teeth",
            lambda e: film.film(e),
            _sections("film", "lubricant", "roughness", "operating", "tolerance"),
            needs=("dry cycle",),
            packages=("gears", "meshes", "fem", "ehl", "flankfilm"),
            kept=True,
            settings=_decided(lambda plan: {"model": plan.film.choice, "film": plan.film_tolerance}),
        ),
        Stage(
            "mesh",
            "mesh stiffness of the motion",
            lambda e: motion.mesh(e),
            _sections(),
            needs=("dry cycle", "film"),
            settings=_decided(lambda plan: {"model": plan.film.choice}),
        ),
        Stage(
            "fourier",
            "Fourier stiffness",
            lambda e: motion.fourier(e),
            _sections("stiffness", "dynamics"),
            needs=("mesh",),
            packages=("dynamics",),
            settings=_decided(lambda plan: {"series": plan.series}),
        ),
        Stage(
            "scaling",
            "physical to dimensionless",
            lambda e: motion.scaling(e),
            _sections("operating", "dynamics", "pair", "material"),
            needs=("fourier",),
        ),
        Stage(
            "sweep",
            "sweep up and down",
            lambda e: sweep.sweep(e),
            _sections("dynamics"),
            needs=("fourier", "scaling"),
            packages=("dynamics", "flankfilm"),
            kept=True,
        ),
        Stage(
            "diagram",
            "every branch of motions",
            lambda e: diagram.diagram(e),
            _sections("dynamics"),
            needs=("fourier", "scaling"),
            packages=("dynamics", "flankfilm", "gears"),
            kept=True,
        ),
        Stage(
            "fields", "stress and displacement fields", lambda e: fields.fields(e), _TEETH, needs=("mesh",)
        ),
    )
}


def goals(scene: Scene) -> tuple[str, ...]:
    """Name the stages that the scene's wants ask for; those that these need follow by themselves."""
    found: list[str] = []
    wants = set(scene.wants)
    given = scene.stiffness.model == "given"
    if wants & {"geometry"}:
        found.append("pair")
    if wants & {"closed-forms"} or ("report" in wants and "stiffness" in wants and not given):
        found.append("closed forms")
    if wants & {"stiffness", "film"} and not given:
        found += ["plan", "dry cycle"]
        if "closed-forms" in wants or "report" in wants:
            found.append("other cycles")
        if scene.film.model != "none" or "film" in wants:
            found.append("mesh")
    found += [name for name in ("torques", "revolution") if name in wants]
    if "root-stress" in wants:
        found.append("root stress")
    if wants & {"fourier", "sweep", "diagram"}:
        found.append("fourier")
    for name in ("sweep", "diagram"):
        if name in wants:
            found += ["scaling", name]
    if "vtk" in wants:
        found.append("fields")
    return tuple(dict.fromkeys(found))
