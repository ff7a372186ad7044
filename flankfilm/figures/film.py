"""Film thickness and pressure, along the path of contact and through the contact, and what a film changes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.reading import CYCLE_LABEL, PATH_LABEL, mark_path, need, text, travel
from flankfilm.figures.style import Style, colours, figure, from_zero, legend_above, looks, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

FILM = 'run a scene that wants "film"'
SOLVED = 'run a scene that wants "film" with film.model = "ehl"'
THROUGH = "distance from the line of centres [half-widths]"

SHARES = {
    "film_starvation": "central film\nover flooded [-]",
    "film_ratio": "film ratio\nLambda [-]",
    "film_asperity_share": "asperities' share\nof the load [-]",
}


def film_along_path(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw central and minimum film and the Hertz pressure against the travel of a pair from A.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``film``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, FILM, "film_rho1", "film_central_thickness", "path_point_rho1")
    at = travel(results, "film_rho1")
    with styled(style):
        drawn = figure(height=4.2)
        upper, lower = drawn.subplots(2, 1, sharex=True, height_ratios=(3, 2))
        first, second, third = looks(3)
        upper.plot(at, 1e6 * results["film_central_thickness"].values, label="central film", **first)
        upper.plot(at, 1e6 * results["film_minimum_thickness"].values, label="minimum film", **second)
        upper.set(ylabel="film thickness [µm]")
        from_zero(upper)
        legend_above(drawn, upper)
        lower.plot(at, 1e-9 * results["film_hertz_pressure"].values, color=third["color"])
        lower.set(xlabel=PATH_LABEL, ylabel="Hertz pressure [GPa]")
        from_zero(lower)
        mark_path(results, (upper, lower), upper)
    return drawn


def film_shares(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw how far films are starved and what their asperities carry along the path, a panel each.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run with a starved film or with rough flanks.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    shown = {name: label for name, label in SHARES.items() if name in results}
    if not shown:
        need(results, "run a scene with a starved film or a section [roughness]", *SHARES)
    with styled(style):
        drawn = figure(height=0.8 + 1.5 * len(shown))
        panels = drawn.subplots(len(shown), 1, sharex=True, squeeze=False).ravel().tolist()
        for axes, (name, label), colour in zip(panels, shown.items(), colours(len(shown)), strict=True):
            axes.plot(travel(results, "film_rho1"), results[name].values, color=colour)
            axes.set(ylabel=label)
            from_zero(axes)
        panels[-1].set(xlabel=PATH_LABEL)
        mark_path(results, panels, panels[0])
    return drawn


def film_profiles(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw pressure and film thickness through the contacts at points of the path.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that solves films.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    points = [name for name in "ABCDE" if f"film_profile_{name}_x" in results]
    if not points:
        need(results, SOLVED, "film_profile_C_x")
    with styled(style):
        drawn = figure(height=4.4)
        upper, lower = drawn.subplots(2, 1, sharex=True)
        thickest = 0.0
        for name, look in zip(points, looks(len(points)), strict=True):
            x, pressure, thickness = _through(results, name)
            upper.plot(x, pressure, label=name, **look)
            lower.plot(x, thickness, **look)
            thickest = max(thickest, float(np.interp(0.0, x, thickness)))
        upper.set(ylabel="pressure [GPa]")
        from_zero(upper)
        legend_above(drawn, upper, columns=5)
        lower.set(xlabel=THROUGH, ylabel="film thickness [µm]", xlim=(-2.0, 1.5), ylim=(0, 3 * thickest))
    return drawn


def film_families(
    family: Mapping[str, xr.Dataset], point: str = "C", *, style: Style | None = None
) -> Figure:
    """Draw films of several runs: through the contact at a point on the left, along the path on the right.

    Parameters
    ----------
    family : mapping
        Label to the results of a run that solves films.
    point : str
        ``"A"`` to ``"E"``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    with styled(style):
        drawn = figure(7.6, 4.4)
        (pressure, hertz), (thickness, along) = drawn.subplots(2, 2)
        thickest = 0.0
        for (label, results), look in zip(family.items(), looks(len(family)), strict=True):
            need(results, SOLVED, f"film_profile_{point}_x", "film_rho1")
            x, p, h = _through(results, point)
            pressure.plot(x, p, label=label, **look)
            thickness.plot(x, h, **look)
            thickest = max(thickest, float(np.interp(0.0, x, h)))
            at = travel(results, "film_rho1")
            hertz.plot(at, 1e-9 * results["film_hertz_pressure"].values, **look)
            along.plot(at, 1e6 * results["film_minimum_thickness"].values, **look)
        legend_above(drawn, pressure)
        pressure.set(ylabel=f"pressure at {point} [GPa]", xlim=(-1.5, 1.2))
        from_zero(pressure)
        thickness.set(ylabel=f"film at {point} [µm]", xlim=(-1.5, 1.2), ylim=(0, 2 * thickest))
        thickness.set(xlabel=THROUGH)
        hertz.set(ylabel="Hertz pressure [GPa]")
        from_zero(hertz)
        along.set(xlabel="travel along the path from A [mm]", ylabel="least film [µm]")
        from_zero(along)
    return drawn


def film_changes(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the tangent stiffness of a mesh with films, and below what each changes the dry one by.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``film``; of a starved one, with what would be if the other of meniscus and oil layer
        stayed.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, FILM, "dry_tangent_stiffness", "lubricated_tangent_stiffness", "lubricated_model")
    dry, phase = results["dry_tangent_stiffness"].values, results["dry_phase"].values
    cycles = {text(results, "lubricated_model"): results["lubricated_tangent_stiffness"].values}
    if "held_model" in results:
        held = results["held_tangent_stiffness"].values
        cycles = dict(zip(results["held_model"].values.tolist(), held, strict=True))
    with styled(style):
        drawn = figure(height=4.4)
        upper, lower = drawn.subplots(2, 1, sharex=True)
        *own, last = looks(len(cycles) + 1)
        for (label, tangent), look in zip(cycles.items(), own, strict=True):
            upper.plot(phase, 1e-9 * tangent, label=label, **look)
            lower.plot(phase, 100 * (tangent / dry - 1), **look)
        upper.plot(phase, 1e-9 * dry, label=text(results, "dry_model"), **last)
        upper.set(ylabel="tangent stiffness [N/nm]")
        from_zero(upper)
        lower.set(xlabel=CYCLE_LABEL, ylabel="change by the film [%]")
        legend_above(drawn, upper, columns=2)
    return drawn


def film_stiffness(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the film stiffness by every definition along the path, on a logarithmic axis.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``film``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, FILM, "film_rho1", "path_point_rho1")
    names = [str(name) for name in results.data_vars if str(name).startswith("film_stiffness_")]
    with styled(style):
        drawn = figure(height=3.6)
        axes = drawn.subplots()
        for name, look in zip(names, looks(len(names)), strict=True):
            label = name.removeprefix("film_stiffness_").replace("_", " ")
            axes.plot(travel(results, "film_rho1"), results[name].values, label=label, **look)
        axes.set(xlabel=PATH_LABEL, ylabel="film stiffness, whole face [N/m]", yscale="log")
        mark_path(results, (axes,), axes)
        legend_above(drawn, axes)
    return drawn


def _through(results: xr.Dataset, point: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Place [half-widths], pressure [GPa] and film [um] through the contact at a point."""
    name = f"film_profile_{point}"
    x = results[f"{name}_x"].values / float(results[f"{name}_half_width"])
    return x, 1e-9 * results[f"{name}_pressure"].values, 1e6 * results[f"{name}_thickness"].values
