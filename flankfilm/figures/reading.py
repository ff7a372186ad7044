"""What the figures read from a dataset of results: numbers in the unit that people read, labels, and shared marks.

The one place that turns a variable into numbers and a label; both follow from the variable's attributes.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from base.results import figures
from base.units import factor, suffix
from flankfilm.figures.style import MARK
from flankfilm.output.tables import read_in
from flankfilm.output.variables import sentence

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

PATH_LABEL = "travel along the path of contact from A [mm]"

PER_FACE = "N/(mm um)"
"""Unit that people read a stiffness in, per face width."""

WIDEST = 34
"""Most characters of a line of a label."""

LONGEST = 60
"""Most characters of a meaning that is not cut at a comma."""

NO_BREAK = "\N{NO-BREAK SPACE}"


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
        return fill(f"{meaning} {unit}", WIDEST).replace(NO_BREAK, " ")


def read(results: xr.Dataset, name: str, *, per_face: bool = False) -> Reading:
    """Read a variable in the unit that people read.

    Parameters
    ----------
    results : xarray.Dataset
    name : str
        Of the variable.
    per_face : bool
        Whether a stiffness is divided by the face width: N/(mm um) instead of N/m.

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
    width = float(results["pair_face_width"]) if per_face else None
    return _reading(results[name].values, about["units"], read_in(results, name), about["long_name"], width)


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
    return _reading(value, figure.unit, figure.read_in, sentence(figure.meaning), face_width)


def _reading(values: Array, unit: str, shown: str, meaning: str, face_width: float | None) -> Reading:
    scale = 1.0 if shown == unit else factor(shown)
    if face_width is not None:
        shown, scale = PER_FACE, factor(PER_FACE) * face_width
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


def text(results: xr.Dataset, name: str) -> str:
    """Give a variable that is one text."""
    return str(results[name].values.item())


def travel(results: xr.Dataset, name: str) -> Array:
    """Travel from A [mm] of the curvature radii in a variable."""
    start = float(results["path_point_rho1"][0])
    return np.asarray(1e3 * (results[name].values - start))


def two_pitches(position: Array, values: Array) -> tuple[Array, Array]:
    """Repeat a curve over a second base pitch."""
    return np.concatenate([position, position + 1]), np.concatenate([values, values])


def mark_path(results: xr.Dataset, panels: Sequence[Axes], named: Axes) -> None:
    """Mark A to E in all panels, and name them above one."""
    for name, at in zip(
        results["path_point"].values, travel(results, "path_point_rho1").tolist(), strict=True
    ):
        for axes in panels:
            axes.axvline(at, color=MARK, linewidth=0.8)
        named.annotate(
            str(name), (at, 1.0), xycoords=("data", "axes fraction"), xytext=(0, 2), textcoords="offset points",
            ha="center", va="bottom", color="#000000",
        )  # fmt: skip


def label_of(results: xr.Dataset, name: str) -> str:
    """Model that a variable's ``long_name`` names after its colon."""
    return str(results[name].attrs["long_name"]).partition(": ")[2]


def words(results: xr.Dataset, name: str) -> str:
    """Name of a study's output without its unit, as a person writes it."""
    return name.removesuffix(f"_{suffix(read_in(results, name))}").replace("_", " ")


def unit_of(results: xr.Dataset, name: str, pure: str = "-") -> str:
    """Unit of a variable as people read it; `pure` for numbers without one."""
    return unit_text(read_in(results, name), pure)


def titled(results: xr.Dataset, name: str) -> str:
    """Give a study's output with its unit, for an axis or the head of a column."""
    return f"{words(results, name)} [{unit_of(results, name)}]"
