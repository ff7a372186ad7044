"""REXS models as JSON (.rexsj), which the standard has from version 1.5 on and programs wrote before."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any
from xml.etree import ElementTree as ET

from base import InputError, shorten
from flankfilm.exchange.rexs_model import LONGEST_VALUE, Component, Model, Relation, assembled

_NO_VALUE = ("id", "unit")
"""Names in an attribute beside that of its value, which says what kind of value it is."""


def model_of_json(content: bytes, name: str) -> Model:
    """Read a model as JSON; numbers remain text until an attribute that needs one asks.

    Parameters
    ----------
    content : bytes
    name : str
        What faults call the file.

    Raises
    ------
    InputError
        Where it is no JSON, or no REXS model.
    """
    try:
        text = content.decode("utf-8-sig")
        document = json.loads(text, parse_int=str, parse_float=str, parse_constant=str)
    except RecursionError as fault:
        raise InputError.at(name, "", "is nested too deeply", "Export the model again as REXS") from fault
    except ValueError as fault:
        allowed = f"must be JSON in UTF-8: {shorten(str(fault))}"
        raise InputError.at(name, "", allowed, "Export the model again as REXS") from fault
    model = document.get("model") if isinstance(document, dict) else None
    if not isinstance(model, dict):
        allowed = "is JSON but no REXS model (it has no object named model)"
        raise InputError.at(name, "", allowed, "Export it as REXS, versions 1.0 to 2.0")
    head = {key: value for key, value in model.items() if isinstance(value, str)}
    relations = (
        Relation(
            _text(relation, "type"),
            {_text(ref, "role"): _text(ref, "id") for ref in _objects(relation, "refs")},
        )
        for relation in _objects(model, "relations")
    )
    return assembled(name, head, map(_component, _objects(model, "components")), relations)


def _component(node: dict[str, Any]) -> Component:
    attributes = {
        _text(attribute, "id"): (value[:LONGEST_VALUE], _text(attribute, "unit").strip())
        for attribute in _objects(node, "attributes")
        if (value := _scalar(attribute)) is not None
    }
    return Component(_text(node, "id"), _text(node, "type"), _text(node, "name"), attributes)


def _scalar(attribute: dict[str, Any]) -> str | None:
    """Value of an attribute as it would stand in XML; None of arrays, matrices and coded ones."""
    for name, value in attribute.items():
        if name in _NO_VALUE:
            continue
        if isinstance(value, bool):
            return "true" if value else "false"
        if isinstance(value, str):
            return value.strip()
    return None


def _objects(node: dict[str, Any], name: str) -> Iterator[dict[str, Any]]:
    """Objects in a list that an object has; none where it has no such list."""
    listed = node.get(name)
    return (entry for entry in (listed if isinstance(listed, list) else ()) if isinstance(entry, dict))


def _text(node: dict[str, Any], name: str) -> str:
    value = node.get(name)
    return value if isinstance(value, str) else ""


def json_text(model: ET.Element) -> str:
    """Write a model, given as the elements of its XML, as JSON; attributes that are arrays are left out.

    Parameters
    ----------
    model : Element
        Whose attributes have single numbers, whole numbers and truth values.
    """
    relations = [
        _numbered(relation) | {"refs": [_numbered(ref) for ref in relation]}
        for relation in model.iterfind("relations/relation")
    ]
    components = [
        _numbered(component)
        | {"attributes": [_attribute(attribute) for attribute in component if not len(attribute)]}
        for component in model.iterfind("components/component")
    ]
    parts = {**model.attrib, "relations": relations, "components": components}
    return json.dumps({"model": parts}, indent=2, ensure_ascii=False) + "\n"


def _numbered(element: ET.Element) -> dict[str, Any]:
    """Attributes of an element, ids and orders as numbers."""
    return {name: int(value) if name in ("id", "order") else value for name, value in element.attrib.items()}


def _attribute(element: ET.Element) -> dict[str, Any]:
    text = element.text or ""
    kinds: dict[str, Any] = {"true": ("boolean", True), "false": ("boolean", False)}
    number = ("integer", int(text)) if text.isdecimal() else None
    kind, value = kinds.get(text) or number or ("floating_point", float(text))
    return {**element.attrib, kind: value}
