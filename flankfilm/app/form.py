"""The form of a scene: sections and keys with units, meanings, bounds and choices, from the sections' fields."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from flankfilm.scene import Scene
from flankfilm.scene.explain import model_in
from flankfilm.scene.sections.key import key_of
from flankfilm.scene.toml import toml

__all__ = ["FormKey", "FormSection", "form", "form_keys"]

DEEPEST = 6
"""Tables inside each other that a form shows."""

CHOICE, WORDS, SWITCH, NUMBER, TEXT = "choice", "words", "switch", "number", "text"
"""Kinds of keys: one word of several, any of several, true or false, a number, anything else as TOML."""


@dataclass(frozen=True)
class FormKey:
    """A key of a scene as a form shows it.

    Attributes
    ----------
    path : str
        With dots: ``pair.pinion.teeth``.
    name : str
        Last part of the path.
    unit : str
        Of the number; empty for pure numbers and words.
    meaning, allowed : str
        In words, and what must hold.
    kind : {"choice", "words", "switch", "number", "text"}
        How it is typed.
    choices : tuple of str
        Words that may be given.
    default : str
        What holds where the key is left out, as TOML; empty where the key is required or has none.
    required : bool
    example : str
        As TOML; empty without one.
    low, high : float or None
        Bounds in the user's unit; None without.
    """

    path: str
    name: str
    unit: str
    meaning: str
    allowed: str
    kind: str
    choices: tuple[str, ...]
    default: str
    required: bool
    example: str
    low: float | None
    high: float | None


@dataclass(frozen=True)
class FormSection:
    """A table of a scene as a form shows it: ``pair.pinion``; the empty path is that of the scene itself."""

    path: str
    meaning: str
    required: bool
    keys: tuple[FormKey, ...]


@cache
def form() -> tuple[FormSection, ...]:
    """Sections of a scene's form, in the order of a scene file; a table inside a section follows it.

    Examples
    --------
    >>> pinion = next(section for section in form() if section.path == "pair.pinion")
    >>> teeth = pinion.keys[0]
    >>> teeth.path, teeth.kind, teeth.required, teeth.meaning
    ('pair.pinion.teeth', 'number', True, 'number of teeth')
    """
    return tuple(_sections("", "The scene", True, Scene, 0))


@cache
def form_keys() -> dict[str, FormKey]:
    """All keys of the form by their paths.

    Examples
    --------
    >>> form_keys()["pair.module_mm"].unit
    'mm'
    """
    return {key.path: key for section in form() for key in section.keys}


def _sections(
    path: str, meaning: str, required: bool, model: type[BaseModel], depth: int
) -> Iterator[FormSection]:
    start = f"{path}." if path else ""
    fields = model.model_fields
    tables = {} if depth == DEEPEST else {n: t for n, f in fields.items() if (t := _table(f.annotation))}
    keys = tuple(_key(start, name, field) for name, field in fields.items() if name not in tables)
    yield FormSection(path, meaning, required, keys)
    for name, inner in tables.items():
        field = fields[name]
        yield from _sections(f"{start}{name}", field.description or "", field.is_required(), inner, depth + 1)


def _members(annotation: Any) -> tuple[Any, ...]:
    """Members of a union without None; the annotation alone where it is none."""
    if get_origin(annotation) is Annotated:
        return _members(get_args(annotation)[0])
    if get_origin(annotation) in (Union, UnionType):
        return tuple(m for one in get_args(annotation) if one is not type(None) for m in _members(one))
    return (annotation,)


def _table(annotation: Any) -> type[BaseModel] | None:
    """Model of a key that is a table and nothing else."""
    (first, *others) = _members(annotation)
    alone = not others and isinstance(first, type) and issubclass(first, BaseModel)
    return model_in(first) if alone else None


def _key(start: str, name: str, field: FieldInfo) -> FormKey:
    about, default = key_of(field), field.default
    kind, choices = _kind(_members(field.annotation))
    bounds = about.bounds
    left_out = default is None or default is PydanticUndefined or isinstance(default, BaseModel)
    return FormKey(
        path=f"{start}{name}",
        name=name,
        unit="" if about.unit == "1" else about.unit,
        meaning=field.description or "",
        allowed=about.allowed,
        kind=kind,
        choices=choices,
        default="" if left_out else toml(default),
        required=field.is_required(),
        example="" if about.example is None else toml(about.example),
        low=_finite(None if bounds is None else bounds.low),
        high=_finite(None if bounds is None else bounds.high),
    )


def _finite(bound: float | None) -> float | None:
    return None if bound is None or abs(bound) == float("inf") else float(bound)


def _kind(members: tuple[Any, ...]) -> tuple[str, tuple[str, ...]]:
    """Kind of a key by the types that it takes, and the words that it may have."""
    words = tuple(str(w) for m in members if get_origin(m) is Literal for w in get_args(m))
    others = [m for m in members if get_origin(m) is not Literal]
    if words and not others:
        return CHOICE, words
    if len(members) == 1 and get_origin(members[0]) is tuple:
        entries = tuple(str(w) for m in get_args(members[0]) if get_origin(m) is Literal for w in get_args(m))
        return (WORDS, entries) if entries else (TEXT, ())
    if others == [bool]:
        return SWITCH, ("true", "false")
    if others and all(m in (int, float) for m in others):
        return NUMBER, words
    return TEXT, words
