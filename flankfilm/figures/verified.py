"""Closed forms beside finite elements: one pair, the mesh cycle, and the differences with their error band."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.reading import PATH_LABEL, mark_path, need, read, travel
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
        "model_single_stiffness",
        "reference_single_stiffness",
    )
    at, position = travel(found, "path_rho1"), read(found, "mesh_position")
    both = np.concatenate([position.values, position.values + 1])
    single, secant = (
        {kind: read(found, f"{kind}_{what}", per_face=True) for kind in ("reference", "model")}
        for what in ("single_stiffness", "secant_stiffness")
    )
    like = int(found["like_for_like"])
    labels = [str(n) for n in found["reference"].values]
    with styled(style):
        drawn = figure(7.0, 7.4)
        one, mesh, off = drawn.subplots(3, 1)
        for i, line in ((0, "-"), (like, "--")):
            label = labels[i] if i == 0 else f"finite elements {labels[i]}"
            one.plot(at, single["reference"].values[i], color="#000000", linestyle=line, label=label)
            mesh.plot(both, np.tile(secant["reference"].values[i], 2), color="#000000", linestyle=line)
        for i, (name, look) in enumerate(zip(found["model"].values, looks(found["model"].size), strict=True)):
            curve = single["model"].values[i]
            one.plot(at, curve, label=str(name), **look)
            mesh.plot(both, np.tile(secant["model"].values[i], 2), **look)
            off.plot(at, 100 * (curve / single["reference"].values[like] - 1), **look)
        error = 100 * float(found["reference_error"][like])
        off.axhspan(-error, error, color="#bbbbbb", linewidth=0)
        off.axhline(0.0, color="#000000", linewidth=0.8, linestyle="--")
        one.set(xlabel=PATH_LABEL, ylabel=single["model"].label)
        from_zero(one)
        mesh.set(xlabel=position.label, ylabel=secant["model"].label)
        from_zero(mesh)
        off.set(xlabel=PATH_LABEL, ylabel="one pair, difference\nfrom dashed black line [%]")
        for axes in (one, off):
            mark_path(found, (axes,), axes)
        drawn.legend(*one.get_legend_handles_labels(), loc="outside upper left", ncols=2, handlelength=2.6)
    return drawn
