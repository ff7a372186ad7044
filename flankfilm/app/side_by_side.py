"""Results of runs side by side: what a folder keeps, curves over each other, and differences of figures."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from base import InputError
from base.results import EXACT
from base.units import factor
from flankfilm.app.checking import Place
from flankfilm.app.kept import CYCLES, DATA
from flankfilm.figures.reading import PER_FACE, read
from flankfilm.files.folder import readable, refuse_missing
from flankfilm.output.tables import read_in
from flankfilm.report.text import number, percent, plain

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Comparison", "Difference", "Overlaid", "compared"]

CURVES = ("transmission_error", "tangent_stiffness", "load_share")

LONG = ("film_profile",)
"""Beginnings of the names of figures that are too many for a table."""

LARGEST = 500_000_000
"""Bytes of a file of results that is read."""

MANY = 6
"""Results that are compared at once."""

BETWEEN = "Tick two to six results of the list"


@dataclass(frozen=True)
class Overlaid:
    """A curve of several runs over the mesh cycle.

    Attributes
    ----------
    name, label, unit : str
    runs : tuple of dict
        For each run that has it: its ``run``, ``position`` in base pitches, ``lines``, one for the mesh or one for each
        pair of teeth with None where it does not touch, and ``error``.
    """

    name: str
    label: str
    unit: str
    runs: tuple[dict[str, Any], ...]


@dataclass(frozen=True)
class Difference:
    """A figure of several runs.

    Attributes
    ----------
    name, label, unit : str
    values : tuple of str
        With errors; empty for a run without it.
    differences : tuple of str
        Against the first run that has the figure; empty for that one, and where nothing differs.
    real : tuple of bool
        Whether the difference is larger than both errors together.
    """

    name: str
    label: str
    unit: str
    values: tuple[str, ...]
    differences: tuple[str, ...]
    real: tuple[bool, ...]


@dataclass(frozen=True)
class Comparison:
    """Several runs side by side.

    Attributes
    ----------
    runs : tuple of str
    curves : tuple of Overlaid
    rows : tuple of Difference
        Of figures that two runs have and that are not equal.
    equal : int
        Figures that are, to the last digit.
    about : str
        Which errors count.
    """

    runs: tuple[str, ...]
    curves: tuple[Overlaid, ...]
    rows: tuple[Difference, ...]
    equal: int
    about: str


@dataclass(frozen=True, eq=False)
class _Run:
    """Results that are compared."""

    name: str
    data: xr.Dataset

    @property
    def cycle(self) -> str:
        """How names of the mesh cycle begin; empty without one."""
        return next((one for one in CYCLES if f"{one}_transmission_error" in self.data.variables), "")

    @property
    def models(self) -> tuple[tuple[str, str], ...]:
        """Models by which its figures are."""
        decisions = json.loads(self.data.attrs.get("decisions_json", "[]"))
        return tuple(
            (one["subject"], one["choice"]) for one in decisions if one["subject"] != "Fourier order"
        )

    @cached_property
    def figures(self) -> dict[str, tuple[float, float | None, float | None]]:
        """Single numbers with their numerical and model errors, absolute, in the unit that people read."""
        held = self.data.variables
        return {
            name: figure
            for name in map(str, held)
            if not held[name].dims
            and not name.startswith(LONG)
            and (figure := self._figure(name)) is not None
        }

    def unit(self, name: str) -> str:
        """Unit of a figure; stiffness per face width."""
        shown = read_in(self.data, name)
        return PER_FACE if shown == "N/m" and "pair_face_width" in self.data.variables else shown

    def _figure(self, name: str) -> tuple[float, float | None, float | None] | None:
        held = self.data.variables[name]
        if held.dtype.kind not in "fiu" or "units" not in held.attrs or "alias_of" in held.attrs:
            return None
        exact = held.attrs.get("error_note") == EXACT
        relative = 0.0 if exact else held.attrs.get("error")
        if not exact and relative is None:
            return None
        unit, shown = held.attrs["units"], self.unit(name)
        value = float(held.values) if unit == shown else float(held.values) / factor(shown)
        if shown == PER_FACE and unit == "N/m":
            value /= float(self.data.variables["pair_face_width"].values)
        numerical = None if relative is None else abs(value) * float(relative)
        return value, numerical, abs(value) * float(held.attrs.get("model_error", 0.0))


def compared(place: Place, names: Sequence[str]) -> Comparison:
    """Compare results of runs.

    Parameters
    ----------
    place : Place
        Of the root.
    names : sequence of str
        Folders of two results or more, from the root.

    Raises
    ------
    InputError
        Where there are fewer or too many, or one is outside the root or cannot be read.
    """
    chosen = list(dict.fromkeys(names))
    if not 2 <= len(chosen) <= MANY:
        raise InputError.at("results", len(chosen), f"must be 2 to {MANY} to be compared", BETWEEN)
    runs = [_Run(name, _read(place.inside(f"{name}/{DATA}"))) for name in chosen]
    same = len({run.models for run in runs}) == 1
    names_of = dict.fromkeys(name for run in runs for name in run.figures)
    shared = [name for name in names_of if sum(name in run.figures for run in runs) > 1]
    rows = [_difference(runs, name, same) for name in shared]
    about = (
        "Numerical errors count: the runs have the same models, whose errors both share."
        if same
        else "Numerical and model errors count: the runs have different models."
    )
    shown = tuple(row for row in rows if any(row.differences))
    curves = tuple(filter(None, (_overlaid(runs, name) for name in CURVES)))
    return Comparison(tuple(chosen), curves, shown, len(rows) - len(shown), about)


def _read(path: Path) -> xr.Dataset:
    """Single numbers and curves of a run's data, which take a fraction of the time of all of them."""
    refuse_missing(path, "Choose results of a run")
    if path.stat().st_size > LARGEST:
        raise InputError.at(path, "", f"is larger than {LARGEST:,} bytes", "Compare other results")
    import h5py
    import xarray as xr

    wanted = {f"{cycle}_{name}" for cycle in CYCLES for name in (*CURVES, "position")}
    with readable(path), h5py.File(path, "r") as whole:
        held = {
            name: (tuple(f"{name}_{axis}" for axis in range(data.ndim)), data[()], _attributes(data.attrs))
            for name, data in whole.items()
            if data.dtype.kind in "fiu" and (not data.ndim or name in wanted)
        }
        return xr.Dataset(held, attrs=_attributes(whole.attrs))


def _attributes(held: Mapping[str, Any]) -> dict[str, Any]:
    """Attributes as plain values; those that are lists, or belong to the format, are left out."""
    plain_ones = {name: np.asarray(value) for name, value in held.items()}
    items = {name: value.item() for name, value in plain_ones.items() if value.size == 1}
    texts = {name: value.decode() if isinstance(value, bytes) else value for name, value in items.items()}
    return {name: value for name, value in texts.items() if isinstance(value, str | int | float)}


def _difference(runs: Sequence[_Run], name: str, same: bool) -> Difference:
    """A figure of all runs; errors of models count where the models differ."""
    figures = [run.figures.get(name) for run in runs]
    first, base = next((run, figure) for run, figure in zip(runs, figures, strict=True) if figure is not None)
    values, differences, real = [], [], []
    for figure in figures:
        error = 0.0 if figure is None else _counted(figure, same)
        change = 0.0 if figure is None else figure[0] - base[0]
        values.append("" if figure is None else _with_error(figure[0], error))
        differences.append(f"{'+' if change > 0.0 else '-'}{number(abs(change), 3)}" if change else "")
        real.append(abs(change) > error + _counted(base, same))
    prefix, _, _ = name.partition("_")
    label = str(first.data.variables[name].attrs.get("long_name", name)).partition("; None")[0]
    unit = first.unit(name)
    label += f", {CYCLES[prefix]}" if prefix in CYCLES else ""
    return Difference(
        name, label, "" if unit == "1" else unit, tuple(values), tuple(differences), tuple(real)
    )


def _counted(figure: tuple[float, float | None, float | None], same: bool) -> float:
    """Error of a figure that counts, absolute."""
    _, numerical, model = figure
    return (numerical or 0.0) + (0.0 if same else model or 0.0)


def _with_error(value: float, error: float) -> str:
    """Value with the decimals that two digits of its error have; with seven digits where it is exact."""
    if not 0.0 < error < abs(value):
        return number(value, 7) + (f" ± {plain(error)}" if error else "")
    decimals = max(0, 1 - math.floor(math.log10(error)))
    return f"{value:.{decimals}f} ± {error:.{decimals}f}"


def _overlaid(runs: Sequence[_Run], name: str) -> Overlaid | None:
    """A curve of all runs that have it; None where none has."""
    drawn, label, unit = [], "", ""
    for run in runs:
        variable = f"{run.cycle}_{name}"
        if not run.cycle or variable not in run.data.variables:
            continue
        reading = read(run.data, variable, per_face=True)
        label, unit = reading.meaning, "" if reading.unit == "-" else reading.unit
        values = np.atleast_2d(np.asarray(reading.values, dtype=float).T)
        if name == "load_share":
            values = np.where(values > 0.0, values, np.nan)
        error = run.data.variables[variable].attrs.get("error")
        drawn.append(
            {
                "run": run.name,
                "position": run.data.variables[f"{run.cycle}_position"].values.tolist(),
                "lines": [line for line in map(_plain, values) if any(v is not None for v in line)],
                "error": "error unknown" if error is None else f"± {percent(float(error))}",
            }
        )
    return Overlaid(name, label, unit, tuple(drawn)) if drawn else None


def _plain(line: Any) -> list[float | None]:
    return [float(value) if math.isfinite(value) else None for value in line]
