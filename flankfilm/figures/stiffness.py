"""Stiffness, load share, transmission error and Fourier fit over the mesh cycle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flankfilm.figures.style import COLOURS, DASHES, figure, legend_above, styled
from flankfilm.mesh_stiffness import MeshStiffness

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from dynamics import FourierFit

Array = NDArray[np.float64]


def single_pairs(
    position: Array, curves: Mapping[str, Array], marks: Mapping[str, float], face_width: float
) -> Figure:
    """Draw the stiffness of one pair of teeth along the path of contact, one curve a model.

    Parameters
    ----------
    position : ndarray
        Travel from A [m].
    curves : mapping
        Label to single-pair stiffness [N/m].
    marks : mapping
        Name of a point of the path to its travel from A [m].
    face_width : float
        [m]
    """
    with styled():
        drawn = figure()
        axes = drawn.subplots()
        for (label, k), colour, dash in zip(curves.items(), COLOURS, DASHES, strict=False):
            axes.plot(
                1e3 * position, 1e-6 * k / (1e3 * face_width), color=colour, linestyle=dash, label=label
            )
        _mark(axes, marks)
        axes.set(
            xlabel="travel along the path of contact from A [mm]",
            ylabel="one pair [N/(mm µm)]",
            ylim=(0, None),
        )
        legend_above(drawn, axes)
    return drawn


def mesh_cycles(cycles: Sequence[MeshStiffness], face_width: float, kind: str = "secant") -> Figure:
    """Draw the mesh stiffness of several models over two base pitches on one axis."""
    with styled():
        drawn = figure(height=3.6)
        axes = drawn.subplots()
        for cycle, colour, dash in zip(cycles, COLOURS, DASHES, strict=False):
            phase, k = _two_pitches(cycle.phase, cycle.stiffness(kind))
            axes.plot(phase, 1e-6 * k / (1e3 * face_width), color=colour, linestyle=dash, label=cycle.label)
        axes.set(xlabel="travel after a pair is at A [base pitches]", ylabel=f"{kind} stiffness [N/(mm µm)]")
        axes.set_ylim(0, None)
        legend_above(drawn, axes, columns=2)
    return drawn


def load_share(cycle: MeshStiffness) -> Figure:
    """Draw each pair's share of the force against its own travel through the mesh."""
    with styled():
        drawn = figure(height=2.8)
        axes = drawn.subplots()
        order = np.argsort(np.where(np.isfinite(cycle.rho1), cycle.rho1, np.inf), axis=None)
        rho = cycle.rho1.ravel()[order]
        share = cycle.load_share.ravel()[order]
        seen = np.isfinite(rho)
        axes.plot(1e3 * rho[seen], share[seen], ".-", color=COLOURS[0], markersize=3)
        axes.set(
            xlabel="curvature radius of the pinion's flank at the contact [mm]",
            ylabel="share of the force [-]",
        )
        axes.set_ylim(-0.02, 1.05)
    return drawn


def transmission_error(cycles: Sequence[MeshStiffness]) -> Figure:
    """Draw the deflection along the line of action over two base pitches."""
    with styled():
        drawn = figure(height=2.8)
        axes = drawn.subplots()
        for cycle, colour, dash in zip(cycles, COLOURS, DASHES, strict=False):
            phase, error = _two_pitches(cycle.phase, cycle.transmission_error)
            axes.plot(phase, 1e6 * error, color=colour, linestyle=dash, label=cycle.label)
        axes.set(xlabel="travel after a pair is at A [base pitches]", ylabel="loaded transmission error [µm]")
        legend_above(drawn, axes, columns=2)
    return drawn


def fourier(
    cycle: MeshStiffness, fits: Mapping[str, FourierFit], harmonics: Array, face_width: float
) -> Figure:
    """Draw the stiffness with its Fourier fits, and beside it the harmonics over the mean."""
    with styled():
        drawn = figure(height=3.2)
        left, right = drawn.subplots(1, 2, width_ratios=(3, 1))
        scale = 1e-9 / face_width
        phase, k = _two_pitches(cycle.phase, cycle.secant)
        left.plot(phase, scale * k, ".", color="#777777", markersize=3, label="secant")
        fine = np.linspace(0, 2, 401)
        for (label, fit), colour, dash in zip(fits.items(), COLOURS, DASHES, strict=False):
            left.plot(
                fine, scale * fit.stiffness(2 * np.pi * fine), color=colour, linestyle=dash, label=label
            )
        left.set(xlabel="travel after a pair is at A [base pitches]", ylabel="stiffness [N/(mm µm)]")
        legend_above(drawn, left)
        order = np.arange(1, harmonics.size + 1)
        right.bar(order, harmonics, color=COLOURS[0])
        right.set(
            xlabel="harmonic", ylabel="amplitude over the mean [-]", xticks=order[:: max(1, order.size // 5)]
        )
    return drawn


def _two_pitches(phase: Array, values: Array) -> tuple[Array, Array]:
    return np.concatenate([phase, phase + 1]), np.concatenate([values, values])


def _mark(axes: object, marks: Mapping[str, float]) -> None:
    for name, at in marks.items():
        axes.axvline(1e3 * at, color="#999999", linewidth=0.8)  # type: ignore[attr-defined]
        axes.annotate(  # type: ignore[attr-defined]
            name,
            (1e3 * at, 0.02),
            xycoords=("data", "axes fraction"),
            xytext=(3, 0),
            textcoords="offset points",
        )
