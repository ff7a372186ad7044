"""How kernels are compiled and kept, with documented options of numba."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt
from numba import njit

from base import hide_compilation

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Table = tuple[FloatArray, FloatArray, FloatArray]  # par, coef, edge
Room = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]  # see tables.room_of
Space = tuple[FloatArray, FloatArray, FloatArray, IntArray]  # see flow.space_of
F = TypeVar("F", bound=Callable[..., Any])

# places in `par`; FREE is the damping ratio in the dead zone
MEAN, ZETA, FORCE, ERROR, FREQUENCY, PHASE, HALF_BACKLASH, SIDES, ORDER, FREE, SERIES = range(11)
# all well, not finite, too many events in a cell, Newton's method failed
FINE, DIVERGED, CROWDED, LOST = range(4)
# a literal would have numba compile callees twice
ZERO, ONE, TWO = cast(int, np.int64(0)), cast(int, np.int64(1)), cast(int, np.int64(2))
YES, NO = cast(bool, np.bool_(True)), cast(bool, np.bool_(False))
# a product and a sum may be rounded once, nothing else is relaxed; which of them are depends on what surrounds them, so
# that each kernel has its helpers as parts of itself: a call would run whatever copy the process has compiled or loaded
# first, and last digits would depend on it
_OPTIONS: dict[str, Any] = {
    "error_model": "numpy",
    "nogil": True,
    "fastmath": {"contract"},
    "forceinline": True,
}
MAX_EVENTS = 10_000  # in one cell, which holds a fraction of an oscillation: never met in earnest


hide_compilation("dynamics")


def helper(function: F) -> F:
    """Compile when first called by a kernel; not kept on disk, because its callers hold it.

    A helper allocates nothing: `_nrt=False`, which numba does not document, leaves out the counting of references to
    its arrays, whose locked instructions would take longer than the arithmetic of an impact.
    """
    return cast(F, njit(_nrt=False, **_OPTIONS)(function))


def maker(function: F) -> F:
    """Compile as a helper that returns a fresh array, or multiplies matrices by the library."""
    return cast(F, njit(**_OPTIONS)(function))


def kernel(function: F) -> F:
    """Compile for callers in Python, kept on disk."""
    return cast(F, njit(cache=True, **_OPTIONS)(function))


def plain_kernel(function: F) -> F:
    """Compile for callers in Python, kept on disk; like a helper it allocates nothing."""
    return cast(F, njit(cache=True, _nrt=False, **_OPTIONS)(function))
