"""Pictures of single records of what drives the motion, of its orders, run-ups and maps, for `result.plot()`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.style import colours, sheet

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    import dynamics
    from flankfilm.coupling import DynamicMap, ErrorSeries, MotionSpectrum, SpeedRunUp

RPM = 30.0 / np.pi


def error_series(series: ErrorSeries) -> Figure:
    """Draw the unloaded transmission error over its period, with its series."""
    turn = np.linspace(0.0, series.meshes, 801)
    order = np.arange(1, series.order + 1) / series.meshes
    shown = series.curve.mean() + np.cos(2 * np.pi * turn[:, None] * order + series.phase) @ series.amplitude
    with sheet(None, height=3.2) as (drawn, (axes,)):
        axes.plot(series.position, 1e6 * series.curve, color="#999999", linewidth=2.2, label=series.source)
        axes.plot(turn, 1e6 * shown, color=colours(1)[0], label=f"series of order {series.order}")
        axes.set(xlabel="position, base pitches from A [-]", ylabel="error [µm]")
    return drawn


def spectrum(lines: dynamics.Spectrum) -> Figure:
    """Draw the lines of displacement and force over the order of the excitation."""
    return _lines(
        lines.order, lines.displacement, lines.force, "order of the excitation [-]", "mesh force [-]"
    )


def motion_spectrum(lines: MotionSpectrum) -> Figure:
    """Draw the lines of displacement and force over the mesh order."""
    return _lines(lines.order, lines.displacement, lines.force, "mesh order [-]", "force over the mean [-]")


def _lines(order: Array, displacement: Array, force: Array, across: str, forces: str) -> Figure:
    with sheet(None, 2, height=4.2, legend=0) as (drawn, panels):
        for axes, values, label in zip(
            panels, (force, displacement), (forces, "displacement X [-]"), strict=True
        ):
            low = 1e-5 * max(float(np.nanmax(values, initial=0.0)), 1e-300)
            axes.vlines(order, low, np.maximum(values, low), color=colours(1)[0], linewidth=1.0)
            axes.set(yscale="log", ylim=(low, None), ylabel=label)
        panels[-1].set_xlabel(across)
    return drawn


def run_up(run: dynamics.RunUp) -> Figure:
    """Draw root mean square, peak and maximum force over the frequency."""
    with sheet(None, 3, height=5.0, legend=0) as (drawn, panels):
        for axes, values, label in zip(
            panels,
            (run.rms, run.peak, run.force_peak),
            ("X, root mean\nsquare [-]", "maximum X [-]", "maximum mesh\nforce [-]"),
            strict=True,
        ):
            axes.plot(run.frequency, values, color=colours(1)[0])
            axes.set_ylabel(label)
        panels[-1].set_xlabel("frequency [-]")
    return drawn


def speed_run_up(run_ups: SpeedRunUp) -> Figure:
    """Draw maximum force and vibration over the speed, up and down."""
    with sheet(None, 2, height=4.2, legend=2) as (drawn, panels):
        for axes, figure, label in zip(
            panels,
            (run_ups.force_factor, run_ups.spread),
            ("maximum force\nover mean [-]", "displacement, root\nmean square [-]"),
            strict=True,
        ):
            for way, colour, dash in zip(("up", "down"), colours(2), ("-", "--"), strict=True):
                at = run_ups.frequency[way] if run_ups.speed is None else RPM * run_ups.speed[way]
                axes.plot(at, figure[way], dash, color=colour, label=way)
            axes.set_ylabel(label)
        panels[-1].set_xlabel(
            "mesh over natural frequency [-]" if run_ups.speed is None else "pinion speed [rpm]"
        )
    return drawn


def dynamic_map(factors: DynamicMap) -> Figure:
    """Draw the dynamic factor over the speed at each torque, beside ISO 6336-1."""
    with sheet(None, height=3.6, legend=5) as (drawn, (axes,)):
        for k, (torque, colour) in enumerate(zip(factors.torque.tolist(), 5 * colours(7), strict=False)):
            axes.plot(
                RPM * factors.speed, factors.factor[k], color=colour, linestyle="-", label=f"{torque:g} N m"
            )
            axes.plot(RPM * factors.speed, factors.iso[k], color=colour, linestyle=":", linewidth=1.0)
        axes.set(xlabel="pinion speed [rpm]", ylabel="dynamic factor K_v [-]\n(dotted: ISO 6336-1, B)")
    return drawn
