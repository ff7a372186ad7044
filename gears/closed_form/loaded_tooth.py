"""A tooth under a normal load: load geometry, and integrals over its true sections."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from base import Array, Faults, RangeWarning
from gears.pair.gear_pair import GearPair
from gears.pair.path import PathOfContact
from gears.pair.spur_only import require_spur
from gears.tooth.bisection import bisect
from gears.tooth.errors import GeometryError
from gears.tooth.material import Material
from gears.tooth.profile import ToothProfile

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)


@dataclass(frozen=True, eq=False)
class LoadedTooth:
    """One tooth with loads at n points of its right-hand flank.

    Parameters
    ----------
    profile : ToothProfile
        The tooth.
    material : Material
        Its material.
    rho : (n,) array
        Curvature radii of the loaded points [m].
    """

    profile: ToothProfile
    material: Material
    rho: Array

    @property
    def radius(self) -> Array:
        """Distance of the load from the axis r_x, (n,) [m]."""
        return np.hypot(self.rho, self.profile.base_radius)

    @property
    def half_angle(self) -> Array:
        """Half-thickness angle at the load gamma_x, (n,) [rad]."""
        return self.profile.half_angle(self.radius)

    @property
    def load_angle(self) -> Array:
        """Angle omega_x between the load and the normal to the tooth's centre line, (n,) [rad]."""
        return np.asarray(self.rho / self.profile.base_radius - self.profile.base_half_angle)

    @property
    def crossing(self) -> Array:
        """Height at which the load's line crosses the centre line, r_b / cos omega_x, (n,) [m]."""
        return np.asarray(self.profile.base_radius / np.cos(self.load_angle))

    @property
    def depth(self) -> Array:
        """Distance from the loaded point along the load's line to the centre line, (n,) [m]."""
        return np.asarray(self.profile.involute(self.rho)[..., 0] / np.cos(self.load_angle))

    @property
    def root_section(self) -> tuple[float, float]:
        """Height and full width of the chord between the feet of the fillets [m]."""
        angle, root = self.profile.root_half_angle, self.profile.root_radius
        return root * math.cos(angle), 2.0 * root * math.sin(angle)

    def integrate(self, integrand: Callable[[Array, Array], Array], top: Array) -> Array:
        """Integrate over the height of the tooth's true profile, from the root section upwards.

        Gauss-Legendre quadrature in the parameters of fillet and involute, in which the profile is analytic.

        Parameters
        ----------
        integrand : callable
            Of height y and half width x, both (n, nodes) [m].
        top : (n,) array
            Height at which the integral ends [m].

        Returns
        -------
        (n,) array
            The integral.
        """
        curve, start = self.profile.fillet_curve, self.profile.flank_rho[0]
        base = self.profile.base_radius
        beta, per_beta = _nodes(0.0, _parameter_at(curve.point, top, 0.0, curve.end))
        end = self.profile.flank_rho[1]
        rho, per_rho = _nodes(start, _parameter_at(self.profile.involute, top, start, end))
        total = np.zeros_like(top)
        for points, rise in (
            (curve.point(beta), per_beta * curve.speed(beta) * curve.normal(beta)[..., 0]),
            (self.profile.involute(rho), per_rho * rho / base * self.profile.normal(rho)[..., 0]),
        ):
            total = total + (integrand(points[..., 1], points[..., 0]) * rise).sum(axis=-1)
        return np.asarray(total)


def _nodes(low: float, high: Array) -> tuple[Array, Array]:
    half = 0.5 * (high - low)[..., None]
    return np.asarray(low + half * (1.0 + _NODES)), np.asarray(half * _WEIGHTS)


def _parameter_at(curve: Callable[[Array], Array], top: Array, low: float, high: float) -> Array:
    """Parameter at which a rising curve of points reaches the height `top`, kept within its ends."""
    ends = np.full_like(top, low), np.full_like(top, high)
    return bisect(lambda parameter: curve(parameter)[..., 1] < top, *ends)


def loaded_teeth(pair: GearPair, path: PathOfContact) -> tuple[LoadedTooth, LoadedTooth]:
    """Teeth of pinion and wheel with the loads of a path of contact.

    Raises
    ------
    GeometryError
        If a point of the path is not on both involutes, or the pair is helical.

    Warns
    -----
    RangeWarning
        For a gear on a web: the formulas know bodies as wide as the face.
    """
    require_spur(pair, "closed forms of the deflection")
    webs = [
        f"the {name}'s body is taken as a disc, without its web of {profile.zones[1].thickness:.3g} face widths"
        for name, profile in zip(("pinion", "wheel"), pair.teeth_profiles, strict=True)
        if profile.steps
    ]
    if webs:
        warnings.warn("closed form: " + "; ".join(webs), RangeWarning, stacklevel=3)
    teeth = []
    with Faults(GeometryError) as faults:
        for name, profile, material, rho in zip(
            ("rho1", "rho2"), pair.teeth_profiles, pair.materials, (path.rho1, path.rho2), strict=True
        ):
            low, high = profile.flank_rho
            slack = 1e-9 * profile.module
            if not np.all((rho >= low - slack) & (rho <= high + slack)):
                allowed = f"must be at least {low:.6g} and at most {high:.6g} m, the flank"
                value = f"{np.min(rho):g} .. {np.max(rho):g}"
                faults.add(f"path.{name}", value, allowed, "closed forms hold between A and E")
            teeth.append(LoadedTooth(profile, material, np.clip(rho, low, high)))
    return teeth[0], teeth[1]
