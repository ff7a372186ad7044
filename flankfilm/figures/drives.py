"""Drive trains: what bearings, shafts and couplings carry over the speed, and the modes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from base import Array
from flankfilm.figures.reading import need, read
from flankfilm.figures.style import DASHES, MARK, Style, colours, from_zero, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DRIVE = 'run a scene with [shafts] that wants "sweep"'

WAYS = {"up": "rising", "down": "falling"}
FORCE = "maximum force\nover mean [-]"
PARTS = {
    "bearing": ("bearing_force", "maximum force\nof a bearing"),
    "shaft": ("shaft_torque", "maximum torque"),
}
"""What carries, its figure and how that is called."""

DIRECTIONS = {"": "", "across": ",\nacross", "axial": ",\naxial"}
"""Endings of names of forces that are not along the line of action, each with its panel's addition."""


def drive_sweep(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the maximum mesh force, and what every bearing, shaft and coupling carries at most, over the speed.

    Both sweeps: rising speeds full, falling ones dashed. Grey lines stand where the mesh frequency is a natural one.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run with ``[shafts]`` that wants ``sweep``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, DRIVE, "drive_sweep_frequency", "drive_sweep_force_factor_up")
    over = "speed" if "drive_sweep_speed" in results.variables else "frequency"
    x = read(results, f"drive_sweep_{over}")
    marks = resonances(results, over == "speed")
    return carried(dict.fromkeys(WAYS, x.values), x.label, carried_rows(results, "drive_sweep"), marks, style)


def drive_map(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the maximum force of a bearing and the maximum torque of a shaft over the speed, at each torque.

    Of the sweeps up and down the greater. Grey lines stand where the mesh frequency is a natural one at the scene's
    torque.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run with ``[shafts]`` that wants ``dynamic-map``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    wanted = 'run a scene with [shafts] that wants "dynamic-map"'
    need(results, wanted, "dynamic_map_speed", "drive_resonance_speeds")
    speed, marks = read(results, "dynamic_map_speed"), resonances(results)
    torques = results["dynamic_map_torque"].values.tolist()
    kinds = [
        (figure, label)
        for part, (figure, label) in PARTS.items()
        if f"dynamic_map_{part}s" in results.variables
    ]
    panels_of = [
        (
            read(results, f"dynamic_map_{figure}").named(label),
            np.nanmax(results[f"dynamic_map_{figure}"].values, axis=2),
        )
        for figure, label in kinds
    ] or [("dynamic factor K_v [-]", results["dynamic_map_factor"].values)]
    with sheet(style, len(panels_of), height=1.2 + 1.9 * len(panels_of), legend=0) as (drawn, panels):
        for axes, (label, values) in zip(panels, panels_of, strict=True):
            for row, load, colour in zip(values, torques, 5 * colours(7), strict=False):
                axes.plot(speed.values, row, color=colour, linestyle="-", label=f"{load:g} N m")
            _mark(axes, marks, speed.values)
            axes.set_ylabel(label)
        legend_over(panels[0], 5)
        from_zero(*panels)
        panels[-1].set_xlabel(speed.label)
    return drawn


def bearing_sweep(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw what bearings of gears in space carry at most, how these forces swing, axial motion and tilt of the gears.

    Grey lines stand where the mesh frequency is a natural one.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``bearing-forces``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, 'run a scene that wants "bearing-forces"', "in_space_bearing_force", "in_space_speed")
    speed, marks = read(results, "in_space_speed"), read(results, "in_space_resonance_speeds").values
    bearings = [str(name) for name in results["in_space_bearings"].values]
    shown = (
        ("bearing_force", "maximum force", bearings),
        ("bearing_swing", "force about mean,\nroot mean square", bearings),
        ("axial_motion", "axial motion,\npeak to peak", ["pinion", "wheel"]),
        ("tilt", "maximum tilt\nabout mean [µrad]", ["pinion", "wheel"]),
    )
    with sheet(style, len(shown), height=1.2 + 1.9 * len(shown), legend=0) as (drawn, panels):
        for axes, (figure, label, names) in zip(panels, shown, strict=True):
            reading = read(results, f"in_space_{figure}")
            for column, (name, colour) in enumerate(zip(names, 3 * colours(7), strict=False)):
                scaled = (1e6 if figure == "tilt" else 1.0) * reading.values[:, column]
                axes.plot(speed.values, scaled, color=colour, label=name)
            _mark(axes, marks, speed.values)
            axes.set_ylabel(label if figure == "tilt" else reading.named(label))
            legend_over(axes, min(len(names), 4))
        from_zero(*panels)
        panels[-1].set_xlabel(speed.label)
    return drawn


def carried_rows(results: xr.Dataset, prefix: str) -> list[Row]:
    """Panels of the mesh force, of all bearings, and of all shafts and couplings, as far as there are any."""
    ways = {way: results[f"{prefix}_force_factor_{way}"].values[:, None] for way in WAYS}
    rows = [Row(FORCE, ("mesh",), ways)]
    for part, (figure, label) in PARTS.items():
        if f"{prefix}_{part}s" in results.variables:
            readings = {way: read(results, f"{prefix}_{figure}_{way}") for way in WAYS}
            names = tuple(str(name) for name in results[f"{prefix}_{part}s"].values)
            for ending, direction in DIRECTIONS.items():
                kept = [k for k, name in enumerate(names) if _ending(name) == ending]
                ways = {way: reading.values[:, kept] for way, reading in readings.items()}
                if kept:
                    shown = tuple(names[k].removesuffix(f" {ending}") for k in kept)
                    rows.append(Row(readings["up"].named(label + direction), shown, ways))
    return rows


def _ending(name: str) -> str:
    """Direction in a part's name; empty along the line of action."""
    return next((ending for ending in DIRECTIONS if ending and name.endswith(f" {ending}")), "")


class Row(NamedTuple):
    """Panel of a sweep: its label, names of the parts, and their curves by direction, shape (values, parts)."""

    label: str
    names: tuple[str, ...]
    ways: Mapping[str, Array]


def carried(
    at: Mapping[str, Array], label: str, rows: Sequence[Row], marks: Array, style: Style | None = None
) -> Figure:
    """Draw what parts carry over the speed or the frequency of each direction, panel by panel, with lines at places."""
    with sheet(style, len(rows), height=1.2 + 1.9 * len(rows), legend=0) as (drawn, panels):
        for axes, row in zip(panels, rows, strict=True):
            for column, (name, colour) in enumerate(zip(row.names, 3 * colours(7), strict=False)):
                for way, dash in zip(WAYS, DASHES, strict=False):
                    text = f"{name}, speed {WAYS[way]}" if len(row.names) == 1 else name
                    shown = text if way == "up" or len(row.names) == 1 else None
                    axes.plot(at[way], row.ways[way][:, column], linestyle=dash, color=colour, label=shown)
            _mark(axes, marks, at["up"])
            axes.set_ylabel(row.label)
            legend_over(axes, min(max(len(row.names), 2), 4))
        from_zero(*panels)
        panels[-1].set_xlabel(label)
    return drawn


def _mark(axes: Axes, marks: Array, over: Array) -> None:
    """Draw lines at those places that lie within a range."""
    for at in marks[(marks >= over.min()) & (marks <= over.max())]:
        axes.axvline(at, color=MARK, linewidth=0.8, zorder=0)


def resonances(results: xr.Dataset, speeds: bool = True) -> Array:
    """Pinion speeds [rpm], or frequencies over the pair's, at which the mesh meets the natural ones of the train.

    None where the train is not known.
    """
    if not speeds:
        natural = results["drive_natural_frequencies"].values
        return np.asarray(natural / float(results["oscillator_natural_frequency"]))
    if "drive_resonance_speeds" not in results:
        return np.zeros(0)
    return read(results, "drive_resonance_speeds").values


def drive_modes(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the displacements of every freedom in every mode of the drive train, the largest of each mode 1.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run with ``[shafts]`` that wants ``sweep``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, DRIVE, "drive_mode_shapes", "drive_natural_frequencies")
    names = [str(name) for name in results["drive_freedoms"].values]
    frequencies, shapes, shares = (
        results[f"drive_{name}"].values for name in ("natural_frequencies", "mode_shapes", "mesh_share")
    )
    with sheet(style, height=1.6 + 0.3 * len(frequencies), legend=0) as (drawn, (axes,)):
        shade = axes.imshow(shapes, cmap="RdBu_r", vmin=-1.0, vmax=1.0, aspect="auto")
        for (row, column), value in np.ndenumerate(shapes):
            colour = "#ffffff" if abs(value) > 0.6 else "#000000"
            axes.text(
                column,
                row,
                f"{round(value, 2) + 0.0:.2f}",
                ha="center",
                va="center",
                color=colour,
                fontsize=7,
            )
        axes.set_xticks(range(len(names)), names, rotation=30, ha="right")
        rows = [
            f"{frequency:.0f}, {100 * share:.0f} % in the mesh"
            for frequency, share in zip(frequencies, shares, strict=True)
        ]
        axes.set_yticks(range(len(rows)), rows)
        axes.set(xlabel="point of the train", ylabel="natural frequency [Hz]")
        axes.grid(visible=False)
        drawn.colorbar(shade, ax=axes, label="displacement, largest 1 [-]", pad=0.01)
    return drawn
