"""Keys of curves over a flank, from root to tip, and the curves over curvature radii that they make."""

from __future__ import annotations

import math

import numpy as np

import gears
from base import Limit
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.point_sections import BETWEEN, Form, Numbers, PointsSection, points

POSITIONS = {
    "roll_deg": Limit(0.0, 180.0, "deg", "give roll angles from the start of the involute"),
    "diameter_mm": Limit.above(0.0, 2e4, "mm", "give diameters in millimetres"),
    "roll_length_mm": Limit(0.0, 2e4, "mm", "give lengths of roll, the curvature radii of the flank"),
}
"""Keys by one of which a curve says where its points are, and what they may be."""

EXCESS = Limit(-2000.0, 2000.0, "um", "check the unit: micrometres, positive for too much material")
DEPTH = Limit(0.0, 2000.0, "um", "wear removes material; give what is in excess as a profile")


class CurveSection(PointsSection):
    """What curves over a flank have in common: positions from root to tip."""

    positions = POSITIONS

    roll_deg: Numbers | None = points("roll angles of the points, rising", such_as=(10.0, 20.0, 28.0))
    diameter_mm: Numbers | None = points("or their diameters", such_as=(69.0, 73.0, 76.0))
    roll_length_mm: Numbers | None = points(
        "or their lengths of roll: curvature radii of the flank", such_as=(6.0, 12.0, 17.0)
    )
    form: Form = key(BETWEEN, "smooth")

    def radii(self, base_radius: float) -> tuple[float, ...]:
        """Curvature radii at the points [m], of a gear of a base radius [m]; nan below the base circle."""
        by = self.measured_by
        places = np.array(self.value(by))
        if by == "roll_deg":
            places = base_radius * places
        elif by == "diameter_mm":
            square = (0.5 * places) ** 2 - base_radius**2
            places = np.where(square >= 0.0, np.sqrt(np.maximum(square, 0.0)), np.nan)
        return tuple(places.tolist())

    def place(self, rho: float, base_radius: float) -> float:
        """Position as the section's key has it, of a curvature radius [m] on a gear of a base radius [m]."""
        if self.measured_by == "roll_deg":
            return math.degrees(rho / base_radius)
        return 2e3 * math.hypot(rho, base_radius) if self.measured_by == "diameter_mm" else 1e3 * rho


class ProfileSection(CurveSection):
    """Deviation of flanks from the involute, a curve through points."""

    values = ("material_um", EXCESS)

    material_um: Numbers | None = points(
        "deviation at each point, normal to the flank; positive: too much material",
        such_as=(0.0, 0.0, -10.0),
    )

    def profile(self, base_radius: float) -> gears.ProfileDeviation:
        """Deviation of a gear of a base radius [m], in SI."""
        return gears.ProfileDeviation(self.radii(base_radius), self.value("material_um"), self.form)


class DepthSection(CurveSection):
    """Depth of wear, a curve through points."""

    values = ("depth_um", DEPTH)

    depth_um: Numbers | None = points(
        "material worn off at each point, normal to the flank, at least 0", such_as=(12.0, 0.0, 5.0)
    )

    def worn(self, base_radius: float, factor: float) -> gears.WearDepth:
        """Depth of wear times a factor, of a gear of a base radius [m], in SI."""
        depth = factor * np.array(self.value("depth_um"))
        return gears.WearDepth(self.radii(base_radius), tuple(depth.tolist()), self.form)
