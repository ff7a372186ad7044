from __future__ import annotations

import itertools
import warnings

import numpy as np
import pytest

from gears import BasicRack, Gear, GearPair

CASES = {
    "article": lambda: GearPair(Gear(36), Gear(40), 2e-3, 0.04),
    "undercut limit": lambda: GearPair(Gear(17), Gear(43), 2e-3, 0.04),
    "undercut": lambda: GearPair(
        Gear(12, profile_shift=0.1), Gear(12, profile_shift=0.1, tip_alteration=-0.2), 2e-3, 0.04
    ),
    "chamfer": lambda: GearPair(Gear(36, tip_chamfer=2e-4), Gear(40, tip_chamfer=2e-4), 2e-3, 0.04),
    "full radius": lambda: GearPair(Gear(36), Gear(40), 2e-3, 0.04, BasicRack(1.0, 1.4, 0.5)),
    "sharp fillet": lambda: GearPair(Gear(36), Gear(40), 2e-3, 0.04, BasicRack(1.0, 1.25, 0.05)),
    "backlash": lambda: GearPair(Gear(36), Gear(40), 2e-3, 0.04).with_backlash(1e-4),
    "thin rim": lambda: GearPair(Gear(36, bore_radius=0.0325), Gear(40), 2e-3, 0.04),
    "many teeth": lambda: GearPair(Gear(400), Gear(40), 1e-3, 0.04),
}


@pytest.fixture(params=list(CASES))
def profile(request):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return CASES[request.param]().teeth_profiles[0]


@pytest.fixture(scope="session")
def article_profile():
    return GearPair(Gear(36), Gear(40), 2e-3, 0.04).teeth_profiles[0]


def area(points, triangles):
    """Exact area of quadratic triangles: the boundary integral of x dy over their parabolic edges."""
    total = 0.0
    for a, b, m in ((0, 1, 3), (1, 2, 4), (2, 0, 5)):
        p0, p1, pm = (points[triangles[:, k]] for k in (a, b, m))
        # Simpson's rule is exact for x dy/dt, a cubic in t
        for t, weight in ((0.0, 1 / 6), (0.5, 4 / 6), (1.0, 1 / 6)):
            x = (1 - t) * (1 - 2 * t) * p0 + t * (2 * t - 1) * p1 + 4 * t * (1 - t) * pm
            slope = (4 * t - 3) * p0 + (4 * t - 1) * p1 + (4 - 8 * t) * pm
            total += weight * np.sum(x[:, 0] * slope[:, 1])
    return total


def exact_area(profile):
    """Area of one sector: the integral of r times its angular width, by the profile's own outline."""
    edges = [
        profile.bore_radius,
        profile.root_radius,
        profile.form_radius,
        profile.flank_end_radius,
        profile.tip_radius,
    ]
    total = 0.0
    for low, high in itertools.pairwise(edges):
        # the outline leaves the root circle with a vertical tangent: x = low + (high - low) s^2
        s, weight = np.polynomial.legendre.leggauss(80)
        s, weight = 0.5 * (s + 1), 0.5 * weight
        r = low + (high - low) * s**2
        inside = np.clip(r, low * (1 + 1e-13), high * (1 - 1e-13))
        total += np.sum(weight * 2 * s * (high - low) * r * 2 * profile.boundary_angle(inside))
    return total
