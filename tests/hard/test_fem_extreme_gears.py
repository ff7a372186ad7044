"""Gears at the limits of what gears allows must be meshed and solved, or refused in words."""

from __future__ import annotations

import time
import warnings

import numpy as np
import pytest

import fem
from gears import BasicRack, Gear, GearPair, TipRelief
from meshes import mesh_sector


def pair_of(z=(36, 40), m=2e-3, b=0.04, rack=None, first=None, second=None, bore=None):
    rack = rack or BasicRack()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pair = GearPair(Gear(z[0], **(first or {})), Gear(z[1], **(second or {})), m, b, rack)
        if bore is None:
            return pair
        gears = [
            Gear(n, bore_radius=bore * r, **(more or {}))
            for n, r, more in zip(z, pair.root_radii, (first, second), strict=True)
        ]
        return GearPair(*gears, m, b, rack)


GEARS = {
    "undercut limit": {"z": (17, 43)},
    "contact from the form circle on": {"z": (12, 50), "first": {"profile_shift": 0.5}},
    "thousand teeth": {"z": (20, 1000)},
    "ten thousand teeth": {"z": (20, 10000)},
    "rim of a quarter of a module": {"bore": 0.984},
    "shaft with hardly a bore": {"bore": 0.02},
    "fillet of .05 modules": {"rack": BasicRack(1.0, 1.25, 0.05)},
    "full radius": {"rack": BasicRack(1.0, 1.4, 0.5)},
    "contact ratio 2.4": {"z": (60, 80), "rack": BasicRack(1.3, 1.55, 0.3, np.radians(18))},
    "tenth of a millimetre": {"m": 1e-4, "b": 1e-3},
    "module of a metre": {"m": 1.0, "b": 20.0},
    "large chamfer": {"first": {"tip_chamfer": 5e-4}, "second": {"tip_chamfer": 5e-4}},
    "pin-sharp top land": {"z": (20, 40), "first": {"profile_shift": 0.8, "tip_alteration": -0.06}},
}


@pytest.mark.parametrize("name", list(GEARS))
def test_solved_within_its_tolerance(name):
    pair = pair_of(**GEARS[name])
    began = time.perf_counter()
    bodies = fem.compliance(pair, 0.002)
    assert time.perf_counter() - began < 20
    assert bodies.converged, bodies.message
    torque = pair.base_radii[0] * 4.4e5 * pair.face_width * pair.module / 2e-3
    for beyond in (False, True):
        cycle = fem.mesh_cycle(pair, torque, 20, bodies, beyond_path=beyond)
        assert cycle.converged
        np.testing.assert_allclose(cycle.load_share.sum(axis=1), 1.0, atol=1e-12)
        assert np.all(np.isfinite(cycle.approach))
        assert np.all(cycle.stiffness > 0)


def test_a_wheel_of_very_many_teeth_is_nearly_a_rack():
    """z 2000 and z 10000 with the same rim: the tooth has become that of a rack."""
    k = []
    for z in (2000, 10000):
        pair = pair_of(z=(20, z), second={"bore_radius": (0.5 * z - 1.25 - 10.0) * 2e-3})
        k.append(float(fem.single_pair_stiffness(pair, 1e4, [pair.points.C])[0]))
    assert k[1] == pytest.approx(k[0], rel=2e-3)


def test_poisson_near_a_half_does_not_lock():
    from gears import Material

    k = []
    for nu in (0.49, 0.4999):
        rubber = Material(206e9, nu, 1000.0)
        pair = GearPair(Gear(36), Gear(40), 2e-3, 0.04, material=rubber)
        k.append(float(fem.single_pair_stiffness(pair, 1e4, [pair.points.C], tolerance=0.01)[0]))
    assert k[1] == pytest.approx(k[0], rel=0.02)


@pytest.mark.parametrize("torque", [1e-6, 1e-2, 1e2, 2e4])
def test_torques_over_ten_decades(torque):
    pair = pair_of()
    cycle = fem.mesh_cycle(pair, torque, 20)
    assert cycle.converged
    assert np.all(cycle.stiffness >= cycle.secant_stiffness * (1 - 1e-9))


def test_relief_larger_than_the_deflection_takes_the_ends_out_of_contact():
    relief = TipRelief(amount=200e-6, length=3e-3)
    pair = pair_of(first={"tip_relief": relief}, second={"tip_relief": relief})
    cycle = fem.mesh_cycle(pair, 100.0, 40)
    assert np.all((cycle.forces > 0).sum(axis=1) == 1)
    np.testing.assert_allclose(cycle.load_share.max(axis=1), 1.0)


@pytest.mark.slow
def test_random_gears_mesh():
    rng = np.random.default_rng(0)
    meshed = 0
    for _ in range(300):
        z = int(np.exp(rng.uniform(np.log(8), np.log(300))))
        gear = Gear(z, profile_shift=rng.uniform(-0.3, 0.7), tip_chamfer=float(rng.choice([0.0, 1e-4])))
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                pair = GearPair(gear, Gear(60), 2e-3, 0.04)
        except ValueError:
            continue
        mesh_sector(pair.teeth_profiles[0], refinements=1)
        meshed += 1
    assert meshed > 100
