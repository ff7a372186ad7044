"""Film thickness and pressure, along the path of contact and through the contact, and what a film changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array
from flankfilm.figures.panels import curves, over_path, plain_ticks
from flankfilm.figures.reading import Reading, beside, labelled, need, read, text, travel
from flankfilm.figures.style import MARK, Style, colours, films_from_zero, from_zero, looks, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FILM = 'run a scene that wants "film"'
SOLVED = 'run a scene that wants "film" with film.model = "ehl"'
THROUGH = "distance from the line of centres [half-widths]"

POINTS = ("near_A", "after_B", "C", "before_D", "near_E")
"""Contacts through which films are given, in the order of the path."""

SHARES = {
    "film_starvation": "starved over\nflooded film",
    "film_ratio": "film ratio Lambda",
    "film_asperity_share": "asperities'\nshare of load",
}
"""Variables beside the film, with labels that low panels have room for."""


def film_along_path(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw central and minimum film and the Hertz pressure against the travel of a pair from A.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``film``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, FILM, "film_rho1", "film_central_thickness")
    at, pressure = travel(results, "film_rho1"), read(results, "film_hertz_pressure")
    films = {f"{name} film": read(results, f"film_{name}_thickness") for name in ("central", "minimum")}
    with sheet(style, 2, height=4.2, height_ratios=(3, 2)) as (drawn, (upper, lower)):
        curves(upper, at, films, "film thickness")
        lower.plot(at, pressure.values, color=colours(3)[2])
        lower.set(ylabel=pressure.named("Hertz pressure"))
        films_from_zero(upper)
        from_zero(lower)
        over_path(results, upper, lower)
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
    shown = {label: read(results, name) for name, label in SHARES.items() if name in results}
    if not shown:
        need(results, "run a scene with a starved film or a section [roughness]", *SHARES)
    with sheet(style, len(shown), height=0.8 + 1.6 * len(shown)) as (drawn, panels):
        for axes, (label, share), colour in zip(panels, shown.items(), colours(len(shown)), strict=True):
            axes.plot(travel(results, "film_rho1"), share.values, color=colour)
            axes.set(ylabel=share.named(label))
        from_zero(*panels)
        over_path(results, *panels)
    return drawn


def film_profiles(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw pressure and film thickness through the contacts at points of the path, the dry Hertz pressure thin.

    Between rough flanks the pressure is that of film and asperities together; a panel below it has the film's part.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that solves films.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    points = [name for name in POINTS if f"film_profile_{name}_x" in results]
    if not points:
        need(results, SOLVED, "film_profile_C_x")
    parts = ["pressure", "film_pressure"] if _rough(results, points[0]) else ["pressure"]
    height = 2.8 + 1.7 * len(parts)
    with sheet(style, 1 + len(parts), height=height, legend=3) as (drawn, panels):
        *pressures, lower = panels
        for name, look in zip(points, looks(len(points)), strict=True):
            _through(pressures[0], lower, results, name, name.replace("_", " "), look)
            dry = _hertz(results, name)
            pressures[0].plot(dry[0], dry[1], color=look["color"], linestyle="-", linewidth=0.6)
            for axes in pressures[1:]:
                x, film = _places(results, name), read(results, f"film_profile_{name}_pressure")
                curves(axes, x, {name: replace(film, meaning="pressure, film's part")}, **look)
        pressures[0].plot([], [], color=MARK, linestyle="-", linewidth=0.6, label="thin: Hertz pressure, dry")
        if len(parts) > 1:
            pressures[0].set(
                ylabel=read(results, f"film_profile_{points[0]}_pressure").named("pressure, total")
            )
        from_zero(*pressures)
        for axes in pressures[1:]:
            axes.set_ylim(pressures[0].get_ylim())
        lower.set(xlabel=THROUGH, xlim=(-2.0, 1.5), ylim=(0, 3 * _thickest(lower)))
    return drawn


def _rough(results: xr.Dataset, point: str) -> bool:
    """Whether asperities carry a part of the load."""
    return f"film_profile_{point}_total_pressure" in results


def _places(results: xr.Dataset, point: str) -> Array:
    """Places through the contact at a point [half-widths]."""
    x = results[f"film_profile_{point}_x"].values
    return np.asarray(x / float(results[f"film_profile_{point}_half_width"]))


def _hertz(results: xr.Dataset, point: str) -> tuple[Array, Array]:
    """Pressure of the dry contact at a point, over the place in half-widths."""
    x = np.sin(np.linspace(-0.5 * np.pi, 0.5 * np.pi, 61))
    greatest = float(read(results, f"film_profile_{point}_hertz_pressure").values)
    return x, greatest * np.sqrt(np.maximum(1.0 - x**2, 0.0))


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
    (name,) = [name for name in POINTS if name.endswith(point)]
    with sheet(style, 2, 2, width=7.6, height=4.4, sharex="col") as (drawn, panels):
        pressure, hertz, thickness, along = panels
        for (label, results), look in zip(family.items(), looks(len(family)), strict=True):
            need(results, SOLVED, f"film_profile_{name}_x", "film_rho1")
            _through(pressure, thickness, results, name, label, look)
            for axes, what in ((hertz, "film_hertz_pressure"), (along, "film_minimum_thickness")):
                curves(axes, travel(results, "film_rho1"), {label: read(results, what)}, **look)
        from_zero(pressure, hertz)
        films_from_zero(along)
        hertz.set(ylabel=read(results, "film_hertz_pressure").named("Hertz pressure"))
        pressure.set(xlim=(-1.5, 1.2))
        thickness.set(xlabel=THROUGH, xlim=(-1.5, 1.2), ylim=(0, 2 * _thickest(thickness)))
        over_path(next(iter(family.values())), hertz, along)
    return drawn


def _through(
    upper: Axes, lower: Axes, results: xr.Dataset, point: str, label: str, look: Mapping[str, Any]
) -> None:
    """Draw pressure and film through the contact at a point over the place in half-widths."""
    name, x = f"film_profile_{point}", _places(results, point)
    pressure = "total_pressure" if _rough(results, point) else "pressure"
    for axes, what in ((upper, pressure), (lower, "thickness")):
        curves(axes, x, {label: read(results, f"{name}_{what}")}, **look)


def _thickest(axes: Axes) -> float:
    """Largest film on the line of centres among the curves of a panel."""
    drawn = (np.asarray(line.get_xydata()).T for line in axes.lines)
    return max(float(np.interp(0.0, x, thickness)) for x, thickness in drawn)


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
    need(results, FILM, "dry_tangent_stiffness", "lubricated_tangent_stiffness", "lubricated_label")
    dry, wet = (read(results, f"{name}_tangent_stiffness", per_face=True) for name in ("dry", "lubricated"))
    position = read(results, "dry_position")
    cycles = beside(results, "held_tangent_stiffness", per_face=True) or {
        text(results, "lubricated_label"): wet
    }
    changes = {
        label: Reading(100 * (cycle.values / dry.values - 1), "change by the film", "%")
        for label, cycle in cycles.items()
    }
    with sheet(style, 2, height=4.9, legend=2) as (drawn, (upper, lower)):
        curves(upper, position.values, {**cycles, text(results, "dry_label"): dry}, "tangent stiffness")
        from_zero(upper)
        curves(lower, position.values, changes)
        lower.set(xlabel=position.label)
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
    family = {
        label.replace("-", " ").replace("dowson", "Dowson"): curve
        for label, curve in labelled(results, "film_stiffness_", per_face=True).items()
    }
    with sheet(style, height=3.6, legend=5) as (drawn, (axes,)):
        curves(axes, travel(results, "film_rho1"), family, "film stiffness")
        axes.set(yscale="log")
        plain_ticks(axes.yaxis)
        over_path(results, axes)
    return drawn
