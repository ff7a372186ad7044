"""Scenes as TOML: values, lines with remarks, whole files."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from typing import Any

__all__ = ["remarked", "toml", "toml_lines"]

WIDTH = 120
COMMENTS = 35
"""Column of the comments."""


def toml(value: Any) -> str:
    """Write a value as TOML, tables in one line.

    Examples
    --------
    >>> toml({"points": (1, 2.5), "limit": 5e8, "form": "linear"})
    '{ points = [1, 2.5], limit = 5e8, form = "linear" }'
    """
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{name} = {toml(item)}" for name, item in value.items()) + " }"
    if isinstance(value, tuple | list):
        return f"[{', '.join(map(toml, value))}]"
    short = f"{value:g}"
    exact = isinstance(value, float) and "e+" in short and float(short) == value
    return short.replace("e+0", "e").replace("e+", "e") if exact else repr(value)


def _quoted(text: str) -> str:
    """A TOML basic string."""
    escaped = "".join(
        f"\\u{ord(c):04x}" if ord(c) < 32 or ord(c) == 127 else "\\" + c if c in '"\\' else c for c in text
    )
    return f'"{escaped}"'


def toml_lines(raw: Mapping[str, Any]) -> Iterator[str]:
    """Lines for the keys of a scene: those outside sections, then the sections with tables inside them inline.

    Examples
    --------
    >>> list(toml_lines({"pair": {"module_mm": 2.0}, "title": "Pair"}))
    ['title = "Pair"', '', '[pair]', 'module_mm = 2.0']
    """
    sections = {name: value for name, value in raw.items() if isinstance(value, Mapping)}
    yield from (f"{name} = {toml(value)}" for name, value in raw.items() if name not in sections)
    for name, section in sections.items():
        yield from ("", f"[{name}]")
        yield from (f"{key} = {toml(value)}" for key, value in section.items())


def remarked(line: str, remark: str, indent: str = "") -> Iterator[str]:
    """A line with a remark behind it, or above it, after the indent, where both together would be too long.

    Examples
    --------
    >>> list(remarked("module_mm = 2.0", "module of both gears"))
    ['module_mm = 2.0                    # module of both gears']
    """
    together = f"{line:<{COMMENTS - 2}}  # {remark}"
    if len(together) <= WIDTH:
        yield together
    else:
        start = f"# {indent}"
        yield from textwrap.wrap(
            remark, WIDTH, initial_indent=start, subsequent_indent=start, break_on_hyphens=False
        )
        yield line
