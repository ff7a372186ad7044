"""Mass of a pair reduced to the line of action, after ISO 6336-1."""

from __future__ import annotations

import math

from gears.pair.gear_pair import GearPair
from gears.tooth.profile import ToothProfile


def reduced_mass(pair: GearPair) -> float:
    """m_red, per length of face [kg/m].

    With d_m = (d_a + d_f)/2, q = d_i/d_m and u = z_2/z_1,

        m_red = pi/8 (d_m1/d_b1)^2 d_m1^2 / (1/[(1 - q_1^4) rho_1] + 1/[(1 - q_2^4) rho_2 u^2])

    d_i is the diameter inside the rim of a gear on a web; q is 0 of a disc, whose bore its shaft fills. Web and hub do
    not count.

    Parameters
    ----------
    pair : GearPair

    References
    ----------
    ISO 6336-1:2006, clause 6.5.9, equations 30 and 31.

    Examples
    --------
    >>> from gears import Gear
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> round(reduced_mass(pair), 4)
    9.72...
    """
    first, second = pair.teeth_profiles
    mean, base = _mean_diameter(first), 2.0 * pair.base_radii[0]
    rho1, rho2 = (material.density for material in pair.materials)
    resisting = 1.0 / (_ring(first) * rho1) + 1.0 / (_ring(second) * rho2 * pair.ratio**2)
    return math.pi / 8.0 * (mean / base) ** 2 * mean**2 / resisting


def _mean_diameter(profile: ToothProfile) -> float:
    return profile.tip_radius + profile.root_radius


def _ring(profile: ToothProfile) -> float:
    """1 - q^4 of a rim on a web, 1 of a disc."""
    if not profile.steps:
        return 1.0
    inside = 2.0 * (profile.root_radius - profile.rim_thickness)
    return 1.0 - (inside / _mean_diameter(profile)) ** 4
