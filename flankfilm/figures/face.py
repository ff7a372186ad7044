"""What the face bears: flank maps over path and face, the face-load factor, and root stress over the face."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.panels import curves as family
from flankfilm.figures.panels import over_path, over_two_pitches
from flankfilm.figures.reading import GEARS, Reading, need, read
from flankfilm.figures.style import Style, colours, from_zero, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FACE = "run a scene whose pair has a lead or an alignment"

DRY_FACE = "dry_face"
"""Prefix of what the face bears without a film."""

MAPS = ("line_load", "hertz_pressure")
"""Figures of the cells that are painted."""

TIMES_LEAST = 1.5
"""How many times the minimum film colours resolve."""

ROOTS = 'run a scene that wants "root-stress" and whose pair has a lead or an alignment'

FEW = 0.2
"""Part of the maximum tension below which an instant of a tooth is left out at both ends of its way."""

OF_ROOTS = ("travel", "face_position", "tension", "cycle_tension")


@dataclass(frozen=True)
class FlankMap:
    """A figure over path and face of the flanks in mesh.

    Attributes
    ----------
    travel : (places,) array
        Along the path of contact from A, growing [mm].
    face : (cells,) array
        Middles of the cells, 0 at mid-face [mm].
    values : Reading
        (places, cells); nan where nothing bears.
    """

    travel: Array
    face: Array
    values: Reading

    @classmethod
    def of(cls, travel: Reading, face: Reading, values: Reading) -> FlankMap:
        """Gather pairs at all positions by where they touch; the largest where several teeth come by.

        Parameters
        ----------
        travel : Reading
            (positions, pairs); nan where a pair cannot touch.
        face : Reading
            (cells,)
        values : Reading
            (positions, pairs, cells)
        """
        at, cells = travel.values.ravel(), values.values.reshape(-1, len(face.values))
        known = np.isfinite(at)
        # equal places of several pitches differ by rounding
        places, which = np.unique(np.round(at[known], 9), return_inverse=True)
        greatest = np.zeros((len(places), len(face.values)))
        np.fmax.at(greatest, which, cells[known])
        shown = Reading(np.where(greatest > 0.0, greatest, np.nan), values.meaning, values.unit)
        return cls(places, face.values, shown)

    def paint(self, axes: Axes, span: tuple[float, float] | None = None) -> None:
        """Paint the map with its scale of colours, over a span that counts; white where nothing bears."""
        bears = np.flatnonzero(np.isfinite(self.values.values).any(axis=1))
        first, last = (int(bears[0]), int(bears[-1]) + 1) if bears.size else (0, len(self.travel))
        painted = axes.pcolormesh(
            self.travel[first:last],
            self.face,
            self.values.values[first:last].T,
            vmin=0.0 if span is None else span[0],
            vmax=None if span is None else span[1],
            shading="nearest",
            rasterized=True,
        )
        figure = axes.get_figure()
        assert figure is not None
        figure.colorbar(
            painted,
            ax=axes,
            label=self.values.label,
            extend="neither" if span is None or np.nanmax(self.values.values) <= span[1] else "max",
        )
        axes.grid(visible=False)
        half = 0.5 * float(self.face[-1] - self.face[0]) * len(self.face) / (len(self.face) - 1)
        axes.set(ylabel="place on the\nface [mm]", ylim=(-half, half))


def flank_map(results: xr.Dataset, *, prefix: str = DRY_FACE, style: Style | None = None) -> Figure:
    """Draw line load and Hertz pressure over path and face.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run whose pair has a lead or an alignment.
    prefix : str
        Of the variables of ``fem.FaceLoads``.
    style : mapping, optional
        rcParams that overrule the house's; ``image.cmap`` is the scale of colours.
    """
    with sheet(style, len(MAPS), height=2.3 * len(MAPS), legend=0) as (drawn, panels):
        paint(results, prefix, dict(zip(MAPS, panels, strict=True)))
    return drawn


def paint(results: xr.Dataset, prefix: str, panels: Mapping[str, Axes]) -> None:
    """Paint figures of the cells, each in its panel, with the points of the path."""
    places = [f"{prefix}_{name}" for name in ("travel", "face_position")]
    need(results, FACE, *places, *(f"{prefix}_{name}" for name in panels), "path_point_rho1")
    travel, face = (read(results, name) for name in places)
    for name, axes in panels.items():
        FlankMap.of(travel, face, read(results, f"{prefix}_{name}")).paint(axes)
    over_path(results, *panels.values())


def film_map(results: xr.Dataset, *, prefix: str = "film_face", style: Style | None = None) -> Figure:
    """Draw minimum film and Hertz pressure with films over path and face.

    Films of cells that bear little are many times as thick: colours end half as thick again as the smallest.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run with a film whose pair has a lead or an alignment.
    prefix : str
        Of the variables of ``flankfilm.coupling.FaceFilms``.
    style : mapping, optional
        rcParams that overrule the house's; ``image.cmap`` is the scale of colours.
    """
    names = ("travel", "face_position", "minimum_thickness", "hertz_pressure")
    places = [f"{prefix}_{name}" for name in names]
    need(results, "run a scene with a film whose pair has a lead or an alignment", *places, "path_point_rho1")
    travel, face, film, pressure = (read(results, name) for name in places)
    with sheet(style, 2, height=4.6, legend=0) as (drawn, panels):
        # short names: a panel is low
        FlankMap.of(travel, face, replace(film, meaning="minimum film")).paint(panels[0], _thin(film))
        FlankMap.of(travel, face, replace(pressure, meaning="Hertz pressure")).paint(panels[1])
        over_path(results, *panels)
    return drawn


def face_load_factor(results: xr.Dataset, *, prefix: str = "dry_face", style: Style | None = None) -> Figure:
    """Draw the face-load factor over two base pitches.

    Parameters
    ----------
    results, prefix, style
        As of `flank_map`.
    """
    with sheet(style, height=2.4, legend=0) as (drawn, (axes,)):
        factor(axes, results, prefix)
    return drawn


def factor(axes: Axes, results: xr.Dataset, prefix: str) -> None:
    """Draw the face-load factor over two base pitches into a panel."""
    position, name = f"{prefix.removesuffix('_face')}_position", f"{prefix}_face_load_factor"
    need(results, FACE, position, name)
    over_two_pitches(axes, read(results, position), {"": read(results, name)}, "face-load factor")
    axes.set_ylim(bottom=1.0)


def line_load_models(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the line load over the face of the pair at the pitch point, by several models.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run whose pair has a lead or an alignment.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    face, load, model = (f"face_models_{name}" for name in ("face_position", "line_load", "model"))
    need(results, FACE, face, load, model)
    shown, labels = read(results, load), tuple(map(str, results[model].values))
    known = {
        label: replace(shown, values=values)
        for label, values in zip(labels, shown.values, strict=True)
        if np.isfinite(values).all()
    }
    with sheet(style, height=3.0, legend=4) as (drawn, (axes,)):
        family(axes, read(results, face).values, known, "line load at the pitch point")
        axes.set_xlabel("place on the face [mm]")
        from_zero(axes)
    return drawn


def _thin(film: Reading) -> tuple[float, float]:
    """Span of the films that count: from the smallest to some times as much, if there are any so thick."""
    least, most = float(np.nanmin(film.values)), float(np.nanmax(film.values))
    return least, min(TIMES_LEAST * least, most)


def root_face_map(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the maximum tension at the roots over the way of a tooth and the face, and that of a cycle over the face.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``root-stress`` and whose pair has a lead or an alignment, or of one gear's record.
    style : mapping, optional
        rcParams that overrule the house's; ``image.cmap`` is the scale of colours.
    """
    gears = {gear: f"root_face_{gear}" for gear in GEARS}
    if "root_face_tension" in results:
        gears = {"root": "root_face"}
    names = {gear: [f"{prefix}_{name}" for name in OF_ROOTS] for gear, prefix in gears.items()}
    need(results, ROOTS, *(name for of_gear in names.values() for name in of_gear))
    rows = 1 + len(gears)
    with sheet(style, rows, height=2.27 * rows, legend=0, sharex=False) as (drawn, panels):
        for axes, gear, colour in zip(panels, gears, colours(2), strict=False):
            travel, face, tension, most = (read(results, name) for name in names[gear])
            _paint(axes, gear, travel, face, tension)
            panels[-1].plot(face.values, most.values, color=colour, label=gear)
        panels[-1].set(xlabel="place on the face [mm]", ylabel=f"maximum of a\ncycle [{most.unit}]")
        from_zero(panels[-1])
        legend_over(panels[-1], 2)
    return drawn


def _paint(axes: Axes, what: str, travel: Reading, face: Reading, tension: Reading) -> None:
    """Paint a map with its scale of colours, as long as the tooth is stressed."""
    bears = tension.values.max(axis=-1, keepdims=True) > FEW * tension.values.max()
    shown = Reading(np.where(bears, tension.values, 0.0), f"tension, {what}", tension.unit)
    FlankMap.of(travel, face, shown).paint(axes)
    axes.set_xlabel("base pitches since the tooth's pair passed A [-]")
