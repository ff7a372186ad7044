"""Views of records in notebooks and their pictures: registered by name, so that no floor loads one above it."""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

from base.faults import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

GROUP = "base.views"
"""Entry points of packages that draw records: functions without arguments that call `show_with`."""

_VIEWS: dict[str, str] = {}
_PICTURES: dict[str, str] = {}

ANY = "any record"
"""Key of the view of records that have no other."""


def show_with(views: Mapping[str, str], pictures: Mapping[str, str] | None = None) -> None:
    """Register how records show themselves in notebooks, both by name, so that neither loads the other.

    Parameters
    ----------
    views : mapping
        ``"package.module:Class"``, or `ANY`, to ``"package.module:function"``, a function of the record that returns
        HTML.
    pictures : mapping, optional
        The same to functions of the record that return a figure of matplotlib.

    Examples
    --------
    >>> show_with({"gears.pair.gear_pair:GearPair": "gears.notebook:pair_html"})
    """
    _VIEWS.update(views)
    _PICTURES.update(pictures or {})


def view(result: object) -> str | None:
    """HTML of a record by the view registered for its class; None where there is none, and its line is shown.

    A dataclass that is no record shows itself so with ``_repr_html_ = view``.

    Examples
    --------
    >>> view(3.0) is None
    True
    """
    _ask()
    function = _registered(_VIEWS, result)
    if function is None and dataclasses.is_dataclass(result) and ANY in _VIEWS:
        function = _named(_VIEWS[ANY])
    return None if function is None else str(function(result))


@dataclasses.dataclass(frozen=True)
class Surface:
    """What a picture is drawn on.

    Attributes
    ----------
    axes : tuple of matplotlib.axes.Axes
        One for each panel; empty for a figure that the picture makes for itself.
    current : bool
        Whether that figure becomes the current one of pyplot.
    """

    axes: tuple[Any, ...] = ()
    current: bool = False


OWN_FIGURE = Surface()

_SURFACE: ContextVar[Surface] = ContextVar("_SURFACE", default=OWN_FIGURE)

NOTEBOOKS = ("inline", "ipympl", "widget", "nbagg", "notebook")
"""Words in the names of matplotlib's backends that show each figure of pyplot, beside the one that is returned."""


def surface() -> Surface:
    """What the picture at hand is drawn on; for functions that draw.

    Examples
    --------
    >>> surface()
    Surface(axes=(), current=False)
    """
    return _SURFACE.get()


def plot(result: object, ax: Any = None) -> Figure:
    """Picture of a record, by the function registered for its class; every record has it as its method.

    A dataclass that is no record gets it with ``plot = plot``.

    Parameters
    ----------
    result : record
    ax : matplotlib.axes.Axes, or several, optional
        Where to draw, one for each panel of the picture; a new figure if left out.

    Returns
    -------
    matplotlib.figure.Figure
        Shown by a notebook, and written with its ``savefig``. Where ``matplotlib.pyplot`` is loaded it is the current
        figure, so that ``plt.savefig`` and ``plt.show`` have it too; backends of notebooks show it once as it is.

    Raises
    ------
    InputError
        Where no picture is registered for the class, with those that have one.

    Examples
    --------
    >>> plot(3.0)
    Traceback (most recent call last):
    base.faults.InputError: float.plot: has no picture...
    """
    axes = () if ax is None else tuple(getattr(ax, "flat", ax if isinstance(ax, list | tuple) else (ax,)))
    return picture(result, Surface(axes, _pyplot_at_work()))


def _pyplot_at_work() -> bool:
    """Whether pyplot is loaded, with a backend that leaves showing to the user."""
    if "matplotlib.pyplot" not in sys.modules:
        return False
    from matplotlib import get_backend

    return not any(word in get_backend().lower() for word in NOTEBOOKS)


def picture(result: object, on: Surface = OWN_FIGURE) -> Figure:
    """Picture of a record on a surface; see `plot`.

    Examples
    --------
    >>> picture(3.0)
    Traceback (most recent call last):
    base.faults.InputError: float.plot: has no picture...
    """
    _ask()
    function = _registered(_PICTURES, result)
    if function is None:
        known = (
            ", ".join(sorted({place.replace(":", ".") for place in _PICTURES})) or "none that is installed"
        )
        raise InputError.at(f"{type(result).__name__}.plot", "", "has no picture", f"These have one: {known}")
    before = _SURFACE.set(on)
    try:
        drawn: Figure = function(result)
    finally:
        _SURFACE.reset(before)
    return drawn


def has_picture(result: object) -> bool:
    """Whether `plot` draws a record.

    Examples
    --------
    >>> has_picture(3.0)
    False
    """
    _ask()
    return _registered(_PICTURES, result) is not None


def _registered(places: Mapping[str, str], result: object) -> Callable[[Any], Any] | None:
    for cls in type(result).__mro__:
        if (place := places.get(f"{cls.__module__}:{cls.__qualname__}")) is not None:
            return _named(place)
    return None


def _named(place: str) -> Callable[[Any], Any]:
    module, _, name = place.partition(":")
    function: Callable[[Any], Any] = getattr(import_module(module), name)
    return function


@cache
def _ask() -> None:
    """Let installed packages above register their views, once: each has an entry point that is a function."""
    from importlib.metadata import entry_points  # 20 ms, which the command line has no use for

    for entry in entry_points(group=GROUP):
        entry.load()()
