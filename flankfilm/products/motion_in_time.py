"""Motion in time: orders of the settled motion with sidebands of a revolution, and run-up and coast-down."""

from __future__ import annotations

import math
from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Figure, InputError
from flankfilm import coupling
from flankfilm.building.pair import pinion_torque
from flankfilm.figures.reading import Pictures
from flankfilm.output.drives import carrying
from flankfilm.products.drive import of_a_train
from flankfilm.products.output import Named, in_result, output_of, outputs_from
from flankfilm.products.product import CurveTable, Product, section_of, wanting, when
from flankfilm.products.sweep import greatest_of
from flankfilm.report.drive_parts import RPM, carried_table
from flankfilm.report.page import Part, Table, pictures, said
from flankfilm.report.text import counted, number, percent
from flankfilm.scene.sections.section import required
from flankfilm.stages.drives import DRIVE, moving
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.excitation import REVOLUTION_ERROR
from flankfilm.stages.motion import SCALING

if TYPE_CHECKING:
    import xarray as xr

LISTED = 12
"""Lines that a table lists; the data files hold all."""

LINES: Pictures = {"spectrum": "spectrum_force"}


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


def _of_lines(stage: coupling.MotionSpectrum, results: xr.Dataset) -> Part:
    """Draw the orders of the motion, and list the largest lines."""
    from flankfilm.figures.motion import rpm_text, scale  # which loads matplotlib

    force, length = scale(results, "force"), scale(results, "length")
    largest = np.argsort(-np.nan_to_num(stage.displacement), kind="stable")[:LISTED]
    rows = tuple(
        (
            f"{stage.order[k]:.6g}",
            number(float(force.values) * float(stage.force[k])),
            number(float(length.values) * float(stage.displacement[k])),
        )
        for k in sorted(largest.tolist())
    )
    heads = ("mesh order", force.named("force, amplitude"), length.named("displacement, amplitude"))
    meshes = counted(stage.meshes, "mesh", "meshes")
    notes = [
        said(
            "spectrum",
            speed=rpm_text(results),
            motion=stage.motion,
            meshes=meshes,
            part=percent(stage.sidebands),
            error=percent(stage.error),
        )
    ]
    if stage.error_left_out is not None:
        orders = float(stage.error_order[-1])
        notes.append(said("spectrum_revolution", orders=orders, left=percent(stage.error_left_out)))
    notes += [] if stage.converged else [stage.message]
    drawn = pictures(results, LINES)
    return Part(
        "spectrum", "Orders of the motion", figures=drawn, tables=(Table(heads, rows),), notes=tuple(notes)
    )


def _lines() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    of_lines = outputs_from(lambda engine: engine[SPECTRUM], coupling.MotionSpectrum, "spectrum")
    return (of_lines("sidebands"),)


LINES_OF_MOTION = Product(
    name="spectrum",
    goals=wanting("spectrum", SPECTRUM),
    variables=when(SPECTRUM, lambda lines: [carrying("spectrum", lines)]),
    solved={"spectrum": SPECTRUM},
    tables={"spectrum": CurveTable("spectrum", "force", axis="line")},
    pictures=LINES,
    sections=section_of(SPECTRUM, _of_lines),
    outputs=_lines,
)


PASSAGES: Pictures = {
    "run_up": "run_up_peak_up",
    "waterfall": "run_up_order_force_up",
    "drive_run_up": ("run_up_bearings", "run_up_shafts"),
}


@stage("run-up", "run-up and coast-down", "dynamics", SCALING, DRIVE, kept="dynamics flankfilm gears")
def RUN_UP(run: Engine) -> coupling.SpeedRunUp:
    """Motion while the speed rises and falls evenly in time."""
    dynamics = required(run.scene.dynamics, "[dynamics]", "the run-up")
    asked = required(dynamics.run_up, "dynamics.run_up", "the run-up", "add the range")
    periods = 8000 if asked.periods is None else asked.periods
    motion, rows = moving(run), run.rows(RUN_UP)
    if asked.frequency is not None:
        return coupling.speed_run_up(motion, frequency=asked.frequency, periods=periods, progress=rows)
    low, high = asked.ends
    speeds = (low * math.pi / 30.0, high * math.pi / 30.0)
    return coupling.speed_run_up(motion, speeds, seconds=asked.seconds, periods=periods, progress=rows)


def _of_passages(stage: coupling.SpeedRunUp, results: xr.Dataset) -> Part:
    """Draw run-up and coast-down with their orders, and list the maximum force and its largest change."""
    from flankfilm.figures.motion import scale  # which loads matplotlib

    force = scale(results, "force")
    heads = (
        "run",
        force.named("maximum force"),
        "at",
        "largest jump at",
        force.named("before it"),
        force.named("after it"),
    )
    rows = tuple((way, *_extremes(stage, way, float(force.values))) for way in ("up", "down"))
    seconds = "" if stage.seconds is None else f" in {number(stage.seconds)} s"
    note = said(
        "run_up",
        periods=f"{stage.periods:,}",
        seconds=seconds,
        rate=number(stage.rate),
        error=percent(stage.error),
        greatest=percent(stage.greatest_error),
    )
    carried = _carried_on_the_way(stage)
    drawn = pictures(results, PASSAGES)
    tables = (Table(heads, rows), *carried)
    return Part("run-up", "Run-up and coast-down", figures=drawn, tables=tables, notes=(note,))


def _carried_on_the_way(stage: coupling.SpeedRunUp) -> tuple[Table, ...]:
    """Maximum loads of the parts of a drive train in run-up and coast-down."""
    if stage.speed is None:
        return ()
    speed = np.concatenate([stage.speed[way] for way in ("up", "down")])

    def values(figure: str) -> Array:
        return np.concatenate([getattr(stage, figure)[way] for way in ("up", "down")])

    return carried_table(stage, ("at [rpm]",), values, lambda at: (f"{RPM * speed[at[0]]:.0f}",))


def _extremes(stage: coupling.SpeedRunUp, way: str, unit: float) -> tuple[str, ...]:
    """Maximum force and where; the largest change of the root mean square between blocks, and where."""
    factor, spread = stage.force_factor[way], stage.spread[way]
    at = stage.frequency[way] if stage.speed is None else RPM * stage.speed[way]
    rpm = "" if stage.speed is None else " rpm"
    most = int(np.nanargmax(factor))
    jump = int(np.nanargmax(np.abs(np.diff(spread)))) if len(spread) > 1 else 0
    after = min(jump + 1, len(spread) - 1)
    ends = (
        number(unit * float(factor[max(jump - 1, 0)])),
        number(unit * float(factor[min(after + 1, len(at) - 1)])),
    )
    return number(unit * float(factor[most])), f"{at[most]:.5g}{rpm}", f"{at[after]:.5g}{rpm}", *ends


def _passages() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    of_parts = outputs_from(of_a_train(RUN_UP), coupling.SpeedRunUp, "run-up")
    return (
        output_of(
            "greatest_run_up_factor",
            Figure("1", "maximum force over the mean force of run-up and coast-down"),
            "run-up",
            in_result(RUN_UP, lambda run_up: greatest_of(run_up.force_factor)),
            error_output="run_up_error",
        ),
        of_parts("greatest_bearing_force", name="greatest_run_up_bearing_force", error_output="run_up_error"),
        of_parts("greatest_shaft_torque", name="greatest_run_up_shaft_torque", error_output="run_up_error"),
        output_of(
            "run_up_error",
            Figure(
                "1",
                "estimated relative error of the maximum forces and torques of the run-up, by steps of the frequency "
                "and by samples",
            ),
            "run-up",
            in_result(RUN_UP, attrgetter("greatest_error")),
        ),
    )


PASSAGE = Product(
    name="run-up",
    goals=wanting("run-up", RUN_UP),
    variables=when(RUN_UP, lambda ways: [carrying("run_up", ways)]),
    solved={"run_up": RUN_UP},
    tables={"run_up": CurveTable("run_up", "force_factor_up", axis="block")},
    pictures=PASSAGES,
    sections=section_of(RUN_UP, _of_passages),
    outputs=_passages,
)
