"""The unloaded transmission error with its harmonics, and orders of the motion with their sidebands."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.motion import rpm_text, scale
from flankfilm.figures.reading import need, read
from flankfilm.figures.style import MARK, Style, colours, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

CARRIED = {
    "bearing_force": "bearings, largest\namplitude",
    "shaft_torque": "shafts, largest\namplitude",
}
"""What parts of a drive train carry, and how the largest of them is called."""

SHOWN = 40
"""Harmonics that are drawn."""

DECADES = 5.0
"""Powers of ten that a spectrum shows below its largest line."""

SHOWN_DECADES = 4.0
"""The same of the error's harmonics."""


def excitation(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the unloaded transmission error over its period with its series, and the amplitudes of the harmonics.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run whose scene has ``dynamics.error_curve``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(
        results,
        "run a scene with dynamics.error_curve that wants a motion",
        "excitation_curve",
        "excitation_amplitude",
    )
    at, curve = (results[f"excitation_{name}"].values for name in ("position", "curve"))
    amplitude, phase = (results[f"excitation_{name}"].values for name in ("amplitude", "phase"))
    meshes = int(results["excitation_meshes"])
    order = np.arange(1, len(amplitude) + 1)
    turn = np.linspace(0.0, meshes, 801)
    series = curve.mean() + np.cos(2 * np.pi * turn[:, None] * order / meshes + phase) @ amplitude
    all_amplitudes = read(results, "excitation_all_amplitudes")
    with sheet(style, 2, height=4.6, legend=2, sharex=False) as (drawn, (over, lines)):
        first, second = colours(2)
        over.plot(at, 1e6 * curve, color=MARK, linewidth=2.4, label="unloaded transmission error")
        over.plot(turn, 1e6 * series, color=first, linewidth=1.0, label=f"series of order {len(amplitude)}")
        over.set(xlabel="position, base pitches from A [-]", ylabel="error [µm]")
        shown = all_amplitudes.values[:SHOWN]
        kept = np.arange(1, len(shown) + 1) <= len(amplitude)
        places = np.arange(1, len(shown) + 1) / meshes
        wide = 0.6 / meshes
        lines.bar(places[kept], shown[kept], wide, color=first)
        lines.bar(places[~kept], shown[~kept], wide, color=second, alpha=0.6)
        if shown.max(initial=0.0) > 0.0:
            lines.set_yscale("log")
        low = float(shown.max(initial=0.0)) * 10.0**-SHOWN_DECADES
        lines.set(ylim=(low, None), xlabel="mesh order [-]", ylabel="amplitude [µm]")
    return drawn


def spectrum(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the lines of force and displacement over the mesh order; between whole orders lie sidebands.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``spectrum``; in N and um where the scene has scales.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(
        results,
        'run a scene that wants "spectrum"',
        "spectrum_order",
        "spectrum_force",
        "spectrum_displacement",
    )
    order = results["spectrum_order"].values
    force, length = scale(results, "force"), scale(results, "length")
    shown = [
        (float(force.values) * results["spectrum_force"].values, force.named("force, amplitude")),
        (
            float(length.values) * results["spectrum_displacement"].values,
            length.named("displacement,\namplitude"),
        ),
    ]
    for figure, label in CARRIED.items():
        if f"spectrum_{figure}" in results.variables:
            reading = read(results, f"spectrum_{figure}")
            shown.append((reading.values.max(axis=1), reading.named(label)))
    modes = results["spectrum_mode_order"].values if "spectrum_mode_order" in results else np.zeros(0)
    at = f", at {rpm_text(results)}" if "spectrum_frequency" in results else ""
    with sheet(style, len(shown), height=1.0 + 1.9 * len(shown), legend=3) as (drawn, panels):
        for axes, (values, label) in zip(panels, shown, strict=True):
            _lines(axes, order, values, modes)
            axes.set_ylabel(label)
        panels[-1].set(xlabel=f"mesh order [-]{at}")
    return drawn


def _lines(axes: Axes, order: Array, values: Array, modes: Array) -> None:
    """Draw amplitudes of orders, sidebands and mesh orders apart, and where natural frequencies lie."""
    whole = np.abs(order - np.round(order)) < 1e-9
    low = max(float(np.nanmax(values, initial=0.0)), 1e-300) * 10.0**-DECADES
    for these, colour, width, text in zip(
        (~whole, whole), colours(6)[5:] + colours(1), (0.8, 1.8), ("sidebands", "mesh orders"), strict=True
    ):
        if these.any():
            heights = np.maximum(values[these], low)
            axes.vlines(order[these], low, heights, color=colour, linewidth=width, label=text)
    inside, text = modes[modes <= order.max() * 1.02], "natural frequencies"
    for k, at in enumerate(inside.tolist()):
        axes.axvline(
            at, color=colours(3)[2], linewidth=1.2, linestyle="--", zorder=0, label=None if k else text
        )
    axes.set(yscale="log", ylim=(low, None))
