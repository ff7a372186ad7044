"""What the figures read from a dataset of results, and the marks that they share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flankfilm.figures.style import MARK

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

PATH_LABEL = "travel along the path of contact from A [mm]"
CYCLE_LABEL = "travel after a pair is at A [base pitches]"


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


def per_face(results: xr.Dataset) -> float:
    """Factor from N/m at the whole face to N/(mm um)."""
    return 1e-9 / float(results["face_width"])


def text(results: xr.Dataset, name: str) -> str:
    """Give a variable that is one text."""
    return str(results[name].values.item())


def travel(results: xr.Dataset, name: str) -> Array:
    """Travel from A [mm] of the curvature radii in a variable."""
    start = float(results["path_point_rho1"][0])
    return np.asarray(1e3 * (results[name].values - start))


def two_pitches(phase: Array, values: Array) -> tuple[Array, Array]:
    """Repeat a curve over a second base pitch."""
    return np.concatenate([phase, phase + 1]), np.concatenate([values, values])


def mark_path(results: xr.Dataset, panels: Sequence[Axes], named: Axes) -> None:
    """Mark A to E in all panels, and name them above one."""
    for name, at in zip(
        results["path_point_name"].values, travel(results, "path_point_rho1").tolist(), strict=True
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


def words(name: str) -> str:
    """Name of a variable without its unit, as a person writes it."""
    for unit in ("_N_per_mm_um", "_um", "_mm", "_percent", "_deg", "_GPa", "_MPa", "_m_per_s"):
        name = name.removesuffix(unit)
    return name.replace("_", " ")


def unit(results: xr.Dataset, name: str, pure: str = "-") -> str:
    """Unit of a variable; `pure` for numbers without one."""
    held = str(results[name].attrs["units"]).replace("um", "µm")
    return pure if held == "1" else held


def titled(results: xr.Dataset, name: str) -> str:
    """Give a variable's name with its unit, for an axis or the head of a column."""
    return f"{words(name)} [{unit(results, name)}]"
