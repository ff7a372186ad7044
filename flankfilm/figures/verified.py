"""Closed forms beside finite elements: one pair, the mesh cycle, and the differences with their error band."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.reading import CYCLE_LABEL, PATH_LABEL, mark_path, need, per_face, travel
from flankfilm.figures.style import Style, figure, from_zero, looks, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def verification(found: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw one pair along the path, the mesh cycle, and each model's difference from finite elements.

    Black lines are finite elements: with all parts, and without what closed forms lack (hub wind-up and
    coupling of neighbouring teeth). The grey band about zero is the numerical error of the latter.

    Parameters
    ----------
    found : xarray.Dataset
        What ``verify.nc`` holds.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(
        found,
        "give the verify.nc of a verification",
        "model",
        "reference",
        "model_single",
        "reference_single",
    )
    scale, at = per_face(found), travel(found, "path_rho1")
    phase = np.concatenate([found["phase"].values, found["phase"].values + 1])
    like = int(found["like_for_like"])
    labels = [str(n) for n in found["reference"].values]
    with styled(style):
        drawn = figure(7.0, 7.4)
        one, mesh, off = drawn.subplots(3, 1)
        for i, line in ((0, "-"), (like, "--")):
            label = labels[i] if i == 0 else f"finite elements {labels[i]}"
            one.plot(
                at, scale * found["reference_single"].values[i], color="#000000", linestyle=line, label=label
            )
            secant = np.tile(found["reference_secant"].values[i], 2)
            mesh.plot(phase, scale * secant, color="#000000", linestyle=line)
        for i, (name, look) in enumerate(zip(found["model"].values, looks(found["model"].size), strict=True)):
            single = found["model_single"].values[i]
            one.plot(at, scale * single, label=str(name), **look)
            mesh.plot(phase, scale * np.tile(found["model_secant"].values[i], 2), **look)
            off.plot(at, 100 * (single / found["reference_single"].values[like] - 1), **look)
        error = 100 * float(found["reference_error"][like])
        off.axhspan(-error, error, color="#bbbbbb", linewidth=0)
        off.axhline(0.0, color="#000000", linewidth=0.8, linestyle="--")
        one.set(xlabel=PATH_LABEL, ylabel="one pair [N/(mm µm)]")
        from_zero(one)
        mesh.set(xlabel=CYCLE_LABEL, ylabel="mesh, secant [N/(mm µm)]")
        from_zero(mesh)
        off.set(xlabel=PATH_LABEL, ylabel="one pair, difference\nfrom dashed black line [%]")
        for axes in (one, off):
            mark_path(found, (axes,), axes)
        drawn.legend(*one.get_legend_handles_labels(), loc="outside upper left", ncols=2, handlelength=2.6)
    return drawn
