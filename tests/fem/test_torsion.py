"""Steps of thickness in torsion: the exact constriction of long strips, limits, and where the turn is counted."""

from __future__ import annotations

import numpy as np
import pytest

import fem
from fem.cycle.breakdown import deflection_parts
from fem.elasticity.support import FIXED
from fem.elasticity.torsion import _added, step_wind_up
from fem.pair.references import turns
from gears import Blank, Gear, GearPair
from gears.tooth.blank import Zone

WIDTH, G = 0.02, 206e9 / 2.6


def wheel(web=0.3, rim=5.4e-3):
    blank = Blank(rim, web * WIDTH, hub_radius=0.018)
    return GearPair(Gear(25), Gear(50, bore_radius=0.012, blank=blank), 2e-3, WIDTH)


def constriction(ratio: float) -> float:
    """Squares of the wider strip's half that an abrupt step in the width of a long strip adds (conformal map)."""
    return (
        (ratio**2 + 1) / ratio * np.log((1 + ratio) / (1 - ratio)) - 2 * np.log(4 * ratio / (1 - ratio**2))
    ) / np.pi


@pytest.mark.parametrize("ratio", [0.1, 0.3, 0.7])
def test_a_narrow_body_is_a_strip_with_two_steps(ratio):
    """Radii hardly change over half the width: conductivity r^3 in a strip, whose constrictions are known exactly."""
    zones = (Zone(0.985, 1.0, 1.0), Zone(0.970, 0.985, ratio), Zone(0.955, 0.970, 1.0))
    half = 5e-3
    expected = half * constriction(ratio) * (0.985**-3 + 0.970**-3)
    assert _added(zones, half, None) == pytest.approx(expected, rel=0.005)


def test_a_heavy_bore_takes_the_whole_torque_and_a_light_one_little():
    profile = wheel().teeth_profiles[1]
    static = step_wind_up(profile, WIDTH, G)
    found = [step_wind_up(profile, WIDTH, G, inertia) for inertia in (0.0, 1e-7, 1e-6, 1.0)]
    assert found == sorted(found)
    assert found[-1] == pytest.approx(static, rel=1e-5)
    assert 0 < found[0] < 0.1 * static


def test_discs_and_small_steps_add_nothing_and_narrower_webs_more():
    assert step_wind_up(wheel(1.0).teeth_profiles[1], WIDTH, G) == 0.0
    assert step_wind_up(wheel(0.9995).teeth_profiles[1], WIDTH, G) == 0.0
    found = [step_wind_up(wheel(web).teeth_profiles[1], WIDTH, G) for web in (0.99, 0.7, 0.4, 0.2, 0.1)]
    assert found == sorted(found)
    assert 0 < found[0] < 2e-3 * found[-1]


def test_size_does_not_matter():
    small = wheel().teeth_profiles[1]
    blank = Blank(54e-3, 0.3 * 10 * WIDTH, hub_radius=0.18)
    large = GearPair(Gear(25), Gear(50, bore_radius=0.12, blank=blank), 20e-3, 10 * WIDTH).teeth_profiles[1]
    assert step_wind_up(large, 10 * WIDTH, G) == pytest.approx(step_wind_up(small, WIDTH, G), rel=1e-9)


def test_the_turn_is_part_of_the_wind_up_and_nothing_else():
    some = wheel()
    bodies = fem.compliance(some, 0.002)
    added = step_wind_up(some.teeth_profiles[1], WIDTH, some.materials[1].shear_modulus) / WIDTH
    assert bodies.step_windup == (0.0, pytest.approx(added, rel=1e-9))
    assert bodies.hub_windup[1] == pytest.approx(bodies.plane_windup[1] + added, rel=1e-12)
    rho1 = some.points.C + np.array([[-0.5, 0.5]]) * some.base_pitch
    plane = (bodies.pinion.own(rho1) + bodies.wheel.own(some.line_of_action - rho1)) / WIDTH
    np.testing.assert_allclose(bodies.own(rho1) - plane, added, rtol=1e-6)
    whole, without = bodies.bulk(rho1), bodies.without("hub_windup").bulk(rho1)
    np.testing.assert_allclose(whole - without, sum(bodies.hub_windup), rtol=1e-9)
    parts = bodies.parts(rho1[:, 0])
    together = sum(parts[name] for name in ("pinion", "wheel", "hub_windup", "support"))
    np.testing.assert_allclose(together, bodies.own(rho1[:, 0]), rtol=1e-12)
    assert turns(some, (FIXED, FIXED), "bore") == pytest.approx(bodies.hub_windup, rel=1e-9)
    cycle = fem.mesh_cycle(some, 100.0, 6, bodies, reference="bore")
    less = cycle.transmission_error - cycle.against("teeth").transmission_error
    shares = deflection_parts(cycle, bodies)
    np.testing.assert_allclose(less, shares["windup"], rtol=1e-9)
    np.testing.assert_allclose(sum(shares.values()), cycle.transmission_error, rtol=1e-9)
