"""The commented scene of `flankfilm new`: every key with its example and meaning, from the sections' fields."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from flankfilm.scene.explain import model_in
from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.key import key_of
from flankfilm.scene.toml import remarked, toml

__all__ = ["template"]

HEAD = """\
# A flankfilm scene. Run it with:   flankfilm run SCENE.toml
# Every key carries its unit. Sections that no wanted output needs may be left out, as may keys behind a comment sign.
"""


def template() -> str:
    """Text of a commented scene that runs as it is."""
    return _text()


@cache
def _text() -> str:
    """Text from the schema, which stays."""
    own = {name: field for name, field in Scene.model_fields.items() if model_in(field.annotation) is None}
    lines = [HEAD, *(line for name, field in own.items() for line in _key(name, field))]
    for name, field in Scene.model_fields.items():
        model = model_in(field.annotation)
        if model is not None:
            lines += ["", *_section(name, field, model)]
    return "\n".join(lines) + "\n"


def _section(name: str, field: FieldInfo, model: type[BaseModel]) -> Iterator[str]:
    """Head and keys of a section."""
    sign = "# " if key_of(field).commented else ""
    yield f"# {field.description}"
    yield f"{sign}[{name}]"
    opened: dict[type[BaseModel], str] = {}
    for key, inner in model.model_fields.items():
        yield from _key(key, inner, sign)
        yield from _inner_keys(key, inner, opened, "#   ")


def _inner_keys(name: str, field: FieldInfo, opened: dict[type[BaseModel], str], sign: str) -> Iterator[str]:
    """Keys of a table within a section, once for all tables of their kind."""
    model = model_in(field.annotation)
    if model is None or model in opened:
        return
    opened[model] = name
    for key, inner in model.model_fields.items():
        yield from _key(key, inner, sign)
        yield from _inner_keys(key, inner, opened, f"{sign}  ")


def _key(name: str, field: FieldInfo, sign: str = "") -> Iterator[str]:
    """One key; its meaning stands above it where the line would be too long."""
    if not sign and key_of(field).commented:
        sign = "# "
    example = _example(field)
    start = f"{sign}{name} = {toml(example)}"
    words = _choices(field.annotation) if isinstance(example, str | tuple) else []
    meaning = ": ".join(filter(None, [" | ".join(words), field.description]))
    yield from remarked(start, meaning, sign.removeprefix("#").removeprefix(" "))


def _example(field: FieldInfo) -> Any:
    """Value that the template shows: the example, the default, or a table of the required keys."""
    about, model = key_of(field), model_in(field.annotation)
    if about.example is None and model is not None and field.default is None:
        return {name: _example(inner) for name, inner in model.model_fields.items() if inner.is_required()}
    return field.default if about.example is None else about.example


def _choices(annotation: Any) -> list[str]:
    """Words that may stand at a key."""
    if get_origin(annotation) is Literal:
        return [str(word) for word in get_args(annotation)]
    return [word for part in get_args(annotation) for word in _choices(part)]
