"""Studies and optimisations of the page: which files are one, what they may read, and their growing table of rows."""

from __future__ import annotations

import csv
import io
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from base import InputError
from base.units import unit_of
from flankfilm.app.checking import Place, files_outside
from flankfilm.app.scene_files import EXAMPLES, SceneFiles
from flankfilm.scene.reader import parse_toml, read_text
from flankfilm.scene.tables.flank_files import names_a_file
from flankfilm.studies.table import ROWS

__all__ = ["Asked", "Growing", "asked_rows", "heads", "refuse_outside", "rows_files"]

Kind = Literal["study", "optimise"]

FOLDERS: dict[Kind, str] = {"study": "-study", "optimise": "-optimum"}
"""What the folder of rows ends in, after the name of the file."""

LARGEST = 200_000
"""Characters of a file that is looked into."""


@dataclass(frozen=True)
class Asked:
    """A study or an optimisation that can be started.

    Attributes
    ----------
    name : str
        From the root, or from the examples.
    example : bool
    kind : {"study", "optimise"}
    title : str
    folder : str
        Of its rows, from the root.
    rows : int
        Rows that are there, from which it can be resumed.
    report : bool
        Whether it was finished.
    """

    name: str
    example: bool
    kind: Kind
    title: str
    folder: str
    rows: int
    report: bool


def rows_files(files: SceneFiles) -> tuple[Asked, ...]:
    """Studies and optimisations below the root, then those of the examples.

    Parameters
    ----------
    files : SceneFiles
    """
    own = [(files.root, name, False) for name in files.listed()]
    examples = [
        path for folder in ("studies", "optimise") for path in sorted((EXAMPLES / folder).glob("*.toml"))
    ]
    own += [(EXAMPLES, path.relative_to(EXAMPLES).as_posix(), True) for path in examples]
    return tuple(asked for place in own if (asked := _asked(files.root, *place)) is not None)


def asked_rows(files: SceneFiles, name: str, example: bool) -> tuple[Asked, Place, Path]:
    """Study or optimisation of a name, its place, and its file.

    Parameters
    ----------
    files : SceneFiles
    name : str
    example : bool
        Whether it is one of the examples.

    Raises
    ------
    InputError
        Where there is none, or it is outside the folder.
    """
    root = EXAMPLES if example else files.root
    path = Place(root, root).inside(name)
    asked = _asked(files.root, root, name, example)
    if asked is None:
        raise InputError.at(name[:200], "", "is no study and no optimisation", "Choose one of the list")
    return asked, Place(root, path.parent), path


def _asked(root: Path, home: Path, name: str, example: bool) -> Asked | None:
    """What a file is; None where it is no study and no optimisation."""
    path = home / name
    try:
        text = path.read_text(encoding="utf-8") if path.stat().st_size <= LARGEST else ""
        raw = tomllib.loads(text)
    except (OSError, ValueError, RecursionError):
        return None
    if "vary" not in raw:
        return None
    kind: Kind = "optimise" if raw.keys() & {"minimise", "maximise"} else "study"
    beside = Path() if example else Path(name).parent
    folder = beside / f"{path.stem}{FOLDERS[kind]}"
    table = root / folder / ROWS
    rows = max(0, table.read_bytes().count(b"\n") - 1) if table.is_file() else 0
    report = (root / folder / "report.html").is_file()
    return Asked(name, example, kind, str(raw.get("title", ""))[:200], folder.as_posix(), rows, report)


def refuse_outside(path: Path, place: Place) -> None:
    """Refuse a study or an optimisation that names files outside the place.

    Parameters
    ----------
    path : Path
        Its file.
    place : Place

    Raises
    ------
    InputError
    """
    raw = parse_toml(read_text(path), str(path))
    scene = raw.get("scene")
    here = place
    if isinstance(scene, str):
        beside = place.inside(scene)
        here, scene = Place(place.root, beside.parent), parse_toml(read_text(beside), scene)
    faults = [*files_outside(scene, here)]
    for table in ("vary", "set"):
        for key, values in _files_of(raw.get(table, {})):
            faults += [fault for value in values for fault in files_outside({"file": value}, place, key)]
    if faults:
        raise InputError(faults)


def _files_of(table: Any) -> Iterator[tuple[str, list[Any]]]:
    """Keys of a table that name files, with their values."""
    if isinstance(table, Mapping):
        for key, value in table.items():
            if names_a_file(str(key)):
                yield str(key), value if isinstance(value, list) else [value]


def heads(keys: Sequence[str], outputs: Sequence[str]) -> list[dict[str, str]]:
    """Heads of a table of rows: name, unit and meaning of each column.

    Parameters
    ----------
    keys, outputs : sequence of str
        As of `flankfilm.studies.table.Columns`.

    Examples
    --------
    >>> heads(["pair.module_mm"], [])[1]
    {'name': 'pair.module_mm', 'unit': 'mm', 'meaning': 'key of the scene'}
    """
    from flankfilm.studies.outputs import OUTPUTS

    columns = [{"name": "row", "unit": "", "meaning": "number of the row"}]
    columns += [{"name": key, "unit": _read_in(unit_of(key)), "meaning": "key of the scene"} for key in keys]
    for name in outputs:
        about = OUTPUTS[name]
        columns.append({"name": name, "unit": _read_in(about.unit), "meaning": about.meaning})
    columns.append({"name": "seconds", "unit": "s", "meaning": "cost of the row"})
    return [*columns, {"name": "fault", "unit": "", "meaning": "why a row failed"}]


def _read_in(unit: str) -> str:
    return "" if unit == "1" else unit


class Growing:
    """A table of rows that another process adds to.

    Parameters
    ----------
    path : Path
        ``rows.csv``; need not exist yet.
    """

    def __init__(self, path: Path) -> None:
        self._path, self._read, self._header, self._rows = path, 0, True, 0

    def more(self) -> tuple[int, list[list[str]]]:
        """Number of the first row that is new, and all new rows; 0 again where the table was made anew.

        A row that is half written is left for the next time; checksums, which stand last, are left out.
        """
        try:
            with self._path.open("rb") as file:
                if file.seek(0, 2) < self._read:
                    self._read, self._header, self._rows = 0, True, 0
                file.seek(self._read)
                new = file.read()
        except OSError:
            return self._rows, []
        whole = new[: new.rfind(b"\n") + 1]
        self._read += len(whole)
        lines = list(csv.reader(io.StringIO(whole.decode("utf-8", "replace"))))
        if lines and self._header:
            self._header = False
            lines = lines[1:]
        first, self._rows = self._rows, self._rows + len(lines)
        return first, [line[:-1] for line in lines]
