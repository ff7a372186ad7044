"""How kernels are compiled, and when a compiled kernel on disk is still good.

What leans on the insides of numba, the shorter way of `pipeline` and calls by address, is for the versions of numba
that it was tried with. With any other, helpers and shared pieces are compiled into their callers in numba's own way,
which takes longer and gives the same to rounding.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import cache
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import numpy as np
import numpy.typing as npt
from llvmlite import binding
from numba import njit
from numba.core import cgutils, config, sigutils
from numba.core.caching import CompileResultCacheImpl, FunctionCache
from numba.core.typing import signature as typed
from numba.extending import intrinsic

from base import hide_compilation

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Table = tuple[FloatArray, FloatArray, FloatArray]  # par, coef, edge
Room = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]  # see tables.room_of
Space = tuple[FloatArray, FloatArray, FloatArray, IntArray]  # see flow.space_of
F = TypeVar("F", bound=Callable[..., Any])

TRIED = ("0.68.",)
# places in `par`; FREE is the damping ratio in the dead zone
MEAN, ZETA, FORCE, ERROR, FREQUENCY, PHASE, HALF_BACKLASH, SIDES, ORDER, FREE, SERIES = range(11)
# all well, not finite, too many events in a cell, Newton's method failed
FINE, DIVERGED, CROWDED, LOST = range(4)
# a literal would have numba compile callees twice
ZERO, ONE, TWO = cast(int, np.int64(0)), cast(int, np.int64(1)), cast(int, np.int64(2))
YES, NO = cast(bool, np.bool_(True)), cast(bool, np.bool_(False))
# a product and a sum may be rounded once; nothing else is relaxed
_OPTIONS: dict[str, Any] = {
    "error_model": "numpy",
    "nogil": True,
    "fastmath": {"contract"},
    "no_cfunc_wrapper": True,
}
_INNER: dict[str, Any] = {**_OPTIONS, "no_cpython_wrapper": True}  # not for Python
LINKED: dict[str, Any] = {}
WHOLE: dict[str, Any] = {}
if numba.__version__.startswith(TRIED):
    from dynamics.kernels.pipeline import Inner, Outer, meet_extensions

    LINKED["pipeline_class"], WHOLE["pipeline_class"] = Inner, Outer
MAX_EVENTS = 10_000  # in one cell, which holds a fraction of an oscillation: never met in earnest


hide_compilation("dynamics")


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
    """Code on disk; what it calls where it lies is there before it is loaded."""

    _impl_class = _Store

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        if LINKED:
            meet_extensions(target_context)
        if self._cache_file._load_index():
            for ready in pieces_of(self._py_func):
                ready()
        return super().load_overload(sig, target_context)


def pieces_of(function: Callable[..., Any], seen: set[int] | None = None) -> list[Callable[[], None]]:
    """What makes ready the pieces, see `called`, that a function or its helpers call."""
    seen, pieces = set() if seen is None else seen, []
    for name in cast(Any, function).__code__.co_names:
        there = cast(Any, function).__globals__.get(name)
        if id(there) in seen:
            continue
        seen.add(id(there))
        if hasattr(there, "ready_piece"):
            pieces.append(there.ready_piece)
        elif hasattr(there, "py_func"):
            pieces += pieces_of(there.py_func, seen)
    return pieces


def helper(function: F) -> F:
    """Compile when first called by a kernel; not kept on disk, because its callers hold it.

    A helper allocates nothing: `_nrt=False` leaves out the counting of references to its arrays, whose locked
    instructions would take longer than the arithmetic of an impact.
    """
    return cast(F, njit(_nrt=False, **_INNER, **LINKED)(function))


def shared(types: str) -> Callable[[F], F]:
    """Compile once, for these types alone, for kernels that call it where it lies: see `called`."""
    return lambda function: called(kept(function, _nrt=False, **_INNER), types)


def called(compiled: F, types: Any) -> F:
    """Have kernels call what is compiled once where it lies, kept on disk by itself, for these types alone.

    A helper is compiled again into every caller, and into the callers of these. What is long, and takes much longer to
    run than a call, is better called. It raises nothing.
    """
    if config.DISABLE_JIT or not LINKED:
        return compiled
    function: Callable[..., Any] = cast(Any, compiled).py_func
    arguments, result = sigutils.normalize_signature(types)
    symbol = f"{function.__module__}.{function.__qualname__}"

    @cache
    def ready() -> None:
        built = cast(Any, compiled).get_compile_result(typed(result, *arguments))
        binding.add_symbol(symbol, built.library.get_pointer_to_function(built.fndesc.llvm_func_name))

    def call(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        convention = context.call_conv
        kind = convention.get_function_type(result, arguments)
        place = cgutils.get_or_insert_function(builder.module, kind, symbol)
        return convention.call_function(builder, place, result, arguments, values)[1]

    def definition(_context: Any, *_given: Any) -> Any:
        ready()
        return typed(result, *arguments), call

    names = [Parameter("context", Parameter.POSITIONAL_OR_KEYWORD), *signature(function).parameters.values()]
    definition.__signature__ = Signature(names)  # type: ignore[attr-defined]
    definition.ready_piece = ready  # type: ignore[attr-defined]
    return cast(F, intrinsic(definition))


def maker(function: F) -> F:
    """Compile as a helper that returns a fresh array, or multiplies matrices by the library."""
    return cast(F, njit(**_INNER, **LINKED)(function))


def kept(function: F, **options: Any) -> F:
    """Compile when first called, keep the result on disk until any kernel source changes."""
    compiled = njit(**options, **WHOLE)(function)
    compiled._cache = _Kept(function)
    return cast(F, compiled)


def kernel(function: F) -> F:
    """Compile for callers in Python, kept on disk."""
    return kept(function, **_OPTIONS)


def plain_kernel(function: F) -> F:
    """Compile for callers in Python, kept on disk; like a helper it allocates nothing."""
    return kept(function, _nrt=False, **_OPTIONS)
