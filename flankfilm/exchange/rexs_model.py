"""Components and relations of a REXS model, whatever it was read from.

REXS is the open exchange standard for drive trains of the Forschungsvereinigung Antriebstechnik (FVA),
versions 1.0 to 2.0: a model holds components, each with attributes that have a unit, and relations that give
components their roles. What a spur-gear pair does not need (arrays, load spectra) is skipped.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from base import InputError, shorten

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
        relations = self.related(kind, role, component)
        ids = dict.fromkeys(relation.roles.get(other, "") for relation in relations for other in roles)
        return [self.components[i] for i in ids if i in self.components]


def assembled(
    name: str,
    head: Mapping[str, str],
    components: Iterable[Component],
    relations: Iterable[Relation],
) -> Model:
    """Model of a file that faults call `name`, of a version that is known and with ids that differ.

    Parameters
    ----------
    name : str
    head : mapping
        ``version``, ``applicationId`` and ``applicationVersion``.
    components : iterable of Component
    relations : iterable of Relation
    """
    version = head.get("version", "")
    if not version.startswith(VERSIONS):
        allowed = "is not a REXS version that is known here"
        raise InputError.at(f"{name}: version", shorten(version), allowed, "Versions 1.0 to 2.0")
    by_id: dict[str, Component] = {}
    for component in components:
        if component.id in by_id:
            value = f"component id {shorten(component.id)}"
            raise InputError.at(name, value, "stands twice; ids must differ", "Export it again")
        by_id[component.id] = component
    made_by = f"{head.get('applicationId', '')} {head.get('applicationVersion', '')}".strip()
    return Model(version, made_by, by_id, tuple(relations))
