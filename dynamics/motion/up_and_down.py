"""A sweep up and one down, which know nothing of each other, side by side."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from threading import Event, Lock
from typing import Any

import numpy.typing as npt

from base import side_by_side
from dynamics.model.protocol import Oscillator
from dynamics.motion.map_errors import MapErrors
from dynamics.motion.sweeps import SweepResult, visited


def up_and_down(
    oscillator: Oscillator,
    parameter: str,
    values: npt.ArrayLike,
    progress: Callable[[int, int], None] | None = None,
    **options: Any,
) -> dict[str, SweepResult]:
    """Sweep a parameter up and down, each way on a separate core where there are two.

    A sweep carries its state from value to value, so that one alone is a chain that no second core can help with. One
    finer flow of a value is for the errors of both.

    Parameters
    ----------
    oscillator, parameter, values
        As of `sweep`.
    progress : callable, optional
        Called with the number of values done, up and down, and that of all; by one of both at a time.
    options
        What `sweep` takes besides, but direction and progress.

    Returns
    -------
    dict
        Results by "up" and "down": the numbers of one core to the last bit.

    Raises
    ------
    InputError
        If an argument is out of range.
    """
    given_up, one_at_a_time, met = Event(), Lock(), [0, 0]
    errors = MapErrors(2)

    def tell(way: int, done: int, total: int) -> None:
        if progress is not None:
            with one_at_a_time:
                met[way] = done
                progress(sum(met), 2 * total)

    def up() -> SweepResult:
        try:
            return visited(
                oscillator,
                parameter,
                values,
                "up",
                errors,
                progress=lambda done, total: tell(0, done, total),
                **options,
            )
        except BaseException:  # an interrupt comes here: the other way is not waited for to its end
            given_up.set()
            raise

    def down() -> SweepResult:
        return visited(oscillator, parameter, values, "down", errors, progress=heed, **options)

    def heed(done: int, total: int) -> None:
        if given_up.is_set():
            raise InterruptedError("the sweep up has ended early")
        tell(1, done, total)

    return {
        swept.direction: replace(swept, error=errors.largest.get(swept.direction, 0.0))
        for swept in side_by_side([up, down])
    }
