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


def error_series(found: ErrorSeries) -> Figure:
    """Draw the unloaded transmission error over its period, with its series."""
    turn = np.linspace(0.0, found.meshes, 801)
    order = np.arange(1, found.order + 1) / found.meshes
    shown = found.curve.mean() + np.cos(2 * np.pi * turn[:, None] * order + found.phase) @ found.amplitude
    with sheet(None, height=3.2) as (drawn, (axes,)):
        axes.plot(found.position, 1e6 * found.curve, color="#999999", linewidth=2.2, label=found.source)
        axes.plot(turn, 1e6 * shown, color=colours(1)[0], label=f"series of order {found.order}")
        axes.set(xlabel="position, base pitches from A [-]", ylabel="error [µm]")
    return drawn


def spectrum(found: dynamics.Spectrum) -> Figure:
    """Draw the lines of displacement and force over the order of the excitation."""
    return _lines(
        found.order, found.displacement, found.force, "order of the excitation [-]", "mesh force [-]"
    )


def motion_spectrum(found: MotionSpectrum) -> Figure:
    """Draw the lines of displacement and force over the mesh order."""
    return _lines(found.order, found.displacement, found.force, "mesh order [-]", "force over the mean [-]")


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


def run_up(found: dynamics.RunUp) -> Figure:
    """Draw root mean square, peak and maximum force over the frequency."""
    with sheet(None, 3, height=5.0, legend=0) as (drawn, panels):
        for axes, values, label in zip(
            panels,
            (found.rms, found.peak, found.force_peak),
            ("X, root mean\nsquare [-]", "maximum X [-]", "maximum mesh\nforce [-]"),
            strict=True,
        ):
            axes.plot(found.frequency, values, color=colours(1)[0])
            axes.set_ylabel(label)
        panels[-1].set_xlabel("frequency [-]")
    return drawn


def speed_run_up(found: SpeedRunUp) -> Figure:
    """Draw maximum force and vibration over the speed, up and down."""
    with sheet(None, 2, height=4.2, legend=2) as (drawn, panels):
        for axes, figure, label in zip(
            panels,
            (found.force_factor, found.spread),
            ("maximum force\nover mean [-]", "displacement, root\nmean square [-]"),
            strict=True,
        ):
            for way, colour, dash in zip(("up", "down"), colours(2), ("-", "--"), strict=True):
                at = found.frequency[way] if found.speed is None else RPM * found.speed[way]
                axes.plot(at, figure[way], dash, color=colour, label=way)
            axes.set_ylabel(label)
        panels[-1].set_xlabel(
            "mesh over natural frequency [-]" if found.speed is None else "pinion speed [rpm]"
        )
    return drawn


def dynamic_map(found: DynamicMap) -> Figure:
    """Draw the dynamic factor over the speed at each torque, beside ISO 6336-1."""
    with sheet(None, height=3.6, legend=5) as (drawn, (axes,)):
        for k, (torque, colour) in enumerate(zip(found.torque.tolist(), 5 * colours(7), strict=False)):
            axes.plot(
                RPM * found.speed, found.factor[k], color=colour, linestyle="-", label=f"{torque:g} N m"
            )
            axes.plot(RPM * found.speed, found.iso[k], color=colour, linestyle=":", linewidth=1.0)
        axes.set(xlabel="pinion speed [rpm]", ylabel="dynamic factor K_v [-]\n(dotted: ISO 6336-1, B)")
    return drawn
