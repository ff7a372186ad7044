"""Reads the components and relations of a REXS file (XML) without trusting it.

REXS is the open exchange standard for drive trains of the Forschungsvereinigung Antriebstechnik (FVA),
versions 1.0 to 2.0: a model holds components, each with attributes that have a unit, and relations that give
components their roles. What a spur-gear pair does not need (arrays, load spectra) is skipped.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as ET

from base import InputError, shorten
from flankfilm.folder import content_of

LARGEST_FILE = 50_000_000
"""Bytes; a gear unit with all its bearings and results is a few megabytes."""

DEEPEST = 32
"""Elements inside each other; the standard's XML schema has six."""

LONGEST_VALUE = 1000
"""Characters of an attribute's value; longer ones are no number."""

VERSIONS = ("1.", "2.")
"""Beginnings of the versions whose attribute names are known."""


@dataclass(frozen=True)
class Component:
    """One component of a model.

    Attributes
    ----------
    id, type, name : str
    attributes : mapping of str to (str, str)
        Attribute id to value and unit, as written; values that are arrays are left out.
    """

    id: str
    type: str
    name: str
    attributes: Mapping[str, tuple[str, str]]

    def __str__(self) -> str:
        """Type, name and id as a person finds them in the file."""
        name = f" {shorten(self.name, 40)}" if self.name else ""
        return f"{self.type}{name} (id {self.id})"


@dataclass(frozen=True)
class Relation:
    """One relation: its type, and role to component id."""

    type: str
    roles: Mapping[str, str]


@dataclass(frozen=True)
class Model:
    """What a REXS file holds, as far as it is read here.

    Attributes
    ----------
    version, application : str
    components : mapping of str to Component
        By id, in the order of the file.
    relations : tuple of Relation
    """

    version: str
    application: str
    components: Mapping[str, Component]
    relations: tuple[Relation, ...]

    def related(self, kind: str, role: str, component: str) -> tuple[Relation, ...]:
        """Relations of a type in which the component has the role."""
        return tuple(r for r in self.relations if r.type == kind and r.roles.get(role) == component)

    def others(self, kind: str, role: str, component: str, *roles: str) -> list[Component]:
        """Components in other roles of the relations in which the component has one; each once, in their order."""
        found = self.related(kind, role, component)
        ids = dict.fromkeys(relation.roles.get(other, "") for relation in found for other in roles)
        return [self.components[i] for i in ids if i in self.components]


def read_model(path: Path) -> Model:
    """Read a REXS file.

    Document type declarations are refused, so that no entity is expanded and nothing outside the file is
    read; size and depth are bounded.

    Raises
    ------
    InputError
        Where the file is missing, too large, no XML, or no REXS model.
    """
    return parse_model(_bytes_of(path), str(path))


def parse_model(content: bytes, name: str) -> Model:
    """Read the content of a REXS file that faults call `name`; see `read_model`."""
    parser = ET.XMLParser(target=_Tree(name))
    try:
        parser.feed(content)
        root = parser.close()
    except (ET.ParseError, ValueError, LookupError) as fault:
        if isinstance(fault, InputError):
            raise
        allowed = f"must be XML: {shorten(str(fault))}"
        raise InputError.at(name, "", allowed, "Export the model again as REXS (XML)") from fault
    if root.tag != "model":
        allowed = "is XML but no REXS model (its outermost element is not model)"
        raise InputError.at(name, "", allowed, "Export it as REXS, versions 1.0 to 2.0")
    version = root.get("version", "")
    if not version.startswith(VERSIONS):
        allowed = "is not a REXS version that is known here"
        raise InputError.at(f"{name}: version", repr(version), allowed, "Versions 1.0 to 2.0")
    components: dict[str, Component] = {}
    for one in map(_component, root.iterfind("components/component")):
        if one.id in components:
            value = f"component id {shorten(one.id)}"
            raise InputError.at(name, value, "stands twice; ids must differ", "Export it again")
        components[one.id] = one
    relations = (
        Relation(found.get("type", ""), {r.get("role", ""): r.get("id", "") for r in found.iterfind("ref")})
        for found in root.iterfind("relations/relation")
    )
    made_by = f"{root.get('applicationId', '')} {root.get('applicationVersion', '')}".strip()
    return Model(version, made_by, components, tuple(relations))


def _component(element: ET.Element) -> Component:
    attributes = {
        found.get("id", ""): ((found.text or "").strip()[:LONGEST_VALUE], found.get("unit", "").strip())
        for found in element.iterfind("attribute[@id]")
    }
    return Component(element.get("id", ""), element.get("type", ""), element.get("name", ""), attributes)


def _bytes_of(path: Path) -> bytes:
    content = content_of(path, LARGEST_FILE, "Name a REXS file", "Export the stage alone, without results")
    for start, kind in ((b"PK", "a ZIP archive (.rexsz)"), (b"{", "JSON (.rexsj)")):
        if content.lstrip()[:2].startswith(start):
            remedy = "Unpack it, or export the model as XML (.rexs)"
            raise InputError.at(path, "", f"is {kind}; REXS is read as XML alone", remedy)
    return content


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
