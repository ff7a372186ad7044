"""Tables made from the code that reads scenes and studies: the directives ``keys``, ``wants`` and ``outputs``."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from importlib import import_module
from typing import Any

from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList
from sphinx.application import Sphinx

Schema = dict[str, Any]

_BOUNDS = (
    ("exclusiveMinimum", "above "),
    ("minimum", "from "),
    ("exclusiveMaximum", "below "),
    ("maximum", "to "),
)
_WORDS = {"number": "number", "integer": "whole number", "string": "text", "boolean": "true or false"}


def _options(schema: Schema, definitions: Schema) -> list[Schema]:
    """Members of a union without null, references resolved."""
    if "$ref" in schema:
        return _options(definitions[schema["$ref"].rpartition("/")[2]], definitions)
    members = [m for key in ("anyOf", "allOf") for m in schema.get(key, ())]
    return [o for m in members for o in _options(m, definitions)] if members else [schema]


def _allowed(schema: Schema, definitions: Schema) -> str:
    if "properties" in schema:
        return "a table"
    if "enum" in schema or "const" in schema:
        return ", ".join(f"`{value}`" for value in schema.get("enum", [schema.get("const")]))
    if schema.get("type") == "array":
        item = schema.get("items") or (schema.get("prefixItems") or [{}])[0]
        fixed = schema.get("maxItems") if schema.get("minItems") == schema.get("maxItems") else None
        inner = " or ".join(_allowed(o, definitions) for o in _options(item, definitions))
        return f"{fixed or 'list'} of: {inner}"
    kind = _WORDS.get(schema.get("type", ""), "table")
    if "minimum" in schema and "maximum" in schema:
        return f"{kind}, {schema['minimum']:.6g} to {schema['maximum']:.6g}"
    bounds = [f"{sign}{schema[name]:.6g}" for name, sign in _BOUNDS if name in schema]
    return ", ".join([kind, *bounds])


def _shown(value: Any) -> str:
    if value is None or value in ([], {}):
        return ""
    return f"`{str(value).lower() if isinstance(value, bool) else value}`"


def _meaning(field: Schema, key: str) -> str:
    """Meaning of a key, without which the documentation is not built."""
    if "description" not in field:
        raise ValueError(f"the key {key} has no meaning: give its field a description")
    return str(field["description"])


def rows(schema: Schema, definitions: Schema, prefix: str = "") -> Iterator[tuple[str, str, str, str]]:
    """Key, what is allowed, default and meaning of every key, sections opened up."""
    needed = schema.get("required", ())
    opened: dict[str, str] = {}
    for name, field in schema["properties"].items():
        same = opened.setdefault(str(field.get("$ref") or field.get("anyOf") or name), name)
        if same != name and any("properties" in o for o in _options(field, definitions)):
            default = "required" if name in needed else ""
            yield f"`{prefix}{name}`", f"as `{prefix}{same}`", default, _meaning(field, prefix + name)
            continue
        members = [o for o in _options(field, definitions) if o.get("type") != "null"]
        sections = [o for o in members if "properties" in o]
        simple = [o for o in members if "properties" not in o]
        if simple or not sections:
            default = "required" if name in needed else _shown(field.get("default"))
            allowed = " or ".join(_allowed(o, definitions) for o in members)
            yield f"`{prefix}{name}`", allowed, default, _meaning(field, prefix + name)
        for section in sections:
            yield from rows(section, definitions, f"{prefix}{name}.")


def _table(head: tuple[str, ...], body: list[tuple[str, ...]]) -> list[str]:
    def line(cells: tuple[str, ...]) -> str:
        return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"

    return [line(head), "|" + "---|" * len(head), *map(line, body)]


class _Parsed(Directive, ABC):
    """Lines of Markdown in place of the directive."""

    @abstractmethod
    def lines(self) -> list[str]:
        """Lines of Markdown."""

    def run(self) -> list[nodes.Node]:
        """Parse the lines."""
        box = nodes.container()
        self.state.nested_parse(StringList(self.lines(), source="tables of keys"), 0, box)
        return box.children


class Keys(_Parsed):
    """``{keys} module:Model``: all keys of a section."""

    required_arguments = 1

    def lines(self) -> list[str]:
        """Lines of the table."""
        module, _, name = self.arguments[0].partition(":")
        schema = getattr(import_module(module), name).model_json_schema()
        return _table(("key", "allowed", "default", "meaning"), list(rows(schema, schema.get("$defs", {}))))


class Wants(_Parsed):
    """``{wants}``: what a scene can want."""

    def lines(self) -> list[str]:
        """Lines of the table."""
        wants = import_module("flankfilm.scene.wants").WANTS
        return _table(("want", "result"), [(f"`{name}`", want.meaning) for name, want in wants.items()])


class Outputs(_Parsed):
    """``{outputs}``: what a study can ask for."""

    def lines(self) -> list[str]:
        """Lines of the table."""
        studied = import_module("flankfilm.studies.outputs")
        body = [
            (f"`{name}`", o.unit, o.meaning, ", ".join(o.wants), _error(studied, name))
            for name, o in studied.OUTPUTS.items()
        ]
        return _table(("output", "unit", "meaning", "wants", "error"), body)


def _error(studied: Any, name: str) -> str:
    """Name of the output that holds the error of another, or why it has none."""
    held = studied.ERROR_OF.get(name)
    return f"`{held}`" if held else str(studied.error_said(name))


def setup(app: Sphinx) -> dict[str, bool]:
    """Add the directives."""
    app.add_directive("keys", Keys)
    app.add_directive("wants", Wants)
    app.add_directive("outputs", Outputs)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
