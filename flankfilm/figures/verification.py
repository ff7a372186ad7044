"""Closed forms beside finite elements: one pair, the mesh cycle, and the differences with their error band."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.style import COLOURS, DASHES, figure, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from flankfilm.verify.compare import Verification
    from flankfilm.verify.models import Curves


def verification(found: Verification) -> Figure:
    """Draw one pair along the path, the mesh cycle, and each model's difference from finite elements.

    Black lines are finite elements: with all parts, and without what closed forms lack (hub wind-up and
    coupling of neighbouring teeth). The grey band about zero is the numerical error of the latter.
    """
    scale = 1e-9 / found.pair.face_width
    travel = 1e3 * (found.rho1 - found.pair.points.A)
    phase = np.concatenate([found.phase, found.phase + 1])
    models = [model for model in found.models if model.single.size]
    whole = found.references[0]
    like = found.like_for_like
    with styled():
        drawn = figure(7.0, 7.4)
        one, mesh, off = drawn.subplots(3, 1)
        for curves, line in ((whole, "-"), (like, "--")):
            label = f"finite elements {curves.label}" if curves is like else curves.label
            one.plot(travel, scale * curves.single, color="black", linestyle=line, label=label)
            mesh.plot(phase, scale * np.tile(curves.secant, 2), color="black", linestyle=line)
        for model, colour, dash in zip(models, COLOURS, DASHES, strict=False):
            one.plot(travel, scale * model.single, color=colour, linestyle=dash, label=model.label)
            mesh.plot(phase, scale * np.tile(model.secant, 2), color=colour, linestyle=dash)
            off.plot(travel, 100 * (model.single / like.single - 1), color=colour, linestyle=dash)
        _finish(found, one, mesh, off, like)
        drawn.legend(*one.get_legend_handles_labels(), loc="outside upper left", ncols=2, handlelength=2.6)
    return drawn


def _finish(found: Verification, one: Axes, mesh: Axes, off: Axes, like: Curves) -> None:
    """Name axes, mark the path's points and the band of the numerical error."""
    error = 100 * (like.error or 0.0)
    off.axhspan(-error, error, color="#bbbbbb", linewidth=0)
    off.axhline(0.0, color="black", linewidth=0.8, linestyle="--")
    along = "travel along the path of contact from A [mm]"
    one.set(xlabel=along, ylabel="one pair [N/(mm µm)]", ylim=(0, None))
    mesh.set(
        xlabel="travel after a pair is at A [base pitches]", ylabel="mesh, secant [N/(mm µm)]", ylim=(0, None)
    )
    off.set(xlabel=along, ylabel="one pair, difference\nfrom dashed black line [%]")
    points = found.pair.points
    for axes in (one, off):
        for name in "ABCDE":
            at = 1e3 * (getattr(points, name) - points.A)
            axes.axvline(at, color="#999999", linewidth=0.8)
            axes.annotate(name, (at, 1.01), xycoords=("data", "axes fraction"), ha="center", va="bottom")
