"""A scene as far as a file of gear data says it, written with what the file lacks left open."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from base import Fault
from flankfilm.scene.gears import GearSection, PairSection
from flankfilm.scene.section import Section
from flankfilm.scene.template import toml

OPEN = math.nan
"""Stands for a value that the file lacks: no scene takes it, so that it cannot be overlooked."""

Number = float | int


@dataclass
class GearDraft:
    """One gear, in the scene's units; None leaves the key to the scene's default."""

    name: str
    teeth: Number = OPEN
    profile_shift: float = OPEN
    tip_alteration: float | None = None
    bore_mm: float | None = None
    tip_chamfer_mm: float | None = None


@dataclass
class RackDraft:
    """The basic rack, in modules."""

    h_aP: float = 1.0
    h_fP: float = OPEN
    rho_fP: float = OPEN
    alpha_deg: float = OPEN


@dataclass(frozen=True)
class MaterialDraft:
    """Elastic constants of one gear, in the scene's units."""

    youngs_modulus_GPa: float
    poisson_ratio: float
    density_kg_per_m3: float | None


@dataclass
class Draft:
    """What a file says of a pair.

    Attributes
    ----------
    title, source : str
        Title of the scene; what it was read from.
    pinion, wheel : GearDraft
    rack : RackDraft
    module_mm, face_width_mm : float
    centre_distance_mm : float or None
    materials : tuple of MaterialDraft, or None
        Of pinion and wheel.
    notes : list of str
        What was left out, and what the scene's defaults stand for.
    """

    title: str
    source: str
    pinion: GearDraft
    wheel: GearDraft
    rack: RackDraft
    module_mm: float = OPEN
    face_width_mm: float = OPEN
    centre_distance_mm: float | None = None
    materials: tuple[MaterialDraft, MaterialDraft] | None = None
    notes: list[str] = field(default_factory=list)

    def lacking(self) -> tuple[Fault, ...]:
        """Faults for the keys that a scene needs and the file does not give."""
        own = {"pair.module_mm": self.module_mm, "pair.face_width_mm": self.face_width_mm}
        for role, gear in (("pinion", self.pinion), ("wheel", self.wheel)):
            own |= {f"pair.{role}.teeth": gear.teeth, f"pair.{role}.profile_shift": gear.profile_shift}
        own |= {f"pair.rack.{key}": value for key, value in vars(self.rack).items()}
        remedies = {
            "pair.rack.h_fP": "Give it, or name the rack: --rack A",
            "pair.rack.rho_fP": "Give it, or name the rack: --rack A",
        }
        return tuple(
            Fault(key, "", f"is not in {self.source}", remedies.get(key, "Give it in the scene"))
            for key, value in own.items()
            if math.isnan(value)
        )


def scene_text(draft: Draft) -> str:
    """Write the draft as a commented scene; open values are written as nan, which a scene refuses."""
    lines = [
        f"# From {_comment(draft.source)}",
        *(f"# {_comment(note)}" for note in draft.notes),
        f"title = {toml(draft.title[:200])}",
        'wants = ["geometry"]                # more need [operating]: see "flankfilm new"',
        "",
        "[pair]",
        _line("module_mm", draft.module_mm),
        _line("face_width_mm", draft.face_width_mm),
        f"rack = {toml(vars(draft.rack))}",
    ]
    if draft.centre_distance_mm is not None:
        lines.append(_line("centre_distance_mm", draft.centre_distance_mm, "the backlash follows"))
    else:
        lines.append(_absent("centre_distance_mm", PairSection))
    for role, gear in (("pinion", draft.pinion), ("wheel", draft.wheel)):
        lines += ["", f"{f'[pair.{role}]':<35}# {_comment(gear.name)}", *_gear_lines(gear)]
    lines += _material_lines(draft)
    lines += ["", "# [operating]", "# pinion_torque_Nm =", "# pinion_speed_rpm =", ""]
    return "\n".join(lines)


def _gear_lines(gear: GearDraft) -> list[str]:
    lines = [_line("teeth", gear.teeth), _line("profile_shift", gear.profile_shift)]
    for key in ("tip_alteration", "bore_mm", "tip_chamfer_mm"):
        value = getattr(gear, key)
        lines.append(_absent(key, GearSection) if value is None else _line(key, value))
    return lines


def _material_lines(draft: Draft) -> list[str]:
    if draft.materials is None:
        return ["", "# [material]                       # not in the file, or only for one gear"]
    first, second = draft.materials
    if first == second:
        return ["", "[material]", *_elastic_lines(first)]
    lines = []
    for role, material in (("pinion", first), ("wheel", second)):
        lines += ["", f"[material.{role}]", *_elastic_lines(material)]
    return lines


def _elastic_lines(material: MaterialDraft) -> list[str]:
    return [_line(key, value) for key, value in vars(material).items() if value is not None]


def _line(key: str, value: Number, remark: str = "") -> str:
    remark = "NOT IN THE FILE: give it" if math.isnan(value) else remark
    text = f"{key} = {toml(value)}"
    return f"{text:<35}# {remark}" if remark else text


def _absent(key: str, section: type[Section]) -> str:
    """A key that the file lacks, with its default and its meaning."""
    field = section.model_fields[key]
    value = "" if field.default is None else toml(field.default)
    return f"{f'# {key} = {value}':<35}# not in the file: {field.description}"


def _comment(text: str) -> str:
    """Text that cannot leave the comment that it stands in."""
    return "".join(c if c.isprintable() else " " for c in text)[:300]
