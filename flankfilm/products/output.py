"""One number of a study's row: its unit, its meaning, and how it is taken from the stages' results."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypedDict

from base import Figure
from base.results import EXACT, ITSELF, figures, why_no_error
from base.units import factor, suffix
from flankfilm.output.tables import spelt
from flankfilm.output.uncertainty import uncertainty
from flankfilm.output.variables import sentence
from flankfilm.stages.engine import Engine, Stage


@dataclass(frozen=True)
class Output:
    """One number of a row.

    Attributes
    ----------
    unit, meaning : str
    wants : tuple of str
        The scene's wants that stand for it: they decide which sections a scene must have.
    value : callable
        Gives the number from a row's engine.
    error : callable, optional
        Gives its estimated relative error likewise; none where that is not known, or is an output by itself.
    error_output, model_output : str
        Outputs that hold its estimated relative error, and what its model leaves open; empty without such ones.
    no_error : str
        Why it has no error, or why where its record has none in a row: exact, an error itself, or the reason.
    """

    unit: str
    meaning: str
    wants: tuple[str, ...]
    value: Callable[[Engine], float]
    error: Callable[[Engine], float] | None = None
    error_output: str = ""
    model_output: str = ""
    no_error: str = ""


class Held(TypedDict, total=False):
    """Outputs that hold what an output leaves open: its numerical error, and that of its model."""

    error_output: str
    model_output: str


Named = tuple[str, Output]
Take = Callable[[Any], Any]
Of = Callable[[Engine], Any]


def output_of(
    name: str,
    figure: Figure,
    want: str,
    value: Of,
    said: str = "{}",
    error: Of | None = None,
    *,
    error_output: str = "",
    model_output: str = "",
) -> Named:
    """An output by its name, from functions that give its value in SI and its relative error; None stands for nan.

    Why it has no error is what its figure says of it.
    """
    meaning = sentence(figure.meaning)
    if said != "{}":
        meaning = said.format(re.split("[:,;]", meaning, maxsplit=1)[0])
    known = None if error is None else _number(error, 1.0)
    return spelt(name, figure.read_in), Output(
        figure.read_in,
        meaning,
        (want,),
        _number(value, factor(figure.read_in)),
        known,
        error_output,
        model_output,
        figure.no_error,
    )


def _number(value: Of, unit: float) -> Callable[[Engine], float]:
    """Value in a unit; nan where there is none."""

    def of(engine: Engine) -> float:
        in_si = value(engine)
        return float("nan") if in_si is None else float(in_si) / unit

    return of


def with_errors(outputs: Mapping[str, Output]) -> dict[str, Output]:
    """Outputs, and after them the errors of those that know theirs and whose error no other output holds.

    What holds the error of another output is an error itself.
    """
    added = {
        error_name(name, output): Output(
            "1", f"estimated relative error: {output.meaning}", output.wants, output.error, no_error=ITSELF
        )
        for name, output in outputs.items()
        if output.error is not None and not output.error_output
    }
    holding = {held for output in outputs.values() for held in (output.error_output, output.model_output)}
    own = {
        name: replace(output, no_error=ITSELF) if name in holding else output
        for name, output in outputs.items()
    }
    return {**own, **added}


def error_name(name: str, output: Output) -> str:
    """Name of the output that holds the error of another one: without the unit, which is another."""
    end = suffix(output.unit)
    return f"{name.removesuffix(f'_{end}') if end else name}_error"


def outputs_from(stage: Callable[[Engine], Any], kind: type, want: str) -> Callable[..., Named]:
    """Maker of outputs from the figures of a stage's result."""

    def make(
        figure: str,
        take: Take = float,
        name: str = "",
        said: str = "{}",
        *,
        error: str = "",
        error_output: str = "",
        model_output: str = "",
    ) -> Named:
        about = figure_of_kind(kind, figure)

        def value(engine: Engine) -> Any:
            quantity = getattr(stage(engine), figure)
            return None if quantity is None else take(quantity)

        # of curves the error of one entry is not that of another: it has a name that the caller gives
        known = take is float and about.no_error != EXACT and holds_error(kind, figure)
        held: Of | None = error_in(stage, figure) if known else None
        if error:
            held = _attribute(stage, error)
        return output_of(
            name or figure,
            about,
            want,
            value,
            said,
            held,
            error_output=error_output,
            model_output=model_output,
        )

    return make


def _attribute(record: Of, name: str) -> Of:
    """An attribute of a record; None without a record."""

    def of(engine: Engine) -> Any:
        there = record(engine)
        return None if there is None else getattr(there, name)

    return of


def figure_of_kind(kind: type, figure: str) -> Figure:
    """Figure of records of a kind, with why it has no error where the record says this of all its figures."""
    return replace(figures(kind)[figure], no_error=why_no_error(kind, figure))


def holds_error(kind: type, figure: str) -> bool:
    """Whether records of a kind hold the numerical error of a figure."""
    about = figures(kind)[figure]
    return bool(about.error) or (figure in getattr(kind, "headline", ()) and not about.no_error)


def error_in(record: Of, figure: str) -> Of:
    """Numerical error of a figure of a record, relative; None where it is not known."""

    def of(engine: Engine) -> float | None:
        there = record(engine)
        return None if there is None else uncertainty(there, figure).numerical

    return of


def model_error_of(name: str, said: str, want: str, record: Callable[[Engine], Any], figure: str) -> Named:
    """Output of what the model leaves open of a figure of a record, relative; nan where it is not estimated."""

    def of(engine: Engine) -> float | None:
        stage_record = record(engine)
        return None if stage_record is None else uncertainty(stage_record, figure).model

    meaning = f"what the model leaves open of {said}, relative; nan where it is not estimated"
    about = Figure("1", meaning, no_error=ITSELF)
    return output_of(name, about, want, of)


def in_result(stage: Stage[Any], value: Take) -> Callable[[Engine], Any]:
    """Value taken from a stage's result."""
    return lambda engine: value(engine[stage])
