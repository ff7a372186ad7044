"""Computes one row of a study; runs in any process of any machine."""

from __future__ import annotations

import math
import threading
import time
import traceback
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Row:
    """What a row needs to be computed.

    Attributes
    ----------
    index : int
    scene : mapping
        Keys of its scene.
    outputs : tuple of str
    use_cache : bool
        Whether results of earlier runs with the same inputs and code may serve.
    """

    index: int
    scene: Mapping[str, Any]
    outputs: tuple[str, ...]
    use_cache: bool = True


@dataclass(frozen=True)
class RowResult:
    """What came of a row.

    Attributes
    ----------
    index : int
    values : tuple of float
        Outputs in the order asked for; NaN where they failed, throughout where the row did.
    seconds : float
        Cost [s].
    fault : str
        Why it failed, or the outputs that did, each named where others are there; empty where none did.
    """

    index: int
    values: tuple[float, ...]
    seconds: float
    fault: str = ""

    @property
    def lost(self) -> bool:
        """Whether it failed with all its outputs."""
        return bool(self.fault) and all(map(math.isnan, self.values))

    @property
    def worth_another_try(self) -> bool:
        """Whether it failed for want of what another time, or another machine, may have."""
        return self.fault.startswith(NOT_COMPUTED)


_one_at_a_time = threading.Lock()  # the filters of warnings are those of the whole process

NOT_COMPUTED = "not computed: "
"""Begins the fault of a row that failed for want of memory, disk or its process, not of a result."""


def failed(row: Row, fault: str, seconds: float = 0.0) -> RowResult:
    """Give the result of a row that failed."""
    return RowResult(row.index, (float("nan"),) * len(row.outputs), seconds, " ".join(fault.split()))


def compute_row(row: Row) -> RowResult:
    """Compute the outputs of a row; whatever goes wrong becomes its fault, and leaves the other outputs.

    Threads of one process compute one row after the other.
    """
    with _one_at_a_time:
        return _computed(row)


def _computed(row: Row) -> RowResult:
    from base import InputError, SolverError
    from flankfilm.files.cache import keep_compiled_code, results_cache

    keep_compiled_code()
    from flankfilm.scene.reader import validated
    from flankfilm.stages.engine import Engine
    from flankfilm.studies.outputs import OUTPUTS

    start = time.perf_counter()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a scene's own run shows them
            engine = Engine(validated(dict(row.scene)), results_cache(row.use_cache))
            values, faults = [], {}
            for name in row.outputs:
                try:
                    values.append(OUTPUTS[name].value(engine))
                except (InputError, SolverError) as fault:
                    values.append(math.nan)
                    faults[name] = str(fault)
    except (InputError, SolverError) as fault:
        return failed(row, str(fault), time.perf_counter() - start)
    except (MemoryError, OSError) as fault:
        what = f"{NOT_COMPUTED}{type(fault).__name__}: {fault}"
        return failed(row, what, time.perf_counter() - start)
    except Exception as fault:  # noqa: BLE001 - one row must not end a study of thousands; its fault is kept
        place = traceback.extract_tb(fault.__traceback__)[-1]
        cause = f"{type(fault).__name__}: {fault} ({place.name}, line {place.lineno})"
        return failed(row, cause, time.perf_counter() - start)
    return RowResult(row.index, tuple(values), time.perf_counter() - start, _joined(faults, len(values)))


def _joined(faults: Mapping[str, str], outputs: int) -> str:
    """Why outputs failed, each reason once, with their names where others did not."""
    names: dict[str, list[str]] = {}
    for name, fault in faults.items():
        names.setdefault(" ".join(fault.split()), []).append(name)
    if len(faults) == outputs and len(names) == 1:
        return next(iter(names))
    return "; ".join(f"{', '.join(failed)}: {fault}" for fault, failed in names.items())
