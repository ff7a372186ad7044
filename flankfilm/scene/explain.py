"""Turns the validator's findings into faults that name the key, what is allowed and the remedy."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from base import Fault, InputError, shorten
from base.units import factor, unit_of
from flankfilm.scene.sections.key import Key, key_of
from flankfilm.scene.sections.section import Section
from flankfilm.scene.toml import toml

_ALLOWED = {
    "greater_than": "must be greater than {gt:g}",
    "greater_than_equal": "must be at least {ge:g}",
    "less_than": "must be less than {lt:g}",
    "less_than_equal": "must be at most {le:g}",
    "finite_number": "must be a finite number",
    "float_type": "must be a number",
    "int_type": "must be a whole number",
    "bool_type": "must be true or false",
    "string_type": "must be text in quotes",
    "string_too_long": "must have at most {max_length} characters",
    "literal_error": "must be {expected}",
    "missing": "is required",
    "model_type": "must be a table, such as {{ key = value }}",
    "tuple_type": "must be a list, such as [1, 2]",
    "too_short": "must have at least {min_length} entries",
    "too_long": "must have at most {max_length} entries",
    "value_error": "{error}",
}
_OF_NUMBERS = tuple(_ALLOWED)[:7]
_RANGES = tuple(_ALLOWED)[:4]


MOST_FAULTS = 90
"""Faults of one file that are explained; a list of thousands helps nobody."""

HELICAL = ("helix", "beta")
"""How keys of helical gears begin."""

HELIX = "pair.helix_angle_deg"
"""The key that a scene has for it."""

PLAIN = ("bool", "int", "float", "str")
"""What a union of plain values adds to the path of a finding."""

SHAPES = {"tuple_type": tuple, "model_type": dict}
"""Findings about lists and tables, of which a key's example shows the form."""

INCHES = ("_in", "_inch", "_inches")
"""Ends of keys in inches."""

INCH = 0.0254
"""[m]"""

LONGEST_PATH = 200
"""Characters of a key's path in a fault."""


def explain_all(items: Iterable[Mapping[str, Any]], model: type[Section]) -> list[Fault]:
    """Faults for all findings, those of one key (a union's members) joined by "or"."""
    joined: dict[str, Fault] = {}
    findings = _once(list(items))
    inches = {
        (*item["loc"][:-1], name)
        for item in findings
        if item["type"] == "extra_forbidden" and str(item["loc"][-1]).endswith(INCHES)
        for name in _in_metric(str(item["loc"][-1]))
    }
    shown = (item for item in findings if item["type"] != "missing" or tuple(item["loc"]) not in inches)
    for fault in (fault for item in shown for fault in explain(item, model)):
        if len(joined) >= MOST_FAULTS:
            joined["more"] = Fault("the rest", "", "has more faults", "Fix these first")
            break
        same = joined.get(fault.where)
        if same is None:
            joined[fault.where] = fault
        else:
            also = fault.allowed.removeprefix("must be ")
            joined[fault.where] = replace(same, allowed=f"{same.allowed}, or {also}")
    return list(joined.values())


def _once(items: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Findings without those of other forms that a number which is not finite could have had."""
    endless = {_path(item) for item in items if item["type"] == "finite_number"}
    return [item for item in items if item["type"] == "finite_number" or _path(item) not in endless]


def explain(item: Mapping[str, Any], model: type[Section]) -> Iterator[Fault]:
    """Faults for one finding of the validator; more than one where the rule of a section found more.

    Parameters
    ----------
    item : Mapping
        An entry of ``ValidationError.errors()``.
    model : type of Section
        The model of the whole file, to suggest keys from.
    """
    location = tuple(item["loc"])
    path = _path(item)
    dotted_key = ".".join(path)[:LONGEST_PATH] or model.called
    refused = item.get("ctx", {}).get("error")
    if isinstance(refused, InputError):
        for fault in refused.faults:
            yield replace(
                fault, where=".".join([*path, *filter(None, [fault.where])])[:LONGEST_PATH] or dotted_key
            )
    elif item["type"] == "extra_forbidden":
        yield _unknown_key(dotted_key, location, model, item.get("input"))
    else:
        field = _field_at(location, model)
        about = Key("") if field is None else key_of(field)
        allowed = about.allowed if item["type"] in _OF_NUMBERS else ""
        allowed = allowed or _ALLOWED.get(item["type"], item["msg"]).format(**item.get("ctx", {}))
        if item["type"] in SHAPES and isinstance(about.example, SHAPES[item["type"]]):
            allowed = f"{allowed.partition(', such as ')[0]}, such as {toml(about.example)}"
        value = "" if item["type"] in ("missing", "value_error") else shorten(item["input"])
        yield Fault(dotted_key, value, allowed, _remedy(item, about))


def _path(item: Mapping[str, Any]) -> tuple[str, ...]:
    """Keys that lead to a finding, as the user wrote them."""
    location = tuple(item["loc"])
    if location and location[-1] in PLAIN and item["type"] != "extra_forbidden":
        location = location[:-1]
    return tuple(str(part) for part in location if not _names_a_type(part))


def _names_a_type(part: object) -> bool:
    # A union adds the name of the tried member to the path; the user never wrote it.
    return isinstance(part, str) and (part.endswith("Section") or part.startswith("literal["))


def _unknown_key(dotted_key: str, location: tuple[Any, ...], model: type[Section], value: object) -> Fault:
    key = str(location[-1])
    fields = _model_at(location[:-1], model).model_fields
    keys = [field.alias or name for name, field in fields.items()]
    if key.startswith(HELICAL):
        remedy = f"Give {HELIX}, of both gears: above 0 the pinion is right-handed"
        return Fault(dotted_key, shorten(value), f"is not a key of {model.called}", remedy)
    if key.endswith(INCHES) and (lengths := [k for k in keys if k in _in_metric(key)]):
        return Fault(
            dotted_key, shorten(value), "is in inches, which are not read", _converted(value, lengths[0])
        )
    near = difflib.get_close_matches(key, keys, n=1, cutoff=0.75) or [
        k for k in keys if k.split("_")[0] == key.split("_")[0] and len(key) > 2
    ]
    remedy = f"Did you mean {near[0]}?" if near else f"Allowed: {', '.join(keys)}"
    if near and unit_of(near[0]) != unit_of(key):
        remedy += " The unit is part of the key"
    return Fault(dotted_key, "", f"is not a key of {model.called}", remedy)


def _in_metric(key: str) -> list[str]:
    """Names that a key in inches would have in units of the metre."""
    stem = key.removesuffix(next(end for end in INCHES if key.endswith(end)))
    return [f"{stem}_{unit}" for unit in ("mm", "um")]


def _converted(value: object, key: str) -> str:
    """Remedy for a length in inches: the key with its value in its own unit."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return f"Write {key}; 1 inch is 25.4 mm"
    return f"Write {key} = {value * INCH / factor(unit_of(key)):.10g}"


def _model_at(location: Sequence[Any], model: type[BaseModel]) -> type[BaseModel]:
    """Model of the table at a place in the file."""
    here = model
    for part in location:
        field = here.model_fields.get(str(part))
        here = here if field is None else model_in(field.annotation) or here
    return here


def _field_at(location: Sequence[Any], model: type[BaseModel]) -> FieldInfo | None:
    """Field of the key at a place in the file; None for an entry of a list."""
    names = [part for part in location if not _names_a_type(part)]
    return _model_at(names[:-1], model).model_fields.get(str(names[-1])) if names else None


def model_in(annotation: Any) -> type[BaseModel] | None:
    """Model of a table, or of tables in a list or by names, that may stand at a key."""
    if get_origin(annotation) in (Union, UnionType, Annotated, tuple, dict):
        return next((m for m in map(model_in, get_args(annotation)) if m is not None), None)
    return annotation if isinstance(annotation, type) and issubclass(annotation, BaseModel) else None


def _remedy(item: Mapping[str, Any], about: Key) -> str:
    kind, value = item["type"], item["input"]
    if kind in ("float_type", "int_type") and isinstance(value, str):
        return "Write it without quotes" + ("; the unit is part of the key" if about.unit != "1" else "")
    if item["loc"][-1] == "teeth" and isinstance(value, int) and value < 0:
        return "Internal gears are not computed: both gears have external teeth"
    if kind in _RANGES and about.unit != "1":
        return f"Check the unit: the key {item['loc'][-1]} names it"
    if kind == "literal_error" and isinstance(value, str):
        words = [w.strip("' ") for w in str(item["ctx"]["expected"]).replace(" or ", ", ").split(",")]
        near = difflib.get_close_matches(value, words, n=1)
        return f"Did you mean {near[0]!r}?" if near else ""
    return ""
