"""A shorter way through numba for kernels: what they do not need is left out, what is known is not sought again.

Three things take most of the time in which numba compiles a kernel of forty helpers:

- every helper becomes separate machine code, which nobody calls, because its callers link and inline it. Here it is
  handed to them as it is before LLVM works on it, and is worked on there;
- for every ``+``, ``a[i]`` and ``max`` numba tries all that it knows of these, in each round of the inference of types
  and once more for the code, and again for each literal index; of every condition it asks what ``bool`` does. Here the
  answer is remembered by types. Every array that is met has it look for new extensions, which nothing brings here
  but the pieces that a kernel calls where they lie;
- a dozen passes look for what kernels do not have: closures, ``with``, strings, expressions of whole arrays; where
  variables begin and end is found after every second pass, and written into code that counts no references to them.

What a kernel links is its own: elsewhere LLVM's loader takes the first of several functions of one name, so that last
digits would hang on what a process has compiled or loaded before.

All this leans on how numba is built inside, and is for the versions of `compiling.TRIED`.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from functools import cache, partial
from typing import Any

from llvmlite.binding import Linkage
from numba.core import typed_passes, types, untyped_passes
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase
from numba.core.datamodel.models import OpaqueModel
from numba.core.datamodel.registry import register_default
from numba.core.imputils import builtin_registry
from numba.core.ir_utils import build_definitions
from numba.core.rewrites import rewrite_registry
from numba.core.ssa import reconstruct_ssa
from numba.core.transforms import canonicalize_cfg
from numba.core.types.containers import BaseTuple
from numba.core.types.misc import SliceType

_OPERATORS = frozenset(
    {
        operator.getitem, operator.setitem, operator.add, operator.sub, operator.mul, operator.truediv,
        operator.floordiv, operator.mod, operator.iadd, operator.isub, operator.imul, operator.itruediv, operator.neg,
        operator.lt, operator.le, operator.gt, operator.ge, operator.eq, operator.ne,
        abs, bool, float, int, len, max, min, range, math.cos, math.sin, math.sqrt,
    }
)  # fmt: skip


class _Operator(types.Function):
    """An operator, or function, that remembers what it gives for which types of numbers and arrays of them."""

    def __init__(self, function: types.Function) -> None:
        super().__init__(function.templates)
        self._known: dict[Any, Any] = {}

    def get_call_type(self, context: Any, args: Any, kws: Any) -> Any:
        """Signature for these arguments, whether numbers and indices are literal or not."""
        plain = tuple([_unliteral(argument) for argument in args])
        if kws or None in plain:
            return super().get_call_type(context, args, kws)
        if plain not in self._known:
            self._known[plain] = super().get_call_type(context, plain, kws)
        return self._known[plain]


register_default(_Operator)(OpaqueModel)
_KNOWN: dict[types.Function, _Operator] = {}


def _unliteral(argument: Any) -> Any:
    """Type of a number, of an array of numbers or of an index without its value; None of anything else."""
    if isinstance(argument, types.IntegerLiteral):
        return argument.literal_type
    if isinstance(argument, (types.Integer, types.Float, types.Boolean, SliceType)):
        return argument
    if isinstance(argument, types.Array):
        return argument if _numbers(argument) else None
    if isinstance(argument, BaseTuple):
        parts = tuple([_unliteral(part) for part in argument])
        if all(isinstance(part, (types.Integer, SliceType)) for part in parts):
            return BaseTuple.from_types(parts)
    return None


def _numbers(argument: Any) -> bool:
    """Whether this is an array of numbers, whose items are all alike."""
    return isinstance(argument, types.Array) and isinstance(argument.dtype, types.Number)


@cache
def meet_extensions(context: Any) -> None:
    """Have numba meet what extends it, once: each it meets would have it look for all of them again."""
    context.refresh = lambda: None
    try:
        type(context).refresh(context)
    finally:
        del context.refresh


class _Remembering:
    """Numba's context of types, with operators that remember."""

    def __init__(self, context: Any) -> None:
        self._context, self._met = context, dict[Any, Any]()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._context, name)

    def resolve_value_type(self, value: Any) -> Any:
        if not callable(value) or value not in _OPERATORS:
            return self._context.resolve_value_type(value)
        if value not in self._met:
            function = self._context.resolve_value_type(value)
            self._met[value] = _KNOWN.setdefault(function, _Operator(function))
        return self._met[value]

    def resolve_function_type(self, func: Any, args: Any, kws: Any) -> Any:
        if callable(func) and func in _OPERATORS:
            return self.resolve_value_type(func).get_call_type(self, args, kws)
        return self._context.resolve_function_type(func, args, kws)

    def resolve_setitem(self, target: Any, index: Any, value: Any) -> Any:
        return self.resolve_value_type(operator.setitem).get_call_type(self, (target, index, value), {})

    def resolve_static_getitem(self, value: Any, index: Any) -> Any:
        return None if _numbers(value) else self._context.resolve_static_getitem(value, index)

    def resolve_static_setitem(self, target: Any, index: Any, value: Any) -> Any:
        return None if _numbers(target) else self._context.resolve_static_setitem(target, index, value)


class _Optimised(JITCodeLibrary):
    """Machine code of a kernel, worked on by LLVM once, when all that it links is there and its own."""

    def _optimize_functions(self, ll_module: Any) -> None:
        ll_module.data_layout = self._codegen._data_layout

    def _optimize_final_module(self) -> None:
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == Linkage.linkonce_odr:
                function.linkage = Linkage.internal
        passes, builder = self._codegen._module_pass_manager()
        passes.run(self._final_module, builder)


class _Linked(_Optimised):
    """What a helper's callers link: never machine code by itself."""

    def _optimize_final_module(self) -> None:
        pass

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        return 0

    @property
    def codegen(self) -> Any:
        """Of machine code alone: a helper raises nothing, and has no environment to report to."""
        return _Mute(self._codegen)


class _Mute:
    """Numba's code generator for functions that have no machine code."""

    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)

    def set_env(self, name: str, env: Any) -> None:
        """There is nowhere to write it."""


class _Way:
    """What numba calls a pipeline: from a function in Python to machine code, step by step."""

    pipeline_name = "kernel"

    def __init__(self) -> None:
        self.exec_times: dict[str, Any] = {}  # numba keeps it with what was compiled

    def run(self, state: Any) -> None:
        """Compile."""
        for step in _STEPS:
            step(state)


def _rewritten(state: Any) -> None:
    """Loops in numba's own form; constant indices and the like by the functions made for them."""
    blocks = state.func_ir.blocks = canonicalize_cfg(state.func_ir.blocks)
    for kind in rewrite_registry.rewrites["before-inference"]:
        rewrite, waiting = kind(state), list(blocks.items())
        while waiting:
            label, block = waiting.pop()
            if rewrite.match(state.func_ir, block, state.typemap, state.calltypes):
                blocks[label] = rewrite.apply()
                waiting.append((label, blocks[label]))


def _assigned_once(state: Any) -> None:
    """Every variable assigned once."""
    state.func_ir = reconstruct_ssa(state.func_ir)
    state.func_ir._definitions = build_definitions(state.func_ir.blocks)


def _assigned_where_known(state: Any) -> None:
    """Variables that come from several places are assigned in each of these."""
    state.func_ir = typed_passes.PreLowerStripPhis()._strip_phi_nodes(state.func_ir)
    state.func_ir._definitions = build_definitions(state.func_ir.blocks)


def _ended(state: Any) -> None:
    """Where references are counted: where each variable ends."""
    if state.flags.nrt:
        typed_passes.IRLegalization().run_pass(state)


_STEPS: tuple[Callable[[Any], Any], ...] = (
    untyped_passes.TranslateByteCode().run_pass,
    untyped_passes.FixupArgs().run_pass,
    _rewritten,
    _assigned_once,
    typed_passes.NopythonTypeInference().run_pass,
    _assigned_where_known,
    _ended,
    typed_passes.NativeLowering().run_pass,
    typed_passes.NoPythonBackend().run_pass,
)


class Outer(CompilerBase):
    """The way of what is called from Python, or where it lies."""

    library: type[JITCodeLibrary] = _Optimised

    def define_pipelines(self) -> list[Any]:
        """Passes that a kernel needs."""
        state = self.state
        state.typingctx = _Remembering(state.typingctx)
        fresh = partial(state.targetctx.install_registry, builtin_registry)
        state.targetctx = state.targetctx.subtarget(typing_context=state.typingctx, refresh=fresh)
        state.library = self.library(state.targetctx.codegen(), state.func_id.func_qualname)
        state.library.enable_object_caching()
        return [_Way()]


class Inner(Outer):
    """The way of what kernels link."""

    library = _Linked
