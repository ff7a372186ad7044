"""The scene as it stands: what an optimisation is held against, and where its keys are there."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from base import InputError
from flankfilm.scene.reader import validated
from flankfilm.scene.schema import Scene
from flankfilm.studies.study_file import RowsFile, Value

NOT_THERE = ""
"""Value of a key that the scene as it stands does not have, such as the relief of a tip that has none."""


@dataclass(frozen=True)
class Start:
    """The scene as it stands.

    Attributes
    ----------
    scene : mapping or None
        Its keys, with what the file sets; None where they make no scene.
    values : tuple
        Of the keys that vary or follow; `NOT_THERE` where the scene has none.
    fault : str
        Why they make no scene.
    """

    scene: Mapping[str, Any] | None
    values: tuple[Value, ...] = ()
    fault: str = ""


def start_of(scene: Mapping[str, Any], asked: RowsFile) -> Start:
    """Take the scene without the keys that vary.

    What the file sets beside a key that only its ranges bring, such as the length of a relief whose amount varies, goes
    too: the scene as it stands has no relief.

    Parameters
    ----------
    scene : mapping
        Keys as read, with what the file sets.
    asked : RowsFile
    """
    raw = deepcopy(dict(scene))
    keys = (*asked.vary, *asked.follow)
    brought = {_section(key) for key in keys if _at(raw, key) is None}
    for key in asked.set:
        if _section(key) in brought:
            _remove(raw, key)
    try:
        read = validated(raw)
    except InputError as fault:
        return Start(None, fault=" ".join(str(fault).split()))
    return Start(raw, tuple(_value(read, key) for key in keys))


def _section(key: str) -> str:
    return key.rpartition(".")[0]


def _at(raw: Mapping[str, Any], key: str) -> Any:
    here: Any = raw
    for name in key.split("."):
        here = here.get(name) if isinstance(here, Mapping) else None
    return here


def _remove(raw: dict[str, Any], key: str) -> None:
    """Take a key away, and the sections that held nothing else."""
    section, _, last = key.rpartition(".")
    here = _at(raw, section) if section else raw
    if isinstance(here, dict):
        here.pop(last, None)
        if section and not here:
            _remove(raw, section)


def _value(read: Scene, key: str) -> Value:
    """Value of a key of a scene, its default where none is given."""
    here: Any = read
    for name in key.split("."):
        here = getattr(here, name, None)
    return here if isinstance(here, int | float) and not isinstance(here, bool) else NOT_THERE
