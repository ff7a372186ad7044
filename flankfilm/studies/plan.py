"""The study file: a scene, the keys that vary, the design of the rows, and the outputs wanted of each."""

from __future__ import annotations

import difflib
import itertools
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

import numpy as np
from pydantic import Field, ValidationError, model_validator

from base import Fault, Faults, InputError
from flankfilm.scene.explain import explain_all
from flankfilm.scene.flank_files import names_a_file, read_flank_files, without_curves
from flankfilm.scene.reader import parse_toml, read_text, refuse_long_lists, validated
from flankfilm.scene.section import Section
from flankfilm.studies.outputs import OUTPUTS

MOST_ROWS = 1_000_000

MOST_CELLS = 5_000_000
"""Rows times keys; some hundred megabytes."""

MOST_KEYS = 100
"""Varied keys; a scene has fewer."""

MOST_CHECKED = 20_000
"""Rows whose scene is checked before anything is computed; of more rows these, spread evenly."""

MOST_FAULTS = 50
"""Faults of rows that are listed."""

LARGEST = 1e15
"""Of a varied number; no key of a scene takes a larger one."""

Bounded = Annotated[float, Field(ge=-LARGEST, le=LARGEST)]

Value = bool | int | float | str


class Range(Section):
    """Values from one end to the other."""

    from_: Bounded = Field(alias="from", description="one end of the range")
    to: Bounded = Field(description="the other end, the larger number")
    steps: int | None = Field(default=None, ge=2, le=MOST_ROWS, description="of a grid or a list")
    log: bool = Field(default=False, description="equal ratios instead of equal steps")
    whole: bool = Field(default=False, description="round to whole numbers, such as teeth")

    @model_validator(mode="after")
    def _a_range(self) -> Range:
        if not self.from_ < self.to:
            raise ValueError(f"from = {self.from_:g} must lie below to = {self.to:g}")
        if self.log and self.from_ <= 0:
            raise ValueError(f"log needs from > 0, not {self.from_:g}")
        return self

    def at(self, unit: float) -> Value:
        """Value at a place between 0 and 1."""
        if self.log:
            low, high = math.log(self.from_), math.log(self.to)
            value = math.exp(low + unit * (high - low))
        else:
            value = self.from_ + unit * (self.to - self.from_)
        # twelve digits: 0.1 is written as 0.1, whatever the way that led there
        value = min(max(float(f"{value:.12g}"), self.from_), self.to) + 0.0
        return round(value) if self.whole else value


class Follow(Section):
    """A key that follows a varied one: times * value + plus."""

    of: str = Field(description="the varied key that is followed")
    times: Bounded = Field(default=1.0, description="factor of its value")
    plus: Bounded = Field(default=0.0, description="added to that")


class RowsFile(Section):
    """What a study and an optimisation have in common: a scene, keys that vary or follow, and keys that are set."""

    title: str = Field(default="", max_length=200, description="title of the study")
    scene: str | dict[str, Any] = Field(description="a scene file beside this one, or the scene itself")
    vary: Any = Field(description="keys of the scene that vary, each with a range or a list of values")
    follow: Annotated[dict[str, Follow], Field(max_length=MOST_KEYS)] = Field(
        default_factory=dict, description="keys of the scene that follow a varied one"
    )
    set: dict[str, Value] = Field(
        default_factory=dict, description="keys of the scene that have another value throughout"
    )

    @model_validator(mode="after")
    def _leaders_and_places(self) -> RowsFile:
        if not self.vary:
            raise ValueError('vary needs a key of the scene, such as "pair.pinion.profile_shift"')
        for key, rule in self.follow.items():
            if rule.of not in self.vary:
                raise ValueError(f'follow "{key}" follows "{rule.of}", which is not varied')
        twice = (self.vary.keys() & self.follow.keys()) | (
            self.set.keys() & (self.vary.keys() | self.follow.keys())
        )
        if twice:
            raise ValueError(f"{', '.join(sorted(twice))} stands in two of vary, follow and set")
        return self


F = TypeVar("F", bound=RowsFile)


class StudyFile(RowsFile):
    """A whole study file."""

    outputs: Annotated[tuple[str, ...], Field(strict=False, min_length=1, max_length=200)] = Field(
        description="computed for every row; the names are listed below"
    )
    design: Literal["grid", "list", "latin-hypercube", "sobol"] = Field(
        default="grid",
        description="all combinations, values side by side, or sampled points of the ranges",
    )
    samples: int | None = Field(
        default=None, ge=1, le=MOST_ROWS, description="number of rows of a sampled design"
    )
    seed: int = Field(default=1, ge=0, description="of a sampled design; the same seed gives the same rows")
    vary: Annotated[
        dict[str, Range | Annotated[tuple[Value, ...], Field(strict=False, min_length=1)]],
        Field(max_length=MOST_KEYS),
    ] = Field(description="keys of the scene that vary, each with a range or a list of values")

    @model_validator(mode="after")
    def _one_design(self) -> StudyFile:
        sampled = self.design in ("latin-hypercube", "sobol")
        if sampled and self.samples is None:
            raise ValueError(f'design = "{self.design}" needs samples')
        if not sampled and self.samples is not None:
            raise ValueError(f'samples belongs to sampled designs, not to "{self.design}"')
        for key, values in self.vary.items():
            if isinstance(values, Range) and not sampled and values.steps is None:
                raise ValueError(f'vary "{key}" needs steps in a {self.design}')
        return self


@dataclass(frozen=True, eq=False)
class Plan:
    """A study, ready to be computed.

    Attributes
    ----------
    title : str
    scene : mapping
        The scene's keys as read, with what the study sets.
    outputs : tuple of str
        Names in `flankfilm.studies.outputs.OUTPUTS`.
    keys : tuple of str
        Varied keys of the scene, dotted; those that follow come last.
    rows : tuple of tuple
        Values of the keys, one tuple a row.
    design : str
    varied : int
        How many of the keys are varied by themselves.
    folder : Path
        From where values that are files are named.
    """

    title: str
    scene: Mapping[str, Any]
    outputs: tuple[str, ...]
    keys: tuple[str, ...]
    rows: tuple[tuple[Value, ...], ...]
    design: str
    varied: int
    folder: Path = Path()

    def raw_scene(self, row: int) -> dict[str, Any]:
        """Keys of a row's scene, with the curves of files that vary."""
        raw = deepcopy(dict(self.scene))
        for key, value in zip(self.keys, self.rows[row], strict=True):
            put(raw, key, value)
            if names_a_file(key):
                without_curves(raw, key)
        if files := list(filter(names_a_file, self.keys)):
            _refuse(read_flank_files(raw, self.folder, files))
        return raw

    def identity(self) -> dict[str, Any]:
        """What makes two plans the same study, as plain values."""
        rows: Sequence[Any] = self.rows
        if any(map(names_a_file, self.keys)):  # a file of the same name may hold something else
            rows = [self.raw_scene(row) for row in range(len(self.rows))]
        held = {"scene": self.scene, "outputs": self.outputs, "keys": self.keys, "rows": rows}
        plain: dict[str, Any] = json.loads(json.dumps(held))
        return plain


def read_plan(path: Path) -> Plan:
    """Read and check a study file, and every row's scene key by key.

    Raises
    ------
    InputError
        With every fault of the file.
    """
    return plan_of(read_rows_file(path, StudyFile), path.parent)


def read_rows_file(path: Path, kind: type[F]) -> F:
    """Read and check a study or an optimisation file, apart from the scene in it."""
    raw = parse_toml(read_text(path), str(path))
    refuse_long_lists({key: value for key, value in raw.items() if key != "vary"})
    try:
        return kind.model_validate(raw)
    except ValidationError as error:
        raise InputError(explain_all(error.errors(), kind)) from error


def refuse_unknown_outputs(names: Iterable[str]) -> None:
    """Refuse outputs that no row has, all at once."""
    with Faults() as found:
        for name in (name for name in names if name not in OUTPUTS):
            near = difflib.get_close_matches(name, OUTPUTS, n=1)
            remedy = f"Did you mean {near[0]}?" if near else f"Allowed: {', '.join(OUTPUTS)}"
            found.add("outputs", repr(name), "is not an output", remedy)


def plan_of(study: StudyFile, folder: Path) -> Plan:
    """Lay out the rows of a study whose scene file is named from `folder`."""
    refuse_unknown_outputs(study.outputs)
    scene = base_scene(study.scene, study.set, study.outputs, folder)
    keys = (*study.vary, *study.follow)
    varied = tuple(study.vary)
    rows = []
    for values in _design(study):
        by_key = dict(zip(varied, values, strict=True))
        rows.append((*values, *(following(by_key, rule) for rule in study.follow.values())))
    plan = Plan(
        study.title,
        scene,
        tuple(dict.fromkeys(study.outputs)),
        keys,
        tuple(rows),
        study.design,
        len(varied),
        folder,
    )
    _check_rows(plan)
    return plan


def base_scene(
    scene: str | dict[str, Any], fixed: Mapping[str, Value], outputs: Iterable[str], folder: Path
) -> dict[str, Any]:
    """Keys of a scene named from `folder`, or given, with what is set and what the outputs want."""
    if isinstance(scene, str):
        path = folder / scene
        raw, beside = parse_toml(read_text(path), str(path)), path.parent
    else:
        raw, beside = deepcopy(scene), folder
    for key, value in fixed.items():
        put(raw, key, value)
    _refuse(read_flank_files(raw, beside))
    # what a row computes follows from the outputs, not from the scene's own wants
    raw["wants"] = sorted({want for name in outputs for want in OUTPUTS[name].wants})
    return raw


def _refuse(faults: Sequence[Fault]) -> None:
    """Refuse files of flanks that have faults."""
    if faults:
        raise InputError(faults)


def put(raw: dict[str, Any], key: str, value: Value) -> None:
    """Set a dotted key of a scene."""
    *sections, last = key.split(".")
    here = raw
    for section in sections:
        inner = here.setdefault(section, {})
        if not isinstance(inner, dict):
            raise InputError.at(key, "", f"{section} is a value, not a section", "Name a key of the scene")
        here = inner
    here[last] = value


def following(values: Mapping[str, Value], rule: Follow) -> Value:
    """Value of a key that follows one of `values`."""
    leader = values[rule.of]
    if isinstance(leader, str | bool):
        raise InputError.at("follow", rule.of, "is text, which nothing can follow", 'Use design = "list"')
    followed = rule.times * leader + rule.plus
    whole = isinstance(leader, int) and rule.times.is_integer() and rule.plus.is_integer()
    return round(followed) if whole else followed


def _design(study: StudyFile) -> Sequence[tuple[Value, ...]]:
    _bounded(study)
    if study.design in ("latin-hypercube", "sobol"):
        return _sampled(study)
    columns = [_listed(values) for values in study.vary.values()]
    if study.design == "grid":
        return list(itertools.product(*columns))
    return list(zip(*columns, strict=True))


def _bounded(study: StudyFile) -> None:
    """Refuse a study of too many rows, or of columns that do not match, before any row is laid out."""
    lengths = [(v.steps or 2) if isinstance(v, Range) else len(v) for v in study.vary.values()]
    rows = study.samples or 1
    for length in lengths if study.samples is None else ():
        rows = rows * length if study.design == "grid" else max(rows, length)
        if rows > MOST_ROWS:
            raise InputError.at("vary", "", f"must give at most {MOST_ROWS:,} rows", "Take fewer steps")
    if study.design == "list" and len(set(lengths)) != 1:
        allowed = 'must have equally many values in a "list"'
        listed = ", ".join(str(length) for length in lengths)
        raise InputError.at("vary", listed, allowed, 'Or design = "grid"')
    if rows * (len(study.vary) + len(study.follow)) > MOST_CELLS:
        allowed = f"must give at most {MOST_CELLS:,} rows times keys"
        raise InputError.at("vary", "", allowed, "Take fewer rows or keys")


def _listed(values: Range | tuple[Value, ...]) -> tuple[Value, ...]:
    if isinstance(values, Range):
        return tuple(values.at(unit) for unit in np.linspace(0.0, 1.0, values.steps or 2).tolist())
    return values


def _sampled(study: StudyFile) -> list[tuple[Value, ...]]:
    from scipy.stats import qmc

    n, d = study.samples or 1, len(study.vary)
    if study.design == "sobol":
        # whole powers of two keep Sobol's balance; the rest of the last one is cut off
        units = qmc.Sobol(d, scramble=True, rng=study.seed).random_base2(max(0, (n - 1).bit_length()))[:n]
    else:
        units = qmc.LatinHypercube(d, rng=study.seed).random(n)
    return [
        tuple(_pick(values, unit) for values, unit in zip(study.vary.values(), row, strict=True))
        for row in units.tolist()
    ]


def _pick(values: Range | tuple[Value, ...], unit: float) -> Value:
    if isinstance(values, Range):
        return values.at(unit)
    return values[min(int(unit * len(values)), len(values) - 1)]


def _check_rows(plan: Plan) -> None:
    """Refuse a study whose keys or values the scene cannot have, each fault once, with its first row.

    Of very many rows some are checked; a row that is not and that is faulty fails by itself.
    """
    faults: dict[tuple[str, str], Fault] = {}
    for row in range(0, len(plan.rows), -(-len(plan.rows) // MOST_CHECKED)):
        try:
            validated(plan.raw_scene(row))
        except InputError as error:
            for fault in error.faults:
                of_row = replace(fault, where=f"row {row}: {fault.where}")
                faults.setdefault((fault.where, fault.allowed), of_row)
            if len(faults) >= MOST_FAULTS:
                break
    if faults:
        raise InputError(list(faults.values())[:MOST_FAULTS])
