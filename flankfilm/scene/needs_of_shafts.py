"""Rules between [shafts] and other sections: what a drive train excludes, and what would count a shaft twice."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from base import Fault
from flankfilm.scene.needs_of_helix import helix_angle
from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.gears import GEARS
from flankfilm.scene.traits import given_keys
from flankfilm.scene.wants import MOTIONS

AXIAL = "axial_stiffness_N_per_m"


def faults_of_shafts(raw: Mapping[str, Any], listed: set[str]) -> Iterator[Fault]:
    """Faults for what does not go together with [shafts]; of the unchecked file, and of what it wants."""
    if "shafts" not in raw:
        return
    shafts, dynamics = _table(raw, "shafts"), _table(raw, "dynamics")
    if listed & set(MOTIONS) and "mean_force" in dynamics:
        allowed = "excludes the dimensionless form, which has no gears"
        yield Fault("[shafts]", "", allowed, "Give [dynamics] in physical units, or leave [shafts] out")
    bent = [gear for gear in GEARS if _table(shafts, gear).get("segments")]
    if listed & set(MOTIONS) and helix_angle(raw):
        yield from (fault for gear in bent for fault in _slides(gear, _table(shafts, gear).get("bearings")))
    for path, about, value in given_keys(raw, Scene):
        if about.traits.beside_shafts and value:
            yield Fault(path, "", about.traits.beside_shafts, "Leave it out")
        gears = {part for part in path.split(".") if part in GEARS} or {*GEARS}
        segments = " and ".join(f"shafts.{gear}.segments" for gear in bent if gear in gears)
        if about.traits.beside_segments and segments:
            allowed = f"{about.traits.beside_segments}, beside {segments}"
            yield Fault(path, f"{value}", allowed, "Leave one of them out")


def _slides(gear: str, bearings: Any) -> Iterator[Fault]:
    """Fault of a helical gear's shaft that nothing holds along its axis."""
    each = bearings if isinstance(bearings, list | tuple) else []
    if not any(isinstance(one, Mapping) and one.get(AXIAL) for one in each):
        allowed = "must hold the shaft along its axis: helical gears push along it"
        yield Fault(f"shafts.{gear}.bearings", "", allowed, f"Give {AXIAL} of one of the bearings")


def _table(raw: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    section = raw.get(name)
    return section if isinstance(section, dict) else {}
