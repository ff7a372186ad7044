"""Names and units of the REXS attributes that a pair of cylindrical gears has, for reading and for writing.

Values are in the scene's units: millimetres, degrees, GPa, kg/m3, coefficients times the module.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Unit:
    """What a kind of attribute is measured in.

    Attributes
    ----------
    written : str
        As files are written here.
    scales : mapping of str to float
        Spelling without blanks to the value of one in the scene's unit.
    """

    written: str
    scales: Mapping[str, float]

    def __str__(self) -> str:
        """Spellings that are read."""
        return " or ".join(spelling for spelling in self.scales if spelling)


LENGTH = Unit("mm", {"mm": 1.0, "mum": 1e-3})
ANGLE = Unit("deg", {"deg": 1.0, "°": 1.0, "rad": 180.0 / math.pi})
PURE = Unit("none", {"": 1.0, "none": 1.0})
MODULUS = Unit("N / mm^2", {"N/mm^2": 1e-3, "MPa": 1e-3})  # GPa
DENSITY = Unit("kg / dm^3", {"kg/dm^3": 1e3})  # kg/m3


@dataclass(frozen=True, eq=False)
class Attribute:
    """One attribute: its id in the standard, and what it is measured in."""

    name: str
    unit: Unit

    def text(self, value: float | str) -> str:
        """Value, in the scene's unit, as it is written."""
        if not isinstance(value, float):
            return str(value)
        scale = self.unit.scales[self.unit.written.replace(" ", "")]
        return repr(float(f"{value / scale:.14g}"))


CENTRE_DISTANCE = Attribute("center_distance", LENGTH)
COMMON_FACE_WIDTH = Attribute("common_face_width", LENGTH)
IS_DRIVING = Attribute("is_driving_gear", PURE)
MODULE = Attribute("normal_module", LENGTH)
PRESSURE_ANGLE = Attribute("normal_pressure_angle", ANGLE)

TEETH = Attribute("number_of_teeth", PURE)
HELIX_ANGLE = Attribute("helix_angle_reference_diameter", ANGLE)
"""Of each gear; its sign is the hand, above 0 right, so that the gears of an external pair have opposite signs."""

TRANSVERSE_MODULE = Attribute("transverse_module", LENGTH)
TRANSVERSE_PRESSURE_ANGLE = Attribute("pressure_angle_in_the_transverse_section", ANGLE)
REFERENCE_DIAMETER = Attribute("reference_circle_diameter", LENGTH)
BASE_HELIX_ANGLE = (
    Attribute("helix_angle_base_circle", ANGLE),
    Attribute("helix_angle_base_diameter", ANGLE),  # the name of version 2.0
)
FACE_WIDTH = Attribute("face_width", LENGTH)
TIP_DIAMETER = Attribute("tip_diameter", LENGTH)
ROOT_DIAMETER = Attribute("root_diameter", LENGTH)
BORE_DIAMETER = Attribute("inner_diameter", LENGTH)

PROFILE_SHIFT = Attribute("addendum_modification_coefficient", PURE)
PROFILE_SHIFT_LENGTH = Attribute("addendum_modification", LENGTH)
GENERATED_SHIFT = Attribute("generated_addendum_modification_coefficient", PURE)
RACK_ADDENDUM = Attribute("addendum_coefficient_basic_profile", PURE)
TIP_CHAMFER = Attribute("tooth_tip_chamfer", LENGTH)
ALLOWANCES = (Attribute("machining_allowance", LENGTH), Attribute("grinding_allowance", LENGTH))

TOOL_ADDENDUM = (
    Attribute("addendum_coefficient_reference_profile", PURE),
    Attribute("addendum_reference_profile", LENGTH),
)
"""Of the tool, which is the dedendum of the basic rack; the first is the one written."""

TOOL_TIP_RADIUS = (
    Attribute("tip_radius_factor", PURE),
    Attribute("tip_radius", LENGTH),
    Attribute("tip_corner_radius_factor_reference_profile", PURE),  # the names of version 2.0
    Attribute("tip_corner_radius_reference_profile", LENGTH),
)

PROTUBERANCE = (
    Attribute("protuberance_amount", LENGTH),
    Attribute("protuberance_amount_factor", PURE),
    Attribute("machining_allowance_din_3972", LENGTH),
    Attribute("relative_machining_allowance_din_3972", PURE),
    Attribute("machining_allowance_din_3972_1952", LENGTH),
    Attribute("relative_machining_allowance_din_3972_1952", PURE),
)

MATERIAL = {
    "youngs_modulus_GPa": Attribute("elastic_modulus", MODULUS),
    "poisson_ratio": Attribute("poisson_ratio", PURE),
    "density_kg_per_m3": Attribute("density", DENSITY),
}
"""By the scene's keys; the density may be missing."""
