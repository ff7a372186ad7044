"""Run-ups over speed, their orders as a waterfall, and the dynamic factor over speed and torque."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.figures.drives import carried, carried_rows, resonances
from flankfilm.figures.motion import scale
from flankfilm.figures.reading import Reading, need, read
from flankfilm.figures.style import COLOURS, Style, colours, from_zero, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

RUN_UP = 'run a scene that wants "run-up"'

WAYS: Mapping[str, Mapping[str, Any]] = {
    "up": {"color": COLOURS[5], "linewidth": 2.2},
    "down": {"color": COLOURS[0], "linewidth": 1.0},
}
"""Looks of both directions: the wide curve lies below, so that both show where they agree."""

TRACKED = (0.5, 1.0, 2.0, 3.0)
"""Mesh orders that are drawn over the speed."""

DECADES = 3.0
"""Powers of ten that a waterfall shows."""


def run_up(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw maximum force, vibration and time without contact over the speed, up and down.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``run-up``; in N, um and rpm where the scene has scales.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    force, length = scale(results, "force"), scale(results, "length")
    known = (
        ("force_factor", force, "maximum force" if force.unit == "N" else "maximum force\nover mean"),
        ("force_peak", force, "maximum\nmesh force"),
        ("peak", length, "maximum\ndisplacement"),
        ("spread", length, "displacement,\nroot mean square"),
        ("rms", length, "displacement,\nroot mean square"),
        ("separated", None, "time without\ncontact"),
    )
    ways = [way for way in WAYS if f"run_up_peak_{way}" in results] or list(WAYS)
    shown = [figure for figure in known if f"run_up_{figure[0]}_{ways[0]}" in results]
    need(results, RUN_UP, *(f"run_up_peak_{way}" for way in ways))
    with sheet(style, len(shown), height=7.0, legend=2) as (drawn, panels):
        for axes, (name, unit, label) in zip(panels, shown, strict=True):
            for way in ways:
                curve, at = read(results, f"run_up_{name}_{way}"), _place(results, way)
                values = curve.values if unit is None else float(unit.values) * curve.values
                axes.plot(at.values, values, label=way, **WAYS[way])
            axes.set(ylabel=(curve if unit is None else unit).named(label))
        from_zero(*panels)
        panels[-1].set(xlabel=at.label)
    return drawn


def drive_run_up(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the maximum mesh force and what bearings, shafts and couplings carry at most in run-up and coast-down.

    Run-up full, coast-down dashed. Grey lines stand where the mesh frequency is a natural one.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run with ``[shafts]`` that wants ``run-up``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    wanted = 'run a scene with [shafts] that wants "run-up"'
    need(results, wanted, "run_up_speed_up", "drive_resonance_speeds")
    x = {way: read(results, f"run_up_speed_{way}") for way in WAYS}
    label = Reading(x["up"].values, "pinion speed", x["up"].unit).label
    at = {way: reading.values for way, reading in x.items()}
    return carried(at, label, carried_rows(results, "run_up"), resonances(results), style)


def waterfall(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the orders of the force over the speed, up and down, and single orders beside each other.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``run-up``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, RUN_UP, "run_up_order_force_up", "run_up_order")
    force, order = scale(results, "force"), results["run_up_order"].values
    with sheet(style, 3, height=8.2, legend=0) as (drawn, panels):
        greatest = max(
            float(np.nanmax(results[f"run_up_order_force_{way}"].values)) for way in ("up", "down")
        )
        top = np.log10(greatest * float(force.values))
        for axes, way in zip(panels, ("up", "down"), strict=False):
            at, values = (
                _place(results, way),
                float(force.values) * results[f"run_up_order_force_{way}"].values,
            )
            shade = axes.pcolormesh(
                at.values, order, np.log10(np.maximum(values.T, 10.0 ** (top - DECADES))), shading="nearest",
                cmap="cividis", vmin=top - DECADES, vmax=top, rasterized=True,
            )  # fmt: skip
            axes.set(ylabel=f"mesh order [-], {way}")
        drawn.colorbar(shade, ax=panels[:2], label=f"log10 of the force's amplitude [{force.unit}]", pad=0.01)
        for wanted, colour in zip(TRACKED, colours(len(TRACKED)), strict=True):
            k = int(np.argmin(np.abs(order - wanted)))
            for way, dash in (("up", "-"), ("down", "--")):
                at = _place(results, way)
                line = float(force.values) * results[f"run_up_order_force_{way}"].values[:, k]
                label = f"order {wanted:g}" if way == "up" else None
                panels[2].plot(at.values, line, dash, color=colour, linewidth=1.0, label=label)
        panels[2].set(xlabel=at.label, ylabel=force.named("amplitude of the force"))
        from_zero(panels[2])
        legend_over(panels[2], len(TRACKED))
    return drawn


def dynamic_map(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the dynamic factor over speed and torque, and over the speed at each torque beside ISO 6336-1.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``dynamic-map``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, 'run a scene that wants "dynamic-map"', "dynamic_map_factor", "dynamic_map_torque")
    speed, torque = read(results, "dynamic_map_speed"), read(results, "dynamic_map_torque")
    factor, iso = results["dynamic_map_factor"].values, results["dynamic_map_iso"].values
    with sheet(style, 2, height=6.0, legend=0) as (drawn, (above, below)):
        if len(torque.values) > 1:
            shade = above.pcolormesh(
                speed.values,
                torque.values,
                factor,
                shading="nearest",
                cmap="cividis",
                vmin=1.0,
                rasterized=True,
            )
            drawn.colorbar(shade, ax=above, label="dynamic factor K_v [-]", pad=0.01)
        resonance = read(results, "dynamic_map_resonance")
        above.plot(
            resonance.values, torque.values, "o-", color="#ffffff", markersize=3, markeredgecolor="#000000"
        )
        above.set(ylabel=torque.label, xlim=(speed.values.min(), speed.values.max()))
        for k, (load, colour) in enumerate(zip(torque.values.tolist(), 5 * colours(7), strict=False)):
            below.plot(speed.values, factor[k], color=colour, linestyle="-", label=f"{load:g} N m")
            below.plot(speed.values, iso[k], color=colour, linestyle=":", linewidth=1.0)
        below.set(xlabel=speed.label, ylabel="dynamic factor K_v [-]\n(dotted: ISO 6336-1, B)")
        legend_over(below, 5)
    return drawn


def _place(results: xr.Dataset, way: str) -> Reading:
    """Speeds of the blocks where there are some, else frequencies."""
    name = f"run_up_speed_{way}"
    speed = read(results, name if name in results else f"run_up_frequency_{way}")
    return Reading(
        speed.values, "pinion speed" if name in results else "mesh over natural frequency", speed.unit
    )
