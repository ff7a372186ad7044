"""Look of all figures: sizes, colours that survive printing, and the way to SVG text."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from meshes.atomic import replacing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
"""Okabe and Ito's palette: distinct for colour-blind readers and in grey."""

DASHES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)), (0, (3, 1)))

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
def styled() -> Iterator[None]:
    """Draw in the house's style without changing matplotlib's global state for others."""
    import matplotlib as mpl

    with mpl.rc_context(_RC):
        yield


def figure(width: float = 7.0, height: float = 3.2) -> Figure:
    """Give an empty figure of `width` by `height` inches, free of pyplot's global list."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height))


def legend_above(drawn: Figure, axes: Axes, columns: int = 3) -> None:
    """Put the legend of `axes` above the figure, where it covers no data and takes no width from it."""
    handles, labels = axes.get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside upper left", ncols=columns, handlelength=2.6)


def to_svg(drawn: Figure, prefix: str) -> str:
    """Return a figure as inline SVG whose ids start with `prefix`.

    Inline drawings share one page, and equal ids would make one use the other's clip paths.
    """
    text = io.StringIO()
    with styled():
        drawn.savefig(text, format="svg", dpi=150, metadata={"Date": None, "Creator": None})
    svg = text.getvalue()
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r'\bid="', f'id="{prefix}-', svg)
    svg = re.sub(r"url\(#", f"url(#{prefix}-", svg)
    return re.sub(r'href="#', f'href="#{prefix}-', svg)


def save(drawn: Figure, path: Path) -> None:
    """Replace the file `path` by a figure, in the format of its suffix."""
    with styled(), replacing(path) as beside:
        drawn.savefig(beside, format=path.suffix[1:], dpi=200)
