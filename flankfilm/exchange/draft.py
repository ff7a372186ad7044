"""A scene as far as a file of gear data says it, written with what the file lacks left open."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel

from base import Fault
from flankfilm.scene.explain import model_in
from flankfilm.scene.sections.gears import PairSection
from flankfilm.scene.sections.materials import MaterialSection
from flankfilm.scene.toml import remarked, toml

OPEN = math.nan
"""Stands for a value that the file lacks: no scene takes it, so that it cannot be overlooked."""

GEARS = ("pinion", "wheel")


@dataclass(frozen=True)
class Draft:
    """What a file says of a pair, by the keys of a scene and in its units.

    Attributes
    ----------
    title, source : str
        Title of the scene; what it was read from.
    names : (str, str)
        What the file calls pinion and wheel.
    pair, material : dict
        Keys of the two sections; `OPEN` where the file lacks what a scene needs, None where the scene's default stands
        for it. The material is empty where it is not given for both gears.
    notes : list of str
        What was left out, and what the scene's defaults stand for.
    """

    title: str
    source: str
    names: tuple[str, str]
    pair: dict[str, Any] = field(default_factory=lambda: {name: {} for name in GEARS})
    material: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def lacking(self) -> tuple[Fault, ...]:
        """Faults for the keys that a scene needs and the file does not give."""
        named = "Give it, or name the rack: --rack A"
        remedies = {"pair.rack.h_fP": named, "pair.rack.rho_fP": named}
        return tuple(
            Fault(key, "", f"is not in {self.source}", remedies.get(key, "Give it in the scene"))
            for key in _open_keys(self.pair, "pair")
        )


def _open_keys(value: Any, path: str) -> Iterator[str]:
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _open_keys(inner, f"{path}.{key}")
    elif isinstance(value, float) and math.isnan(value):
        yield path


def scene_text(draft: Draft) -> str:
    """Write the draft as a commented scene; open values are written as nan, which a scene refuses."""
    lines = [
        f"# From {_comment(draft.source)}",
        *(f"# {_comment(note)}" for note in draft.notes),
        f"title = {toml(draft.title[:200])}",
        *remarked('wants = ["geometry"]', 'more need [operating]: see "flankfilm new"'),
        *_section("pair", draft.pair, PairSection, draft.names),
    ]
    if draft.material:
        lines += _section("material", draft.material, MaterialSection, draft.names)
    else:
        lines += ["", *remarked("# [material]", "not in the file, or only for one gear")]
    lines += ["", "# [operating]", "# pinion_torque_Nm =", "# pinion_speed_rpm =", ""]
    return "\n".join(lines)


def _section(
    name: str, values: Mapping[str, Any], model: type[BaseModel], names: tuple[str, str]
) -> Iterator[str]:
    """A section with its own keys, then those of each gear."""
    own = {key: value for key, value in values.items() if key not in GEARS}
    if own:
        yield from ("", f"[{name}]", *_keys(own, model))
    for gear, called in zip(GEARS, names, strict=True):
        inner = model_in(model.model_fields[gear].annotation)
        if gear in values and inner is not None:
            head = f"{f'[{name}.{gear}]':<33}  # {_comment(called)}"
            yield from ("", head, *_keys(values[gear], inner))


def _keys(values: Mapping[str, Any], model: type[BaseModel]) -> Iterator[str]:
    """Keys with their meanings; behind a comment sign, with its default, what the file lacks."""
    for key, value in values.items():
        about = model.model_fields[key]
        meaning = about.description or ""
        if value is None:
            default = "" if about.default is None else toml(about.default)
            yield from remarked(f"# {key} = {default}", f"not in the file: {meaning}")
        else:
            remark = "NOT IN THE FILE: give it" if any(_open_keys(value, key)) else meaning
            yield from remarked(f"{key} = {toml(value)}", remark)


def _comment(text: str) -> str:
    """Text that cannot leave the comment that it stands in."""
    return "".join(c if c.isprintable() else " " for c in text)[:300]
