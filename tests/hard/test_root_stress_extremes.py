"""Root stress of hard gears: it converges, keeps its estimate, and stays near the standard where that holds."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import fem
from base import RangeWarning
from gears import BasicRack, Gear, GearPair, GeometryWarning, Material
from gears.closed_form import iso6336_3

CASES = {
    "undercut": (Gear(12), Gear(40, tip_alteration=-0.45), {}),
    "just undercut": (Gear(17), Gear(43), {}),
    "pointed": (Gear(14, 0.75), Gear(40, tip_alteration=-0.2), {}),
    "high contact ratio": (Gear(40), Gear(50), {"rack": BasicRack(h_aP=1.35, h_fP=1.6, rho_fP=0.25)}),
    "full radius": (Gear(25, 0.3), Gear(40), {"rack": BasicRack(alpha=np.radians(25), rho_fP=0.5)}),
    "14.5 degrees, stub": (Gear(40), Gear(60), {"rack": BasicRack(alpha=np.radians(14.5), h_aP=0.8)}),
    "sharp fillet": (Gear(25), Gear(40), {"rack": BasicRack(rho_fP=0.05)}),
    "nearly incompressible": (Gear(25), Gear(40), {"material": Material(206e9, 0.4999, 7850.0)}),
}


def pair_of(name):
    pinion, wheel, more = CASES[name]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", GeometryWarning)
        return GearPair(pinion, wheel, 2e-3, 0.02, **more)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_one_loaded_pair_is_near_the_standard(name):
    pair = pair_of(name)
    found = fem.fillets(pair)
    assert found.converged
    assert found.error <= 0.005
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        nominal = iso6336_3(pair, 1.0)
    outer = pair.points.D, pair.line_of_action - pair.points.B
    for gear, rho, stress in zip((found.pinion, found.wheel), outer, nominal.stresses, strict=True):
        along = gear.stress(0, np.array([rho]))[0]
        place = int(np.argmax(along[0]))
        assert 0 < place < len(gear.line.arc) - 1
        # chart fits of usual gears: far outside them a quarter is what one may expect
        assert 0.75 < along[0].max() / (stress * pair.face_width) < 1.15
        assert along[1].min() < -along[0].max()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["undercut", "sharp fillet"])
def test_estimate_of_hard_fillets_is_honest(name):
    pair = pair_of(name)
    usual, finer = fem.fillets(pair), fem.fillets(pair, fillet_edge=0.02)
    true = 0.0
    for one, other in ((usual.pinion, finer.pinion), (usual.wheel, finer.wheel)):
        rho = np.linspace(*one.rho_range, 15)
        a, b = (np.abs(each.stress(0, rho)).max(axis=2) for each in (one, other))
        true = max(true, float(np.max(np.abs(a / b - 1))))
    assert usual.error > 0.5 * true


def test_both_gears_follow_their_own_material():
    """Stress does not ask for the modulus: a soft wheel under the same force, Poisson's ratio kept."""
    steel, soft = Material(206e9, 0.3, 7850.0), Material(3e9, 0.3, 1200.0)
    one, other = (GearPair(Gear(20), Gear(30), 2e-3, 0.02, material=m) for m in (steel, (steel, soft)))
    for gear in ("pinion", "wheel"):
        a, b = (getattr(fem.fillets(pair, 0.02), gear) for pair in (one, other))
        rho = np.linspace(*a.rho_range, 4)
        first, second = a.stress(0, rho), b.stress(0, rho)
        np.testing.assert_allclose(first, second, atol=1e-9 * np.abs(first).max())
