"""Parameters by name: paths such as "stiffness.amplitudes[0]" in nested records."""

from __future__ import annotations

import dataclasses
import functools
import math
import re
from typing import Any

from base import InputError
from dynamics.model.stiffness import FourierStiffness


def series(stiffness: FourierStiffness) -> tuple[float, ...]:
    """Mean, amplitudes, phases."""
    return (stiffness.mean, *stiffness.amplitudes, *stiffness.phases)


@functools.lru_cache(maxsize=64)
def series_names(order: int) -> tuple[str, ...]:
    """Names of these in a stiffness of so many harmonics."""
    terms = [f"stiffness.{part}[{j}]" for part in ("amplitudes", "phases") for j in range(order)]
    return ("stiffness.mean", *terms)


def value_at(record: Any, path: str) -> float:
    """Number at a path in nested records."""
    for part in path.split("."):
        name, _, index = part.rstrip("]").partition("[")
        record = getattr(record, name)
        record = record[int(index)] if index else record
    return float(record)


def with_value(record: Any, path: str, value: float) -> Any:
    """Copy of nested frozen records with the number at a path changed, all of them checked again."""
    head, _, rest = path.partition(".")
    if rest:
        return dataclasses.replace(record, **{head: with_value(getattr(record, head), rest, value)})
    match = re.fullmatch(r"(\w+)\[(\d+)\]", head)
    if match is None:
        return dataclasses.replace(record, **{head: value})
    items = list(getattr(record, match[1]))
    items[int(match[2])] = value
    return dataclasses.replace(record, **{match[1]: tuple(items)})


def unknown(name: str, names: tuple[str, ...]) -> InputError:
    """Error that names what there is."""
    return InputError.at("parameter", str(name), f"must be one of {', '.join(names)}", "name one of these")


def natural_size(*sizes: float) -> float:
    """Largest of some sizes, never 0."""
    return max([abs(s) for s in sizes if math.isfinite(s)] + [1e-300])
