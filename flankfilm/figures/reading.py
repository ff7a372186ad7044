"""What the figures read from a dataset of results: numbers in the unit that people read, and labels.

The one place that turns a variable into numbers and a label; both follow from the variable's attributes.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from textwrap import fill
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from base import Array
from base.results import figures
from base.units import factor, suffix
from base.units import unit_of as unit_in
from flankfilm.output.tables import read_in
from flankfilm.output.variables import sentence

if TYPE_CHECKING:
    import xarray as xr

PER_FACE = "N/(mm um)"
"""Unit that people read a stiffness in, per face width."""

PER_WHOLE = "N/um"
"""The same of a whole face whose width is not known."""

WIDEST = 34
"""Most characters of a line of a label."""

LONGEST = 60
"""Most characters of a meaning that is not cut at a comma."""

GEARS = ("pinion", "wheel")

NO_BREAK = "\N{NO-BREAK SPACE}"

Pictures: TypeAlias = Mapping[str, str | tuple[str, ...]]
"""Function of `flankfilm.figures` to how the names of the variables begin that it draws."""


@dataclass(frozen=True)
class Reading:
    """A variable as people read it.

    Attributes
    ----------
    values : ndarray
        In `unit`.
    meaning : str
        What it is.
    unit : str
        As it is written on an axis; "-" for pure numbers.
    """

    values: Array
    meaning: str
    unit: str

    @property
    def label(self) -> str:
        """Meaning with its unit, for an axis or the head of a column."""
        return self.named(self.meaning)

    def named(self, meaning: str) -> str:
        """The same for another meaning, such as what several curves have in common."""
        unit = f"[{self.unit}]".replace(" ", NO_BREAK)
        lines = (fill(line, WIDEST) for line in f"{meaning} {unit}".split("\n"))
        return "\n".join(lines).replace(NO_BREAK, " ")


def read(results: xr.Dataset, name: str, *, per_face: bool = False) -> Reading:
    """Read a variable in the unit that people read.

    Parameters
    ----------
    results : xarray.Dataset
    name : str
        Of the variable.
    per_face : bool
        Whether a stiffness is divided by the face width: N/(mm um) instead of N/m; N/um where the width is not known.

    Examples
    --------
    >>> import xarray as xr
    >>> about = {"units": "m", "display_units": "um", "long_name": "transmission error"}
    >>> found = read(xr.Dataset({"dry_transmission_error": ("dry_position", [2e-6, 3e-6], about)}),
    ...              "dry_transmission_error")
    >>> found.values, found.label
    (array([2., 3.]), 'transmission error [µm]')
    """
    about = results[name].attrs
    reading = _reading(results[name].values, about["units"], read_in(results, name), about["long_name"])
    if not per_face or about["units"] != "N/m":
        return reading
    shown, scale = PER_WHOLE, 1e6
    if "pair_face_width" in results:
        shown, scale = PER_FACE, factor(PER_FACE) * float(results["pair_face_width"])
    return replace(reading, values=results[name].values / scale, unit=unit_text(shown))


def read_figure(result: object, name: str, face_width: float | None = None) -> Reading:
    """Read a figure of a record in the unit that people read.

    Parameters
    ----------
    result : object
        A record.
    name : str
        Of the figure.
    face_width : float, optional
        By which a stiffness is divided [m]: N/(mm um) instead of N/m.
    """
    figure = figures(type(result))[name]
    value = np.asarray(getattr(result, name))
    reading = _reading(value, figure.unit, figure.read_in, sentence(figure.meaning))
    if face_width is None:
        return reading
    return replace(reading, values=value / (factor(PER_FACE) * face_width), unit=unit_text(PER_FACE))


def _reading(values: Array, unit: str, shown: str, meaning: str) -> Reading:
    scale = 1.0 if shown == unit else factor(shown)
    return Reading(values if scale == 1.0 else values / scale, _short(meaning), unit_text(shown))


def _short(meaning: str) -> str:
    """What a variable is, without explanations: up to a colon or semicolon, or where that is long to a comma."""
    head = re.split("[:;]", meaning, maxsplit=1)[0]
    return head if len(head) <= LONGEST else head.partition(", ")[0]


def unit_text(unit: str, pure: str = "-") -> str:
    """Unit as it is written on a page; `pure` for numbers without one."""
    return pure if unit in ("1", "") else unit.replace("um", "µm").replace("m2", "m²").replace("m3", "m³")


def need(results: xr.Dataset, wants: str, *names: str) -> None:
    """Refuse a dataset without the variables that a figure draws.

    Parameters
    ----------
    results : xarray.Dataset
    wants : str
        What gives the variables, as the message names it.
    names : str
        Of the variables.

    Raises
    ------
    ValueError
        Naming what is missing and how to get it.
    """
    missing = [name for name in names if name not in results]
    if missing:
        title = results.attrs.get("title") or "these results"
        raise ValueError(f"{title}: no {', '.join(missing)} to draw; {wants}")


def drawable(pictures: Pictures, results: xr.Dataset) -> tuple[str, ...]:
    """Pictures whose variables are there.

    Examples
    --------
    >>> import xarray as xr
    >>> shown = {"fourier": "fourier_samples", "portraits": ("portrait_x", "portrait_v")}
    >>> drawable(shown, xr.Dataset({"portrait_v_of_one": 1.0}))
    ('portraits',)
    """
    names = [str(name) for name in results.variables]
    return tuple(draw for draw, begins in pictures.items() if any(name.startswith(begins) for name in names))


def text(results: xr.Dataset, name: str) -> str:
    """Give a variable that is one text."""
    return str(results[name].values.item())


def travel(results: xr.Dataset, name: str) -> Array:
    """Travel from A [mm] of the curvature radii in a variable; the radii themselves where the path is not known."""
    start = float(results["path_point_rho1"][0]) if "path_point_rho1" in results else 0.0
    return np.asarray(1e3 * (results[name].values - start))


def labelled(results: xr.Dataset, start: str, *, per_face: bool = False) -> dict[str, Reading]:
    """Curves of the variables whose names begin alike, by the model that ``long_name`` names after its colon."""
    names = [name for name in map(str, results.data_vars) if name.startswith(start)]
    return {
        str(results[name].attrs["long_name"]).partition(": ")[2]: read(results, name, per_face=per_face)
        for name in names
    }


def beside(results: xr.Dataset, name: str, *, per_face: bool = False) -> dict[str, Reading]:
    """Curves that stand beside each other in a variable, by the labels of its first axis; none without the variable."""
    if name not in results:
        return {}
    reading = read(results, name, per_face=per_face)
    labels = results[results[name].dims[0]].values.tolist()
    return {
        label: replace(reading, values=curve) for label, curve in zip(labels, reading.values, strict=True)
    }


def key_words(key: str) -> tuple[str, str]:
    """Key of a scene as a person writes it, and its unit.

    Examples
    --------
    >>> key_words("pair.module_mm"), key_words("pair.pinion.profile_shift"), key_words("operating.pinion_torque_Nm")
    (('module', 'mm'), ('profile shift of the pinion', '-'), ('pinion torque', 'N m'))
    """
    *path, last = key.split(".")
    unit = unit_in(last)
    name = last.removesuffix(f"_{suffix(unit)}").replace("_", " ")
    part = " ".join(table.replace("_", " ") for table in path[1:] if table not in GEARS)
    gear = next((f" of the {table}" for table in path if table in GEARS), "")
    return f"{part} {name}".strip() + gear, unit_text(unit)


def key_title(key: str) -> str:
    """Key of a scene with its unit, for an axis or the head of a column."""
    name, unit = key_words(key)
    return f"{name} [{unit}]"


def words(results: xr.Dataset, name: str) -> str:
    """Name of a study's output without its unit, as a person writes it."""
    if name.endswith("_error"):  # of another output, relative
        return f"error of the {name.removesuffix('_error').replace('_', ' ')}"
    return name.removesuffix(f"_{suffix(read_in(results, name))}").replace("_", " ").replace("K v", "K_v")


def unit_of(results: xr.Dataset, name: str, pure: str = "-") -> str:
    """Unit of a variable as people read it; `pure` for numbers without one."""
    return unit_text(read_in(results, name), pure)


def titled(results: xr.Dataset, name: str) -> str:
    """Give a study's output with its unit, for an axis or the head of a column."""
    return f"{words(results, name)} [{unit_of(results, name)}]"
