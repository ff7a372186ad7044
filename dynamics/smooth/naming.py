"""Parameters by name: paths such as "stiffness.amplitudes[0]" in nested records."""

from __future__ import annotations

import dataclasses
import math
import re
from typing import Any

from base import Faults, InputError
from dynamics.stiffness import FourierStiffness

__all__ = ["changed", "natural_size", "series", "series_names", "unknown"]


def series(stiffness: FourierStiffness) -> tuple[float, ...]:
    """Mean, amplitudes, phases."""
    return (stiffness.mean, *stiffness.amplitudes, *stiffness.phases)


def series_names(stiffness: FourierStiffness) -> tuple[str, ...]:
    """Names of these, as in `GearOscillator.with_parameter`."""
    terms = [f"stiffness.{part}[{j}]" for part in ("amplitudes", "phases") for j in range(stiffness.order)]
    return ("stiffness.mean", *terms)


def changed(record: Any, name: str, value: float) -> Any:
    """Copy of nested frozen records with the number at a path such as "stiffness.amplitudes[0]" changed.

    Raises
    ------
    InputError
        If the record has no such parameter.
    """
    if name not in getattr(record, "names", (name,)):
        raise unknown(name, record.names)
    head, _, rest = name.partition(".")
    if rest:
        return dataclasses.replace(record, **{head: changed(getattr(record, head), rest, value)})
    match = re.fullmatch(r"(\w+)\[(\d+)\]", head)
    if match is None:
        return dataclasses.replace(record, **{head: float(value)})
    items = list(getattr(record, match[1]))
    items[int(match[2])] = float(value)
    return dataclasses.replace(record, **{match[1]: tuple(items)})


def unknown(name: str, names: tuple[str, ...]) -> InputError:
    """Error that names what there is."""
    faults = Faults()
    faults.add("parameter", name, f"must be one of {', '.join(names)}", "name one of these")
    return InputError(tuple(faults.found))


def natural_size(*sizes: float) -> float:
    """Largest of some sizes, never 0."""
    return max([abs(s) for s in sizes if math.isfinite(s)] + [1e-300])
