"""Folders of results as named arrays: datasets, tables, pages and other files, without clocks and versions."""

from __future__ import annotations

import csv
import hashlib
import json
import re
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np

from .case import CLOCKS, Arrays

HDF5 = frozenset(
    {"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST", "_Netcdf4Dimid", "_Netcdf4Coordinates"}
)
OF_THE_RUN = frozenset({"versions_json", "code_sha256", "_NCProperties"})
CHECK_SUMS = frozenset({"files.json", ".lock"})
CLOCK = re.compile(r"\b\d[\d.,]*(?:e[+-]?\d+)?\s*(?:ms|s|min|h)\b(?!/)(?:\s*\d+\s*(?:s|min)\b)?")
RATE = re.compile(r"\b\d[\d.,]*(?:e[+-]?\d+)?\s*rows/s\b")
PART = re.compile(r'<dc:date>[^<]*</dc:date>| (?:id|xlink:href|clip-path)="[^"]*"')
UNSHOWN = frozenset({"style", "script", "metadata", "defs"})


def folder_arrays(folder: Path) -> Arrays:
    """Everything in a folder of results."""
    arrays: Arrays = {}
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        name = file.relative_to(folder).as_posix()
        if file.name in CHECK_SUMS:
            continue
        if file.suffix == ".nc":
            arrays |= {f"{name}/{key}": value for key, value in dataset(file)}
        elif file.suffix == ".csv":
            arrays |= {f"{name}/{key}": value for key, value in table(file)}
        elif file.suffix == ".html":
            arrays[name] = np.array(page(file.read_text(encoding="utf-8")))
        elif file.suffix == ".svg":
            arrays[name] = np.array(picture(file.read_text(encoding="utf-8")))
        elif file.suffix == ".json":
            held = json.loads(file.read_text(encoding="utf-8"))
            arrays |= {
                f"{name}/{key}": np.array(json.dumps(held[key])) for key in sorted(held.keys() - OF_THE_RUN)
            }
        else:
            arrays[f"{name}/sha256"] = np.array(hashlib.sha256(file.read_bytes()).hexdigest())
    return arrays


def dataset(file: Path) -> Iterator[tuple[str, Any]]:
    """Variables and attributes of a dataset."""
    import h5py

    with h5py.File(file) as data:
        for name in sorted(data):
            if name in CLOCKS:
                continue
            values = data[name][()]
            yield name, _text(values)
            for key in sorted(data[name].attrs.keys() - HDF5):
                yield f"{name}@{key}", _text(data[name].attrs[key])
        for key in sorted(data.attrs.keys() - OF_THE_RUN):
            value = data.attrs[key]
            yield f"@{key}", np.array(_timeless_json(value)) if key.endswith("_json") else _text(value)


def table(file: Path) -> Iterator[tuple[str, Any]]:
    """Columns of a table, numbers where all of it are; lines that begin with # are text."""
    lines = file.read_text(encoding="utf-8").splitlines()
    notes = [line for line in lines if line.startswith("#")]
    if notes:
        yield "notes", np.array(notes)
    rows = list(csv.reader(line for line in lines if not line.startswith("#")))
    if not rows:
        return
    for k, title in enumerate(rows[0]):
        if title not in CLOCKS:
            cells = [row[k] if k < len(row) else "" for row in rows[1:]]
            yield f"{k} {title}", _column(cells)


def page(html: str) -> list[str]:
    """Words of a page, pictures' words included, with times masked.

    Examples
    --------
    >>> page("<h1>Cost</h1><style>p {}</style><p>Done in <b>1.5 s</b>, 12 rad/s</p>")
    ['Cost', 'Done in', '(time)', ', 12 rad/s']
    """
    reader = _Words()
    reader.feed(html)
    reader.close()
    return [CLOCK.sub("(time)", RATE.sub("(rate)", words)) for words in reader.words]


def picture(svg: str) -> list[str]:
    r"""Lines of a picture without its date and without the names of its parts, which are random.

    Examples
    --------
    >>> picture('<dc:date>2026-01-01</dc:date>\n<path id="m1a" d="M 0 1"/>\n<use xlink:href="#m1a" x="2"/>')
    ['', '<path d="M 0 1"/>', '<use x="2"/>']
    """
    return PART.sub("", svg).splitlines()


class _Words(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.words: list[str] = []
        self._hidden: list[str] = []
        self._row = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag in UNSHOWN:
            self._hidden.append(tag)
        if tag == "tr":
            self._row = len(self.words)

    def handle_endtag(self, tag: str) -> None:
        if self._hidden and self._hidden[-1] == tag:
            self._hidden.pop()
        if tag == "tr":
            row = self.words[self._row :]
            if len(row) == 2 and CLOCK.fullmatch(row[1]):
                del self.words[
                    self._row :
                ]  # listed for its time alone: such a stage is left out where it was quick

    def handle_data(self, data: str) -> None:
        words = " ".join(data.split())
        if words and not self._hidden:
            self.words.append(words)


def _column(cells: list[str]) -> Any:
    """Numbers where every cell is one or empty; an empty column is text."""
    try:
        return (
            np.array([float(cell) if cell else np.nan for cell in cells]) if any(cells) else np.array(cells)
        )
    except ValueError:
        return np.array(cells)


def _text(values: Any) -> Any:
    """Values of a file with text as numpy's text."""
    array = np.asarray(values)
    if array.dtype.kind not in "OS":
        return array
    plain = [entry.decode() if isinstance(entry, bytes) else str(entry) for entry in array.ravel().tolist()]
    return np.array(plain, dtype=str).reshape(array.shape) if plain else np.array([], dtype=str)


def _timeless_json(text: str) -> str:
    """A text of JSON without clocks, in one form."""

    def timeless(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: timeless(part) for key, part in value.items() if key not in CLOCKS}
        return [timeless(part) for part in value] if isinstance(value, list) else value

    return json.dumps(timeless(json.loads(text)), indent=1)
