"""Spur-gear geometry, path of contact, load sharing and closed-form tooth deflection; loads numpy only."""

from gears import closed_form
from gears.deviations import GearDeviations, PitchDeviations, ProfileDeviation
from gears.errors import (
    Fault,
    GearsError,
    GeometryError,
    GeometryWarning,
    LoadSharingError,
    ModelRangeWarning,
)
from gears.gear import Gear, TipRelief
from gears.hertz import half_width, peak_pressure
from gears.load_sharing import LoadShare, independent_pairs, share_load
from gears.material import STEEL, Material, reduced_modulus
from gears.meshing import MeshingCheck, check_meshing
from gears.outline import outline
from gears.pair import GearPair
from gears.path import PathOfContact, PathPoints
from gears.placement import Placement
from gears.profile import ToothProfile
from gears.rack import ISO_53_A, BasicRack

__all__ = [
    "ISO_53_A",
    "STEEL",
    "BasicRack",
    "Fault",
    "Gear",
    "GearDeviations",
    "GearPair",
    "GearsError",
    "GeometryError",
    "GeometryWarning",
    "LoadShare",
    "LoadSharingError",
    "Material",
    "MeshingCheck",
    "ModelRangeWarning",
    "PathOfContact",
    "PathPoints",
    "PitchDeviations",
    "Placement",
    "ProfileDeviation",
    "TipRelief",
    "ToothProfile",
    "check_meshing",
    "closed_form",
    "half_width",
    "independent_pairs",
    "outline",
    "peak_pressure",
    "reduced_modulus",
    "share_load",
]
