"""Friction, losses and temperatures along the path of contact, and the oil's temperature in the hottest contact."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.panels import curves, over_path
from flankfilm.figures.reading import GEARS, Reading, need, read, travel
from flankfilm.figures.style import MARK, Style, colours, films_from_zero, from_zero, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LOSSES = 'run a scene that wants "losses"'

THROUGH = (-2.0, 1.5)
"""Part of the hottest contact that is drawn, in half-widths."""

BAND = "#bbbbbb"
"""Colour of what lies between the ends of a band."""

BLOK = "flash temperature after Blok"


def losses_along_path(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw friction, the power that each contact loses, and pressure times sliding against the travel from A.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``losses``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    with sheet(style, 3, height=5.8, height_ratios=(3, 3, 2), legend=2) as (drawn, panels):
        _losses(panels, results)
        over_path(results, *panels)
    return drawn


def _losses(panels: Sequence[Axes], results: xr.Dataset) -> None:
    """Draw friction, power, and pressure times sliding into three panels."""
    need(results, LOSSES, "losses_path_rho1", "losses_path_friction_coefficient")
    upper, middle, lower = panels
    at, stress = travel(results, "losses_path_rho1"), read(results, "losses_path_pressure_times_sliding")
    friction = read(results, "losses_path_friction_coefficient")
    lost = {f"lost by {way}": read(results, f"losses_path_{way}_loss") for way in ("sliding", "rolling")}
    if "losses_band_eyring_stress" in results:
        stresses = np.sort(read(results, "losses_band_eyring_stress").values)
        ends, band = " to ".join(f"{end:g}" for end in stresses), results["losses_band_friction_coefficient"]
        upper.fill_between(at, *band.values, color=BAND, label=f"Eyring stress {ends} MPa")
    upper.plot(at, friction.values, color=colours(3)[2], label="this run's")
    upper.set(ylabel=friction.named("coefficient of friction"))
    curves(middle, at, lost, "power of one contact")
    lower.plot(at, 1e-9 * stress.values, color=colours(4)[3])
    lower.set(ylabel="Hertz pressure ×\nsliding [GPa m/s]")
    from_zero(upper, middle, lower)
    legend_over(middle, 2)


def temperatures_along_path(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the rise of oil and flanks in each contact, and the film with and without heat below.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``losses``; isothermal films stand beside where it wants ``film`` too.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    with sheet(style, 2, height=4.8, height_ratios=(3, 2), legend=2) as (drawn, panels):
        _temperatures(panels, results)
        over_path(results, *panels)
    return drawn


def heat_along_path(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw friction, power and pressure times sliding, and below them temperatures and film.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``losses``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    with sheet(style, 5, height=10.4, height_ratios=(3, 3, 2.4, 3, 2.4), legend=2) as (drawn, panels):
        _losses(panels[:3], results)
        _temperatures(panels[3:], results)
        over_path(results, *panels)
        legend_over(panels[3], 2)
    return drawn


def _temperatures(panels: Sequence[Axes], results: xr.Dataset) -> None:
    """Draw temperature rises, and the film with and without heat, into two panels."""
    need(results, LOSSES, "losses_path_rho1", "losses_path_surface_temperature_rise")
    upper, lower = panels
    at, flanks = travel(results, "losses_path_rho1"), read(results, "losses_path_surface_temperature_rise")
    rises = {"oil, maximum": read(results, "losses_path_oil_temperature_rise")}
    rises |= {
        f"flank of the {gear}": replace(flanks, values=rise)
        for gear, rise in zip(GEARS, flanks.values, strict=True)
    }
    rises[BLOK] = read(results, "losses_path_flash_temperature")
    curves(upper, at, rises, "rise above the\nbulk temperature")
    films = {"minimum film with heat": (at, read(results, "losses_path_minimum_thickness"))}
    if "film_minimum_thickness" in results:
        isothermal = read(results, "film_minimum_thickness")
        films["isothermal"] = travel(results, "film_rho1"), isothermal
    for (label, (places, film)), colour, dash in zip(
        films.items(), colours(6)[4:], ("-", "--"), strict=False
    ):
        lower.plot(places, film.values, color=colour, linestyle=dash, label=label)
        lower.set(ylabel=film.named("minimum film"))
    from_zero(upper)
    films_from_zero(lower)
    if len(films) > 1:
        legend_over(lower, 2)


def temperature_field(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the oil's temperature across and along the film of the hottest contact, below pressure and both flanks'.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``losses``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, LOSSES, "hot_contact_temperature", "hot_contact_place")
    x = results["hot_contact_x"].values / float(results["hot_contact_half_width"])
    bulk = results["hot_contact_bulk_temperature"].values
    warm = results["hot_contact_temperature"].values
    filled = slice(0, int(np.flatnonzero(results["hot_contact_pressure"].values > 0.0)[-1]) + 1)
    gap, pressure = read(results, "hot_contact_thickness"), read(results, "hot_contact_pressure")
    with sheet(style, 2, height=5.2, height_ratios=(2, 3), legend=3) as (drawn, (upper, lower)):
        for k, (gear, colour, dash) in enumerate(zip(GEARS, colours(2), ("-", "--"), strict=True)):
            rise = warm[filled, -k] - bulk[k]
            upper.plot(x[filled], rise, color=colour, linestyle=dash, label=f"flank of the {gear}")
        upper.plot([], [], color=MARK, linewidth=1.0, label="pressure (right)")
        upper.set(ylabel="flank above its bulk [K]", xlim=THROUGH)
        from_zero(upper)
        _pressure_beside(upper, x, pressure)
        _field(lower, x, gap, results["hot_contact_place"].values, warm[filled] - bulk.mean())
    return drawn


def _pressure_beside(axes: Axes, x: Array, pressure: Reading) -> None:
    """Draw the pressure on a separate axis at the right."""
    other = axes.twinx()
    other.grid(visible=False)
    other.spines["right"].set_visible(True)
    other.plot(x, pressure.values, color=MARK, linewidth=1.0)
    other.set(ylabel=pressure.named("pressure"))
    other.set_ylim(0.0, 1.08 * float(pressure.values.max()))


def _field(axes: Axes, x: Array, gap: Reading, place: Array, rise: Array) -> None:
    """Colour the film between the wheel's flank, below, and the pinion's above by the oil's temperature rise."""
    height = gap.values[: len(rise), None] * (0.5 - place)
    along = np.broadcast_to(x[: len(rise), None], height.shape)
    top = 2.5 * float(np.interp(0.0, x, gap.values))
    painted = axes.pcolormesh(
        along, height, rise, cmap="YlOrRd", shading="gouraud", vmin=0.0, vmax=float(rise.max()),
        rasterized=True,
    )  # fmt: skip
    axes.plot(x, gap.values, color="#000000", linewidth=1.0)
    axes.axhline(0.0, color="#000000", linewidth=1.0)
    axes.grid(visible=False)
    axes.set(
        xlabel="distance from the line of centres [half-widths]",
        ylabel=gap.named("from the wheel's flank"),
        xlim=THROUGH,
        ylim=(0.0, top),
    )
    axes.figure.colorbar(painted, ax=axes, label="oil above the mean bulk [K]", location="bottom", shrink=0.7)
