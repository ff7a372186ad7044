"""The report's page: sections of text, figures and tables, rendered to one self-contained file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import resources
from typing import TYPE_CHECKING

from flankfilm.figures.style import to_svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Drawing:
    """A figure as inline SVG, with its caption."""

    svg: str
    caption: str


@dataclass(frozen=True)
class Table:
    """A table of text cells; the first column is left-aligned, numbers right."""

    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str = ""


@dataclass(frozen=True)
class Part:
    """One section of the report."""

    anchor: str
    title: str
    paragraphs: tuple[str, ...] = ()
    figures: tuple[Drawing, ...] = ()
    tables: tuple[Table, ...] = ()
    notes: tuple[str, ...] = ()
    code: str = ""


@dataclass(frozen=True)
class Headline:
    """One number of the page's head.

    Attributes
    ----------
    name : str
        What it is.
    text : str
        Value with unit.
    note : str
        Error estimate and how it came about.
    """

    name: str
    text: str
    note: str = ""


def drawing(figure: Figure, name: str, caption: str) -> Drawing:
    """Inline a figure; `name` must be unique on the page."""
    return Drawing(to_svg(figure, name), caption)


def render(title: str, lead: str, headlines: Sequence[Headline], parts: Sequence[Part]) -> str:
    """Return the page's HTML."""
    import jinja2

    source = resources.files("flankfilm.report").joinpath("report.html.j2").read_text(encoding="utf-8")
    environment = jinja2.Environment(autoescape=True, trim_blocks=True, undefined=jinja2.StrictUndefined)
    return environment.from_string(source).render(title=title, lead=lead, headlines=headlines, sections=parts)
