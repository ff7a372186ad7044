"""What a scene cannot give of a helical pair: one table, of which a row goes when its model takes a helix.

Helical pairs have every want. `KEYS_OF_SPUR` lists keys, each with the wants beside which it is refused: any, those of
loaded teeth, or single ones.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

from base import Fault, InputError, shorten
from flankfilm.scene.traits import given_keys, named
from flankfilm.scene.wants import RATED, UNLOADED, WANTS

if TYPE_CHECKING:
    from flankfilm.scene.schema import Scene

__all__ = ["HELIX", "KEYS_OF_SPUR", "faults_of_helix", "helix_angle", "refuse_helix", "wants_load"]

HELIX = "pair.helix_angle_deg"
"""Key of the helix."""


def _anything(value: Any) -> bool:
    """Whether a key is given at all: a number or a text that is not 0, or a table."""
    return isinstance(value, Mapping) or bool(value)


def _other_than(*words: Any) -> Callable[[Any], bool]:
    return lambda value: value not in words


ANY = frozenset(WANTS)
"""All wants."""

LOADED = ANY - UNLOADED - {"closed-forms", *RATED}
"""Wants of loaded teeth, beyond sizes and standards' formulas."""


@dataclass(frozen=True)
class SpurKey:
    """Key, or several by a pattern, that only a spur pair may have.

    Attributes
    ----------
    path : str
        Dotted; ``*`` stands for either gear.
    missing : str
        What there is not of helical pairs.
    allowed, remedy : str
        What must hold, and what to do, beside taking a spur pair.
    refuses : callable
        Whether a given value is refused.
    beside : frozenset of str
        Wants beside which it is refused; those of loaded teeth unless given.
    unless : str
        Key with which it is not refused where that is given as true; none unless given.
    """

    path: str
    missing: str
    allowed: str = "must be left out"
    remedy: str = "Leave it out"
    refuses: Callable[[Any], bool] = _anything
    beside: frozenset[str] = LOADED
    unless: str = ""


KEYS_OF_SPUR: tuple[SpurKey, ...] = (
    # what asks for a model of spur teeth, whatever is wanted
    SpurKey(
        "stiffness.model",
        "closed forms of single pairs",
        'must be "fem"',
        'Leave it out: the wanted "closed-forms" gives ISO 6336',
        _other_than("fem", "auto", "given"),
        beside=ANY,
    ),
    SpurKey(
        "stiffness.pairs",
        "pairs of teeth that bear independently",
        'must be "coupled"',
        'Take "coupled"',
        _other_than("coupled"),
        beside=ANY,
    ),
    SpurKey("stiffness.moving_contact", "contacts that the deflection moves", "must be false", beside=ANY),
    # what loaded teeth on oblique lines do not know
    SpurKey(
        "operating.friction",
        "friction that moves gears of six freedoms",
        "must be 0",
        beside=frozenset({"bearing-forces"}),
    ),
    SpurKey(
        "stiffness.plane",
        "plane stress of twisted teeth",
        'must be "strain"',
        'Take "strain"',
        _other_than("strain"),
    ),
    SpurKey("pair.tight", "twisted teeth that bear on both sides", "must be false", "Give more backlash"),
    SpurKey("pair.*.blank", "webs of twisted bodies"),
    SpurKey(
        "pair.*.tip_rounding_um",
        "rounded tip edges where contact is held to the path",
        "must be 0",
        "Give contact_beyond_path = true in [stiffness]",
        unless="stiffness.contact_beyond_path",
    ),
)
"""Keys, each with what is missing for a helical pair."""


def faults_of_helix(raw: Mapping[str, Any], listed: set[str]) -> Iterator[Fault]:
    """Faults of a helical pair for what only spur pairs have; of the unchecked file, and of what it wants."""
    angle = helix_angle(raw)
    if not angle:
        return
    lacking = f"at {HELIX} = {angle:g}: helical pairs have no"
    for path, value, row in _given(raw):
        if row.beside & listed and row.refuses(value):
            remedy = f"{row.remedy}, or give {HELIX} = 0"
            yield Fault(named(path), _shown(value), f"{row.allowed} {lacking} {row.missing}", remedy)


def _shown(value: Any) -> str:
    """Value as a file has it; nothing of a section, nor of several in a list."""
    if isinstance(value, Mapping | list | tuple):
        return ""
    return str(value).lower() if isinstance(value, bool) else shorten(value)


def wants_load(wants: Iterable[str]) -> bool:
    """Whether loaded teeth are wanted, beyond sizes and standards' formulas."""
    return not LOADED.isdisjoint(wants)


def helix_angle(raw: Mapping[str, Any]) -> float:
    """Helix angle of an unchecked scene [deg]; 0 where there is none, or no number."""
    pair = raw.get("pair")
    angle = pair.get("helix_angle_deg") if isinstance(pair, Mapping) else None
    known = isinstance(angle, int | float) and not isinstance(angle, bool) and math.isfinite(angle)
    return float(angle) if known and angle is not None else 0.0


def _given(raw: Mapping[str, Any]) -> Iterator[tuple[str, Any, SpurKey]]:
    """Keys of the table that a scene gives, each with its value and its row."""
    from flankfilm.scene.schema import Scene

    values = {path: value for path, _, value in given_keys(raw, Scene)}
    for row in KEYS_OF_SPUR:
        if values.get(row.unless) is True:
            continue
        paths = [
            path for path in values if path.count(".") == row.path.count(".") and fnmatchcase(path, row.path)
        ]
        yield from ((path, values[path], row) for path in paths)


def refuse_helix(scene: Scene, what: str) -> None:
    """Refuse the helix of a scene where `what`, in words, knows spur pairs alone.

    Raises
    ------
    InputError
        Of a helical pair, under the scene's key.
    """
    if scene.pair is not None and scene.pair.helical:
        value = f"{scene.pair.helix_angle_deg:g}"
        raise InputError.at(HELIX, value, f"must be 0 for {what}, made for spur pairs", f"Give {HELIX} = 0")
