"""What a study can ask of a row's motion: natural frequency, loss of contact, forces, jumps, each with its error."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import product
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Figure, InputError
from base.results import figures
from flankfilm.coupling.drive.pair_drive import PairDrive
from flankfilm.coupling.speeds.drive_sweep import DriveSweep
from flankfilm.coupling.speeds.dynamic_map import DynamicMap
from flankfilm.coupling.speeds.run_ups import SpeedRunUp
from flankfilm.coupling.speeds.sidebands import MotionSpectrum
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.stages.drives import DRIVE, DRIVE_SWEEP
from flankfilm.stages.engine import Engine, Stage
from flankfilm.stages.motion import SCALING, SWEEP
from flankfilm.stages.speeds import DIAGRAM, DYNAMIC_MAP, RUN_UP, SPECTRUM
from flankfilm.studies.output import Named, in_result, model_error_of, output_of, outputs_from

if TYPE_CHECKING:
    from flankfilm.coupling.speeds.jumps import SpeedDiagram
    from flankfilm.coupling.speeds.speed_sweep import SpeedSweep

_oscillator = outputs_from(lambda engine: engine[SCALING], PairOscillator, "fourier")
_drive = outputs_from(lambda engine: engine[DRIVE], PairDrive, "sweep")
_carried = outputs_from(lambda engine: engine[DRIVE_SWEEP], DriveSweep, "sweep")


def _of_a_train(stage: Stage[Any]) -> Callable[[Engine], Any]:
    """Result of a stage, of scenes with shafts alone."""

    def of(engine: Engine) -> Any:
        if engine.scene.shafts is None:
            allowed = "are of a drive train: there are no bearings and shafts without [shafts]"
            raise InputError.at(
                "outputs", "bearing forces and shaft torques", allowed, "Give [shafts], or drop them"
            )
        return engine[stage]

    return of


_on_the_way = outputs_from(_of_a_train(RUN_UP), SpeedRunUp, "run-up")
_of_map = outputs_from(_of_a_train(DYNAMIC_MAP), DynamicMap, "dynamic-map")


def _resonance(motion: PairOscillator) -> float | None:
    """Pinion speed at which the mesh frequency is the natural one."""
    return None if motion.scales is None else motion.scales.speed(1.0)


def _greatest(values: Mapping[str, Array] | None) -> float | None:
    """Largest of both directions of a sweep, of the motions that are known; None without any."""
    known = [curve[~np.isnan(curve)] for curve in (values or {}).values()]
    joined = np.concatenate(known) if known else np.zeros(0)
    return float(joined.max()) if joined.size else None


def _swept(name: str, figure: Figure, value: Callable[[SpeedSweep], Any]) -> Named:
    """Output of the pair's sweep on rigid shafts."""

    def of(engine: Engine) -> Any:
        if engine.scene.shafts is not None:
            allowed = "is of a pair on rigid shafts: the sweep of a drive train does not know it"
            raise InputError.at(f"outputs.{name}", "", allowed, "Leave it out, or leave [shafts] out")
        return value(engine[SWEEP])

    return output_of(name, figure, "sweep", of)


def _moved(name: str, figure: Figure, value: Callable[[SpeedSweep | DriveSweep], Any]) -> Named:
    """Output of the sweep, of a drive train's where the scene has shafts."""
    return output_of(
        name,
        figure,
        "sweep",
        lambda engine: value(engine[SWEEP] if engine.scene.shafts is None else engine[DRIVE_SWEEP]),
    )


def _force_error(sweep: SpeedSweep | DriveSweep) -> float | None:
    """Sampling, and what more harmonics change; None where that is not known."""
    if not isinstance(sweep, DriveSweep):
        return sweep.greatest_factor_error
    truncation = _greatest(sweep.force_change)
    return None if truncation is None else truncation + sweep.sampling_error


def _loss_speed(sweep: SpeedSweep) -> float | None:
    """Lowest pinion speed at which contact is lost, by the sweep's own speed over frequency."""
    least = sweep.least_grazing
    if least is None or sweep.speed is None:
        return None
    return float(sweep.speed[0] / sweep.frequency[0]) * least


def _first(rising: bool, curve: str) -> Callable[[SpeedDiagram], float | None]:
    """Figure of the first jump that a rising, or a falling, speed reaches; None where no motion ends."""

    def of(diagram: SpeedDiagram) -> float | None:
        values = getattr(diagram, curve)
        met = [at for at, jump in enumerate(diagram.jumps) if jump.rising is rising]
        return None if values is None or not met else float(values[met[0] if rising else met[-1]])

    return of


def _jumps() -> list[Named]:
    ways = {"rising": ("least", "rises"), "falling": ("greatest", "falls")}
    shown = {
        "jump_speed": (
            "rad/s",
            "rpm",
            "{} pinion speed at which a motion ends as the speed {}; nan without one",
        ),
        "jump_frequency": ("1", "", "{} frequency at which a motion ends as it {}; nan without one"),
        "jump_error": ("1", "", "estimated relative error of the {} speed at which a motion ends as it {}"),
    }
    return [
        output_of(
            f"{curve}_{way}",
            Figure(unit, meaning.format(*words), shown=shown_in),
            "diagram",
            in_result(DIAGRAM, _first(way == "rising", curve)),
        )
        for (way, words), (curve, (unit, shown_in, meaning)) in product(ways.items(), shown.items())
    ]


MOTION_OUTPUTS: tuple[Named, ...] = (
    _oscillator("natural_frequency"),
    output_of(
        "resonance_speed",
        Figure("rad/s", "pinion speed at which the mesh frequency is the natural one", shown="rpm"),
        "fourier",
        in_result(SCALING, _resonance),
    ),
    output_of(
        "natural_frequency_error",
        Figure(
            "1", "estimated relative error of natural frequency and resonance speed, by the mean stiffness"
        ),
        "fourier",
        in_result(SCALING, attrgetter("frequency_error")),
    ),
    model_error_of(
        "natural_frequency_model_error",
        "natural frequency and resonance speed",
        "fourier",
        lambda engine: engine[SCALING],
        "natural_frequency",
    ),
    _moved(
        "greatest_force_factor",
        Figure("1", "maximum force over the mean force, of all motions of the sweep"),
        lambda sweep: _greatest(sweep.force_factor),
    ),
    _moved(
        "greatest_force_factor_error",
        Figure("1", "its estimated relative error by samples and the series' order"),
        _force_error,
    ),
    _moved(
        "separated",
        Figure("1", "largest part of the time without contact, of all motions of the sweep", shown="%"),
        lambda sweep: _greatest(sweep.separated),
    ),
    _swept(
        "contact_loss_speed",
        Figure("rad/s", "lowest pinion speed at which contact is lost; nan where it never is", shown="rpm"),
        _loss_speed,
    ),
    _swept(
        "contact_loss_error",
        Figure("1", "estimated relative error of that speed; nan where unknown"),
        attrgetter("least_grazing_error"),
    ),
    _drive("lowest_frequency", name="lowest_drive_frequency"),
    _drive("mesh_frequency", name="drive_mesh_frequency"),
    output_of(
        "drive_frequency_error",
        Figure(
            "1",
            "estimated relative error of these frequencies, the greater, by reduction, elements and mean stiffness; "
            "nan for a given series",
        ),
        "sweep",
        in_result(DRIVE, lambda drive: max(drive.lowest_frequency_error, drive.mesh_frequency_error)),
    ),
    _drive("valid_to", name="drive_valid_to"),
    _drive("tilt_stiffness", name="drive_tilt_stiffness"),
    _drive("load_centre", name="drive_load_centre"),
    _drive("tilt_change", name="drive_tilt_change"),
    _carried("greatest_bearing_force"),
    _carried("greatest_shaft_torque"),
    output_of(
        "greatest_bearing_force_error",
        Figure(
            "1",
            "estimated relative error of that force by search, samples and the band of the shafts' damping",
        ),
        "sweep",
        in_result(DRIVE_SWEEP, attrgetter("greatest_bearing_error")),
    ),
    output_of(
        "greatest_shaft_torque_error",
        Figure("1", "estimated relative error of that torque, likewise"),
        "sweep",
        in_result(DRIVE_SWEEP, attrgetter("greatest_shaft_error")),
    ),
    *(
        model_error_of(f"{figure}_model_error", said, "sweep", lambda engine: engine[DRIVE_SWEEP], figure)
        for figure, said in (
            ("greatest_bearing_force", "that force, by the band of the damping and the search"),
            ("greatest_shaft_torque", "that torque, likewise"),
        )
    ),
    output_of(
        "drive_sampling_error",
        Figure("1", "estimated relative error of that force and torque by samples of a period"),
        "sweep",
        in_result(DRIVE_SWEEP, attrgetter("sampling_error")),
    ),
    output_of(
        "drive_sweep_error",
        Figure(
            "1",
            "estimated relative error of forces and torques of a drive train, by samples and the series' order; "
            "nan for a given series",
        ),
        "sweep",
        in_result(DRIVE_SWEEP, attrgetter("carried_error")),
    ),
    _oscillator("error_range"),
    output_of(
        "sidebands",
        figures(MotionSpectrum)["sidebands"],
        "spectrum",
        in_result(SPECTRUM, attrgetter("sidebands")),
    ),
    output_of(
        "greatest_run_up_factor",
        Figure("1", "maximum force over the mean force of run-up and coast-down"),
        "run-up",
        in_result(RUN_UP, lambda run_up: _greatest(run_up.force_factor)),
    ),
    output_of(
        "greatest_map_factor",
        Figure("1", "maximum dynamic factor over speeds and torques"),
        "dynamic-map",
        in_result(DYNAMIC_MAP, attrgetter("greatest")),
    ),
    output_of(
        "greatest_map_factor_error",
        Figure("1", "estimated relative error of that factor by samples of a period"),
        "dynamic-map",
        in_result(DYNAMIC_MAP, attrgetter("sampling_error")),
    ),
    _on_the_way("greatest_bearing_force", name="greatest_run_up_bearing_force"),
    _on_the_way("greatest_shaft_torque", name="greatest_run_up_shaft_torque"),
    _of_map("greatest_bearing_force", name="greatest_map_bearing_force"),
    _of_map("greatest_shaft_torque", name="greatest_map_shaft_torque"),
    output_of(
        "run_up_error",
        Figure(
            "1",
            "estimated relative error of the maximum forces and torques of the run-up, by steps of the frequency and "
            "by samples",
        ),
        "run-up",
        in_result(RUN_UP, attrgetter("greatest_error")),
    ),
    *_jumps(),
    output_of(
        "greatest_K_v",
        Figure("1", "maximum dynamic factor K_v by ISO 6336-1, method B, over the diagram's range"),
        "diagram",
        in_result(
            DIAGRAM,
            lambda diagram: (
                np.nanmax(diagram.force_factor_iso6336)
                if np.isfinite(diagram.force_factor_iso6336).any()
                else None
            ),
        ),
    ),
)
"""Outputs of the motion, with the names that a study file gives them."""
