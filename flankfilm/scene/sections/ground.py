"""Faults of the ground floors, which speak SI and of attributes, under the scene's keys and in their units."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace

from base import Fault, InputError
from flankfilm.scene.sections.key import Key, key_of
from flankfilm.scene.sections.section import Section

__all__ = ["in_keys", "under_keys"]

_NUMBER = r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
_LENGTH = Key("", unit="mm", scale=1e-3)
"""How lengths are shown that have no key."""


@contextmanager
def under_keys(section: Section | None, path: str) -> Iterator[None]:
    """Give the faults that are raised within the keys of a section; see `in_keys`."""
    try:
        yield
    except InputError as error:
        raise InputError(in_keys(fault, section, path) for fault in error.faults) from error


def in_keys(fault: Fault, section: Section | None, path: str) -> Fault:
    """Bring a fault under the scene's key: its path, the value as the user wrote it, bounds in the key's unit.

    Parameters
    ----------
    fault : Fault
        Of the ground: `where` names an attribute below the section, lengths are written ``0.1017 m``.
    section : Section or None
        Where the attributes come from.
    path : str
        Its path in the scene.
    """
    names, about, user_value = _key_at(fault.where.split("."), section)
    key = ".".join(filter(None, [path, *names]))
    if about is None:
        value, allowed = fault.value, _in_unit(fault.allowed, _LENGTH, "m")
        if allowed != fault.allowed:
            value = _in_unit(f"{value} m", _LENGTH, "m")
        return replace(
            fault, where=key, value=value, allowed=allowed, remedy=_in_unit(fault.remedy, _LENGTH, "m")
        )
    limit = about.limit
    if limit is not None and fault.allowed == str(limit):
        return Fault(key, _shown(user_value, fault.value, about), about.allowed)
    unit = "" if limit is None else limit.unit
    allowed = _in_unit(fault.allowed, about, unit)
    if allowed != fault.allowed:
        allowed += about.remark
    return Fault(key, _shown(user_value, fault.value, about), allowed, _in_unit(fault.remedy, _LENGTH, "m"))


def _key_at(attributes: Sequence[str], section: Section | None) -> tuple[list[str], Key | None, object]:
    """Names of the keys that lead to an attribute, the last one's field and value; attributes without a key stay."""
    if not attributes or section is None:
        return list(attributes), None, None
    whole, _, entry = attributes[0].removesuffix("]").partition("[")
    for name, field in type(section).model_fields.items():
        about, value = key_of(field), getattr(section, name)
        if about.of == ".".join(attributes):  # also of a part without a separate section
            return [name], about, value
        if entry and whole == name and isinstance(value, tuple) and isinstance(value[int(entry)], Section):
            names, about_inner, inner = _key_at(attributes[1:], value[int(entry)])
            return [name, entry, *names], about_inner, inner
        if attributes[0] in (name, about.of):
            if isinstance(value, Section):
                names, about_inner, inner = _key_at(attributes[1:], value)
                return [name, *names], about_inner, inner
            return [name, *attributes[1:]], None if attributes[1:] else about, value
    return list(attributes), None, None


def _shown(user_value: object, text: str, about: Key) -> str:
    """Value as the user wrote it; one that follows from others, in the key's unit."""
    if isinstance(user_value, int | float):
        return f"{user_value:.12g}"
    return f"{about.user(float(text)):.6g}" if user_value is None and re.fullmatch(_NUMBER, text) else text


def _in_unit(text: str, about: Key, unit: str) -> str:
    """Text with its numbers of the ground's `unit` in that of a key."""
    if not unit or unit == about.unit or about.unit == "1":
        return text
    return re.sub(
        rf"({_NUMBER}) {re.escape(unit)}(?![\w/])",
        lambda match: f"{about.user(float(match[1])):.7g} {about.unit}",
        text,
    )
