"""What the face bears: flank maps over path and face, and the face-load factor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.of_records import curves
from flankfilm.figures.panels import curves as family
from flankfilm.figures.panels import mark_path, over_path, over_two_pitches
from flankfilm.figures.reading import Reading, need, read, read_figure
from flankfilm.figures.style import Style, colours, from_zero, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    import fem
    from flankfilm import coupling

FACE = "run a scene whose pair has a lead or an alignment"

MAPS = ("line_load", "hertz_pressure")
"""Figures of the cells that are painted."""


FILMS = ("line_load", "minimum_thickness")
"""Figures of the cells' films that are painted."""

TIMES_LEAST = 1.5
"""How many times the minimum film colours resolve."""


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


def flank_map(results: xr.Dataset, *, prefix: str = "dry_face", style: Style | None = None) -> Figure:
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
    places = [f"{prefix}_{name}" for name in ("travel", "face_position")]
    painted = [f"{prefix}_{name}" for name in MAPS]
    need(results, FACE, *places, *painted, "path_point_rho1")
    travel, face = (read(results, name) for name in places)
    with sheet(style, len(painted), height=2.3 * len(painted), legend=0) as (drawn, panels):
        for axes, name in zip(panels, painted, strict=True):
            FlankMap.of(travel, face, read(results, name)).paint(axes)
        over_path(results, *panels)
    return drawn


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
    position, name = f"{prefix.removesuffix('_face')}_position", f"{prefix}_face_load_factor"
    need(results, FACE, position, name)
    with sheet(style, height=2.4, legend=0) as (drawn, (axes,)):
        over_two_pitches(axes, read(results, position), {"": read(results, name)}, "face-load factor")
        axes.set_ylim(bottom=1.0)
    return drawn


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
    return _by_models(read(results, face), read(results, load), tuple(map(str, results[model].values)), style)


def face_loads(loads: fem.FaceLoads) -> Figure:
    """Draw line load and Hertz pressure over path and face."""
    with sheet(None, len(MAPS), height=2.3 * len(MAPS), legend=0) as (drawn, panels):
        _painted(panels, loads, MAPS)
    return drawn


def face_films(films: coupling.FaceFilms) -> Figure:
    """Draw line load and minimum film over path and face."""
    span = _thin(read_figure(films, "minimum_thickness"))
    with sheet(None, len(FILMS), height=2.3 * len(FILMS), legend=0) as (drawn, panels):
        _painted(panels, films, FILMS, {"minimum_thickness": span})
    return drawn


def loaded_contact(cycle: fem.MeshCycle) -> Figure:
    """Draw stiffness and transmission error, or what the face bears where it has cells."""
    if cycle.face is None:
        return curves(cycle)
    with sheet(None, 3, height=6.4, legend=0, sharex=False) as (drawn, panels):
        _painted(panels[:1], cycle.face, MAPS[:1])
        at = read_figure(cycle, "position")
        factor, error = read_figure(cycle.face, "face_load_factor"), read_figure(cycle, "transmission_error")
        for axes, reading, label in zip(
            panels[1:],
            (factor, error),
            ("face-load factor [-]", "transmission\nerror [µm]"),
            strict=True,
        ):
            axes.plot(at.values, reading.values, color=colours(1)[0])
            axes.set(ylabel=label, xlabel=at.label)
        panels[1].sharex(panels[2])
        panels[1].tick_params(labelbottom=False)
        panels[1].set_xlabel("")
    return drawn


def face_models(models: coupling.FaceLoadModels) -> Figure:
    """Draw the line load over the face of a comparison of models."""
    return _by_models(
        read_figure(models, "face_position"), read_figure(models, "line_load"), models.model, None
    )


def _by_models(face: Reading, load: Reading, labels: tuple[str, ...], style: Style | None) -> Figure:
    """Curve of each model that has an answer."""
    known = {
        label: Reading(values, load.meaning, load.unit)
        for label, values in zip(labels, load.values, strict=True)
        if np.isfinite(values).all()
    }
    with sheet(style, height=3.0, legend=4) as (drawn, (axes,)):
        family(axes, face.values, known, "line load at the pitch point")
        axes.set_xlabel("place on the face [mm]")
        from_zero(axes)
    return drawn


def _thin(film: Reading) -> tuple[float, float]:
    """Span of the films that count: from the smallest to some times as much, if there are any so thick."""
    least, most = float(np.nanmin(film.values)), float(np.nanmax(film.values))
    return least, min(TIMES_LEAST * least, most)


def _painted(
    panels: Sequence[Axes],
    record: fem.FaceLoads | coupling.FaceFilms,
    names: Sequence[str],
    spans: Mapping[str, tuple[float, float]] | None = None,
) -> None:
    """Paint figures of the cells of a record, over given spans, with the points of its pair's path."""
    travel, face = read_figure(record, "travel"), read_figure(record, "face_position")
    for axes, name in zip(panels, names, strict=True):
        FlankMap.of(travel, face, read_figure(record, name)).paint(axes, (spans or {}).get(name))
    points = record.pair.points
    mark_path({name: 1e3 * (getattr(points, name) - points.A) for name in "ABCDE"}, *panels)
