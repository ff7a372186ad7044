"""A gear in modules and E*: all that decides its flexibility, and nothing else.

In lengths over the module and stresses over E* the plane problem of a gear knows its shape, the radius at which it is
held and nu* alone: neither module nor modulus, face width, load or mate. A displacement per line load, u E*, is a
number of the shape; logarithms count lengths in modules.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, is_dataclass, replace
from functools import partial
from math import ceil
from typing import TYPE_CHECKING, Any, Final, Literal, TypeAlias

from fem.elasticity.plane_elasticity import PlaneElasticity
from gears import BasicRack, Blank, Gear
from gears.tooth.face import STRAIGHT

if TYPE_CHECKING:
    from gears import GearPair, ToothProfile
    from meshes import Sizes

__all__ = ["COARSE", "FINE", "GearShape", "MeshLevel", "MeshedShape", "plain", "rounded", "shapes"]

MeshLevel: TypeAlias = Literal["fine", "coarse"]
"""Which of the two nested meshes of a gear: what errs by the mesh is what FINE and COARSE differ by, over the gain.

Answers are those of FINE, the mesh in use. COARSE is the one before its last refinement; its answers are in errors
alone, and in corrections so small that their error is none of the answer's."""

FINE: Final = "fine"
COARSE: Final = "coarse"

DIGITS = 12
"""Of lengths over the module: gears that differ in size alone have the same numbers, whatever the last bits are."""


@dataclass(frozen=True)
class GearShape:
    """One gear, free of size and modulus.

    Attributes
    ----------
    gear : gears.Gear
        All lengths in modules, the bore where the gear is held, the web's thickness in face widths; without relief,
        lead and face width, which no mesh shows.
    rack : gears.BasicRack
    poisson : float
        nu*, in which plane strain and plane stress are one.
    helix_angle : float
        Size of beta on the reference cylinder, whatever the hand [rad]: the shape is that of the transverse section.
    """

    gear: Gear
    rack: BasicRack
    poisson: float
    helix_angle: float = 0.0

    @property
    def profile(self) -> ToothProfile:
        """Tooth of (normal) module 1."""
        from gears.tooth.profile import generate

        tooth = generate(self.gear, 1.0, self.rack, 1.0, self.helix_angle)
        assert tooth is not None  # the pair that it comes from has teeth
        return tooth

    @property
    def law(self) -> PlaneElasticity:
        """Elasticity with E* = 1."""
        return PlaneElasticity("stress", 1.0, self.poisson)

    @property
    def reach(self) -> int:
        """Neighbours that may be in contact together with a tooth, whatever the mate."""
        low, high = self.profile.flank_rho
        base_pitch = self.profile.pitch_angle * self.profile.base_radius
        return ceil((high - low) / base_pitch) + 1


@dataclass(frozen=True)
class MeshedShape:
    """A gear's shape and the mesh in use, which is solved together with the one that it refines (`MeshLevel`).

    Attributes
    ----------
    shape : GearShape
    sizes : meshes.Sizes
        Before the mesh is refined.
    refinements : int
    """

    shape: GearShape
    sizes: Sizes
    refinements: int


def rounded(length: float) -> float:
    """Length over the module or the face width, by which what is solved is known."""
    return float(f"{length:.{DIGITS}g}")


def plain(part: Any) -> Any:
    """Turn what decides a record, nested records and numbers, into what keys of caches are made of."""
    if is_dataclass(part):
        return {field.name: plain(getattr(part, field.name)) for field in fields(part)}
    if isinstance(part, tuple):
        return [plain(inner) for inner in part]
    return part if part is None or isinstance(part, str) else float(part)


def shapes(
    pair: GearPair, profiles: tuple[ToothProfile, ToothProfile], plane: str
) -> tuple[GearShape, GearShape]:
    """Pinion and wheel of a pair, each held at the bore of its profile.

    Parameters
    ----------
    pair : gears.GearPair
    profiles : (gears.ToothProfile, gears.ToothProfile)
        Whose bores are where the gears are held.
    plane : {"strain", "stress"}
    """

    def over(unit: float, length: float) -> float:
        return rounded(length / unit)

    modules = partial(over, pair.module)

    def scaled(blank: Blank, width: float) -> Blank:
        hub = None if blank.hub_radius is None else modules(blank.hub_radius)
        return Blank(modules(blank.rim_thickness), over(width, blank.web_thickness), hub)

    first, second = (
        GearShape(
            replace(
                gear,
                bore_radius=modules(profile.bore_radius),
                thickness_allowance=modules(gear.thickness_allowance),
                tip_chamfer=modules(gear.tip_chamfer),
                tip_relief=None,
                lead=STRAIGHT,
                face_width=None,
                face_offset=0.0,
                blank=scaled(gear.blank, width) if gear.blank is not None and profile.steps else None,
            ),
            pair.rack,
            PlaneElasticity.of(material, plane).plane_poisson,
            rounded(abs(pair.helix_angle)),
        )
        for gear, width, profile, material in zip(
            (pair.pinion, pair.wheel), pair.face_widths, profiles, pair.materials, strict=True
        )
    )
    return first, second
