"""The drive train: its modes, and what bearings, shafts and couplings carry over the speed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Set
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from base import Figure, InputError
from base.results import ITSELF
from flankfilm import coupling
from flankfilm.coupling.vibration.part_loads import PARTS
from flankfilm.output import drives
from flankfilm.products.output import Named, in_result, model_error_of, output_of, outputs_from
from flankfilm.products.product import CurveTable, Product, ranked, section_of, together
from flankfilm.report import drive_parts
from flankfilm.report.page import Headline
from flankfilm.scene import Scene
from flankfilm.scene.needs import MOTIONS
from flankfilm.stages.computed import Computed
from flankfilm.stages.drives import DRIVE, DRIVE_SWEEP
from flankfilm.stages.engine import Engine, Stage

if TYPE_CHECKING:
    import xarray as xr

CARRIED = tuple(f"{figure}{end}" for figure, _ in PARTS.values() for end in ("", "_swing"))
"""What bearings, shafts and couplings carry, where there are any."""


def goals(scene: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
    """The train of every motion on shafts, and its sweep."""
    if scene.shafts is not None and wants & {*MOTIONS}:
        yield DRIVE
        if "sweep" in wants:
            yield DRIVE_SWEEP


def variables(computed: Computed) -> Iterator[xr.Dataset]:
    """Modes of the train, and its sweep."""
    return drives.train(computed.get(DRIVE), computed.get(DRIVE_SWEEP))


def headlines(computed: Computed) -> Iterator[Headline]:
    """Maximum forces and torques, and the dynamic factor around the operating speed."""
    if (stage := computed.get(DRIVE_SWEEP)) is None:
        return
    yield from ranked(drive_parts.headlines(stage), 2, 2, 2)
    if (rpm := computed.scene.rpm) is not None:
        yield from ranked(drive_parts.operating_headlines(stage, rpm), 1)


def of_a_train(stage: Stage[Any]) -> Callable[[Engine], Any]:
    """Result of a stage, of scenes with shafts alone."""

    def of(engine: Engine) -> Any:
        if engine.scene.shafts is None:
            allowed = "are of a drive train: there are no bearings and shafts without [shafts]"
            raise InputError.at(
                "outputs", "bearing forces and shaft torques", allowed, "Give [shafts], or drop them"
            )
        return engine[stage]

    return of


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    of_drive = outputs_from(lambda engine: engine[DRIVE], coupling.PairDrive, "sweep")
    of_carried = outputs_from(lambda engine: engine[DRIVE_SWEEP], coupling.DriveSweep, "sweep")
    return (
        of_drive("lowest_frequency", name="lowest_drive_frequency", error_output="drive_frequency_error"),
        of_drive("mesh_frequency", name="drive_mesh_frequency", error_output="drive_frequency_error"),
        output_of(
            "drive_frequency_error",
            Figure(
                "1",
                "estimated relative error of these frequencies, the greater, by reduction, elements and mean "
                "stiffness; nan for a given series",
            ),
            "sweep",
            in_result(DRIVE, lambda drive: max(drive.lowest_frequency_error, drive.mesh_frequency_error)),
        ),
        of_drive("valid_to", name="drive_valid_to"),
        of_drive("tilt_stiffness", name="drive_tilt_stiffness"),
        of_drive("load_centre", name="drive_load_centre"),
        of_drive("tilt_change", name="drive_tilt_change"),
        of_drive("load_travel", name="drive_load_travel"),
        of_carried(
            "greatest_bearing_force",
            error_output="drive_sampling_error",
            model_output="greatest_bearing_force_model_error",
        ),
        of_carried(
            "greatest_shaft_torque",
            error_output="drive_sampling_error",
            model_output="greatest_shaft_torque_model_error",
        ),
        output_of(
            "greatest_bearing_force_error",
            Figure(
                "1",
                "estimated relative error of that force by search, samples and the band of the shafts' damping",
                no_error=ITSELF,
            ),
            "sweep",
            in_result(DRIVE_SWEEP, attrgetter("greatest_bearing_error")),
        ),
        output_of(
            "greatest_shaft_torque_error",
            Figure("1", "estimated relative error of that torque, likewise", no_error=ITSELF),
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
                no_error=ITSELF,
            ),
            "sweep",
            in_result(DRIVE_SWEEP, attrgetter("carried_error")),
        ),
    )


PRODUCT = Product(
    name="drive train",
    goals=goals,
    variables=variables,
    tables={
        "drive_modes": CurveTable(
            "drive",
            "natural_frequencies",
            ("natural_frequencies", "frequency_error", "retained", "mesh_share"),
        ),
        **{
            f"drive_peaks_{part}s": CurveTable(
                "drive_sweep",
                f"{figure}_peak",
                (f"{part}s", *(f"{figure}_peak{end}" for end in ("", "_speed", "_error"))),
            )
            for part, (figure, _) in PARTS.items()
        },
        "drive_sweep": CurveTable("drive_sweep", "force_factor_up", axis="frequency"),
    },
    headlines=headlines,
    pictures={**drive_parts.SWEPT, **drive_parts.MODES},
    sections=together(section_of(DRIVE, drive_parts.drive), section_of(DRIVE_SWEEP, drive_parts.drive_sweep)),
    outputs=outputs,
)
