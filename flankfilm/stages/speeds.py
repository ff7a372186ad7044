"""The stages of the motion as a test rig sees it: orders, branches, run-up, and a map over speed and torque."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from base import InputError
from flankfilm import coupling
from flankfilm.building.film import film_model, lubricant
from flankfilm.building.pair import pinion_speed, pinion_torque
from flankfilm.building.shafts import drive_arguments
from flankfilm.scene.sections.dynamics import OSCILLATOR
from flankfilm.scene.sections.section import required
from flankfilm.stages.damping import FILM_DAMPING, damping_ratio
from flankfilm.stages.drives import DRIVE, moving
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.excitation import EXCITATION, REVOLUTION_ERROR
from flankfilm.stages.mesh import DRY_CYCLE, FILM, MESH, PAIR, PLAN, TEETH, loaded_teeth, with_arcs
from flankfilm.stages.motion import BRANCHES, FOURIER, SCALING, by_jumps, dynamics_of, ranged


@stage(
    "spectrum",
    "orders of the motion at the speed, with sidebands of a revolution",
    "operating dynamics",
    SCALING,
    DRIVE,
    REVOLUTION_ERROR,
    kept="dynamics flankfilm gears",
)
def SPECTRUM(run: Engine) -> coupling.MotionSpectrum:
    """Spectrum of the motion at the scene's speed; over a revolution where teeth differ."""
    motion = moving(run)
    error = None if motion.scales is None else run[REVOLUTION_ERROR]
    if error is not None and pinion_torque(run.scene) < 0.0:
        allowed = "must be positive for a spectrum with deviations of single teeth, which are those of the front flanks"
        raise InputError.at(
            "operating.pinion_torque_Nm", "negative", allowed, "leave spectrum out, or the pitches"
        )
    return coupling.mesh_spectrum(motion, error)


@stage(
    "diagram",
    "every branch of motions",
    "dynamics",
    FOURIER,
    SCALING,
    BRANCHES,
    DRIVE,
    kept="dynamics flankfilm gears",
)
def DIAGRAM(run: Engine) -> coupling.SpeedDiagram:
    """Every branch of motions over the scene's range, with the jumps."""
    if by_jumps(run):
        return run[BRANCHES].diagram
    asked = required(dynamics_of(run).diagram, "dynamics.diagram", "the diagram", "add the range")
    return coupling.jump_speeds(moving(run), **ranged(asked))


@stage("run-up", "run-up and coast-down", "dynamics", SCALING, DRIVE, kept="dynamics flankfilm gears")
def RUN_UP(run: Engine) -> coupling.SpeedRunUp:
    """Motion while the speed rises and falls evenly in time."""
    section = required(run.scene.dynamics, "[dynamics]", "the run-up")
    asked = required(section.run_up, "dynamics.run_up", "the run-up", "add the range")
    periods = 8000 if asked.periods is None else asked.periods
    motion, rows = moving(run), run.rows(RUN_UP)
    if asked.frequency is not None:
        return coupling.speed_run_up(motion, frequency=asked.frequency, periods=periods, progress=rows)
    low, high = asked.ends
    speeds = (low * math.pi / 30.0, high * math.pi / 30.0)
    return coupling.speed_run_up(motion, speeds, seconds=asked.seconds, periods=periods, progress=rows)


@stage(
    "dynamic-map",
    "dynamic factor over speed and torque",
    f"{TEETH} operating dynamics film lubricant roughness shafts",
    DRY_CYCLE,
    FILM,
    FOURIER,
    EXCITATION,
    FILM_DAMPING,
    kept="dynamics flankfilm gears fem meshes ehl",
)
def DYNAMIC_MAP(run: Engine) -> coupling.DynamicMap:
    """Maximum force over the mean one, each torque with its own mesh cycle and the order of the scene's series."""
    scene = run.scene
    section = required(scene.dynamics, "[dynamics]", "the dynamic map")
    operating = required(scene.operating, "[operating]", "the dynamic map")
    asked = required(section.sweep, "dynamics.sweep", "the dynamic map", "add the range")
    arguments = section.si(*OSCILLATOR) | {"damping_ratio": damping_ratio(run)}
    if arguments["error_phase"] == (0.0,):
        arguments["error_phase"] = 0.0
    if section.error_curve is not None and (error := run[EXCITATION]) is not None:
        arguments["error_amplitude"], arguments["error_phase"] = error.amplitude, error.phase
    arguments |= {
        "extra_inertia": section.extra_inertia_kg_m2.each,
        "reference": scene.reference or "body",
    }
    speeds = np.linspace(*asked.ends, asked.points) * math.pi / 30.0
    order = run[FOURIER].order

    ends = float(speeds[0]), float(speeds[-1])
    shafts = None if scene.shafts is None else drive_arguments(scene) | {"speeds": ends}

    def at(torque: float) -> coupling.PairOscillator | coupling.PairDrive:
        cycle = _mesh_at(run, torque)
        series = coupling.mesh_series(cycle, section.stiffness, order)
        if shafts is not None:
            tilting = coupling.tilting_mesh(cycle)
            return coupling.pair_drive(
                run[PAIR], series, torque, float(speeds[0]), **shafts, **arguments, **tilting
            )
        return coupling.pair_oscillator(run[PAIR], series, torque, float(speeds[0]), **arguments)

    return coupling.dynamic_map(at, operating.torques_Nm, speeds, progress=run.rows(DYNAMIC_MAP))


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
