"""Sections of the report about drive trains: modes, and loads of bearings, shafts and couplings over the speed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from base.units import factor
from flankfilm.coupling.vibration.part_loads import PARTS, Carrying
from flankfilm.figures.reading import Pictures
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import counted, number, percent

if TYPE_CHECKING:
    import xarray as xr

    from base import Array
    from flankfilm.coupling import DriveSweep, PairDrive

RPM = 1.0 / factor("rpm")

SWEPT: Pictures = {"drive_sweep": "drive_sweep_force_factor_up"}
MODES: Pictures = {"drive_modes": "drive_mode_shapes"}


def drive(stage: PairDrive, results: xr.Dataset) -> Part:
    """Modes of the train: frequency, pinion speed of resonance with the mesh, and coordinate of largest motion."""
    rows = tuple(
        (
            str(row),
            number(float(frequency), 5),
            percent(float(error)),
            f"{RPM * stage.resonance_speed(float(frequency)):.0f}",
            number(100.0 * float(share)),
            stage.freedoms[int(np.argmax(np.abs(shape)))],
            "yes" if retained else "no",
        )
        for row, (frequency, error, share, shape, retained) in enumerate(
            zip(
                stage.natural_frequencies,
                stage.frequency_error,
                stage.mesh_share,
                stage.mode_shapes,
                stage.retained,
                strict=True,
            ),
            start=1,
        )
    )
    heads = (
        "mode",
        "frequency [Hz]",
        "error",
        "mesh resonance at [rpm]",
        "elastic energy in the mesh [%]",
        "largest motion",
        "retained",
    )
    notes = [
        said(
            "drive",
            error="unknown" if stage.error is None else percent(stage.error),
            gyroscopic=percent(stage.gyroscopic_change),
            tilt=_tilt(stage),
        ),
        *valid(stage),
    ]
    drawn = pictures(results, MODES)
    return Part("drive", "Drive train", figures=drawn, tables=(Table(heads, rows),), notes=tuple(notes))


def _tilt(stage: PairDrive) -> str:
    """Resistance of the mesh of the train to tilt, and the parts of it that are left out."""
    change = percent(stage.tilt_change)
    if not stage.tilt_stiffness:
        return said("drive_gives_way", change=change)
    centre = number(1e3 * stage.load_centre)
    known = np.isfinite(stage.load_travel_error)
    off = f" (± {percent(stage.load_travel_error)})" if known else ""
    travel = f"{number(1e6 * stage.load_travel)} µm{off}"
    return said(
        "drive_resists", change=change, stiffness=number(stage.tilt_stiffness), centre=centre, travel=travel
    )


def valid(stage: PairDrive | DriveSweep) -> list[str]:
    """Up to which mesh frequency forces hold; nothing where all modes are retained."""
    if stage.valid_to is None:
        return []
    return [said("drive_valid", to=f"{stage.valid_to:.0f}", error=percent(stage.reduction_error))]


def drive_sweep(stage: DriveSweep, results: xr.Dataset) -> Part:
    """Draw the load of every part over the speed; list the maximum of each and its speed."""
    heads = (
        "part",
        "mean",
        "maximum",
        "error",
        "at [rpm]",
        "with damping of shafts at the ends of its band",
        "root mean square about the mean, maximum",
        "unit",
    )
    rows = (*_rows(stage, "bearing", "bearing_force", "N"), *_rows(stage, "shaft", "shaft_torque", "N m"))
    said_of = {"error": percent(stage.sampling_error), "periods": counted(stage.cost.periods, "period")}
    notes = [said("drive_sweep", flow=f"{stage.error:.0e}", **said_of), *valid(stage), *_truncated(stage)]
    notes += [stage.message] if stage.message else []
    drawn = pictures(results, SWEPT)
    return Part(
        "drive-sweep",
        "Motion of the drive train",
        figures=drawn,
        tables=(Table(heads, rows),),
        notes=tuple(notes),
    )


def _truncated(stage: DriveSweep) -> list[str]:
    """Effect of the omitted harmonics on forces and torques; nothing for a given series."""
    if stage.force_change is None or stage.checked is None:
        return []
    changes = np.concatenate(list(stage.force_change.values()))
    same, repeating = np.isfinite(changes), ~np.isnan(changes)
    other, rest = int(np.sum(repeating & ~same)), int(np.sum(~repeating))
    force = float(changes[same].max()) if same.any() else None
    return [
        said(
            "truncated_drive",
            order=stage.longer_order,
            count=int(same.sum()),
            all=len(changes),
            force=percent(force),
            parts=percent(stage.truncation),
            unknown=said("truncated_unknown", other=other, rest=rest) if other + rest else "",
        )
    ]


def _rows(stage: DriveSweep, part: str, figure: str, unit: str) -> Iterator[tuple[str, ...]]:
    """Mean, maximum and variation of every bearing, or of every shaft and coupling, of both sweeps."""
    for column, name in enumerate(getattr(stage, f"{part}s")):
        mean, swing = (_both(stage, f"{figure}{kind}", column) for kind in ("_mean", "_swing"))
        peak, error, speed = (
            float(getattr(stage, f"{figure}_peak{kind}")[column]) for kind in ("", "_error", "_speed")
        )
        if not np.isfinite(peak):
            yield name, "-", "-", "-", "-", "-", "-", unit
            continue
        band = getattr(stage, f"{figure}_peak_band")[:, column]
        yield (
            name,
            number(float(np.nanmean(mean))),
            number(peak),
            percent(error),
            f"{RPM * speed:.0f}",
            " to ".join(number(float(end)) if np.isfinite(end) else "-" for end in band),
            number(float(np.nanmax(swing))),
            unit,
        )


def carried_table(
    stage: Carrying,
    places: tuple[str, ...],
    values: Callable[[str], Array],
    cells_at: Callable[[Sequence[int]], tuple[str, ...]],
) -> tuple[Table, ...]:
    """Table of the maximum and the variation of every part, and their place; none for a pair on rigid shafts.

    Parameters
    ----------
    stage : Carrying
    places : tuple of str
        Heads of the columns that say where.
    values : callable
        Gives all values of a figure, the parts along the last axis.
    cells_at : callable
        Gives the cells of these columns for indices of the other axes.
    """
    rows = []
    for part, (figure, unit) in PARTS.items():
        for column, name in enumerate(getattr(stage, f"{part}s")):
            most, swing = (values(f"{figure}{kind}")[..., column] for kind in ("", "_swing"))
            if not np.isfinite(most).any():
                continue
            at = [int(k) for k in np.unravel_index(int(np.nanargmax(most)), most.shape)]
            rows.append(
                (name, number(float(np.nanmax(most))), *cells_at(at), number(float(np.nanmax(swing))), unit)
            )
    heads = ("part", "maximum", *places, "root mean square about the mean, maximum", "unit")
    return (Table(heads, tuple(rows)),) if rows else ()


def _both(stage: DriveSweep, figure: str, column: int) -> Array:
    """Values of a part in the sweep up and then in the one down."""
    return np.concatenate([getattr(stage, figure)[way][:, column] for way in ("up", "down")])


def _about(band: Array) -> str:
    """Say what the error of a peak is made of; `band` has its heights with other damping, nan without a period."""
    if np.isfinite(band).any():
        return "model: the band of the damping and the search"
    return "the motion there does not repeat: its maximum may be higher"


def operating_headlines(stage: DriveSweep, rpm: float) -> list[Headline]:
    """Mesh force over the mean one at the speeds of the sweeps around the operating one; nothing beyond the sweeps."""
    speeds, after = RPM * stage.speed, int(np.searchsorted(RPM * stage.speed, rpm))
    if not 0 < after < len(speeds):
        return []
    met = np.array([*stage.force_factor.values()])[:, after - 1 : after + 1]
    if not np.isfinite(met).any():
        return []
    ends = dict.fromkeys(f"{end(met):.3g}" for end in (np.nanmin, np.nanmax))
    note = f"settled motions at {speeds[after - 1]:.0f} and {speeds[after]:.0f} rpm, swept around {rpm:g} rpm"
    off = Uncertainty(float(stage.sampling_error))
    return [Headline("dynamic factor around the operating speed", " to ".join(ends), note, "", off)]


def headlines(stage: DriveSweep) -> list[Headline]:
    """Maximum force of the mesh, of a bearing, and maximum torque of a shaft, each with its speed."""
    shown = []
    if np.isfinite(stage.force_peak):
        sampled = min(stage.sampling_error, stage.force_peak_error)
        off = Uncertainty(None)
        if np.isfinite(stage.force_peak_error):
            off = Uncertainty(sampled, stage.force_peak_error - sampled)
        note = f"at {RPM * stage.force_peak_speed:.0f} rpm; {_about(stage.force_peak_band)}"
        shown.append(
            Headline("maximum mesh force over the mean force", f"{stage.force_peak:.3g}", note, "", off)
        )
    for what, part, figure, unit in (
        ("maximum force of a bearing", "bearing", "bearing_force", "N"),
        ("maximum torque of a shaft", "shaft", "shaft_torque", "N m"),
    ):
        names, values = getattr(stage, f"{part}s"), getattr(stage, f"{figure}_peak")
        if not names or not np.isfinite(values).any():
            continue
        at = int(np.nanargmax(values))
        off, rpm = (
            getattr(stage, f"{figure}_peak_error")[at],
            RPM * getattr(stage, f"{figure}_peak_speed")[at],
        )
        sampled = min(stage.sampling_error, off)
        known_off = Uncertainty(sampled, off - sampled) if np.isfinite(off) else Uncertainty(None)
        note = f"{names[at]}, at {rpm:.0f} rpm; {_about(getattr(stage, f'{figure}_peak_band')[:, at])}"
        if stage.carried_error is not None:
            omitted = stage.carried_error - stage.sampling_error
            known = f"up to {percent(omitted)}" if np.isfinite(omitted) else "more, in places unknown,"
            note += f"; {known} by harmonics that the series leaves out"
        shown.append(Headline(what, number(float(values[at])), note, unit, known_off))
    return shown
