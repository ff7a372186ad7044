"""Drive trains: what bearings, shafts and couplings carry over the speed, and the modes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from base import Array
from flankfilm.figures.reading import Reading, need, read
from flankfilm.figures.style import DASHES, MARK, Style, colours, from_zero, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

DRIVE = 'run a scene with [shafts] that wants "sweep"'

WAYS = {"up": "rising", "down": "falling"}
FORCE = "greatest force\nover mean [-]"
PARTS = {
    "bearing": ("bearing_force", "greatest force\nof a bearing"),
    "shaft": ("shaft_torque", "greatest torque"),
}
"""What carries, its figure and how that is called."""


def drive_sweep(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the greatest mesh force, and what every bearing, shaft and coupling carries at most, over the speed.

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
    ways = {way: results[f"drive_sweep_force_factor_{way}"].values[:, None] for way in WAYS}
    rows = [Row(FORCE, ("mesh",), ways)]
    for part, (figure, label) in PARTS.items():
        if f"drive_sweep_{part}s" in results.variables:
            found = {way: read(results, f"drive_sweep_{figure}_{way}") for way in WAYS}
            names = tuple(str(name) for name in results[f"drive_sweep_{part}s"].values)
            ways = {way: reading.values for way, reading in found.items()}
            rows.append(Row(found["up"].named(label), names, ways))
    return carried(x, rows, resonances(results), style)


class Row(NamedTuple):
    """Panel of a sweep: its label, names of the parts, and their curves by direction, shape (values, parts)."""

    label: str
    names: tuple[str, ...]
    ways: Mapping[str, Array]


def carried(x: Reading, rows: Sequence[Row], marks: Array, style: Style | None = None) -> Figure:
    """Draw what parts carry over the speed or the frequency, panel by panel, with lines at some places."""
    with sheet(style, len(rows), height=1.2 + 1.9 * len(rows), legend=0) as (drawn, panels):
        for axes, row in zip(panels, rows, strict=True):
            for column, (name, colour) in enumerate(zip(row.names, 3 * colours(7), strict=False)):
                for way, dash in zip(WAYS, DASHES, strict=False):
                    label = f"{name}, speed {WAYS[way]}" if len(row.names) == 1 else name
                    shown = label if way == "up" or len(row.names) == 1 else None
                    axes.plot(x.values, row.ways[way][:, column], linestyle=dash, color=colour, label=shown)
            for at in marks[(marks >= x.values.min()) & (marks <= x.values.max())]:
                axes.axvline(at, color=MARK, linewidth=0.8, zorder=0)
            axes.set_ylabel(row.label)
            legend_over(axes, min(max(len(row.names), 2), 4))
        from_zero(*panels)
        panels[-1].set_xlabel(x.label)
    return drawn


def resonances(results: xr.Dataset) -> Array:
    """Places on the axis of a sweep at which the mesh frequency is a natural one of the train."""
    frequency, rpm = results["drive_sweep_frequency"].values, results.get("drive_sweep_speed")
    natural = results["drive_natural_frequencies"].values / float(results["oscillator_natural_frequency"])
    if rpm is None:
        return np.asarray(natural)
    return np.asarray(natural * read(results, "drive_sweep_speed").values[-1] / frequency[-1])


def drive_modes(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the displacements of every freedom in every mode of the drive train.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run with ``[shafts]`` that wants ``sweep``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, DRIVE, "drive_mode_shapes", "drive_natural_frequencies")
    names = [str(name) for name in results["drive_freedoms"].values]
    return modes(
        results["drive_natural_frequencies"].values,
        results["drive_mode_shapes"].values,
        results["drive_mesh_share"].values,
        names,
        style,
    )


def modes(
    frequencies: Array, shapes: Array, shares: Array, names: Sequence[str], style: Style | None = None
) -> Figure:
    """Draw a table of modes: colour and number are displacements, the largest of each mode 1."""
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
            f"{one:.0f} Hz, {100 * share:.0f} % in the mesh"
            for one, share in zip(frequencies, shares, strict=True)
        ]
        axes.set_yticks(range(len(rows)), rows)
        axes.grid(visible=False)
        drawn.colorbar(shade, ax=axes, label="displacement, largest 1 [-]", pad=0.01)
    return drawn
