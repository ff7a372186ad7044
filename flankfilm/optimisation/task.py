"""The optimisation file: a scene, the keys that may change and their bounds, the outputs to minimise, and limits."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar

from pydantic import Field, model_validator

from base import Fault, InputError
from flankfilm.optimisation.start import Start, start_of
from flankfilm.scene.reader import validated
from flankfilm.scene.schema import Scene, parse_tolerance
from flankfilm.scene.sections.section import Section, refused
from flankfilm.studies.design import following
from flankfilm.studies.outputs import ERROR_OF
from flankfilm.studies.plan import base_scene, put, refuse_unknown_outputs
from flankfilm.studies.study_file import Range, RowsFile, Value, in_file, read_rows_file

COARSENING = 5.0
"""The tolerance of the first phase, in tolerances of the scene."""


COARSEST = 0.05
"""Of the first phase, unless the scene's own tolerance is wider."""


LEAST = 5
"""Scenes of a generation that differential evolution needs."""


class Limit(Section):
    """Bounds of an output."""

    at_least: float | None = Field(default=None, description="lower bound; none if left out")
    at_most: float | None = Field(default=None, description="upper bound; none if left out")

    @model_validator(mode="after")
    def _a_bound(self) -> Limit:
        if self.at_least is None and self.at_most is None:
            raise refused("has no bound", "give at_least or at_most, or both")
        if self.at_least is not None and self.at_most is not None and self.at_least > self.at_most:
            allowed = f"must not lie above at_most = {self.at_most:g}"
            raise refused(allowed, "lower it, or raise at_most", key="at_least", value=f"{self.at_least:g}")
        return self


class OptimisationFile(RowsFile):
    """A whole optimisation file."""

    called: ClassVar[str] = "the optimisation"
    start: ClassVar[str] = "start from the optimisation in docs/howto/optimise.md"

    minimise: Annotated[tuple[str, ...], Field(strict=False, max_length=5)] = Field(
        default=(), description="outputs to minimise; with several in all, their trade-off is sought"
    )
    maximise: Annotated[tuple[str, ...], Field(strict=False, max_length=5)] = Field(
        default=(), description="outputs to maximise"
    )
    evaluations: int = Field(default=300, ge=16, le=1_000_000, description="scenes computed at most")
    population: int = Field(
        default=24,
        ge=8,
        le=1000,
        description="scenes of each generation of the search; a quarter of evaluations where that is less",
    )
    seed: int = Field(default=1, ge=0, description="of the search; the same seed gives the same search")
    vary: dict[str, Range] = Field(description="keys of the scene that may change, with ranges")
    limits: dict[str, Limit] = Field(default_factory=dict, description="bounds of outputs")

    @model_validator(mode="after")
    def _something_to_want(self) -> OptimisationFile:
        if not self.minimise and not self.maximise:
            raise refused("needs an output", 'such as ["transmission_error_um"]', key="minimise")
        if overlap := set(self.minimise) & set(self.maximise):
            allowed = "is to be minimised and maximised at once"
            raise refused(allowed, "take it out of one", key="maximise", value=", ".join(sorted(overlap)))
        return self


@dataclass(frozen=True, eq=False)
class Task:
    """An optimisation, ready to be searched.

    Attributes
    ----------
    asked : OptimisationFile
        What the file asks for.
    scene : mapping
        The scene's keys as read, with what the file sets.
    tolerances : tuple of float
        Of the first phase, far from the optimum, and of the second.
    start : Start
        The scene as it stands.
    """

    asked: OptimisationFile
    scene: Mapping[str, Any]
    tolerances: tuple[float, float]
    start: Start

    @property
    def objectives(self) -> tuple[str, ...]:
        """Outputs that are traded off, those to minimise first."""
        return (*self.asked.minimise, *self.asked.maximise)

    @property
    def signs(self) -> tuple[float, ...]:
        """Of each objective: 1 where it is minimised, -1 where it is maximised."""
        return (1.0,) * len(self.asked.minimise) + (-1.0,) * len(self.asked.maximise)

    @property
    def limits(self) -> tuple[tuple[str, float, float], ...]:
        """Output, sign and bound of each limit: sign (value - bound) <= 0 is allowed."""
        return tuple(
            (name, sign, bound)
            for name, limit in self.asked.limits.items()
            for sign, bound in ((-1.0, limit.at_least), (1.0, limit.at_most))
            if bound is not None
        )

    @property
    def outputs(self) -> tuple[str, ...]:
        """Outputs of each evaluation: objectives, those that are limited alone, errors of the objectives."""
        return _outputs(self.asked)

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the scene that change."""
        return (*self.asked.vary, *self.asked.follow)

    @property
    def whole(self) -> tuple[bool, ...]:
        """Of each varied key: whether its values are whole numbers."""
        return tuple(span.whole for span in self.asked.vary.values())

    @property
    def population(self) -> int:
        """Scenes of each generation."""
        return max(LEAST, min(self.asked.population, self.asked.evaluations // 4))

    def places(self, values: Sequence[Value]) -> tuple[float, ...] | None:
        """Place in the unit cube of values of the keys; None where they lie outside it, or are not known."""
        known = [
            span.place(value) if isinstance(value, int | float) else math.nan
            for span, value in zip(self.asked.vary.values(), values, strict=False)
        ]
        return tuple(known) if all(0.0 <= place <= 1.0 for place in known) else None

    def values(self, unit: Sequence[float]) -> tuple[Value, ...]:
        """Values of the keys at a point of the unit cube."""
        own = {key: span.at(u) for (key, span), u in zip(self.asked.vary.items(), unit, strict=True)}
        return (*own.values(), *(following(own, rule) for rule in self.asked.follow.values()))

    def raw_scene(self, values: Sequence[Value], tolerance: float) -> dict[str, Any]:
        """Keys of the scene with these values."""
        at_start = self.start.scene is not None and tuple(values) == self.start.values
        raw = deepcopy(dict(self.start.scene if self.start.scene is not None and at_start else self.scene))
        for key, value in zip(self.keys, values, strict=True) if not at_start else ():
            put(raw, key, value)
        raw["tolerance"] = tolerance
        return raw


def _outputs(asked: OptimisationFile) -> tuple[str, ...]:
    objectives = (*asked.minimise, *asked.maximise)
    errors = (ERROR_OF[name] for name in objectives if name in ERROR_OF)
    return tuple(dict.fromkeys((*objectives, *asked.limits, *errors)))


def read_task(path: Path) -> Task:
    """Read and check an optimisation file, and the scene at both ends of every range.

    Raises
    ------
    InputError
        With every fault of the file.
    """
    asked = read_rows_file(path, OptimisationFile)
    refuse_unknown_outputs({name: getattr(asked, name) for name in ("minimise", "maximise", "limits")})
    scene = base_scene(asked.scene, asked.set, _outputs(asked), path.parent)
    fine = parse_tolerance(scene.get("tolerance", Scene.model_fields["tolerance"].default), "tolerance")
    # a tolerance that is no number is left for the scene's own check to refuse
    first = max(fine, min(COARSENING * fine, COARSEST)) if isinstance(fine, float) else COARSEST
    task = Task(asked, scene, (first, fine), start_of(scene, asked))
    faults: dict[Fault, None] = {}
    for end in (0.0, 1.0):
        try:
            validated(task.raw_scene(task.values([end] * len(asked.vary)), fine))
        except InputError as error:
            faults |= dict.fromkeys(in_file(fault, asked.vary) for fault in error.faults)
    if faults:
        raise InputError(faults)
    return task
