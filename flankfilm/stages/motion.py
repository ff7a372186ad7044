"""The stages of the motion, from the mesh cycle's stiffness to sweeps and diagrams."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

import dynamics
from flankfilm import coupling
from flankfilm.building.followed_speeds import followed_speed
from flankfilm.building.pair import pinion_torque
from flankfilm.scene.sections.dynamics import OSCILLATOR, DiagramSection, DynamicsSection
from flankfilm.scene.sections.operating import GIVEN
from flankfilm.scene.sections.section import required
from flankfilm.stages.damping import FILM_DAMPING, damping_ratio
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.excitation import EXCITATION
from flankfilm.stages.mesh import MESH, PAIR, PLAN, decided
from flankfilm.stages.ranges import frequency_range


@stage(
    "curve series",
    "Fourier stiffness by its curve",
    "stiffness dynamics",
    MESH,
    FILM_DAMPING,
    settings=decided(lambda plan: {"series": plan.series}),
)
def CURVE_SERIES(run: Engine) -> coupling.MeshSeries:
    """Series of the mesh stiffness whose order is that of the curve and the motion."""
    return _series(run)


def _series(run: Engine) -> coupling.MeshSeries:
    """Series of the mesh stiffness, or the given one; an order to be found is that of the curve and the motion."""
    scene, section = run.scene, run.scene.dynamics
    if scene.stiffness.model == "given":
        return coupling.given_series(**scene.stiffness.si(*GIVEN))
    share = run[PLAN].series or scene.tolerance
    if section is None:
        return coupling.mesh_series(run[MESH], share=share)
    order = None if section.fourier_order == "auto" else section.fourier_order
    bounds = frequency_range(run, section)
    return coupling.mesh_series(run[MESH], section.stiffness, order, share, bounds, damping_ratio(run))


@stage(
    "branches",
    "every branch of motions, with the harmonics that its jumps need",
    "operating dynamics pair material heat wants",
    CURVE_SERIES,
    EXCITATION,
    FILM_DAMPING,
    kept="dynamics flankfilm gears",
    settings=lambda run: {"tolerance": run.scene.tolerance} if by_jumps(run) else {},
)
def BRANCHES(run: Engine) -> coupling.OrderedJumps:
    """Branches with the lowest order of the series that the jump speeds allow, for an order to be found."""
    asked = required(dynamics_of(run).diagram, "dynamics.diagram", "the diagram", "add the range")
    return coupling.jumps_to_tolerance(
        lambda series: _oscillator(run, series), run[CURVE_SERIES], run.scene.tolerance, **ranged(asked)
    )


@stage(
    "fourier",
    "Fourier stiffness",
    "stiffness dynamics",
    MESH,
    CURVE_SERIES,
    BRANCHES,
    FILM_DAMPING,
    settings=decided(lambda plan: {"series": plan.series}),
)
def FOURIER(run: Engine) -> coupling.MeshSeries:
    """Series of the mesh stiffness, or the given one; with a wanted diagram of the order that its jumps need."""
    if not by_jumps(run):
        return _series(run)  # no separate stage, which a run would list beside this one
    series, jumps = run[CURVE_SERIES], run[BRANCHES]
    if jumps.order == series.order or series.cycle is None:
        return series
    more = coupling.mesh_series(series.cycle, series.kind, jumps.order)
    return replace(more, left_out=series.left_out, share=series.share, tried=jumps.tried)


def by_jumps(run: Engine) -> bool:
    """Whether an order is to be found for a diagram; not for one of a drive train, whose jumps take long to carry."""
    scene, section = run.scene, run.scene.dynamics
    if (
        scene.stiffness.model == "given"
        or section is None
        or section.diagram is None
        or scene.shafts is not None
    ):
        return False
    return section.fourier_order == "auto" and "diagram" in scene.wants


@stage(
    "scaling",
    "physical to dimensionless",
    "operating dynamics pair material heat",
    FOURIER,
    EXCITATION,
    FILM_DAMPING,
)
def SCALING(run: Engine) -> coupling.PairOscillator:
    """Oscillator of the scene at its speed, or at the start of the sweep."""
    return _oscillator(run, run[FOURIER])


def _oscillator(run: Engine, series: coupling.MeshSeries) -> coupling.PairOscillator:
    """Oscillator of the scene with a series of its stiffness."""
    section = dynamics_of(run)
    if section.dimensionless:
        ranged, arguments = section.sweep or section.diagram, _given(run)
        start = ranged.frequency[0] if ranged and ranged.frequency else 1.0
        oscillator = dynamics.GearOscillator(
            stiffness=series.stiffness.normalised(), frequency=start, **arguments
        )
        return coupling.PairOscillator(oscillator, None, series)
    speed, arguments = of_the_pair(run, series)
    return coupling.pair_oscillator(run[PAIR], series, pinion_torque(run.scene), speed, **arguments)


def of_the_pair(run: Engine, series: coupling.MeshSeries) -> tuple[float, dict[str, Any]]:
    """Speed of the pinion [rad/s] and what the scene says of its pair's oscillator, as arguments."""
    section, arguments = dynamics_of(run), _given(run)
    rpm = followed_speed(run.scene, run[PAIR], series)
    if section.error_curve is not None and (error := run[EXCITATION]) is not None:
        arguments["error_amplitude"], arguments["error_phase"] = error.amplitude, error.phase
    arguments["extra_inertia"] = section.extra_inertia_kg_m2.each
    arguments["reference"] = run.scene.reference or "body"
    return rpm * math.pi / 30.0, arguments


def _given(run: Engine) -> dict[str, Any]:
    """What the oscillator takes of the section as it is."""
    arguments = dynamics_of(run).si(*OSCILLATOR)
    arguments["damping_ratio"] = damping_ratio(run)
    if arguments["error_phase"] == (0.0,):
        arguments["error_phase"] = 0.0  # of all harmonics
    return arguments


def dynamics_of(run: Engine) -> DynamicsSection:
    """The scene's [dynamics]."""
    return required(run.scene.dynamics, "[dynamics]", "the motion")


@stage("sweep", "sweep up and down", "dynamics", FOURIER, SCALING, kept="dynamics flankfilm")
def SWEEP(run: Engine) -> coupling.SpeedSweep:
    """Sweep of the speed up and down over the scene's range."""
    section, motion = dynamics_of(run), run[SCALING]
    asked = required(section.sweep, "dynamics.sweep", "the sweep", "add the range")
    wanted = list(section.portraits_frequency)
    if motion.scales is not None:
        wanted += [motion.scales.frequency_from_rpm(rpm) for rpm in section.portraits_rpm]
    values = np.linspace(*asked.ends, asked.points)
    if asked.frequency is not None:
        return coupling.speed_sweep(motion, frequency=values, portraits=wanted)
    return coupling.speed_sweep(motion, values * math.pi / 30.0, portraits=wanted)


def ranged(asked: DiagramSection) -> dict[str, Any]:
    """Range of a diagram with its searches, as arguments."""
    speed = asked.speed_rpm and (asked.speed_rpm[0] * math.pi / 30.0, asked.speed_rpm[1] * math.pi / 30.0)
    return {
        "speed": speed,
        "frequency": asked.frequency,
        "searches": asked.searches,
        "max_period": asked.max_period,
    }
