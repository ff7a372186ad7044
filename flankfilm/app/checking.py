"""What is wrong with a scene while it is typed: every fault beside its key, and the scene where there is none."""

from __future__ import annotations

import copy
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from base import Fault, InputError, SolverError
from flankfilm.app.document import Document
from flankfilm.app.form import NUMBER, form_keys
from flankfilm.building.preflight import refuse
from flankfilm.scene import Scene
from flankfilm.scene.reader import refuse_long_lists, validated
from flankfilm.scene.tables.flank_files import read_flank_files

__all__ = ["Checked", "Place", "checked", "files_outside"]

QUOTES = "Write it without quotes"
"""How the remedy begins for a number in quotes, which nobody typed into a form."""


@dataclass(frozen=True)
class Place:
    """Where files may be: below the root, named from the folder of the scene.

    Attributes
    ----------
    root, folder : Path
    """

    root: Path
    folder: Path

    def inside(self, name: str) -> Path:
        """Path of a file that a scene or a page names.

        Raises
        ------
        InputError
            Where it is not below the root, links followed.

        Examples
        --------
        >>> Place(Path("/data"), Path("/data/gears")).inside("flank.csv").as_posix()
        '/data/gears/flank.csv'
        """
        try:
            path = (self.folder / name).resolve()
            outside = not path.is_relative_to(self.root.resolve())
        except (OSError, ValueError, RuntimeError):
            outside = True
        if outside:
            allowed = f"must be below {self.root}"
            raise InputError.at(
                "file", name[:200], allowed, "Move it there, or start the page in another folder"
            )
        return path


@dataclass(frozen=True)
class Checked:
    """A scene file as it was judged.

    Attributes
    ----------
    scene : Scene or None
        None where there are faults.
    faults : tuple of Fault
    heard : tuple of str
        Warnings.
    """

    scene: Scene | None
    faults: tuple[Fault, ...] = ()
    heard: tuple[str, ...] = ()

    @property
    def by_key(self) -> dict[str, list[str]]:
        """Faults beside the keys and sections of the form that they are of; what is of none stands under ""."""
        beside: dict[str, list[str]] = {}
        for fault in self.faults:
            beside.setdefault(key_at(fault.where), []).append(_told(fault))
        return beside


def key_at(place: str) -> str:
    """Key or section of the form that a fault is of; empty for one of the whole file.

    Examples
    --------
    >>> key_at("pair.pinion.tip_relief.amount_um"), key_at("[lubricant]"), key_at("x.toml")
    ('pair.pinion.tip_relief.amount_um', 'lubricant', '')
    """
    path = place.strip("[]")
    while path:
        if path in form_keys() or any(key.startswith(f"{path}.") for key in form_keys()):
            return path
        path = path.rpartition(".")[0]
    return ""


def _told(fault: Fault) -> str:
    """A fault as a sentence; the key is where it stands."""
    sentence = str(replace(fault, value=""))
    return sentence.removeprefix(f"{fault.where}: ") if key_at(fault.where) else sentence


def checked(document: Document, place: Place) -> Checked:
    """Judge a scene as a run does before it solves anything.

    Parameters
    ----------
    document : Document
    place : Place
        Where the files that it names are.

    Examples
    --------
    >>> checked(Document('wants = ["geometry"]'), Place(Path(), Path())).by_key
    {'pair': ['is required by geometry. Add the section [pair]']}
    """
    raw = copy.deepcopy(document.raw)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            outside = list(files_outside(raw, place))
            if outside:
                return Checked(None, tuple(outside))
            refuse_long_lists(raw)
            scene = validated(raw, read_flank_files(raw, place.folder))
            refuse(scene)
        except InputError as error:
            return Checked(None, tuple(map(_half_typed, error.faults)))
        except (SolverError, ArithmeticError, ValueError) as error:
            return Checked(None, (Fault("", "", str(error) or type(error).__name__),))
    return Checked(scene, (), tuple(dict.fromkeys(str(warning.message) for warning in caught)))


def _half_typed(fault: Fault) -> Fault:
    """Fault of a number that is half typed, as one of a number."""
    about = form_keys().get(fault.where)
    if about is None or about.kind != NUMBER or not fault.remedy.startswith(QUOTES):
        return fault
    return replace(fault, remedy=f"Such as {about.example or about.default or 1}")


def files_outside(raw: Any, place: Place, path: str = "") -> Iterator[Fault]:
    """Fault for each file that a scene names outside the place.

    Parameters
    ----------
    raw : object
        Keys of the scene as read, or a part of them.
    place : Place
    path : str
        Key of the part.
    """
    if isinstance(raw, list):
        for entry in raw:
            yield from files_outside(entry, place, path)
    elif isinstance(raw, Mapping):
        for key, value in raw.items():
            here = f"{path}.{key}".lstrip(".")
            if key == "file" and isinstance(value, str):
                try:
                    place.inside(value)
                except InputError as error:
                    for fault in error.faults:
                        yield Fault(here, fault.value, fault.allowed, fault.remedy)
            else:
                yield from files_outside(value, place, here)
