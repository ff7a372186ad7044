"""Reads REXS models as XML without trusting them."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from base import InputError, shorten
from flankfilm.exchange.rexs_model import LONGEST_VALUE, Component, Model, Relation, assembled

DEEPEST = 32
"""Elements inside each other; the standard's XML schema has six."""


def model_of_xml(content: bytes, name: str) -> Model:
    """Read a model as XML; document type declarations are refused, so that no entity is expanded."""
    parser = ET.XMLParser(target=_Tree(name))
    try:
        parser.feed(content)
        root = parser.close()
    except (ET.ParseError, ValueError, LookupError) as fault:
        if isinstance(fault, InputError):
            raise
        allowed = f"must be XML: {shorten(str(fault))}"
        raise InputError.at(name, "", allowed, "Export the model again as REXS") from fault
    if root.tag != "model":
        allowed = "is XML but no REXS model (its outermost element is not model)"
        raise InputError.at(name, "", allowed, "Export it as REXS, versions 1.0 to 2.0")
    relations = (
        Relation(
            relation.get("type", ""), {r.get("role", ""): r.get("id", "") for r in relation.iterfind("ref")}
        )
        for relation in root.iterfind("relations/relation")
    )
    return assembled(name, root.attrib, map(_component, root.iterfind("components/component")), relations)


def _component(element: ET.Element) -> Component:
    attributes = {
        attribute.get("id", ""): (
            (attribute.text or "").strip()[:LONGEST_VALUE],
            attribute.get("unit", "").strip(),
        )
        for attribute in element.iterfind("attribute[@id]")
    }
    return Component(element.get("id", ""), element.get("type", ""), element.get("name", ""), attributes)


class _Tree(ET.TreeBuilder):
    """Builds the elements of a file that declares no document type and is not nested without end."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self._name = name
        self._depth = 0

    def doctype(self, *_: object) -> None:
        remedy = "REXS files have none; remove it if you trust the file"
        raise InputError.at(self._name, "", "has a document type declaration, which is refused", remedy)

    def start(self, tag: str, attrs: dict[str, str], /) -> ET.Element:
        self._depth += 1
        if self._depth > DEEPEST:
            raise InputError.at(self._name, "", f"is nested deeper than {DEEPEST} elements")
        return super().start(tag.rpartition("}")[2], attrs)

    def end(self, tag: str, /) -> ET.Element:
        self._depth -= 1
        element = super().end(tag)
        if element.tag == "attribute" and len(element):
            element.clear()  # an array, a matrix: no scalar, and much of some files
        return element
