"""Curves of records that no picture of a whole run shows: films of one contact, passages, damping."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.panels import curves as family
from flankfilm.figures.reading import Reading, need, read
from flankfilm.figures.style import Style, colours, legend_over, sheet
from flankfilm.output.variables import joined

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

CURVES: Mapping[str, tuple[str, Mapping[str, tuple[str, ...]]]] = {
    "contact_film": ("x", {"pressure": ("pressure",), "thickness": ("thickness",)}),
    "transient": (
        "time",
        {
            "load": ("load",),
            "film thickness": ("central", "least"),
            "maximum pressure": ("greatest_pressure",),
        },
    ),
    "traction": (
        "slide_roll",
        {
            "traction coefficient": ("traction_coefficient",),
            "temperature rise": ("oil_temperature_rise", "surface_temperature_rise"),
        },
    ),
    "passage": (
        "rho1",
        {
            "load": ("load",),
            "minimum film": ("least", "steady_least"),
            "central film": ("central", "steady_central"),
        },
    ),
    "face_tolerance": ("in_plane", {"face-load factor": ("face_load_factor",)}),
    "damping": ("position", {"damping": ("damping_curve",)}),
}
"""Prefix of a record's variables to the one along the axis, and those of each panel under its title."""

WORDS = {
    "central": "central film",
    "least": "minimum film",
    "steady_central": "central film, steady",
    "steady_least": "minimum film, steady",
}
"""Names of curves that are not their variable's."""

SHOWN = 4.0
"""End of an axis of the film through a contact, over that on the line of centres: beyond the outlet the gap opens."""

THROUGH = (-3.0, 1.5)
"""Part of a contact that is drawn, in half-widths: the inlet reaches much farther, and nothing happens there."""


def curves(results: xr.Dataset, prefix: str = "", *, style: Style | None = None) -> Figure:
    """Draw the curves of a record against their place, those of one unit together.

    Parameters
    ----------
    results : xarray.Dataset
        Of such a record.
    prefix : str
        Which one, of `CURVES`; the first that is there unless given.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    prefix = prefix or next(
        (known for known in CURVES if f"{known}_{CURVES[known][0]}" in results), "damping"
    )
    across, panels_of = CURVES[prefix]
    need(results, "give the dataset of a film, a passage, a tolerance or a damping", f"{prefix}_{across}")
    x = read(results, f"{prefix}_{across}")
    with sheet(style, len(panels_of), height=1.2 + 1.9 * len(panels_of), legend=0) as (drawn, panels):
        for axes, (meaning, names) in zip(panels, panels_of.items(), strict=True):
            known = [_curve(results, prefix, name) for name in names if joined(prefix, name) in results]
            family(axes, x.values, {reading.meaning: reading for reading in known}, meaning)
            if len(known) > 1:
                legend_over(axes, len(known))
        if prefix == "contact_film":
            half = 1e6 * float(results["contact_film_half_width"])
            thickness = read(results, "contact_film_thickness").values
            panels[-1].set(
                xlim=(THROUGH[0] * half, THROUGH[1] * half),
                ylim=(0.0, SHOWN * np.interp(0.0, x.values, thickness)),
            )
        panels[-1].set_xlabel(x.label)
    return drawn


def _curve(results: xr.Dataset, prefix: str, name: str) -> Reading:
    """Curve by its name, without the definition that its meaning holds."""
    reading = read(results, joined(prefix, name))
    return replace(reading, meaning=WORDS.get(name, name.replace("_", " ")))


def film_response(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw yielding per load, in phase and a quarter behind, and damping over the frequency.

    Parameters
    ----------
    results : xarray.Dataset
        Of a film's answer to a load that oscillates.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, "give the dataset of a film's response", "response_frequency", "response_compliance")
    at = results["response_frequency"].values / (2e3 * np.pi)
    yielding = 1e12 * results["response_compliance"].values
    parts = {"in phase with the load": yielding.real, "a quarter of a period behind": -yielding.imag}
    shown = {label: Reading(values, "yielding per load", "µm per kN/mm") for label, values in parts.items()}
    with sheet(style, 2, height=4.6, legend=2) as (drawn, (upper, lower)):
        family(upper, at, shown)
        upper.set(ylabel="yielding per load\n[µm per kN/mm]")
        lower.plot(at, 1e-9 * results["response_damping"].values, color=colours(1)[0])
        lower.set(ylabel="damping [N s/(mm µm)]", xlabel="frequency [kHz]")
        if at[0] > 0.0 and at[-1] > 30.0 * at[0]:
            lower.set_xscale("log")
    return drawn
