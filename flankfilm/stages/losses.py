"""The stages of heat: whether the film has it, and friction, losses and temperatures along the path."""

from __future__ import annotations

from dataclasses import replace

import ehl
from flankfilm import coupling
from flankfilm.building.film import boundary_friction, roughness, supply
from flankfilm.building.heat import shearing_oil, solids, warmth
from flankfilm.building.pair import pinion_speed, pinion_torque
from flankfilm.plan.decisions import Decision
from flankfilm.plan.heat_choice import heat_choice
from flankfilm.scene.sections.ground import under_keys
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.mesh import COMPLIANCE, DRY_CYCLE, FILM, PAIR, TEETH, decided, loaded_teeth

SUPPLY = "film.supply film.meniscus_mm film.meniscus_half_widths film.oil_layer_um"
"""What is held at the inlets."""

_TEETH_DECIDED = decided(lambda plan: {"stiffness model": plan.stiffness.choice})


@stage(
    "heat in the film",
    "what heat changes of the film",
    "film lubricant roughness operating heat tolerance",
    FILM,
    kept="gears meshes fem ehl flankfilm",
)
def HEAT_CHOICE(run: Engine) -> Decision:
    """Whether the wanted film is that with heat."""
    scene, pair, film = run.scene, run[PAIR], run[FILM].film

    def screen(tolerance: float) -> coupling.HeatScreen:
        return coupling.heat_screen(
            pair,
            film,
            pinion_speed(scene),
            shearing_oil(scene),
            solids=solids(pair),
            bulk_temperatures=warmth(scene).bulk,
            tolerance=tolerance,
            supply=supply(scene),
        )

    return heat_choice(scene, film.model == "ehl", screen)


@stage(
    "losses",
    "friction, losses and temperatures",
    f"{TEETH} lubricant roughness {SUPPLY}",
    DRY_CYCLE,
    COMPLIANCE,
    kept="gears meshes fem ehl flankfilm",
    settings=_TEETH_DECIDED,
)
def LOSSES(run: Engine) -> coupling.MeshLosses:
    """Films with heat along the path, in agreement with the load share and with the flanks' temperatures."""
    scene, pair, teeth = run.scene, run[PAIR], loaded_teeth(run)
    warm = warmth(scene)
    with under_keys(scene.film, "film"):
        return coupling.mesh_losses(
            pair,
            pinion_torque(scene),
            pinion_speed(scene),
            shearing_oil(scene),
            solids=solids(pair),
            bulk_temperatures=warm.bulk,
            heat_transfer=warm.transfer,
            ambient_temperature=warm.ambient,
            tolerance=scene.tolerance,
            roughness=roughness(scene),
            **boundary_friction(scene),
            supply=supply(scene),
            model=teeth.model,
            pairs=teeth.pairs,
            compliance=teeth.compliance,
            flanks=replace(teeth.flanks, friction=0.0),
        )


@stage("film with heat", "film with heat", "", HEAT_CHOICE, LOSSES)
def HOT_FILM(run: Engine) -> coupling.MeshLosses | None:
    """Films with heat along the path where they are wanted; None where isothermal ones do."""
    return run[LOSSES] if run[HEAT_CHOICE].choice == "on" else None


@stage(
    "hot contact",
    "film of the hottest contact",
    f"lubricant operating {SUPPLY}",
    PAIR,
    LOSSES,
    kept="gears meshes fem ehl flankfilm",
)
def HOT_CONTACT(run: Engine) -> ehl.ThermalFilm:
    """Whole film of the contact whose oil is hottest, for pictures."""
    pair, losses = run[PAIR], run[LOSSES]
    return coupling.hottest_film(
        pair, losses, shearing_oil(run.scene), solids(pair), supply=supply(run.scene)
    )
