"""The helix on the reference cylinder, and the transverse section that it makes of a rack given in its normal section.

With beta on the reference cylinder and beta_b on the base cylinder

    sin beta_b = sin beta cos alpha_n
    sin alpha_t = sin alpha_n/cos beta_b,  cos alpha_t = cos alpha_n cos beta/cos beta_b,

so that all that a helix changes are factors cos beta and cos beta_b, and summands with sin beta: at beta = 0 they are 1
and 0 to the last bit, and a spur gear is the same formulas.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from base import Limit

LARGEST = math.radians(45.0)
"""Helix angle up to which gears are accepted [rad]."""

HELIX_ANGLE = Limit(
    -LARGEST,
    LARGEST,
    "rad",
    "give the angle on the reference cylinder in radians (20 deg is 0.349066), negative of a left-handed pinion",
)
"""What the helix angle of a pair may be."""


@dataclass(frozen=True)
class Helix:
    """Helix of a gear whose rack is given in the normal section; symbols of ISO 21771.

    Parameters
    ----------
    angle : float
        beta on the reference cylinder [rad]; its sign is the hand and changes no profile.
    normal_pressure_angle : float
        alpha_n of the rack [rad].

    References
    ----------
    ISO 21771:2007, Gears - Cylindrical involute gears and gear pairs - Concepts and geometry, clauses 4 and 5.

    Examples
    --------
    >>> helix = Helix(math.radians(10.0), math.radians(20.0))
    >>> [round(math.degrees(angle), 3) for angle in (helix.transverse_pressure_angle, helix.base_angle)]
    [20.284, 9.391]
    >>> Helix(0.0, math.radians(20.0)).transverse_pressure_angle == math.radians(20.0)
    True
    """

    angle: float  # beta, rad
    normal_pressure_angle: float  # alpha_n, rad

    @property
    def cosine(self) -> float:
        """Normal over transverse lengths on the reference cylinder, cos beta = m_n/m_t."""
        return math.cos(self.angle)

    @property
    def base_sine(self) -> float:
        """Return sin beta_b = sin beta cos alpha_n."""
        return math.sin(self.angle) * math.cos(self.normal_pressure_angle)

    @property
    def base_cosine(self) -> float:
        """Normal over transverse lengths in the base tangent plane, cos beta_b = p_bn/p_bt."""
        return math.sqrt((1.0 - self.base_sine) * (1.0 + self.base_sine))

    @property
    def base_tangent(self) -> float:
        """Return tan beta_b = tan beta cos alpha_t."""
        return self.base_sine / self.base_cosine

    @property
    def base_angle(self) -> float:
        """Helix angle on the base cylinder, beta_b [rad]."""
        return math.asin(self.base_sine)

    @property
    def transverse_sine(self) -> float:
        """Return sin alpha_t = sin alpha_n/cos beta_b."""
        return math.sin(self.normal_pressure_angle) / self.base_cosine

    @property
    def transverse_cosine(self) -> float:
        """Return cos alpha_t = cos alpha_n cos beta/cos beta_b."""
        return math.cos(self.normal_pressure_angle) * self.cosine / self.base_cosine

    @property
    def transverse_tangent(self) -> float:
        """Return tan alpha_t = tan alpha_n/cos beta."""
        return math.tan(self.normal_pressure_angle) / self.cosine

    @property
    def transverse_pressure_angle(self) -> float:
        """Transverse pressure angle alpha_t, alpha_n and what the helix adds [rad].

        tan(alpha_t - alpha_n) = tan alpha_n (1 - cos beta)/(cos beta + tan^2 alpha_n)
        """
        tangent = math.tan(self.normal_pressure_angle)
        opened = 2.0 * math.sin(0.5 * self.angle) ** 2
        return self.normal_pressure_angle + math.atan(tangent * opened / (self.cosine + tangent**2))

    def virtual_teeth(self, teeth: float) -> float:
        """Teeth of the spur gear that the normal section resembles, z_n = z/(cos^2 beta_b cos beta)."""
        return teeth / (self.base_cosine**2 * self.cosine)
