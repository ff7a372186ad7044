"""Sections of the report about run-ups and about the dynamic factor over speed and torque."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.motion import scale
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.report.drive_parts import carried_table
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import DynamicMap, SpeedRunUp

RPM = 30.0 / np.pi


def run_up(stage: SpeedRunUp, results: xr.Dataset) -> Part:
    """Draw run-up and coast-down with their orders, and list where the force is greatest and changes most."""
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
    drawn = pictures(results, "run_up", "waterfall", *(["drive_run_up"] if carried else []))
    tables = (Table(heads, rows), *carried)
    return Part("run-up", "Run-up and coast-down", figures=drawn, tables=tables, notes=(note,))


def _carried_on_the_way(stage: SpeedRunUp) -> tuple[Table, ...]:
    """What parts of a drive train carry at most in run-up and coast-down."""
    if stage.speed is None:
        return ()
    speed = np.concatenate([stage.speed[way] for way in ("up", "down")])

    def values(figure: str) -> Array:
        return np.concatenate([getattr(stage, figure)[way] for way in ("up", "down")])

    return carried_table(stage, ("at [rpm]",), values, lambda at: (f"{RPM * speed[at[0]]:.0f}",))


def _extremes(stage: SpeedRunUp, way: str, unit: float) -> tuple[str, ...]:
    """Greatest force and where; the largest change of the root mean square between blocks, and where."""
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


def dynamic_map(stage: DynamicMap, results: xr.Dataset) -> Part:
    """Draw the map, and list the greatest factor at each torque."""
    rows = []
    for torque, resonance, factors, iso, apart in zip(
        stage.torque, stage.resonance, stage.factor, stage.iso, stage.separated, strict=True
    ):
        most = int(np.nanargmax(factors))
        beside = number(float(iso[most])) if np.isfinite(iso[most]) else "-"
        rows.append(
            (
                number(float(torque)),
                f"{RPM * resonance:.0f}",
                number(float(factors[most])),
                f"{RPM * stage.speed[most]:.0f}",
                beside,
                number(100.0 * float(np.nanmax(apart))),
            )
        )
    heads = (
        "torque [N m]",
        "resonance [rpm]",
        "maximum K_v [-]",
        "at [rpm]",
        "ISO 6336-1, B, there [-]",
        "most time without contact [%]",
    )
    notes = [said("dynamic_map", error=percent(stage.sampling_error))]
    if stage.truncation is not None:
        notes.append(said("dynamic_map_order", changed=percent(stage.truncation)))
    if not stage.converged:
        notes.append(stage.message)
    carried = carried_table(
        stage,
        ("at [rpm]", "at [N m]"),
        lambda figure: np.asarray(getattr(stage, figure)),
        lambda at: (f"{RPM * stage.speed[at[1]]:.0f}", number(float(stage.torque[at[0]]))),
    )
    drawn = pictures(results, "dynamic_map", *(["drive_map"] if carried else []))
    tables = (Table(heads, tuple(rows)), *carried)
    return Part(
        "dynamic-map",
        "Dynamic factor over speed and torque",
        figures=drawn,
        tables=tables,
        notes=tuple(notes),
    )


def map_headlines(stage: DynamicMap) -> list[Headline]:
    """Greatest factor of the map."""
    row, column = np.unravel_index(int(np.nanargmax(stage.factor)), stage.factor.shape)
    note = f"at {RPM * stage.speed[column]:.0f} rpm and {stage.torque[row]:g} N m"
    off = Uncertainty(float(stage.sampling_error))
    name = "maximum dynamic factor K_v of the map"
    return [Headline(name, f"{stage.greatest:.3g}", note, uncertainty=off)]
