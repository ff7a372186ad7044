"""Rules between [shafts] and other sections: what a drive train excludes, and what would count a shaft twice."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from base import Fault

MOVING = ("sweep", "diagram", "spectrum", "run-up", "dynamic-map")
"""Wants of motions, which need masses and springs in physical units beside shafts."""

GEARS = ("pinion", "wheel")
_HUB = ("radial_stiffness_N_per_m", "torsional_stiffness_Nm_per_rad")
_ALIGNMENT = ("in_plane_um", "out_of_plane_um")
_PORTRAITS = ("portraits_rpm", "portraits_frequency")


def faults_of_shafts(raw: Mapping[str, Any], listed: set[str]) -> Iterator[Fault]:
    """Faults for what does not go together with [shafts]; of the unchecked file, and of what it wants."""
    if "shafts" not in raw:
        return
    shafts, dynamics = _table(raw, "shafts"), _table(raw, "dynamics")
    moving = any(want in listed for want in MOVING)
    if moving and "mean_force" in dynamics:
        allowed = "excludes the dimensionless form, which has no gears"
        yield Fault("[shafts]", "", allowed, "Give [dynamics] in physical units, or leave [shafts] out")
    for name in _PORTRAITS:
        if dynamics.get(name):
            allowed = "is of the pair on rigid shafts, which [shafts] excludes"
            yield Fault(f"dynamics.{name}", "", allowed, "Leave it out")
    for gear in GEARS:
        if not _table(shafts, gear).get("segments"):
            continue
        hub = _table(_table(_table(raw, "pair"), gear), "hub")
        for name in _HUB:
            if name in hub:
                allowed = f"counts the shaft twice, beside shafts.{gear}.segments"
                yield Fault(f"pair.{gear}.hub.{name}", f"{hub[name]}", allowed, "Leave one of them out")
    bent = [f"shafts.{gear}.segments" for gear in GEARS if _table(shafts, gear).get("segments")]
    aligned = _table(raw, "alignment")
    for name in _ALIGNMENT:
        if bent and name in aligned:
            allowed = f"gives the alignment twice, beside {' and '.join(bent)}"
            yield Fault(f"alignment.{name}", f"{aligned[name]}", allowed, "Leave one of them out")


def _table(raw: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    section = raw.get(name)
    return section if isinstance(section, dict) else {}
