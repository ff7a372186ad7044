"""The report's page: sections of text, figures and tables, rendered to one self-contained file."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from flankfilm import figures
from flankfilm.figures.reading import Pictures, drawable
from flankfilm.output.files import write_text
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.report.text import counted, missed, off, parts, percent, total

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from flankfilm.processes.assistant import Assistant

T = TypeVar("T")

BOUND = re.compile(r"\[[^\]]*\]|± (?:< )?[\d.e+-]+(?: %)?|\d %")
"""What a line does not break within: a unit in brackets, an error behind its sign, a per cent."""


@dataclass(frozen=True)
class Drawing:
    """A figure as inline SVG, with its caption.

    Attributes
    ----------
    svg, caption : str
    function : str
        Name of the function that draws it from results, if one does.
    redraw : callable, optional
        Gives it as a phone shows it; of pictures that fit a phone anyway there is no other one.
    """

    svg: str
    caption: str
    function: str = ""
    redraw: Callable[[], str] | None = None

    def drawn(self, helper: Assistant | None) -> Drawing:
        """The figure, whose drawing for a phone waits in the queue of a helper, or is made at once without one."""
        if self.redraw is None:
            return self
        if helper is None:
            return replace(self, redraw=partial(str, self.redraw()))
        return replace(self, redraw=partial(helper.result, helper.submit(self.redraw)))

    @cached_property
    def narrow(self) -> str:
        """The figure for a phone, drawn once; empty where it has no other one."""
        return "" if self.redraw is None else self.redraw()


CARDS, SHOWN = 8, 4
"""Figures and warnings on the first screen; more unfold."""

UNFIT = frozenset(("drive_modes",))
"""Pictures that hold too much for a phone's width: there they scroll in their frame."""

FEW, MANY = 3, 7
"""Columns of a table that is no wider than it needs to be, and more than those of one in the page's own type."""


@dataclass(frozen=True)
class Table:
    """A table of text cells; the first column and columns of words are left-aligned, numbers right."""

    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str = ""

    @classmethod
    def of(cls, rows: Iterable[T], columns: Mapping[str, Callable[[T], str]], caption: str = "") -> Table:
        """Lay out equal things, one a row; `columns` are the head of each to the text of its cell."""
        cells = tuple(tuple(text(row) for text in columns.values()) for row in rows)
        return cls(tuple(columns), cells, caption)

    @property
    def filled(self) -> Table:
        """The table without columns that hold nothing."""
        kept = [i for i, column in enumerate(zip(*self.rows, strict=True)) if any(column)]
        rows = tuple(tuple(row[i] for i in kept) for row in self.rows)
        return Table(tuple(self.heads[i] for i in kept), rows, self.caption) if self.rows else self

    @property
    def titles(self) -> tuple[str, ...]:
        """Heads of the columns whose units do not break over lines."""
        return tuple(map(_unbroken, self.heads))

    @property
    def sides(self) -> tuple[str, ...]:
        """Class of each column: "f" for a first one of words, "k" of numbers; "t" for words, "n" for numbers."""
        columns = list(zip(*self.rows, strict=True)) if self.rows else [()] * len(self.heads)
        first, *others = (_side(column) for column in columns)
        return "k" if first == "n" else "f", *others

    @property
    def width(self) -> str:
        """Class of the table by its columns: "few", "many", or neither."""
        return "few" if len(self.heads) <= FEW else "many" if len(self.heads) > MANY else ""


def _unbroken(text: str) -> str:
    """Text whose units, errors and per cents stay on the line of what they belong to."""
    return BOUND.sub(lambda words: words.group().replace(" ", "\u00a0"), text)


def _side(column: Sequence[str]) -> str:
    """Words where most cells that hold something do not begin like a number."""
    filled = [cell for cell in column if cell not in ("", "-", "unknown")]
    words = sum(not re.match(r"[-+±.]?\d", cell) for cell in filled)
    return "t" if 2 * words > len(filled) else "n"


@dataclass(frozen=True)
class Part:
    """One section of the report: its text and first figure are seen at once, the rest unfolds.

    Attributes
    ----------
    anchor, title : str
    paragraphs, notes : tuple of str
    figures : tuple of Drawing
    tables : tuple of Table
    code : str
        Shown in the type of a file.
    seen : int
        Figures that are seen at once.
    unfolded : bool
        Whether all of it is seen at once.
    inset : str
        HTML of a view that begins when it is unfolded.
    """

    anchor: str
    title: str
    paragraphs: tuple[str, ...] = ()
    figures: tuple[Drawing, ...] = ()
    tables: tuple[Table, ...] = ()
    notes: tuple[str, ...] = ()
    code: str = ""
    seen: int = 1
    unfolded: bool = False
    inset: str = ""

    def drawn(self, helper: Assistant | None) -> Part:
        """Have what is seen at once drawn for a phone too, as `Drawing.drawn`; the rest has no other picture."""
        seen = (figure.drawn(helper) for figure in self.figures[: self.seen])
        return replace(self, figures=(*seen, *self.figures[self.seen :]))

    @property
    def folded(self) -> str:
        """Contents of what unfolds, in words; empty where there is nothing."""
        if self.unfolded:
            return ""
        held = {
            "more picture" if self.seen else "picture": len(self.figures[self.seen :]),
            "table": len(self.tables),
            "note": len(self.notes),
        }
        texts = [counted(count, noun) for noun, count in held.items() if count]
        return ", ".join([*texts, "the scene"] if self.code else texts)


@dataclass(frozen=True)
class Headline:
    """One number of the page's head.

    Attributes
    ----------
    name : str
        What it is.
    text : str
        Value.
    note : str
        Error estimate and how it came about.
    unit : str
        Of the value; empty for pure numbers.
    uncertainty : Uncertainty or None
        What `against` puts before the note; None where nothing is to be estimated.
    rank : int
        Order on the page: 1 for limits of the teeth and the oil, 2 for what the pair does, 3 for the rest.
    bound, made_up, mark : str
        What a card shows of the uncertainty, by `against`: the total, its parts, and that it misses the tolerance.
    remark : str
        The note without these; empty as long as there are none.
    """

    name: str
    text: str
    note: str = ""
    unit: str = ""
    uncertainty: Uncertainty | None = None
    rank: int = 3
    bound: str = ""
    made_up: str = ""
    mark: str = ""
    remark: str = ""

    def against(self, tolerance: float) -> Headline:
        """Put the uncertainty before the note, marked where it does not meet the tolerance."""
        uncertainty = self.uncertainty
        if uncertainty is None:
            return self
        return replace(
            self,
            note="; ".join(filter(None, (off(uncertainty, tolerance), self.note))),
            bound=total(uncertainty),
            made_up=parts(uncertainty),
            mark=missed(uncertainty, tolerance),
            remark=self.note,
        )

    def miss(self, tolerance: float) -> str:
        """Say that its error is above the tolerance; empty where it is not, or not known."""
        uncertainty = self.uncertainty
        if uncertainty is None or uncertainty.numerical is None or uncertainty.met(tolerance):
            return ""
        return (
            f"{self.name}: its numerical error of {percent(uncertainty.numerical)} is above the tolerance of "
            f"{percent(tolerance)}"
        )

    @property
    def with_unit(self) -> str:
        """Value with unit."""
        return f"{self.text} {self.unit}".strip()


@dataclass(frozen=True)
class Fact:
    """A short statement under the title, with the anchor of the section with the details, or empty."""

    text: str
    anchor: str = ""


def picture(draw: Callable[[xr.Dataset], Figure], results: xr.Dataset, caption: str) -> Drawing:
    """Draw results with one of `flankfilm.figures` for the page; its name becomes the figure's id."""
    from flankfilm.figures.style import to_svg  # which loads matplotlib

    name = f"flankfilm.figures.{draw.__name__}"
    redraw = None if draw.__name__ in UNFIT else partial(_on_phone, draw, results)
    return Drawing(to_svg(draw(results), draw.__name__), caption, name, redraw)


def _on_phone(draw: Callable[[xr.Dataset], Figure], results: xr.Dataset) -> str:
    """SVG of a figure as a phone shows it."""
    from flankfilm.figures.style import narrow, to_svg

    with narrow():
        return to_svg(draw(results), f"{draw.__name__}-narrow")


def pictures(results: xr.Dataset, shown: Pictures, **words: str) -> tuple[Drawing, ...]:
    """Draw what results have the variables of, each with its caption, into which `words` are filled."""
    captions = _prose()["captions"]
    return tuple(
        picture(getattr(figures, name), results, captions[name].format(**words))
        for name in drawable(shown, results)
    )


def said(note: str, **words: Any) -> str:
    """Give a note of ``prose.toml`` with `words` filled in."""
    return _prose()["notes"][note].format(**words)


@cache
def _prose() -> dict[str, dict[str, str]]:
    return tomllib.loads(_text("prose.toml"))


def _text(name: str) -> str:
    return resources.files("flankfilm.report").joinpath(name).read_text(encoding="utf-8")


@dataclass(frozen=True)
class Head:
    """First screen of a page.

    Attributes
    ----------
    title : str
    facts : sequence of Fact
    headlines : sequence of Headline
    warnings : sequence of str
    drawing : Drawing, optional
    """

    title: str
    facts: Sequence[Fact]
    headlines: Sequence[Headline]
    warnings: Sequence[str] = ()
    drawing: Drawing | None = None

    @property
    def cards(self) -> list[Headline]:
        """Figures to act on, those of the lowest ranks first."""
        return self._ranked[:CARDS]

    @property
    def more(self) -> list[Headline]:
        """Figures that unfold."""
        return self._ranked[CARDS:]

    @property
    def _ranked(self) -> list[Headline]:
        return sorted(self.headlines, key=lambda headline: headline.rank)


def render(head: Head, parts: Sequence[Part]) -> str:
    """Return the page's HTML."""
    import jinja2

    house = jinja2.Environment(
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    house.filters["unbroken"] = _unbroken
    page = house.from_string(_text("report.html.j2"))
    return str(page.render(head=head, shown=SHOWN, sections=parts))


def write_page(folder: Path, head: Head, parts: Sequence[Part]) -> Path:
    """Write ``report.html`` into a folder and return its path."""
    path = folder / "report.html"
    write_text(path, render(head, parts))
    return path
