"""Where the gears stand when one pair of teeth touches at a given point of the path of contact."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from base import Array, quantity, record
from base.results import EXACT
from gears.tooth.rotation import turned

if TYPE_CHECKING:
    from gears.pair.pair_geometry import PairGeometry


@record
class Placement:
    """A mesh position in the common frame.

    The pinion's axis is the origin, the wheel's axis stands above it at (0, a). The pinion drives
    anticlockwise, so on **both** gears the loaded flank is the left-hand one of the tooth's own frame, the
    mirror image (x -> -x) of the right-hand flank that `ToothProfile` gives. Angles turn anticlockwise; they
    bring a tooth's own frame (centre line +y) into the common frame, for the tooth in contact: the next tooth
    of the pinion to come into contact has pinion_angle - 2 pi / z1, that of the wheel wheel_angle + 2 pi / z2.
    """

    no_error = EXACT

    pinion_angle: float = quantity("rad", "turn of the pinion's tooth", shown="deg")
    wheel_angle: float = quantity("rad", "turn of the wheel's tooth", shown="deg")
    wheel_centre: Array = quantity("m", "the wheel's axis", "coordinate", shown="mm")
    contact_point: Array = quantity("m", "point of contact", "coordinate", shown="mm")
    normal: Array = quantity(
        "1", "unit normal of the contact, outward from the pinion, along the force on the wheel", "coordinate"
    )

    def pinion(self, points: Array) -> Array:
        """Points (n, 2) of the pinion's tooth frame in the common frame [m]."""
        return turned(points, self.pinion_angle)

    def wheel(self, points: Array) -> Array:
        """Points (n, 2) of the wheel's tooth frame in the common frame [m]."""
        return np.asarray(turned(points, self.wheel_angle) + self.wheel_centre)


def place(pair: PairGeometry, rho1: float) -> Placement:
    """Placement of the gears for a contact at curvature radius `rho1` of the pinion.

    The line of action leaves the pinion's base circle at r_b1 (sin alpha_w, cos alpha_w) in the direction
    (-cos alpha_w, sin alpha_w); the tooth of the pinion is turned by rho1 / r_b1 - psi_b1 - alpha_w, that of
    the wheel by pi + rho2 / r_b2 - psi_b2 - alpha_w.

    Parameters
    ----------
    pair : PairGeometry
        The gears.
    rho1 : float
        Curvature radius of the pinion's flank at the contact [m].

    Returns
    -------
    Placement
        Angles, contact point and normal.
    """
    path = pair.path_at(rho1)
    first, second = pair.teeth_profiles
    alpha = pair.working_pressure_angle
    sine, cosine = math.sin(alpha), math.cos(alpha)
    normal = np.array([-cosine, sine])
    return Placement(
        pinion_angle=float(path.rho1[0]) / first.base_radius - first.base_half_angle - alpha,
        wheel_angle=math.pi + float(path.rho2[0]) / second.base_radius - second.base_half_angle - alpha,
        wheel_centre=np.array([0.0, pair.working_centre_distance]),
        contact_point=first.base_radius * np.array([sine, cosine]) + path.rho1[0] * normal,
        normal=normal,
    )
