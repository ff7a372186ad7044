"""Safeties of a rating beside the required ones, and the damage of a load spectrum."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.reading import GEARS, need
from flankfilm.figures.style import Style, is_narrow, looks, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BAR = 0.36
"""Thickness of a bar, of the distance between two rows."""

REQUIRED = "#000000"
"""Colour of the marks at required safeties."""


def safeties(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the safeties of both gears, by the standard and by our own load factors, with the required ones.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``rating``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, 'run a scene that wants "rating"', "rating_S_H")
    rows = _rows(results)
    by_standard = [float(value) for value, _, _ in rows.values()]
    required = [asked for _, asked, _ in rows.values()]
    own = [value for _, _, value in rows.values()]
    at = np.arange(len(rows), dtype=np.float64)
    has_own = any(value is not None for value in own)
    with sheet(style, height=1.0 + 0.42 * len(rows), legend=3) as (drawn, (axes,)):
        first, second = (look["color"] for look in looks(2))
        shift = 0.5 * BAR if has_own else 0.0
        axes.barh(at - shift, by_standard, BAR, color=first, label="by the standard")
        if has_own:
            _own_bars(axes, at + shift, own, second)
        label = "required"
        for place, safety in zip(at, required, strict=True):
            axes.plot(
                [safety, safety], [place - 0.45, place + 0.45], color=REQUIRED, ls="-", lw=1.6, label=label
            )
            label = "_"
        axes.set_yticks(at, list(rows))
        axes.invert_yaxis()
        axes.set_xlim(left=0.0)
        axes.set(xlabel="safety [-]")
        axes.grid(visible=False, axis="y")
    return drawn


Own = tuple[float, float] | None
"""Safety by our own factors with its absolute error; None where there is none."""


def _rows(results: xr.Dataset) -> Mapping[str, tuple[float, float, Own]]:
    """Name of a row to safety by the standard, required one, and our own."""
    rows: dict[str, tuple[float, float, Own]] = {}
    for name, said in (("S_H", "pitting"), ("S_F", "breakage")):
        if f"rating_{name}" not in results:
            continue
        own = results.get(f"rating_own_{name}")
        off = 0.0 if own is None else float(results[f"rating_own_{name}_error"])
        for gear, called in enumerate(GEARS):
            value = float(results[f"rating_{name}"][gear])
            ours = None if own is None else (float(own[gear]), off * float(own[gear]))
            rows[f"{said}, {called}"] = value, float(results[f"rating_required_{name}"]), ours
    if "rating_S_S" in results:
        rows["scuffing"] = float(results["rating_S_S"]), float(results["rating_required_S_S"]), None
    return rows


def _own_bars(axes: Axes, at: Array, own: list[Own], colour: str) -> None:
    """Bars of safeties by our own factors with their errors."""
    placed = [(place, *value) for place, value in zip(at, own, strict=True) if value is not None]
    places, values, errors = zip(*placed, strict=True)
    axes.barh(
        places, values, BAR, xerr=errors, color=colour, label="with our own load factors",
        error_kw={"elinewidth": 1.0, "capsize": 2.5},
    )  # fmt: skip


def spectrum_damage(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the damage of each step of a load spectrum, of flanks and roots of both gears, on a logarithmic axis.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``rating`` with a spectrum.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    need(results, 'run a scene that wants "rating" with rating.spectrum', "rating_spectrum_parts_H")
    parts = {
        f"{what}, {gear}": results[f"rating_spectrum_parts_{name}"].values[place]
        for name, what in (("H", "flanks"), ("F", "roots"))
        if f"rating_spectrum_parts_{name}" in results
        for place, gear in enumerate(GEARS)
    }
    steps = np.arange(1, next(iter(parts.values())).size + 1)
    shown = [curve[np.isfinite(curve) & (curve > 0.0)] for curve in parts.values()]
    known = np.concatenate([np.ones(1), *shown])
    low, high = 0.3 * float(known.min()), 3.0 * float(known.max())
    with sheet(style, height=3.0, legend=1 if is_narrow() else 5) as (drawn, (axes,)):
        width = 0.8 / len(parts)
        for place, ((label, curve), look) in enumerate(zip(parts.items(), looks(len(parts)), strict=True)):
            heights = np.minimum(np.where(curve > 0.0, curve, 0.0), high)
            shift = (place - 0.5 * (len(parts) - 1)) * width
            axes.bar(steps + shift, heights, width, color=look["color"], label=label)
        axes.axhline(1.0, color=REQUIRED, linestyle="-", linewidth=1.2, label="failure")
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter(FuncFormatter(lambda damage, _: f"{damage:g}"))
        axes.set_ylim(low, high)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set(xlabel="step of the spectrum [-]", ylabel="damage at the required\nsafety [-]")
    return drawn
