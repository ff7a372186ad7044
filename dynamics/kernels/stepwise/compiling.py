"""How the kernels of the stepwise flow are compiled, and the type of a law."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

from numba import cfunc, njit, types

from dynamics.kernels.compiling import FloatArray, IntArray

F = TypeVar("F", bound=Callable[..., Any])
_OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True}
# own parameters, law, parameters and data of the law, places of the parameters to differentiate by; a tuple that
# began with a function would not be typed as one
Model = tuple[FloatArray, Any, FloatArray, FloatArray, IntArray]

# places in `par`; amplitudes and phases of the error's harmonics from the second on begin at MORE
ZETA, FORCE, ERROR, FREQUENCY, PHASE, MORE = range(6)
FINE, DIVERGED, CROWDED, TINY, STUCK = range(5)
MAX_EVENTS = 100_000  # in one call, which is a period at most
MAX_STEPS = 1_000_000  # likewise: seconds of work
VECTOR = types.Array(types.float64, 1, "C")
LAW = types.void(types.float64, types.float64, types.float64, types.int64, VECTOR, VECTOR, VECTOR)


def helper(function: F) -> F:
    """Compile when first called by a kernel; not kept on disk, because its callers hold it."""
    return cast(F, njit(**_OPTIONS)(function))


def kernel(function: F) -> F:
    """Compile when first called, keep the result on disk."""
    return cast(F, njit(cache=True, **_OPTIONS)(function))


def law_kernel(function: Callable[..., None]) -> Any:
    """Compile a law of this package; kept on disk until its file changes."""
    return cfunc(LAW, cache=True, error_model="numpy")(function)
