"""The stages of the drive train: the pair on the scene's shafts, its sweep over the speed, and what moves."""

from __future__ import annotations

import math

import numpy as np

from flankfilm import coupling
from flankfilm.building.pair import pinion_torque
from flankfilm.building.shafts import drive_arguments
from flankfilm.scene.sections.section import required
from flankfilm.stages.damping import FILM_DAMPING
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.excitation import EXCITATION
from flankfilm.stages.mesh import PAIR
from flankfilm.stages.motion import FOURIER, SCALING, of_the_pair
from flankfilm.stages.ranges import speeds_looked_at


@stage(
    "drive",
    "drive train",
    "operating dynamics pair material heat shafts",
    PAIR,
    FOURIER,
    EXCITATION,
    FILM_DAMPING,
)
def DRIVE(run: Engine) -> coupling.PairDrive:
    """The pair with its shafts, bearings, motor and load."""
    series = run[FOURIER]
    speed, arguments = of_the_pair(run, series)
    arguments["speeds"] = speeds_looked_at(run, series, speed)
    arguments |= drive_arguments(run.scene) | coupling.tilting_mesh(series.cycle)
    return coupling.pair_drive(run[PAIR], series, pinion_torque(run.scene), speed, **arguments)


def moving(run: Engine) -> coupling.PairOscillator | coupling.PairDrive:
    """What moves: the drive train of a scene with shafts, else the pair on rigid ones."""
    return run[SCALING] if run.scene.shafts is None else run[DRIVE]


@stage(
    "drive sweep", "sweep of the drive train up and down", "dynamics", DRIVE, kept="dynamics flankfilm gears"
)
def DRIVE_SWEEP(run: Engine) -> coupling.DriveSweep:
    """Forces of bearings and torques of shafts over the scene's range of speed, up and down."""
    section = required(run.scene.dynamics, "[dynamics]", "the sweep")
    asked = required(section.sweep, "dynamics.sweep", "the sweep", "add the range")
    values = np.linspace(*asked.ends, asked.points)
    drive, rows = run[DRIVE], run.rows(DRIVE_SWEEP)
    if asked.frequency is not None:
        return coupling.drive_sweep(drive, frequency=values, progress=rows)
    return coupling.drive_sweep(drive, values * math.pi / 30.0, progress=rows)
