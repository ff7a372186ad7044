"""The fillet: envelope of the rack's tip arc as the rack rolls on the reference circle."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from base import Array
from gears.tooth.bisection import bisect
from gears.tooth.involute import involute_function

# Below this roll angle of undercut the limit form of the intersection is more exact than a root search.
_SLIGHT_UNDERCUT = 1e-4


@dataclass(frozen=True)
class Trochoid:
    """Fillet on the right of a tooth whose centre line is +y.

    The parameter is the angle beta between the normal of the rack's tip arc and the gear's radius through the
    pitch point I. The common normal passes through I, so with the arc's centre at depth d below the pitch
    line the rack stands at -d tan beta and the contact lies at l = d / cos beta + rho from I. The rack then
    turns about I by d beta + d dbeta / (r cos^2 beta) relative to the gear, which gives the arc length
    ds/dbeta = rho (1 + d / (r cos^2 beta)) + d^2 / (r cos^3 beta), positive for every rack and shift: the
    curve is regular and its radius grows monotonically with beta. Polar angles are measured from +y towards
    +x.

    Parameters
    ----------
    reference_radius : float
        r [m].
    depth : float
        Depth d of the arc's centre below the reference circle, h_fP - rho_fP - x in modules [m]; may be
        negative.
    arc_radius : float
        rho, radius of the rack's tip arc [m].
    foot_angle : float
        Polar angle at which the fillet leaves the root circle [rad].
    end : float
        beta at the form circle [rad].
    """

    reference_radius: float  # r, m
    depth: float  # d, m
    arc_radius: float  # rho, m
    foot_angle: float  # rad
    end: float  # rad

    def point(self, beta: Array) -> Array:
        """Points of the fillet, (n, 2) [m]."""
        across, up = self._contact(beta)
        turn = self._turn(beta)
        return np.stack(
            (across * np.cos(turn) + up * np.sin(turn), up * np.cos(turn) - across * np.sin(turn)), axis=-1
        )

    def normal(self, beta: Array) -> Array:
        """Outward unit normals, (n, 2)."""
        angle = beta + self._turn(beta)
        return np.stack((np.sin(angle), np.cos(angle)), axis=-1)

    def speed(self, beta: Array) -> Array:
        """Arc length per beta, (n,) [m/rad]; the tangent is the normal turned a quarter anticlockwise."""
        cosine = np.cos(beta)
        ratio = self.depth / self.reference_radius
        return np.asarray(
            self.arc_radius * (1.0 + ratio / cosine**2) + ratio * self.depth / cosine**3, dtype=float
        )

    def squared_radius(self, beta: Array) -> Array:
        """Squared distance from the gear's axis, (n,) [m^2]."""
        distance = self.depth / np.cos(beta) + self.arc_radius
        fall = self.depth + self.arc_radius * np.cos(beta)
        return np.asarray(self.reference_radius**2 - 2.0 * self.reference_radius * fall + distance**2)

    def polar_angle(self, beta: Array) -> Array:
        """Polar angle from the tooth's centre line, (n,) [rad]."""
        across, up = self._contact(beta)
        return np.asarray(np.arctan2(across, up) + self._turn(beta))

    def beta_at(self, radius: Array, highest: float) -> Array:
        """Parameter at which the curve has the given radii, between 0 and `highest`."""
        target = np.asarray(radius, dtype=float) ** 2
        highs = np.full_like(target, highest)
        return bisect(lambda beta: self.squared_radius(beta) < target, np.zeros_like(target), highs)

    def _contact(self, beta: Array) -> tuple[Array, Array]:
        """Where rack and gear touch, across and up from the gear's axis to the pitch point [m]."""
        distance = self.depth / np.cos(beta) + self.arc_radius
        across = -distance * np.sin(beta)
        return np.asarray(across), np.asarray(self.reference_radius - distance * np.cos(beta))

    def _turn(self, beta: Array) -> Array:
        return np.asarray(self.foot_angle + self.depth * np.tan(beta) / self.reference_radius)


def form_point(
    trochoid: Trochoid, base_radius: float, base_half_angle: float, pressure_angle: float
) -> tuple[float, float, bool] | None:
    """Where the fillet meets the involute.

    The rack's arc ends at beta = pi/2 - alpha. There the straight flank takes over, and the involute starts
    at rho_F = r sin alpha - (d / sin alpha + rho). If rho_F < 0 the rack passes the base circle's tangent
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
    pressure_angle : float
        alpha of the rack [rad].

    Returns
    -------
    (beta, rho, undercut) or None
        Parameter of the fillet's end [rad], curvature radius where the involute starts [m], whether the
        tooth is undercut; None if the undercut removes the whole involute.
    """
    corner = 0.5 * math.pi - pressure_angle
    distance = trochoid.depth / math.sin(pressure_angle) + trochoid.arc_radius
    rho = trochoid.reference_radius * math.sin(pressure_angle) - distance
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
