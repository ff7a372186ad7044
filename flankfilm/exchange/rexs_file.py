"""Reads the components and relations of a REXS file (XML) without trusting it.

REXS is the open exchange standard for drive trains of the Forschungsvereinigung Antriebstechnik (FVA),
versions 1.0 to 2.0: a model holds components, each with attributes that have a unit, and relations that give
components their roles. What a spur-gear pair does not need (arrays, load spectra) is skipped.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.parsers import expat

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
    reader = _Reader(name)
    parser = expat.ParserCreate(namespace_separator="}")
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = reader.doctype
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.CharacterDataHandler = reader.text
    try:
        parser.Parse(content, True)
    except (expat.ExpatError, ValueError, LookupError) as fault:
        if isinstance(fault, InputError):
            raise
        allowed = f"must be XML: {shorten(str(fault))}"
        raise InputError.at(name, "", allowed, "Export the model again as REXS (XML)") from fault
    return reader.model()


def _bytes_of(path: Path) -> bytes:
    content = content_of(path, LARGEST_FILE, "Name a REXS file", "Export the stage alone, without results")
    for start, kind in ((b"PK", "a ZIP archive (.rexsz)"), (b"{", "JSON (.rexsj)")):
        if content.lstrip()[:2].startswith(start):
            remedy = "Unpack it, or export the model as XML (.rexs)"
            raise InputError.at(path, "", f"is {kind}; REXS is read as XML alone", remedy)
    return content


class _Reader:
    """Gathers components and relations while the parser goes through the file."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._path: list[str] = []
        self._head: dict[str, str] | None = None
        self._components: dict[str, Component] = {}
        self._relations: list[Relation] = []
        self._attributes: dict[str, tuple[str, str]] = {}
        self._component: dict[str, str] = {}
        self._relation = ""
        self._roles: dict[str, str] = {}
        self._attribute: tuple[str, str] = ("", "")
        self._value: list[str] | None = None

    def doctype(self, *_: object) -> None:
        remedy = "REXS files have none; remove it if you trust the file"
        raise InputError.at(self._name, "", "has a document type declaration, which is refused", remedy)

    def start(self, tag: str, marks: dict[str, str]) -> None:
        self._path.append(tag.rpartition("}")[2])
        if len(self._path) > DEEPEST:
            raise InputError.at(self._name, "", f"is nested deeper than {DEEPEST} elements")
        match self._path:
            case ["model"]:
                self._head = marks
            case ["model", "relations", "relation"]:
                self._relation, self._roles = marks.get("type", ""), {}
            case ["model", "relations", "relation", "ref"]:
                self._roles[marks.get("role", "")] = marks.get("id", "")
            case ["model", "components", "component"]:
                self._component, self._attributes = marks, {}
            case ["model", "components", "component", "attribute"]:
                self._attribute, self._value = (marks.get("id", ""), marks.get("unit", "")), []
            case ["model", "components", "component", "attribute", *_]:
                self._value = None  # an array, a matrix: no scalar

    def text(self, data: str) -> None:
        if self._value is not None and self._path[-1] == "attribute":
            self._value.append(data[: LONGEST_VALUE + 1])
            if len(self._value) > LONGEST_VALUE:
                self._value = None

    def end(self, tag: str) -> None:
        match self._path:
            case ["model", "relations", "relation"]:
                self._relations.append(Relation(self._relation, self._roles))
            case ["model", "components", "component"]:
                self._keep()
            case ["model", "components", "component", "attribute"] if self._value is not None:
                name, unit = self._attribute
                self._attributes[name] = ("".join(self._value).strip()[:LONGEST_VALUE], unit.strip())
                self._value = None
        self._path.pop()

    def _keep(self) -> None:
        marks = self._component
        key = marks.get("id", "")
        if key in self._components:
            allowed = "stands twice; ids must differ"
            raise InputError.at(self._name, f"component id {shorten(key)}", allowed, "Export it again")
        kind, name = marks.get("type", ""), marks.get("name", "")
        self._components[key] = Component(key, kind, name, self._attributes)

    def model(self) -> Model:
        if self._head is None:
            allowed = "is XML but no REXS model (its outermost element is not model)"
            raise InputError.at(self._name, "", allowed, "Export it as REXS, versions 1.0 to 2.0")
        version = self._head.get("version", "")
        if not version.startswith(VERSIONS):
            allowed = "is not a REXS version that is known here"
            raise InputError.at(f"{self._name}: version", repr(version), allowed, "Versions 1.0 to 2.0")
        made_by = self._head.get("applicationId", ""), self._head.get("applicationVersion", "")
        return Model(version, " ".join(made_by).strip(), self._components, tuple(self._relations))
