"""Picture of a single record: its dataset, drawn by the function that draws it of a run."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING

from flankfilm.figures.views import PICTURES, Picture
from flankfilm.output import records
from flankfilm.output.variables import merged

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

__all__ = ["dataset", "function", "picture", "picture_of"]


def picture(record: object) -> Figure:
    """Draw a record.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=0.04)
    >>> [axes.get_ylabel() for axes in picture(pair.path_of_contact(9)).axes]
    ['curvature radius [mm]']
    """
    return function(picture_of(record))(dataset(record))


def dataset(record: object) -> xr.Dataset:
    """Variables of a record alone, named as a run names them."""
    how = picture_of(record)
    return merged(getattr(records, how.data)(how.prefix, record), {"title": type(record).__name__})


def picture_of(record: object) -> Picture:
    """How a record is drawn: as its class, or the nearest one above, says."""
    places = (f"{cls.__module__}:{cls.__qualname__}" for cls in type(record).__mro__)
    return next(PICTURES[place] for place in places if place in PICTURES)


def function(how: Picture) -> Callable[[xr.Dataset], Figure]:
    """Function of a dataset that draws."""
    module, _, name = how.draw.partition(".")
    draw: Callable[[xr.Dataset], Figure] = getattr(import_module(f"flankfilm.figures.{module}"), name)
    return draw
