"""How kernels are compiled, and when a compiled kernel on disk is still good."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt
from numba import njit
from numba.core.caching import CompileResultCacheImpl, FunctionCache

from base import hide_compilation

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Table = tuple[FloatArray, FloatArray, FloatArray]  # par, coef, edge
Room = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]  # see tables.room_of
F = TypeVar("F", bound=Callable[..., Any])

MEAN, ZETA, FORCE, ERROR, FREQUENCY, PHASE, HALF_BACKLASH, SIDES, ORDER, SERIES = range(10)  # places in `par`
# all well, not finite, too many events in a cell, Newton's method failed
FINE, DIVERGED, CROWDED, LOST = range(4)
# a literal would have numba compile callees twice
ZERO, ONE, TWO = cast(int, np.int64(0)), cast(int, np.int64(1)), cast(int, np.int64(2))
YES, NO = cast(bool, np.bool_(True)), cast(bool, np.bool_(False))
# a product and a sum may be rounded once; nothing else is relaxed
_OPTIONS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "fastmath": {"contract"}}
_INNER: dict[str, Any] = {**_OPTIONS, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}  # not for Python
MAX_EVENTS = 10_000  # in one cell, which holds a fraction of an oscillation: never met in earnest


hide_compilation()


@cache
def sources_digest() -> str:
    """Digest of all kernel sources."""
    digest = hashlib.sha256()
    folder = Path(__file__).parent
    for source in sorted(folder.rglob("*.py")):
        digest.update(str(source.relative_to(folder)).encode())
        digest.update(source.read_bytes())
    return digest.hexdigest()


class _Store(CompileResultCacheImpl):
    """Kept code is stamped with all kernel sources: numba itself looks at the caller's file alone."""

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        self._locator.get_source_stamp = sources_digest


class _Kept(FunctionCache):
    _impl_class = _Store


def helper(function: F) -> F:
    """Compile when first called by a kernel; not kept on disk, because its callers hold it.

    A helper allocates nothing: `_nrt=False` leaves out the counting of references to its arrays, whose locked
    instructions would take longer than the arithmetic of an impact.
    """
    return cast(F, njit(_nrt=False, **_INNER)(function))


def maker(function: F) -> F:
    """Compile as a helper that returns a fresh array."""
    return cast(F, njit(**_INNER)(function))


def kept(function: F, **options: Any) -> F:
    """Compile when first called, keep the result on disk until any kernel source changes."""
    compiled = njit(**options)(function)
    compiled._cache = _Kept(function)
    return cast(F, compiled)


def kernel(function: F) -> F:
    """Compile for callers in Python, kept on disk."""
    return kept(function, **_OPTIONS)
