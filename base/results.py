"""What every result has: figures that describe themselves, a line that one can read, a view in notebooks.

A figure's unit, axes and meaning stand where the figure does, once: as `quantity` for a field and `described` for a
property. Datasets, tables, labels and the class's own documentation follow from there.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar, dataclass_transform, runtime_checkable

import numpy as np

from base.cost import Cost
from base.faults import SolverError
from base.units import factor
from base.views import plot, view

T = TypeVar("T")
LONGEST_LINE = 200

EXACT = "exact: it follows from what is given"
"""Why a figure has no error: it errs by rounding alone."""

ITSELF = "it is an error, or the measure of one, itself"
"""Why a figure has no error: it says what others err by."""

BY_RECORD = "not known beforehand: it depends on how the figure was computed, and the record says so"
"""Why figures of a class have no error, where each record says it by itself."""

WORST = 0.2
"""Relative error from which a solver has not converged; below it figures are kept, with their error."""


@runtime_checkable
class Result(Protocol):
    """What a solver gives back: its figures, and these."""

    @property
    def error(self) -> float | None:
        """Estimated relative error of the headline figures; None where it is unknown."""

    @property
    def cost(self) -> Cost:
        """What the result cost."""

    @property
    def converged(self) -> bool:
        """Whether the solver believes its figures."""

    @property
    def message(self) -> str:
        """What happened, with a remedy where it did not converge."""


@dataclass(frozen=True)
class Figure:
    """What a figure is.

    Attributes
    ----------
    unit : str
        Of the value, SI; "1" for pure numbers, "" for text.
    meaning : str
        In words, as a label.
    dims : tuple of str
        Names of its axes, none for a single number.
    shown : str
        Unit that people read it in; the SI one unless given.
    error : str
        Name of the record's figure or property that holds its relative error, those of several by their names, or an
        array with one for each entry; empty where that is unknown.
    no_error : str
        Why it has none, or why where the record has none this time; empty where the record's own `no_error`, an
        attribute or a property, says so of all its figures.
    model_error : str
        Name of the record's figure or property that holds what the model leaves open, relative, as `error` has the
        numerical error; empty where it is not estimated.
    called : str
        What variables and columns of files are called, where the record's own name says less; for one version they
        have that name too.
    """

    unit: str
    meaning: str
    dims: tuple[str, ...] = ()
    shown: str = ""
    error: str = ""
    no_error: str = ""
    model_error: str = ""
    called: str = ""

    @property
    def read_in(self) -> str:
        """Unit that people read it in."""
        return self.shown or self.unit

    def in_shown(self, value: Any) -> Any:
        """Value in the unit that people read."""
        return value if self.read_in == self.unit else np.asarray(value) / factor(self.read_in)


@dataclass(frozen=True)
class Quantity:
    """A figure with its name and value.

    Attributes
    ----------
    name : str
        Of the record's field or property.
    figure : Figure
        What it is.
    value : Any
        SI.
    """

    name: str
    figure: Figure
    value: Any


def quantity(
    unit: str,
    meaning: str,
    dims: str = "",
    *,
    shown: str = "",
    error: str = "",
    no_error: str = "",
    model_error: str = "",
    called: str = "",
    default: Any = dataclasses.MISSING,
    default_factory: Any = dataclasses.MISSING,
) -> Any:
    """Field of a `record` that is a figure.

    Parameters
    ----------
    unit, meaning, shown, error, no_error, model_error, called : str
        As of `Figure`.
    dims : str
        Names of its axes, separated by blanks.
    default, default_factory
        As of `dataclasses.field`.

    Examples
    --------
    >>> @record
    ... class Film:
    ...     minimum: float = quantity("m", "minimum film", shown="um")
    >>> Film(0.5e-6)
    Film(minimum 5e-07 m)
    """
    figure = Figure(unit, meaning, tuple(dims.split()), shown, error, no_error, model_error, called)
    return _field({"figure": figure}, default=default, default_factory=default_factory)


def part(
    meaning: str, *, default: Any = dataclasses.MISSING, default_factory: Any = dataclasses.MISSING
) -> Any:
    """Field of a `record` that is no figure: another record, several of them, a choice.

    Parameters
    ----------
    meaning : str
        In words; the class's documentation shows it.
    default, default_factory
        As of `dataclasses.field`.

    Examples
    --------
    >>> @record
    ... class Gear:
    ...     '''A gear.'''
    ...
    ...     tool: str = part("the tool that cuts it")
    >>> "the tool that cuts it." in Gear.__doc__
    True
    """
    return _field({"meaning": meaning}, default=default, default_factory=default_factory)


def _field(about: dict[str, Any], **defaults: Any) -> Any:
    """Field with what it is; defaults that are missing are as if they were not given."""
    return field(metadata=about, **defaults)


class Described(property, Generic[T]):
    """Property that is a figure."""

    if TYPE_CHECKING:

        def __get__(self, instance: Any, owner: type | None = None, /) -> T:  # type: ignore[override]
            """Value of the figure."""


def described(
    unit: str,
    dims: str = "",
    *,
    shown: str = "",
    error: str = "",
    no_error: str = "",
    model_error: str = "",
    called: str = "",
    kept: bool = False,
) -> Callable[[Callable[[Any], T]], Described[T]]:
    """Make a function a property that is a figure; its docstring's first line is the meaning.

    Parameters
    ----------
    unit, dims, shown, error, no_error, model_error, called : str
        As of `quantity`.
    kept : bool
        Whether the value is kept once it has been computed.

    Examples
    --------
    >>> @record
    ... class Contact:
    ...     load: float = quantity("N/m", "force per length of face")
    ...     radius: float = quantity("m", "radius of relative curvature", shown="mm")
    ...
    ...     @described("N/m2", shown="")
    ...     def stress(self) -> float:
    ...         '''Load over radius.'''
    ...         return self.load / self.radius
    >>> Contact(10.0, 0.5).stress
    20.0
    """

    def made(function: Callable[[Any], T]) -> Any:
        meaning = (function.__doc__ or "").strip().split("\n")[0].rstrip(".")
        descriptor: Any = cached_property(function) if kept else Described(function)
        descriptor.__figure__ = Figure(
            unit, meaning, tuple(dims.split()), shown, error, no_error, model_error, called
        )
        return descriptor

    return made


@dataclass_transform(frozen_default=True, eq_default=False, field_specifiers=(quantity, part, field))
def record(cls: type[T]) -> type[T]:
    """Make a class a frozen record: a dataclass compared by identity, shown in one line, documented by its fields.

    ``headline``, a tuple of names, says which figures its line shows; the first few that are single numbers unless
    given.

    Examples
    --------
    >>> @record
    ... class Load:
    ...     '''A load.'''
    ...
    ...     force: float = quantity("N", "normal force")
    >>> "normal force [N]." in Load.__doc__
    True
    """
    made = dataclass(frozen=True, eq=False, repr=False)(cls)
    if "__repr__" not in cls.__dict__:
        made.__repr__ = headline  # type: ignore[method-assign]
    if "_repr_html_" not in cls.__dict__:
        made._repr_html_ = view  # type: ignore[attr-defined]
    if "plot" not in cls.__dict__:
        made.plot = plot  # type: ignore[attr-defined]
    made.__doc__ = _documented(made)
    return made


def figures(cls: type) -> dict[str, Figure]:
    """Figures of a record's class by name: fields in their order, then properties."""
    return dict(_figures(cls))


@cache
def _figures(cls: type) -> Mapping[str, Figure]:
    """The same, looked for once."""
    of_fields = {f.name: f.metadata["figure"] for f in dataclasses.fields(cls) if "figure" in f.metadata}
    names = dict.fromkeys(name for base in reversed(cls.__mro__) for name in vars(base))
    marked = ((name, getattr(getattr(cls, name, None), "__figure__", None)) for name in names)
    return of_fields | {name: figure for name, figure in marked if figure is not None}


def quantities(result: object) -> dict[str, Quantity]:
    """Figures of a record with their values; those that are None are left out.

    Examples
    --------
    >>> @record
    ... class Contact:
    ...     load: float = quantity("N/m", "force per length of face")
    >>> load = quantities(Contact(1e5))["load"]
    >>> load.value, load.figure.unit, load.figure.meaning
    (100000.0, 'N/m', 'force per length of face')
    """
    values = {name: (figure, getattr(result, name)) for name, figure in figures(type(result)).items()}
    return {
        name: Quantity(name, figure, value) for name, (figure, value) in values.items() if value is not None
    }


def why_no_error(record: object, name: str) -> str:
    """Why a figure of a record, or of its class, has no error; empty where nothing says so.

    Examples
    --------
    >>> @record
    ... class Tooth:
    ...     height: float = quantity("m", "height", no_error=EXACT)
    ...     deflection: float = quantity("m", "deflection", error="error")
    ...     error: float = quantity("1", "relative error of the deflection")
    >>> [why_no_error(Tooth, name) for name in ("height", "deflection", "error")] == [EXACT, "", ITSELF]
    True
    """
    known = figures(record if isinstance(record, type) else type(record))
    if known[name].no_error:
        return known[name].no_error
    if name == "converged":
        return EXACT
    if name == "error" or any(figure.error == name for figure in known.values()):
        return ITSELF
    said = getattr(record, "no_error", "")
    return said if isinstance(said, str) else BY_RECORD


def headline(result: object) -> str:
    """One line of at most 200 characters: headline figures, error, whether it converged, seconds."""
    known = figures(type(result))
    names = getattr(type(result), "headline", None) or list(known)[:4]
    parts = [
        f"{name} {_text(value)}{_unit(known.get(name))}"
        for name in names
        if np.ndim(value := _shown(result, name)) == 0 and value is not None
    ]
    if isinstance(error := getattr(result, "error", None), float):
        parts.append(f"error {error:.1e}")
    if isinstance(converged := getattr(result, "converged", None), bool):
        parts.append("converged" if converged else "not converged")
    if isinstance(cost := getattr(result, "cost", None), Cost):
        parts.append(f"{cost.seconds:.3g} s")
    line = f"{type(result).__name__}({', '.join(parts)})"
    return line if len(line) <= LONGEST_LINE else f"{line[: LONGEST_LINE - 4]}...)"


def _shown(result: object, name: str) -> Any:
    """Value of a figure; None where its solver, asked for it now, finds none: a line is no place to fail."""
    try:
        return getattr(result, name)
    except SolverError:
        return None


def _text(value: Any) -> str:
    return f"{value:.5g}" if isinstance(value, float | np.floating) else str(value)[:60]


def _unit(figure: Figure | None, form: str = " {}") -> str:
    return form.format(figure.unit) if figure is not None and figure.unit not in ("", "1") else ""


def _documented(cls: type) -> str:
    """Docstring with a section of attributes for what is described where it stands, unless there is one written."""
    text = (cls.__doc__ or "").rstrip()
    about = [(f, meaning) for f in dataclasses.fields(cls) if (meaning := meaning_of(f))]
    if not any({"figure", "meaning"} & set(f.metadata) for f, _ in about) or "Attributes\n" in text:
        return text
    lines = ["", "", "    Attributes", "    ----------"]
    for record_field, meaning in about:
        figure: Figure | None = record_field.metadata.get("figure")
        shape = f", ({', '.join(figure.dims)})" if figure is not None and figure.dims else ""
        lines += [
            f"    {record_field.name} : {record_field.type}{shape}",
            f"        {meaning}{_unit(figure, ' [{}]')}.",
        ]
    return text + "\n".join(lines) + "\n    "


def meaning_of(record_field: dataclasses.Field[Any]) -> str:
    """What a record's field is, in words; of `error`, `cost` and so on that of every `Result`; else empty."""
    if (figure := record_field.metadata.get("figure")) is not None:
        return str(figure.meaning)
    if "meaning" in record_field.metadata:
        return str(record_field.metadata["meaning"])
    common = getattr(Result, record_field.name, None)
    return (common.__doc__ or "").rstrip(".") if isinstance(common, property) else ""
