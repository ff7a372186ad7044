"""One pair of teeth along the path by every model: closed forms, their parts, and finite elements beside them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.panels import curves, over_path, over_two_pitches
from flankfilm.figures.reading import Reading, beside, labelled, need, read, travel
from flankfilm.figures.style import Style, colours, from_zero, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def single_pairs(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the stiffness of one pair of teeth along the path of contact, one curve a model.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``closed-forms``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, 'run a scene that wants "closed-forms"', "single_pair_rho1")
    models = labelled(results, "single_pair_stiffness_", per_face=True)
    with sheet(style, legend=4) as (drawn, (axes,)):
        curves(axes, travel(results, "single_pair_rho1"), models)
        from_zero(axes)
        over_path(results, axes)
    return drawn


def closed_form(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the parts of the deflection per force at each point, stacked.

    Parameters
    ----------
    results : xarray.Dataset
        Of a closed form of `gears`.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    parts = {name: 1e9 * part.values for name, part in labelled(results, "closed_form_parts_").items()}
    if not parts:
        need(results, "give the dataset of a closed form", "closed_form_parts")
    values = list(parts.values())
    points = np.arange(1, values[0].size + 1)
    names = [name.replace("_", " ") for name in parts]
    with sheet(style, height=3.4, legend=3) as (drawn, (axes,)):
        axes.stackplot(points, values, labels=names, colors=colours(len(parts)), alpha=0.7)
        marker = "o" if points.size == 1 else ""
        axes.plot(points, np.sum(values, axis=0), color="#000000", marker=marker, label="whole")
        axes.set(xlabel="point [-]", ylabel="deflection per force [nm/N]")
    return drawn


def verification(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw one pair along the path, the mesh cycle, and each model's difference from finite elements.

    Black lines are finite elements: with all parts, and without what closed forms lack (hub wind-up and
    coupling of neighbouring teeth). The grey band about zero is the numerical error of the latter.

    Parameters
    ----------
    results : xarray.Dataset
        What ``verify.nc`` holds.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    singles, secants = (
        {of: f"{of}_{what}" for of in ("reference", "model")}
        for what in ("single_stiffness", "secant_stiffness")
    )
    need(results, "give the verify.nc of a verification", "model", "reference", *singles.values())
    single, secant = (
        {of: beside(results, name, per_face=True) for of, name in names.items()}
        for names in (singles, secants)
    )
    at, position, like = (
        travel(results, "path_rho1"),
        read(results, "mesh_position"),
        int(results["like_for_like"]),
    )
    whole, lacking = (list(single["reference"])[i] for i in (0, like))
    base, error = single["reference"][lacking].values, 100 * float(results["reference_error"][like])
    differences = {
        name: Reading(100 * (curve.values / base - 1), "", "%") for name, curve in single["model"].items()
    }
    with sheet(style, 3, height=7.4, legend=2, sharex=False) as (drawn, (pair, mesh, off)):
        for name, label, dash in ((whole, whole, "-"), (lacking, f"finite elements {lacking}", "--")):
            curves(pair, at, {label: single["reference"][name]}, color="#000000", linestyle=dash)
            over_two_pitches(
                mesh, position, {label: secant["reference"][name]}, color="#000000", linestyle=dash
            )
        curves(pair, at, single["model"])
        over_two_pitches(mesh, position, secant["model"])
        curves(off, at, differences)
        off.axhspan(-error, error, color="#bbbbbb", linewidth=0)
        off.axhline(0.0, color="#000000", linewidth=0.8, linestyle="--")
        off.set(ylabel="one pair, difference\nfrom dashed black line [%]")
        from_zero(pair, mesh)
        for axes in (pair, off):
            over_path(results, axes)
    return drawn
