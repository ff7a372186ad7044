"""Results as data alone: plain values, arrays, and records of this project, whose reading runs no code of the file.

A content is a JSON head, in which every list, mapping, record and array stands once, and the arrays' bytes behind it.
A record is named by its class, which must be a dataclass of one of our packages; its fields are set without its own
checks, as they were when it was written. Cached properties go along where they hold data.
"""

from __future__ import annotations

import importlib
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

ALIGNED = 64
"""Bytes to a multiple of which an array begins."""

KINDS = "biufcUS"
"""Kinds of numbers and text that an array may hold: no objects."""

TYPES = re.compile(rf"[<>|=][{KINDS}]\d{{1,9}}")
"""Types of arrays as numpy writes them; what else it reads as one is none."""

SEQUENCES: Mapping[str, Callable[[list[Any]], Any]] = {
    "tuple": tuple,
    "list": list,
    "set": set,
    "frozenset": frozenset,
}
MAPPINGS: Mapping[str, Callable[[dict[Any, Any]], Any]] = {"dict": dict, "mappingproxy": MappingProxyType}


class NotPlainDataError(ValueError):
    """A value that cannot be kept as data, or a content that holds none."""


def written(value: object, packages: tuple[str, ...]) -> bytes:
    """Give a value as bytes.

    Parameters
    ----------
    value : object
    packages : tuple of str
        Packages whose records are known.

    Raises
    ------
    NotPlainDataError
        With the type that is no data.

    Examples
    --------
    >>> content = written({"rho": np.linspace(0.0, 1.0, 3)}, ())
    >>> read(content, ())["rho"].tolist()
    [0.0, 0.5, 1.0]
    """
    writer = _Writer(packages)
    root = writer.node(value)
    head = json.dumps({"root": root, "nodes": writer.nodes}, separators=(",", ":")).encode("ascii")
    return b"".join([len(head).to_bytes(8, "little"), head, *writer.arrays])


def read(content: bytes, packages: tuple[str, ...]) -> Any:
    """Give the value back.

    Raises
    ------
    NotPlainDataError
        Where the content is not one that `written` gives.
    """
    try:
        size = int.from_bytes(content[:8], "little")
        head = json.loads(content[8 : 8 + size].decode("ascii"))
        reader = _Reader(memoryview(content)[8 + size :], packages)
        for node in head["nodes"]:
            reader.values.append(reader.made(node))
        return reader.value(head["root"])
    except (
        ValueError,
        TypeError,
        KeyError,
        IndexError,
        AttributeError,
        ImportError,
        OverflowError,
        RecursionError,
    ) as fault:
        raise NotPlainDataError(f"no plain data: {type(fault).__name__}: {fault}") from fault


class _Writer:
    """Nodes in the order in which they can be made again: what a node holds stands before it."""

    def __init__(self, packages: tuple[str, ...]) -> None:
        self.packages = packages
        self.nodes: list[Any] = []
        self.arrays: list[bytes] = []
        self.size = 0
        self._known: dict[int, tuple[int, object]] = {}  # the object too, so that its identity stays taken

    def node(self, value: object) -> Any:
        """Plain value itself, or the place of its node as a list of one number."""
        if value is None or type(value) in (bool, int, float, str):
            return value
        known = self._known.get(id(value))
        if known is None:
            self.nodes.append(self._described(value))
            known = self._known[id(value)] = (len(self.nodes) - 1, value)
        return [known[0]]

    def _described(self, value: object) -> list[Any]:
        name = type(value).__name__
        if isinstance(value, (np.ndarray, np.generic)):
            return self._array(value)
        if name in SEQUENCES and type(value) in (tuple, list, set, frozenset):
            return [name, [self.node(entry) for entry in value]]  # type: ignore[attr-defined]
        if type(value) in (dict, MappingProxyType):
            assert isinstance(value, Mapping)
            return [name, [[self.node(key), self.node(entry)] for key, entry in value.items()]]
        cls = type(value)
        _check_class(cls, self.packages)
        # a record without fields has no state at all
        state = {} if (pickle_state := value.__getstate__()) is None else pickle_state
        if not isinstance(state, dict):
            raise NotPlainDataError(f"{cls.__qualname__} has no fields to keep")
        values: dict[str, Any] = {}
        for key, entry in state.items():
            try:
                values[key] = self.node(entry)
            except NotPlainDataError:
                # a fit of a library, say, found again when it is asked for
                if not isinstance(getattr(cls, key, None), cached_property):
                    raise
        return ["record", cls.__module__, cls.__qualname__, values]

    def _array(self, value: np.ndarray[Any, Any] | np.generic) -> list[Any]:
        if value.dtype.kind not in KINDS:
            raise NotPlainDataError(f"an array of {value.dtype} is no data")
        if isinstance(value, np.generic):
            kind, array, order, writable = "scalar", np.asarray(value), "C", False
        else:
            order = "F" if value.flags.f_contiguous and not value.flags.c_contiguous else "C"
            kind, array, writable = "array", value, bool(value.flags.writeable)
        content = array.tobytes("F" if order == "F" else "C")
        start, gap = self.size, -len(content) % ALIGNED
        self.arrays.append(content + bytes(gap))
        self.size += len(content) + gap
        return [kind, array.dtype.str, list(array.shape), order, writable, start]


class _Reader:
    """Values of the nodes that were read so far."""

    def __init__(self, arrays: memoryview, packages: tuple[str, ...]) -> None:
        self.arrays = arrays
        self.packages = packages
        self.values: list[Any] = []

    def value(self, node: Any) -> Any:
        """Plain value, or that of the node at a place."""
        if not isinstance(node, list):
            return node
        (place,) = node
        return self.values[place]

    def made(self, node: list[Any]) -> Any:
        """Value of a node."""
        kind, *rest = node
        if kind in ("array", "scalar"):
            return self._array(kind, *rest)
        if kind in SEQUENCES:
            return SEQUENCES[kind]([self.value(entry) for entry in rest[0]])
        if kind in MAPPINGS:
            return MAPPINGS[kind]({self.value(key): self.value(entry) for key, entry in rest[0]})
        if kind != "record":
            raise NotPlainDataError(f"a {kind!r} is none of ours")
        module, name, state = rest
        return self._record(module, name, state)

    def _array(
        self, kind: str, dtype: str, shape: list[int], order: Any, writable: bool, start: int
    ) -> np.ndarray[Any, Any] | np.generic:
        if not TYPES.fullmatch(dtype) or order not in ("C", "F") or min([start, *shape], default=0) < 0:
            raise NotPlainDataError(f"an array of {dtype} is none of ours")
        form = np.dtype(dtype)
        count = int(np.prod(shape, dtype=object))
        flat = np.frombuffer(self.arrays[start : start + count * form.itemsize], form, count).copy()
        array: np.ndarray[Any, Any] = flat.reshape(shape, order=order)
        if kind == "scalar":
            scalar: np.generic = form.type(array[()])
            return scalar
        array.flags.writeable = writable
        return array

    def _record(self, module: str, name: str, state: dict[str, Any]) -> object:
        if module.partition(".")[0] not in self.packages or not name.isidentifier():
            raise NotPlainDataError(f"{module}.{name} is none of our records")
        cls = getattr(importlib.import_module(module), name)
        _check_class(cls, self.packages)
        if missing := {field.name for field in fields(cls)} - set(state):
            raise NotPlainDataError(f"{name} lacks {', '.join(sorted(missing))}")
        made = object.__new__(cls)
        for key, entry in state.items():
            if not hasattr(cls, key) and key not in cls.__dataclass_fields__:
                raise NotPlainDataError(f"{name} has no {key}")
            made.__dict__[key] = self.value(entry)
        return made


def _check_class(cls: object, packages: tuple[str, ...]) -> None:
    """Refuse what is no dataclass of one of our packages."""
    known = (
        isinstance(cls, type) and cls.__module__.partition(".")[0] in packages and "." not in cls.__qualname__
    )
    if not (known and is_dataclass(cls)):
        raise NotPlainDataError(f"{cls!r} is no record of ours")
