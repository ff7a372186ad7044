"""A sweep up and one down, which know nothing of each other, side by side."""

from __future__ import annotations

from threading import Event
from typing import Any

import numpy.typing as npt

from base import side_by_side
from dynamics.protocol import Oscillator
from dynamics.sweeps import SweepResult, sweep


def up_and_down(
    oscillator: Oscillator, parameter: str, values: npt.ArrayLike, **options: Any
) -> dict[str, SweepResult]:
    """Sweep a parameter up and down, each way on a separate core where there are two.

    A sweep carries its state from value to value, so that one alone is a chain that no second core can help with.

    Parameters
    ----------
    oscillator, parameter, values
        As of `sweep`.
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
    given_up = Event()

    def up() -> SweepResult:
        try:
            return sweep(oscillator, parameter, values, "up", **options)
        except BaseException:  # an interrupt comes here: the other way is not waited for to its end
            given_up.set()
            raise

    def down() -> SweepResult:
        return sweep(oscillator, parameter, values, "down", progress=heed, **options)

    def heed(_done: int, _all: int) -> None:
        if given_up.is_set():
            raise InterruptedError("the sweep up has ended early")

    found = side_by_side([up, down])
    return {"up": found[0], "down": found[1]}
