"""One number of a study's row: its unit, its meaning, and how it is taken from the stages' results."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from base import Figure
from base.results import figures
from base.units import factor
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
    """

    unit: str
    meaning: str
    wants: tuple[str, ...]
    value: Callable[[Engine], float]


Named = tuple[str, Output]
Take = Callable[[Any], Any]


def output_of(
    name: str, figure: Figure, want: str, value: Callable[[Engine], Any], said: str = "{}"
) -> Named:
    """An output by its name, from a function that gives its value in SI; None stands for nan."""

    def of(engine: Engine) -> float:
        in_si = value(engine)
        return float("nan") if in_si is None else float(in_si) / factor(figure.read_in)

    meaning = sentence(figure.meaning)
    if said != "{}":
        meaning = said.format(re.split("[:,;]", meaning, maxsplit=1)[0])
    return spelt(name, figure.read_in), Output(figure.read_in, meaning, (want,), of)


def outputs_from(stage: Callable[[Engine], Any], kind: type, want: str) -> Callable[..., Named]:
    """Maker of outputs from the figures of a stage's result."""

    def make(figure: str, take: Take = float, name: str = "", said: str = "{}") -> Named:
        about = figures(kind)[figure]

        def value(engine: Engine) -> Any:
            quantity = getattr(stage(engine), figure)
            return None if quantity is None else take(quantity)

        return output_of(name or figure, about, want, value, said)

    return make


def model_error_of(name: str, said: str, want: str, record: Callable[[Engine], Any], figure: str) -> Named:
    """Output of what the model leaves open of a figure of a record, relative; nan where it is not estimated."""

    def of(engine: Engine) -> float | None:
        stage_record = record(engine)
        return None if stage_record is None else uncertainty(stage_record, figure).model

    about = Figure("1", f"what the model leaves open of {said}, relative; nan where it is not estimated")
    return output_of(name, about, want, of)


def in_result(stage: Stage[Any], value: Take) -> Callable[[Engine], Any]:
    """Value taken from a stage's result."""
    return lambda engine: value(engine[stage])
