"""Root stress of a passing tooth, mesh stiffness over torque, transmission error over a revolution."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from flankfilm.figures.style import COLOURS, figure, legend_above, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]


def root_stress(passages: Mapping[str, Mapping[str, Array]], nominal: Mapping[str, float]) -> Figure:
    """Draw tension and compression at the roots of one tooth of each gear while it passes through the mesh.

    Parameters
    ----------
    passages : mapping
        Gear to its columns ``way_base_pitches``, ``tension_Pa`` and ``compression_Pa``.
    nominal : mapping
        Gear to sigma_F0 of ISO 6336-3 [Pa]; may be empty.
    """
    with styled():
        drawn = figure(height=3.4)
        axes = drawn.subplots()
        for (name, columns), colour in zip(passages.items(), COLOURS, strict=False):
            way = columns["way_base_pitches"]
            axes.plot(way, 1e-6 * columns["tension_Pa"], color=colour, label=f"{name}, tension")
            axes.plot(
                way,
                1e-6 * columns["compression_Pa"],
                color=colour,
                linestyle="--",
                label=f"{name}, compression",
            )
            if name in nominal:
                axes.axhline(
                    1e-6 * nominal[name], color=colour, linestyle=":", label=f"{name}, ISO 6336-3 at D"
                )
        axes.axhline(0.0, color="black", linewidth=0.6)
        axes.set(
            xlabel="travel since the tooth's pair was at A [base pitches]",
            ylabel="stress along the fillet [MPa]",
        )
        legend_above(drawn, axes)
    return drawn


def over_torque(found: Any, face_width: float) -> Figure:
    """Draw mean stiffness, and transmission error, over the pinion's torque."""
    with styled():
        drawn = figure(height=2.8)
        left, right = drawn.subplots(1, 2)
        scale = 1e-9 / face_width
        left.plot(found.torque, scale * found.secant, ".-", color=COLOURS[0], label="secant")
        left.plot(found.torque, scale * found.tangent, ".--", color=COLOURS[1], label="tangent")
        left.set(xlabel="torque of the pinion [N m]", ylabel="mean stiffness [N/(mm µm)]")
        right.plot(found.torque, 1e6 * found.transmission_error, ".-", color=COLOURS[0])
        right.set(
            xlabel="torque of the pinion [N m]",
            ylabel="transmission error,\npeak to peak [µm]",
            ylim=(0, None),
        )
        legend_above(drawn, left)
    return drawn


def revolution(travel: Array, loaded: Array, unloaded: Array) -> Figure:
    """Draw the transmission error tooth by tooth, under load and without."""
    with styled():
        drawn = figure(height=2.8)
        axes = drawn.subplots()
        axes.plot(travel, 1e6 * loaded, color=COLOURS[0], linewidth=0.9, label="under load")
        axes.plot(travel, 1e6 * unloaded, color=COLOURS[1], linewidth=0.9, label="without load")
        axes.set(
            xlabel="travel after the first pair is at A [base pitches]", ylabel="transmission error [µm]"
        )
        legend_above(drawn, axes)
    return drawn
