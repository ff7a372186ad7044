"""The stages of the motion over speed as a test rig runs it: run-up and coast-down, and a map over speed and torque."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from flankfilm import coupling
from flankfilm.build import pinion_speed
from flankfilm.build_film import film_model, lubricant
from flankfilm.scene.dynamics import OSCILLATOR
from flankfilm.scene.section import required
from flankfilm.stages.catalogue import DRY_CYCLE, FILM, MESH, PAIR, PLAN, TEETH, loaded_teeth, with_arcs
from flankfilm.stages.damping import FILM_DAMPING, damping_ratio
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.excitation import EXCITATION
from flankfilm.stages.motion import FOURIER, SCALING


@stage("run-up", "run-up and coast-down", "dynamics", SCALING, kept="dynamics flankfilm")
def RUN_UP(run: Engine) -> coupling.SpeedRunUp:
    """Motion while the speed rises and falls evenly in time."""
    section = required(run.scene.dynamics, "[dynamics]", "the run-up")
    asked = required(section.run_up, "dynamics.run_up", "the run-up", "add the range")
    periods = 8000 if asked.periods is None else asked.periods
    if asked.frequency is not None:
        return coupling.speed_run_up(run[SCALING], frequency=asked.frequency, periods=periods)
    low, high = asked.ends
    speeds = (low * math.pi / 30.0, high * math.pi / 30.0)
    return coupling.speed_run_up(run[SCALING], speeds, seconds=asked.seconds, periods=periods)


@stage(
    "dynamic-map",
    "dynamic factor over speed and torque",
    f"{TEETH} operating dynamics film lubricant roughness",
    DRY_CYCLE,
    FILM,
    FOURIER,
    EXCITATION,
    FILM_DAMPING,
    kept="dynamics flankfilm gears fem meshes ehl",
)
def DYNAMIC_MAP(run: Engine) -> coupling.DynamicMap:
    """Greatest force over the mean one, each torque with its own mesh cycle and the order of the scene's series."""
    scene = run.scene
    section = required(scene.dynamics, "[dynamics]", "the dynamic map")
    operating = required(scene.operating, "[operating]", "the dynamic map")
    asked = required(section.sweep, "dynamics.sweep", "the dynamic map", "add the range")
    given = section.si(*OSCILLATOR) | {"damping_ratio": damping_ratio(run)}
    if given["error_phase"] == (0.0,):
        given["error_phase"] = 0.0
    if section.error_curve is not None and (error := run[EXCITATION]) is not None:
        given["error_amplitude"], given["error_phase"] = error.amplitude, error.phase
    given |= {
        "extra_inertia": section.extra_inertia_kg_m2.each,
        "reference": section.stiffness_reference or "body",
    }
    speeds = np.linspace(*asked.ends, asked.points) * math.pi / 30.0
    order = run[FOURIER].order

    def at(torque: float) -> coupling.PairOscillator:
        cycle = _mesh_at(run, torque)
        if cycle.contact is not None:
            cycle = cycle.against(section.stiffness_reference or "body", section.extra_inertia_kg_m2.each)
        series = coupling.mesh_series(cycle, section.stiffness, order)
        return coupling.pair_oscillator(run[PAIR], series, torque, float(speeds[0]), **given)

    return coupling.dynamic_map(at, operating.torques_Nm, speeds)


def _mesh_at(run: Engine, torque: float) -> coupling.MeshCycle:
    """Mesh cycle under another torque, with films at the scene's speed where it has them."""
    scene, plan = run.scene, run[PLAN]
    teeth = replace(loaded_teeth(run), torque=torque)
    if torque == loaded_teeth(run).torque:
        return run[MESH]
    dry = with_arcs(teeth.sampled(plan.resolution.sampling, plan.resolution.transmission_error))
    if plan.film.choice == "none":
        return dry
    model = film_model(scene, plan.film.choice)
    return with_arcs(
        coupling.lubricate(teeth, dry, pinion_speed(scene), lubricant(scene), plan.resolution, model)
    )
