"""Look of all figures: sizes, colours that survive printing, and the way to files and SVG text."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Any

from base import InputError
from base.files import replacing
from base.views import surface
from flankfilm.processes.current_folder import load_matplotlib

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


load_matplotlib()

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
"""Okabe and Ito's palette: distinct for colour-blind readers and in grey."""

DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)), (0, (3, 1)))

Style = Mapping[str, Any]
"""Settings of matplotlib's rcParams that go before the house's own."""

MARK = "#999999"
"""Colour of lines that mark places."""

_RC: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "flankfilm",
    "font.family": "sans-serif",
    "font.size": 9.0,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.4,
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "figure.constrained_layout.use": True,
}


@contextmanager
def styled(style: Style | None = None) -> Iterator[None]:
    """Draw in the house's style without changing matplotlib's global state for others.

    Parameters
    ----------
    style : mapping, optional
        rcParams that overrule the house's, such as ``{"font.family": "serif", "figure.figsize": (3.4, 2.2)}``;
        ``axes.prop_cycle`` gives the curves' colours and dashes.
    """
    import matplotlib as mpl
    from cycler import cycler

    curves = cycler(color=COLOURS) + cycler(linestyle=DASHES)
    chosen: dict[Any, Any] = {**_RC, "axes.prop_cycle": curves, "figure.figsize": (0.0, 0.0), **(style or {})}
    with mpl.rc_context(chosen):
        yield


def looks(count: int) -> list[dict[str, Any]]:
    """Give colour and dashes of `count` curves in the style at hand, from the start again where they run out."""
    import matplotlib as mpl

    known = list(mpl.rcParams["axes.prop_cycle"])
    return [dict(known[i % len(known)]) for i in range(count)]


def colours(count: int) -> list[str]:
    """Give the colours alone of `count` curves."""
    return [str(look["color"]) for look in looks(count)]


PHONE = 3.9
"""Width of a drawing whose text a phone shows large enough [inches]."""

SHORT = 22
"""Letters of labels two of which stand beside each other in such a drawing."""

_narrow: ContextVar[bool] = ContextVar("narrow", default=False)


@contextmanager
def narrow() -> Iterator[None]:
    """Draw as a phone shows it: panels below each other, `PHONE` wide, with legends that this width holds."""
    before = _narrow.set(True)
    try:
        yield
    finally:
        _narrow.reset(before)


def is_narrow() -> bool:
    """Whether pictures are drawn as a phone shows them."""
    return _narrow.get()


@contextmanager
def sheet(
    style: Style | None = None,
    rows: int = 1,
    columns: int = 1,
    *,
    width: float = 7.0,
    height: float = 3.2,
    legend: int = 3,
    **options: Any,
) -> Iterator[tuple[Figure, list[Axes]]]:
    """Give a figure with empty panels in the house's style, and legend it at the end.

    It is free of pyplot's global list, unless the surface at hand (`base.views.surface`) is its current figure or axes
    that somebody gave.

    Parameters
    ----------
    style : mapping, optional
        As of `styled`; its ``figure.figsize`` goes before width and height.
    rows, columns : int
        Of panels; where they stand below each other alone, they share the horizontal axis.
    width, height : float
        [inches]
    legend : int
        Columns of the legend of the first panel's curves. It stands above the figure, where it covers no data and
        takes no width from it; 0 for none.
    options
        As of ``Figure.subplots``.
    """
    import matplotlib as mpl

    if _narrow.get():
        legend = min(legend, 1)
        if columns > 1:
            height *= max(1.0, 0.75 * columns)
            kept = {name: value for name, value in options.items() if name != "width_ratios"}
            rows, columns, options = rows * columns, 1, {"sharex": False, **kept}
        width = PHONE
    with styled(style):
        own, on = tuple(mpl.rcParams["figure.figsize"]), surface()
        if on.axes:
            panels = _given(on.axes, rows * columns)
            drawn = panels[0].figure.figure
        else:
            drawn = _empty(own if min(own) > 0 else (width, height), on.current)
            grid = drawn.subplots(rows, columns, squeeze=False, **{"sharex": columns == 1, **options})
            panels = grid.ravel().tolist()
        yield drawn, panels
        handles, labels = panels[0].get_legend_handles_labels()
        if not (legend and labels):
            return
        if on.axes:
            legend_over(panels[0], legend)
        else:
            short = _narrow.get() and max(map(len, labels)) < SHORT
            columns = 2 if short else legend
            drawn.legend(handles, labels, loc="outside upper left", ncols=columns, handlelength=2.6)


def _given(axes: tuple[Any, ...], panels: int) -> list[Axes]:
    """Axes that somebody gave for the panels of a picture."""
    from matplotlib.axes import Axes

    if len(axes) != panels or not all(isinstance(panel, Axes) for panel in axes):
        kinds = ", ".join(dict.fromkeys(type(panel).__name__ for panel in axes))
        remedy = f"Give those of matplotlib's figure.subplots({panels}), or leave ax out"
        raise InputError.at(
            "ax", f"{len(axes)} of {kinds}", f"must be {panels} axes, one for each panel", remedy
        )
    return list(axes)


def _empty(size: tuple[float, ...], current: bool) -> Figure:
    """Figure without panels; the current one of pyplot where that is wanted and its backend can be loaded."""
    from matplotlib.figure import Figure

    if current:
        from matplotlib import pyplot

        with suppress(ImportError):
            return pyplot.figure(figsize=(size[0], size[1]))
    return Figure(figsize=(size[0], size[1]))


def legend_over(axes: Axes, columns: int) -> None:
    """Put the legend of `axes` right above it: the curves leave no corner free for certain."""
    if _narrow.get():
        longest = max(map(len, axes.get_legend_handles_labels()[1]), default=0)
        columns = min(columns, 4 if longest < SHORT // 4 else 2 if longest < SHORT - 4 else 1)
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=columns,
        borderaxespad=0.2,
        handlelength=2.6 if columns < 5 else 1.8,
        columnspacing=2.0 if columns < 5 else 1.0,
    )


def from_zero(*panels: Axes) -> None:
    """Let the vertical axis begin at zero, and end above the data, level ones too."""
    for axes in panels:
        axes.set_ylim(0.0, 1.08 * float(axes.dataLim.y1) or 1.0)


FILM_SHOWN = 2.5
"""End of an axis of film thickness, over the median of the films."""


def films_from_zero(*panels: Axes) -> None:
    """Let an axis of film thickness begin at zero, and end where nearly unloaded contacts rise far above the others.

    At the ends of a relieved flank a contact carries hardly any load, and its film is many times as thick.
    """
    import numpy as np

    for axes in panels:
        from_zero(axes)
        values = np.concatenate([np.asarray(line.get_ydata(), dtype=float) for line in axes.lines])
        values = values[np.isfinite(values)]
        if values.size == 0:
            continue
        largest, end = float(values.max()), FILM_SHOWN * float(np.median(values))
        if largest <= end:
            continue
        axes.set_ylim(0.0, end)
        said = f"up to {largest:.2g} at hardly loaded ends"
        axes.text(0.5, 0.97, said, transform=axes.transAxes, ha="center", va="top", color=MARK)


RASTER = 150
"""Dots per inch of the parts of a drawing that are pixels."""

THEME = {
    "#0072b2": "--c1", "#d55e00": "--c2", "#009e73": "--c3", "#cc79a7": "--c4", "#56b4e9": "--c5", "#e69f00": "--c6",
    "#000000": "--ink", "#dddddd": "--grid", "#999999": "--mark", "#777777": "--mark", "#aaaaaa": "--mark",
    "#555555": "--mark", "#dce9f5": "--shade1", "#f8e6d8": "--shade2", "#bbbbbb": "--band",
    "#ffffff": "--card",
}  # fmt: skip
"""Colours of figures that a page may replace in the dark, as custom properties of its style sheet."""


def to_svg(drawn: Figure, prefix: str) -> str:
    """Return a figure as inline SVG whose ids start with `prefix` and whose colours follow the page.

    Inline drawings share one page, and equal ids would make one use the other's clip paths.
    """
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    text = io.StringIO()
    # no background: the page's shows through, with the shades that hint at more
    drawn.patch.set_visible(False)
    for axes in drawn.axes:
        axes.patch.set_visible(False)
    with styled():
        # savefig would lay the figure out twice
        drawn.set_dpi(RASTER)
        FigureCanvasSVG(drawn).print_svg(text, metadata={"Date": None, "Creator": None})
    svg = text.getvalue()
    svg = svg[svg.index("<svg") :]
    for place in (' id="', "url(#", 'href="#'):
        svg = svg.replace(place, f"{place}{prefix}-")
    # what stands before a colour is looked at last: a pattern that begins with its "#" is found ten times as fast
    return re.sub(r"#[0-9a-f]{6}\b(?<=[:\s].{7})", lambda colour: _themed(colour.group()), svg)


def _themed(colour: str) -> str:
    return f"var({THEME[colour]},{colour})" if colour in THEME else colour


def save(drawn: Figure, path: Path) -> None:
    """Replace the file `path` by a figure, in the format of its suffix."""
    with styled(), replacing(path) as beside:
        drawn.savefig(beside, format=path.suffix[1:], dpi=200)
