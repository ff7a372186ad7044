"""Keys of a scene that are given, each with what is declared of it: rules ask for a trait, and name no keys."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import BaseModel

from flankfilm.scene.explain import model_in
from flankfilm.scene.sections.key import Key, key_of
from flankfilm.scene.sections.section import Section

__all__ = ["given_keys", "named"]


def given_keys(
    table: Mapping[str, Any] | Section, model: type[BaseModel], path: str = ""
) -> Iterator[tuple[str, Key, Any]]:
    """Path, declaration and value of every key that is given: those of a table, then those of tables inside it.

    Parameters
    ----------
    table : Mapping or Section
        Of the unchecked file, in which anything may stand, or a section with its defaults.
    model : type of BaseModel
        Of the table.
    path : str
        Where the table stands, with a dot behind; keys of lists of tables are left out.

    Examples
    --------
    >>> from flankfilm.scene.sections.gears import GearSection
    >>> [(path, value) for path, _, value in given_keys({"teeth": 36, "hub": {"hub_mm": 40.0}}, GearSection)]
    [('teeth', 36), ('hub', {'hub_mm': 40.0}), ('hub.hub_mm', 40.0)]
    """
    tables: list[tuple[Mapping[str, Any] | Section, type[BaseModel], str]] = []
    for name, field in model.model_fields.items():
        value = table.get(name) if isinstance(table, Mapping) else getattr(table, name)
        if value is None:
            continue
        yield f"{path}{name}", key_of(field), value
        if isinstance(value, Section):
            tables.append((value, type(value), f"{path}{name}."))
        elif isinstance(value, Mapping) and (inner := model_in(field.annotation)) is not None:
            tables.append((value, inner, f"{path}{name}."))
    for inside, of, start in tables:
        yield from given_keys(inside, of, start)


def named(path: str) -> str:
    """How a fault calls a key or a section.

    Examples
    --------
    >>> named("alignment"), named("pair.tight")
    ('[alignment]', 'pair.tight')
    """
    return path if "." in path else f"[{path}]"
