"""A scene file while it is edited: one key changes, and comments, order and all other lines stay."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, MutableMapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import Item

from base import InputError
from flankfilm.app.form import CHOICE, SWITCH, form_keys
from flankfilm.scene.reader import LARGEST_FILE, bounded, parse_toml
from flankfilm.scene.toml import toml

__all__ = ["Document", "value_of"]

REMEDY = "Open a scene, an example, or the template"


@dataclass(frozen=True)
class Document:
    """The text of a scene file, which is TOML at any time.

    Attributes
    ----------
    text : str
    """

    text: str

    @classmethod
    def read(cls, text: str, name: str = "scene") -> Document:
        """Take over the text of a file.

        Parameters
        ----------
        text : str
        name : str
            What a fault calls it.

        Raises
        ------
        InputError
            Where it is no TOML, or larger than any scene.

        Examples
        --------
        >>> Document.read("tolerance = 0.01  # of means").shown("tolerance")
        '0.01'
        """
        if len(text) > LARGEST_FILE:
            raise InputError.at(name, "", f"is larger than {LARGEST_FILE:,} bytes", REMEDY)
        parse_toml(text, name, REMEDY)
        return cls(text)

    @cached_property
    def raw(self) -> dict[str, Any]:
        """Keys and values as the file has them."""
        return tomllib.loads(self.text)

    def shown(self, path: str) -> str:
        """Value of a key as a form shows it: a word without quotes, all else as TOML; empty where it is left out.

        Parameters
        ----------
        path : str
            With dots.
        """
        value: Any = self.raw
        for part in path.split("."):
            if not isinstance(value, Mapping) or part not in value:
                return ""
            value = value[part]
        return value if isinstance(value, str) else toml(value)

    @property
    def values(self) -> dict[str, str]:
        """What a form shows at each of its keys that the file has."""
        return {path: text for path in form_keys() if (text := self.shown(path))}

    def with_value(self, path: str, typed: str) -> Document:
        r"""Give the file with another value of a key; an empty one takes it out, with a table that it empties.

        Parameters
        ----------
        path : str
            A key of the form.
        typed : str
            As it was typed; see `value_of`.

        Raises
        ------
        InputError
            Where the form has no such key, or a table on the way to it is none in the file.

        Examples
        --------
        >>> before = Document.read("[pair]\nmodule_mm = 2.0  # of both\n")
        >>> print(before.with_value("pair.module_mm", "2.5").text, end="")
        [pair]
        module_mm = 2.5  # of both
        """
        if path not in form_keys():
            raise InputError.at(path[:200], "", "is not a key of the form", "Choose one of its keys")
        typed = typed.strip()
        if typed == self.shown(path):
            return self
        file = tomlkit.parse(self.text)
        try:
            if typed:
                _set(file, path.split("."), value_of(path, typed))
            else:
                _remove(file, path.split("."))
            text = tomlkit.dumps(file)
            tomllib.loads(text)
        except (TOMLKitError, ValueError, TypeError, KeyError, AttributeError) as fault:
            remedy = "Write this key in the file, and open it again"
            raise InputError.at(path, typed[:200], f"cannot be put into the file: {fault}", remedy) from fault
        return Document(text)


def value_of(path: str, typed: str) -> Any:
    """Value that was typed at a key: TOML where it is some, a word otherwise, which the scene then judges.

    Parameters
    ----------
    path : str
        A key of the form.
    typed : str
        A number that is half typed is a word, and so a fault beside its key.

    Returns
    -------
    tomlkit.items.Item
        As it was typed: 2e4 does not become 20000.0.

    Examples
    --------
    >>> value_of("pair.module_mm", "2.5"), value_of("pair.module_mm", "2."), value_of("title", "12")
    (2.5, '2.', '12')
    """
    about = form_keys()[path]
    is_word = about.kind == CHOICE or about.name in PROSE or (about.kind != SWITCH and typed in about.choices)
    if not is_word and typed.isprintable():
        try:
            bounded(tomllib.loads(f"value = {typed}"), path)
            return tomlkit.value(typed)
        except (ValueError, RecursionError, TOMLKitError):
            pass
    return tomlkit.item(typed)


PROSE = ("title", "file", "name")
"""Names of keys whose words may look like numbers."""


def _set(file: MutableMapping[str, Any], parts: list[str], value: Any) -> None:
    """Give a key a value; tables that lack are made, those of the scene itself as sections."""
    table: Any = file
    for depth, part in enumerate(parts[:-1]):
        if part not in table:
            table[part] = tomlkit.inline_table() if depth else tomlkit.table()
        table = table[part]
        if not isinstance(table, MutableMapping):
            raise TypeError(f"{part} is no table there")
    last = parts[-1]
    if last in table and isinstance(file_item := table.item(last), Item) and isinstance(value, Item):
        value.trivia.comment_ws, value.trivia.comment = file_item.trivia.comment_ws, file_item.trivia.comment
        value.trivia.trail = file_item.trivia.trail
    table[last] = value


def _remove(file: MutableMapping[str, Any], parts: list[str]) -> None:
    """Take a key out, and each table that is empty without it."""
    tables: list[Any] = [file]
    for part in parts[:-1]:
        if not isinstance(tables[-1], Mapping) or part not in tables[-1]:
            return
        tables.append(tables[-1][part])
    for table, part in zip(reversed(tables), reversed(parts), strict=True):
        if not isinstance(table, MutableMapping) or part not in table:
            return
        del table[part]
        if len(table):
            return
