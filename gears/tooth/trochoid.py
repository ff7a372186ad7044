"""The fillet: envelope of the rack's tip arc as the rack rolls on the reference circle."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from base import Array
from gears.tooth.bisection import bisect
from gears.tooth.helix import Helix
from gears.tooth.involute import involute_function

# Below this roll angle of undercut the limit form of the intersection is more exact than a root search.
_SLIGHT_UNDERCUT = 1e-4


@dataclass(frozen=True)
class Trochoid:
    """Fillet on the right of a tooth whose centre line is +y, in the transverse section.

    The parameter t is the angle between the normal of the rack's tip arc and the gear's radius, in the normal section
    of the rack, where the arc is a circle. With the arc's centre at depth d below the pitch line, at e from the centre
    line of the rack's tooth, and c = cos(helix angle), its transverse section is the ellipse

        X = (e + rho sin t)/c,  Y = -(d + rho cos t),  dY/dX = c tan t .

    The common normal passes through the pitch point I, so that the rack stands at q = X + Y dY/dX =
    e/c - c d tan t + rho (1/c - c) sin t. With l = d/cos t + rho and w^2 = 1 - (1 - c^2) sin^2 t the contact is w l
    from I, and the rack turns about I by -dq/r, which gives the arc length

        ds/dt = w [rho/c + l (c d/cos^2 t - rho (1/c - c) cos t)/r],

    positive for racks and shifts that leave a tooth: the curve is regular and its radius grows monotonically with t.
    Without helix c = w = 1 to the last bit, and t is the angle to the gear's radius through I. Polar angles are
    measured from +y towards +x.

    Parameters
    ----------
    reference_radius : float
        r [m].
    depth : float
        Depth d of the arc's centre below the reference circle, h_fP - rho_fP - x in modules [m]; may be
        negative.
    arc_radius : float
        rho, radius of the rack's tip arc in the normal section [m].
    foot_angle : float
        Polar angle at which the fillet leaves the root circle [rad].
    end : float
        t at the form circle [rad].
    helix_angle : float
        On the reference cylinder [rad].
    """

    reference_radius: float  # r, m
    depth: float  # d, m
    arc_radius: float  # rho, m
    foot_angle: float  # rad
    end: float  # rad
    helix_angle: float = 0.0  # beta, rad

    @property
    def _cosine(self) -> float:
        """Cosine c of the helix angle."""
        return math.cos(self.helix_angle)

    @property
    def _stretch(self) -> float:
        """1/c - c, what the transverse section of the arc is longer by, over its radius."""
        return math.sin(self.helix_angle) * math.tan(self.helix_angle)

    def point(self, beta: Array) -> Array:
        """Points of the fillet, (n, 2) [m]."""
        across, up = self._contact(beta)
        turn = self._turn(beta)
        return np.stack(
            (across * np.cos(turn) + up * np.sin(turn), up * np.cos(turn) - across * np.sin(turn)), axis=-1
        )

    def normal(self, beta: Array) -> Array:
        """Outward unit normals, (n, 2)."""
        sine, cosine = np.sin(beta), np.cos(beta)
        flatter = 2.0 * math.sin(0.5 * self.helix_angle) ** 2 * sine * cosine
        # by which the normal of the ellipse is steeper than that of the circle
        lean = np.arctan2(flatter, cosine**2 + self._cosine * sine**2)
        angle = beta - lean + self._turn(beta)
        return np.stack((np.sin(angle), np.cos(angle)), axis=-1)

    def speed(self, beta: Array) -> Array:
        """Arc length per parameter, (n,) [m/rad]; the tangent is the normal turned a quarter anticlockwise."""
        cosine, c = np.cos(beta), self._cosine
        ratio = self.depth / self.reference_radius * c
        distance = self.depth / cosine + self.arc_radius
        longer = distance * self.arc_radius * self._stretch * cosine / self.reference_radius
        along = self.arc_radius * (1.0 / c + ratio / cosine**2) + ratio * self.depth / cosine**3 - longer
        return np.asarray(along * np.sqrt(self._shortening(beta)), dtype=float)

    def squared_radius(self, beta: Array) -> Array:
        """Squared distance from the gear's axis, (n,) [m^2]."""
        distance = self.depth / np.cos(beta) + self.arc_radius
        fall = self.depth + self.arc_radius * np.cos(beta)
        squared = distance**2 * self._shortening(beta)
        return np.asarray(self.reference_radius**2 - 2.0 * self.reference_radius * fall + squared)

    def polar_angle(self, beta: Array) -> Array:
        """Polar angle from the tooth's centre line, (n,) [rad]."""
        across, up = self._contact(beta)
        return np.asarray(np.arctan2(across, up) + self._turn(beta))

    def beta_at(self, radius: Array, highest: float) -> Array:
        """Parameter at which the curve has the given radii, between 0 and `highest`."""
        target = np.asarray(radius, dtype=float) ** 2
        highs = np.full_like(target, highest)
        return bisect(lambda beta: self.squared_radius(beta) < target, np.zeros_like(target), highs)

    def _shortening(self, beta: Array) -> Array:
        """w^2, squared distance from I to the contact over that without helix."""
        return np.asarray(1.0 - (math.sin(self.helix_angle) * np.sin(beta)) ** 2)

    def _contact(self, beta: Array) -> tuple[Array, Array]:
        """Where rack and gear touch, across and up from the gear's axis to the pitch point [m]."""
        distance = self.depth / np.cos(beta) + self.arc_radius
        across = -distance * np.sin(beta) * self._cosine
        return np.asarray(across), np.asarray(self.reference_radius - distance * np.cos(beta))

    def _turn(self, beta: Array) -> Array:
        along = self.depth * np.tan(beta) * self._cosine - self.arc_radius * self._stretch * np.sin(beta)
        return np.asarray(self.foot_angle + along / self.reference_radius)


def form_point(
    trochoid: Trochoid, base_radius: float, base_half_angle: float, helix: Helix
) -> tuple[float, float, bool] | None:
    """Where the fillet meets the involute.

    The rack's arc ends at t = pi/2 - alpha_n. There the straight flank takes over, and the involute starts
    at rho_F = r sin alpha_t - (d + rho sin alpha_n)/sin alpha_t. If rho_F < 0 the rack passes the base circle's tangent
    point and the trochoid cuts the involute at a higher point (undercut). With xi = -rho_F / r_b the cut
    tends to rho = -rho_F / 2 as xi -> 0 (the trochoid is then a straight line of slope xi across the
    involute's cusp, and 2 q^3 + 3 q^2 - 1 = (q + 1)^2 (2 q - 1) = 0); the polar angles differ by xi^3 there,
    so for xi below 1e-4 this limit is exact to rounding where a root search sees only rounding.

    Parameters
    ----------
    trochoid : Trochoid
        The fillet; its `end` is not used.
    base_radius : float
        r_b [m].
    base_half_angle : float
        Half-thickness angle of the tooth on the base circle [rad].
    helix : Helix
        With the pressure angles of the rack.

    Returns
    -------
    (t, rho, undercut) or None
        Parameter of the fillet's end [rad], curvature radius where the involute starts [m], whether the
        tooth is undercut; None if the undercut removes the whole involute.
    """
    corner = 0.5 * math.pi - helix.normal_pressure_angle
    distance = trochoid.depth / math.sin(helix.normal_pressure_angle) + trochoid.arc_radius
    rho = trochoid.reference_radius * helix.transverse_sine - distance * helix.base_cosine
    if rho >= 0.0:
        return corner, rho, False
    if -rho < _SLIGHT_UNDERCUT * base_radius:
        cut = -0.5 * rho
        radius = np.asarray(math.hypot(base_radius, cut))
        return float(trochoid.beta_at(radius, corner)), cut, True

    def excess(beta: Array) -> Array:
        """Polar angle of the trochoid beyond the involute at the same radius."""
        roll = np.sqrt(np.maximum(trochoid.squared_radius(beta) / base_radius**2 - 1.0, 0.0))
        return np.asarray(trochoid.polar_angle(beta) - base_half_angle + involute_function(roll))

    at_base = float(trochoid.beta_at(np.asarray(base_radius), corner))
    beta = np.linspace(at_base, corner, 65)
    sign = excess(beta) > 0.0
    crossings = np.flatnonzero(~sign[:-1] & sign[1:])
    if crossings.size == 0:
        return None
    last = crossings[-1]
    beta_cut = bisect(lambda beta: ~(excess(beta) > 0.0), beta[last], beta[last + 1])
    squared = float(trochoid.squared_radius(beta_cut)) - base_radius**2
    return float(beta_cut), math.sqrt(max(squared, 0.0)), True
