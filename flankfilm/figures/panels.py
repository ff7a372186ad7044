"""Panels that several figures share: a family of curves, over the path of contact, over two base pitches."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array
from flankfilm.figures.reading import Reading, travel
from flankfilm.figures.style import MARK, looks

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

NARROW = 0.03
"""Part of the path within which the names of two points would overprint."""

PATH_LABEL = "travel along the path of contact from A [mm]"

RADIUS_LABEL = "radius of curvature of the pinion's flank [mm]"


def curves(axes: Axes, x: Array, family: Mapping[str, Reading], meaning: str = "", **options: Any) -> None:
    """Draw curves by their labels in the style's colours and dashes, and title the vertical axis.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    x : ndarray
    family : mapping
        Label to curve, all in one unit.
    meaning : str
        What the curves have in common; that of the last one unless given.
    options
        Of ``Axes.plot``, which go before the style's.
    """
    for (label, curve), look in zip(family.items(), looks(len(family)), strict=True):
        axes.plot(x, curve.values, label=label, **{**look, **options})
        axes.set(ylabel=curve.named(meaning or curve.meaning))


def over_two_pitches(
    axes: Axes,
    position: Reading,
    family: Mapping[str, Reading],
    meaning: str = "",
    at: Mapping[str, Array] | None = None,
    **options: Any,
) -> None:
    """Draw curves of the mesh cycle, repeated over a second base pitch.

    Parameters
    ----------
    axes, family, meaning, options
        As of `curves`.
    position : Reading
        Of the curves.
    at : mapping, optional
        Label to positions of a curve that has its own.
    """
    for (label, curve), look in zip(family.items(), looks(len(family)), strict=True):
        own = (at or {}).get(label, position.values)
        twice = np.concatenate([own, own + 1]), np.tile(curve.values, 2)
        axes.plot(*twice, label=label, **{**look, **options})
        axes.set(ylabel=curve.named(meaning or curve.meaning))
    axes.set(xlabel=position.label)


def beside(axes: Axes, scale: float, label: str, way: str = "right") -> None:
    """Show a panel's values on its other side as multiples of `scale`, such as dimensionless ones.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    scale : float
        Value in the panel of 1 on the other side.
    label : str
        Of the other side.
    way : {"right", "top"}
    """
    conversions = (lambda value: value / scale), (lambda value: value * scale)
    if way == "top":
        axes.secondary_xaxis("top", functions=conversions).set_xlabel(label)
        axes.spines["top"].set_visible(True)
    else:
        axes.secondary_yaxis("right", functions=conversions).set_ylabel(label)
        axes.spines["right"].set_visible(True)


def plain_ticks(axis: Axis) -> None:
    """Tick a logarithmic axis of one or two decades at 1, 2 and 5, in plain numbers."""
    from matplotlib.ticker import LogLocator, NullLocator

    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(lambda value, _: f"{value:.3g}" if value < 1000 else f"{value:.0f}")


def over_path(results: xr.Dataset, *panels: Axes) -> None:
    """Mark A to E in panels over the travel along the path, name them above the first, and title the last.

    Of records that do not know their path, panels are over the radius of the pinion's flank.
    """
    if "path_point_rho1" not in results:
        panels[-1].set(xlabel=RADIUS_LABEL)
        return
    places = travel(results, "path_point_rho1").tolist()
    points = dict(zip(map(str, results["path_point"].values), places, strict=True))
    narrow, before, raised = NARROW * (max(points.values()) - min(points.values())), -np.inf, False
    for at, name in sorted((at, name) for name, at in points.items()):
        for axes in panels:
            axes.axvline(at, color=MARK, linewidth=0.8)
        # names of points that lie close together stand alternately at two heights
        raised = not raised and at - before < narrow
        panels[0].annotate(
            name, (at, 1.0), xycoords=("data", "axes fraction"), xytext=(0, 12 if raised else 2),
            textcoords="offset points", ha="center", va="bottom", color="#000000",
        )  # fmt: skip
        before = at
    panels[-1].set(xlabel=PATH_LABEL)
