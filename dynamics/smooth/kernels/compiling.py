"""How the kernels of the stepwise flow are compiled, and the type of a law."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

from numba import cfunc, njit, types
from numba.core.caching import CompileResultCacheImpl, FunctionCache

from dynamics.kernels.compiling import FloatArray, IntArray
from dynamics.kernels.compiling import sources_digest as exact_digest

F = TypeVar("F", bound=Callable[..., Any])
# own parameters, law, parameters and data of the law, places of the parameters to differentiate by; a tuple that
# began with a function would not be typed as one
Model = tuple[FloatArray, Any, FloatArray, FloatArray, IntArray]

ZETA, FORCE, ERROR, FREQUENCY, PHASE, OWN = range(6)  # places in `par`; from OWN on a parameter of the law
FINE, DIVERGED, CROWDED, TINY, STUCK = range(5)
MAX_EVENTS = 100_000  # in one call, which is a period at most
MAX_STEPS = 1_000_000  # likewise: seconds of work
VECTOR = types.Array(types.float64, 1, "C")
LAW = types.void(types.float64, types.float64, types.float64, types.int64, VECTOR, VECTOR, VECTOR)


@cache
def sources_digest() -> str:
    """Digest of these kernels and of those of the exact flow, whose root finder they call."""
    digest = hashlib.sha256(exact_digest().encode())
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.name.encode())
        digest.update(source.read_bytes())
    return digest.hexdigest()


class _Store(CompileResultCacheImpl):
    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        self._locator.get_source_stamp = sources_digest


class _Kept(FunctionCache):
    _impl_class = _Store


def helper(function: F) -> F:
    """Compile when first called by a kernel; not kept on disk, because its callers hold it."""
    return cast(F, njit(error_model="numpy", nogil=True)(function))


def kernel(function: F) -> F:
    """Compile when first called, keep the result on disk until any kernel source changes."""
    compiled = njit(error_model="numpy", nogil=True)(function)
    compiled._cache = _Kept(function)
    return cast(F, compiled)


def law_kernel(function: Callable[..., None]) -> Any:
    """Compile a law of this package; kept on disk until its file changes."""
    return cfunc(LAW, cache=True, error_model="numpy")(function)
