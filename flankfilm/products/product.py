"""A product: what a want of the scene gives, from its stages to the report, a study's numbers and the files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, TypeVar

from flankfilm.figures.reading import Pictures
from flankfilm.output.variables import of_record
from flankfilm.products.output import Named
from flankfilm.report.page import Headline, Part
from flankfilm.report.run_parts import Work
from flankfilm.scene import Scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Stage

if TYPE_CHECKING:
    import xarray as xr

T = TypeVar("T")


@dataclass(frozen=True)
class CurveTable:
    """A CSV file: columns of the variables with a prefix, named, or all along an axis; without `about` none."""

    prefix: str
    about: str
    names: tuple[str, ...] = ()
    axis: str = ""


def _nothing(*_: object) -> Iterator[Any]:
    return iter(())


@dataclass(frozen=True, kw_only=True)
class Product:
    """One thing that a user can get; everything that lists results asks the products.

    Attributes
    ----------
    name : str
        The want of the scene, or what it adds to one.
    goals : callable
        Stages that a scene asks for by its wants; those that these need follow by themselves.
    variables : callable
        Datasets with the variables of ``results.nc``.
    solved : mapping
        Prefix of variables to the stage whose solver they are of.
    tables : mapping
        CSV files by name.
    headlines : callable
        Numbers for the head of the report and for the terminal.
    pictures : mapping
        Functions of `flankfilm.figures` to the variables that they draw. The first one whose variables are there is
        what ``plot()`` of a run, and of the product's record, draws.
    sections : callable
        Sections of the report.
    work : mapping
        Name of a stage to what it did for which error, for the table of error against cost.
    outputs : callable
        Numbers that a study can ask for, by name; a function, since their figures load what computes them.
    """

    name: str
    goals: Callable[[Scene, Set[str]], Iterable[Stage[Any]]] = _nothing
    variables: Callable[[Computed], Iterable[xr.Dataset]] = _nothing
    solved: Mapping[str, Stage[Any]] = field(default_factory=dict)
    tables: Mapping[str, CurveTable] = field(default_factory=dict)
    headlines: Callable[[Computed], Iterable[Headline]] = _nothing
    pictures: Pictures = field(default_factory=dict)
    sections: Callable[[Computed, xr.Dataset], Iterable[Part]] = _nothing
    work: Mapping[str, Callable[[Any, Computed], Work]] = field(default_factory=dict)
    outputs: Callable[[], Iterable[Named]] = _nothing


def record_of(prefix: str, stage: Stage[Any]) -> Callable[[Computed], Iterator[xr.Dataset]]:
    """Variables of a stage whose result is one record."""
    return when(stage, lambda record: [of_record(prefix, record)])


def when(
    stage: Stage[T] | Stage[T | None], variables: Callable[[T], Iterable[Any]]
) -> Callable[[Computed], Iterator[Any]]:
    """What a stage's result gives; nothing where there is none."""

    def of(computed: Computed) -> Iterator[Any]:
        value: T | None = computed.values.get(stage.name)
        if value is not None:
            yield from variables(value)

    return of


def section_of(
    stage: Stage[T] | Stage[T | None], part: Callable[[T, xr.Dataset], Part]
) -> Callable[[Computed, xr.Dataset], Iterator[Part]]:
    """Section of the report about a stage's result; none where there is no result."""
    return lambda computed, results: when(stage, lambda value: [part(value, results)])(computed)


def together(*parts: Callable[..., Iterable[T]]) -> Callable[..., Iterator[T]]:
    """What several functions of the same arguments give, one after the other."""

    def of(*arguments: Any) -> Iterator[T]:
        for part in parts:
            yield from part(*arguments)

    return of


def wanting(want: str, *stages: Stage[Any]) -> Callable[[Scene, Set[str]], Iterator[Stage[Any]]]:
    """Stages that one want asks for."""

    def of(_: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
        if want in wants:
            yield from stages

    return of


def ranked(headlines: Iterable[Headline], *ranks: int) -> list[Headline]:
    """Give the first figures of a product their ranks on the page."""
    shown = list(headlines)
    first = [replace(headline, rank=rank) for headline, rank in zip(shown, ranks, strict=False)]
    return first + shown[len(ranks) :]
