"""The rows of a study: all combinations, values side by side, or sampled points of the ranges."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import numpy as np

from base import InputError
from flankfilm.studies.study_file import MOST_ROWS, Follow, Range, StudyFile, Value

MOST_CELLS = 5_000_000
"""Rows times keys; some hundred megabytes."""


def rows_of(study: StudyFile) -> Sequence[tuple[Value, ...]]:
    """Values of the varied keys, one tuple a row."""
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
            raise InputError.at(
                "vary", "", f"must give at most {MOST_ROWS:,} rows", "take fewer steps or values"
            )
    if study.design == "list" and len(set(lengths)) != 1:
        allowed = 'must have equally many values in a "list"'
        listed = ", ".join(str(length) for length in lengths)
        raise InputError.at("vary", listed, allowed, 'give each as many, or take design = "grid"')
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


def following(values: Mapping[str, Value], rule: Follow) -> Value:
    """Value of a key that follows one of `values`."""
    leader = values[rule.of]
    if isinstance(leader, str | bool):
        raise InputError.at(
            "follow", rule.of, "is text, which nothing can follow", 'vary both, with design = "list"'
        )
    followed = rule.times * leader + rule.plus
    whole = isinstance(leader, int) and rule.times.is_integer() and rule.plus.is_integer()
    return round(followed) if whole else followed
