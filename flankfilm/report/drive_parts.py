"""Sections of the report about drive trains: modes, and what bearings, shafts and couplings carry over the speed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from base.units import factor
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import counted, number, percent, plus_minus

if TYPE_CHECKING:
    import xarray as xr

    from base import Array
    from flankfilm.coupling import DriveSweep, PairDrive

RPM = 1.0 / factor("rpm")


def drive(stage: PairDrive, results: xr.Dataset) -> Part:
    """Modes of the train: frequency, the pinion's speed at which the mesh meets it, and what moves most."""
    rows = tuple(
        (
            str(row),
            number(float(frequency), 5),
            f"{RPM * stage.resonance_speed(float(frequency)):.0f}",
            number(100.0 * float(share)),
            stage.freedoms[int(np.argmax(np.abs(shape)))],
        )
        for row, (frequency, share, shape) in enumerate(
            zip(stage.natural_frequencies, stage.mesh_share, stage.mode_shapes, strict=True), start=1
        )
    )
    heads = (
        "mode",
        "frequency [Hz]",
        "met by the mesh at [rpm]",
        "elastic energy in the mesh [%]",
        "moves most",
    )
    known = "unknown" if stage.error is None else percent(stage.error)
    notes = (said("drive", error=known),)
    drawn = pictures(results, "drive_modes")
    return Part("drive", "Drive train", figures=drawn, tables=(Table(heads, rows),), notes=notes)


def drive_sweep(stage: DriveSweep, results: xr.Dataset) -> Part:
    """Draw what every part carries over the speed, and list the greatest of each and where it is met."""
    heads = ("part", "mean", "greatest", "at [rpm]", "root mean square about the mean, greatest", "unit")
    rows = (*_rows(stage, "bearing", "bearing_force", "N"), *_rows(stage, "shaft", "shaft_torque", "N m"))
    said_of = {"error": percent(stage.sampling_error), "periods": counted(stage.cost.periods, "period")}
    notes = [said("drive_sweep", flow=f"{stage.error:.0e}", **said_of)]
    notes += [stage.message] if stage.message else []
    drawn = pictures(results, "drive_sweep")
    return Part(
        "drive-sweep",
        "Motion of the drive train",
        figures=drawn,
        tables=(Table(heads, rows),),
        notes=tuple(notes),
    )


def _rows(stage: DriveSweep, part: str, figure: str, unit: str) -> Iterator[tuple[str, ...]]:
    """Mean, greatest and swing of every bearing, or of every shaft and coupling, of both sweeps."""
    for column, name in enumerate(getattr(stage, f"{part}s")):
        mean, swing, most = (_both(stage, f"{figure}{kind}", column) for kind in ("_mean", "_swing", ""))
        if not np.isfinite(most).any():
            yield name, "-", "-", "-", "-", unit
            continue
        at = int(np.nanargmax(most)) % len(stage.speed)
        values = (float(np.nanmean(mean)), float(np.nanmax(most)))
        yield (
            name,
            *map(number, values),
            f"{RPM * stage.speed[at]:.0f}",
            number(float(np.nanmax(swing))),
            unit,
        )


def _both(stage: DriveSweep, figure: str, column: int) -> Array:
    """Values of a part in the sweep up and then in the one down."""
    return np.concatenate([getattr(stage, figure)[way][:, column] for way in ("up", "down")])


def headlines(stage: DriveSweep) -> list[Headline]:
    """Greatest force of a bearing and greatest torque of a shaft, each with where it is met."""
    found = []
    for what, part, figure, unit in (
        ("greatest force of a bearing", "bearing", "bearing_force", "N"),
        ("greatest torque of a shaft", "shaft", "shaft_torque", "N m"),
    ):
        names = getattr(stage, f"{part}s")
        values = np.concatenate([getattr(stage, figure)[way] for way in ("up", "down")])
        if not names or not np.isfinite(values).any():
            continue
        row, column = np.unravel_index(int(np.nanargmax(values)), values.shape)
        rpm = RPM * stage.speed[int(row) % len(stage.speed)]
        error = f"{plus_minus(stage.sampling_error)} by samples"
        note = f"{names[int(column)]}, at {rpm:.0f} rpm of the speeds swept; {error}"
        found.append(Headline(what, number(float(values[row, column])), note, unit))
    return found
