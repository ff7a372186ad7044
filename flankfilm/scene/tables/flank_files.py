"""Files that a scene names for measured flanks, read into the scene: it then holds all that it needs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from base import Fault, InputError
from flankfilm.scene.sections.curve_sections import POSITIONS
from flankfilm.scene.sections.error_curve import POINTS
from flankfilm.scene.sections.gears import GEARS
from flankfilm.scene.sections.map_section import PLACES
from flankfilm.scene.tables.error_curve_file import names_the_error, read_error_file, without_points

__all__ = ["CURVES", "names_a_file", "read_flank_files", "without_curves"]

FILES = {
    ("deviations", "traces"): ("material_um", POSITIONS),
    ("deviations", "lead"): ("material_um", PLACES),
    ("deviations", "map"): ("material_um", POSITIONS),
    ("wear",): ("depth_um", POSITIONS),
}
"""Tables of a gear that may name a file, what its values are, and how they may be placed."""


CURVES = ("teeth", *POSITIONS, *PLACES, *dict.fromkeys(name for name, _ in FILES.values()), *POINTS)
"""Keys that a file gives."""


def read_flank_files(raw: dict[str, Any], folder: Path, keys: Sequence[str] = ()) -> list[Fault]:
    """Put the curves of the files that a scene names beside their names; return what is wrong with the files.

    The curves are those of flanks, and that of the transmission error.

    Parameters
    ----------
    raw : mapping
        Keys of the scene as read; changed. A table whose file cannot be read is taken out, so that it has no fault
        twice.
    folder : Path
        From where the files are named.
    keys : sequence of str
        Dotted keys that alone are looked at, where others have been read; all unless given.
    """
    faults = read_error_file(raw, folder, keys)
    for path, table, parent, (kind, positions) in _tables(raw):
        key = f"pair.{path}.file"
        if keys and key not in keys:
            continue
        clash = sorted(table.keys() & set(CURVES))
        if clash:
            faults.append(
                Fault(key, table["file"], f"excludes {' and '.join(clash)}", "Leave one of them out")
            )
            continue
        from flankfilm.scene.tables.map_files import read_map
        from flankfilm.scene.tables.trace_files import mean_of, read_curves

        try:
            curves: Any
            if path.endswith(".map"):
                curves = read_map(folder / table["file"], key)
            else:
                curves = read_curves(folder / table["file"], kind, key, tuple(positions))
            if isinstance(curves, list) and path.endswith(".lead"):
                curves = mean_of(curves, "z_mm", kind, key)
        except InputError as error:
            faults += error.faults
            del parent[path.rpartition(".")[2]]
            continue
        if isinstance(curves, dict) and not path.endswith(".traces"):
            table.update(curves)
        else:
            table["teeth"] = [curves] if isinstance(curves, dict) else curves
    return faults


def names_a_file(key: str) -> bool:
    """Whether a dotted key of a scene names a file of flanks, or of the transmission error."""
    return names_the_error(key) or any(
        key == f"pair.{gear}.{'.'.join(path)}.file" for gear in GEARS for path in FILES
    )


def without_curves(raw: dict[str, Any], key: str) -> None:
    """Take out what was read from the file that stood at a key, which now names another."""
    if names_the_error(key):
        without_points(raw)
    for path, table, *_ in _tables(raw):
        if key == f"pair.{path}.file":
            for name in CURVES:
                table.pop(name, None)


def _tables(
    raw: Mapping[str, Any],
) -> Iterator[tuple[str, dict[str, Any], dict[str, Any], tuple[str, Mapping[str, Any]]]]:
    """Tables that name a file: path below the pair, table, the table it is in, what `FILES` says of it."""
    pair = raw.get("pair")
    for gear in GEARS:
        for keys, kind in FILES.items():
            above: Any = None
            here: Any = pair
            for key in (gear, *keys):
                above, here = here, here.get(key) if isinstance(here, dict) else None
            if isinstance(here, dict) and isinstance(here.get("file"), str):
                yield ".".join((gear, *keys)), here, above, kind
