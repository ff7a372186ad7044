"""Results that a folder keeps, with their dates and headline figures."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from base import InputError
from flankfilm.files.folder import content_of
from flankfilm.report.text import number, percent

__all__ = ["CYCLES", "DATA", "Kept", "kept_results"]

DATA = "results.nc"

CYCLES = {"lubricated": "with the film", "dry": "without film"}
"""Mesh cycles of results, the one that is shown before the other."""

FIGURES = "csv/uncertainties.csv"
"""Table of single figures that a run writes beside its data: it is read in a millisecond."""

HEADLINES = ("mean_tangent_stiffness", "transmission_error_range")
"""Figures that the list of results shows, with the film where there is one."""

DEEPEST, MOST = 3, 100
"""Levels of folders in which results are listed, and how many."""


@dataclass(frozen=True)
class Kept:
    """Results that a folder keeps.

    Attributes
    ----------
    name : str
        Folder, from the root.
    scene, date : str
    figures : tuple of str
        Headline figures with units and errors.
    """

    name: str
    scene: str
    date: str
    figures: tuple[str, ...]


def kept_results(root: Path) -> tuple[Kept, ...]:
    """Results below a folder, the newest first; hidden folders and links are left out.

    Parameters
    ----------
    root : Path
    """
    listed: list[tuple[float, Kept]] = []
    for folder, folders, files in os.walk(root):
        here = Path(folder)
        deep = len(here.relative_to(root).parts) >= DEEPEST
        folders[:] = [] if deep else sorted(name for name in folders if not name.startswith("."))
        if DATA in files and not (here / DATA).is_symlink():
            changed = (here / DATA).stat().st_mtime
            date = datetime.fromtimestamp(changed).astimezone().strftime("%Y-%m-%d %H:%M")
            name = here.relative_to(root).as_posix()
            scene = here.name.removesuffix("-results")
            listed.append((changed, Kept(name, scene, date, tuple(_headlines(here / FIGURES)))))
    listed.sort(key=lambda entry: entry[0], reverse=True)
    return tuple(kept for _, kept in listed[:MOST])


def _headlines(table: Path) -> Iterator[str]:
    """Headline figures of a run's table; none where it has none, or one that nobody can read."""
    try:
        text = content_of(table, 10**6, "", "").decode("utf-8")
        rows = {row["variable"]: row for row in csv.DictReader(io.StringIO(text))}
        for name in HEADLINES:
            row = next((rows[f"{cycle}_{name}"] for cycle in CYCLES if f"{cycle}_{name}" in rows), None)
            if row is not None:
                value, unit = float(row["value"]), row["unit"]
                shown = (value * 1e-6, "N/um") if unit == "N/m" else (value, unit)
                error = percent(float(row["numerical_error"]))
                yield f"{row['figure']} {number(shown[0], 5)} {shown[1]} ± {error}"
    except (InputError, ValueError, KeyError, TypeError, csv.Error):
        return
