"""Shafts under the face at their limits: solved, or refused with the reason, and never an absurd stiffness."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from base import RangeWarning
from gears import Bearing, Gear, GearPair, Shaft, ShaftSegment

PAIR = GearPair(Gear(teeth=24), Gear(teeth=31), module=2e-3, face_width=20e-3).with_backlash(300e-6)
TORQUE = 80.0
MOUNTED = {
    "between its bearings": Shaft(
        (ShaftSegment(0.12, 0.02),), (Bearing(0.01, 3e8), Bearing(0.11, 3e8)), 0.06, 0.0
    ),
    "overhung": Shaft((ShaftSegment(0.12, 0.02),), (Bearing(0.07, 2e8), Bearing(0.11, 2e8)), 0.04, 0.12),
    "overhung, torque through the far end": Shaft(
        (ShaftSegment(0.12, 0.02),), (Bearing(0.07, 2e8), Bearing(0.11, 2e8)), 0.04, 0.0
    ),
    "bearings under the gear": Shaft(
        (ShaftSegment(0.12, 0.02),), (Bearing(0.055, 2e8), Bearing(0.065, 2e8)), 0.06, 0.12
    ),
    "beyond both bearings, far": Shaft(
        (ShaftSegment(0.4, 0.03),), (Bearing(0.3, 2e8), Bearing(0.38, 2e8)), 0.15, 0.4
    ),
    "long": Shaft((ShaftSegment(1.0, 0.03),), (Bearing(0.0, 3e8), Bearing(1.0, 3e8)), 0.2, 1.0),
}


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, 0.02)


@pytest.fixture(scope="module")
def aligned(bodies) -> fem.MeshCycle:
    return _cycle(bodies, None)


def _cycle(bodies, shafts, torque=TORQUE, **more):
    options = {"cells": 16, "face_model": "walls", "beyond_path": False} | more
    return fem.mesh_cycle(PAIR, torque, 8, bodies, shafts=shafts, **options)


def _softer(shaft: Shaft, times: float) -> Shaft:
    thinner = tuple(replace(one, diameter=one.diameter * times**-0.25) for one in shaft.segments)
    bearings = tuple(replace(one, stiffness=one.stiffness / times) for one in shaft.bearings)
    return replace(shaft, segments=thinner, bearings=bearings)


def _is_no_stiffer(found: fem.MeshCycle, aligned: fem.MeshCycle, ratio: float = 1.0) -> None:
    assert np.all(found.stiffness > 0.0)
    assert np.all(found.stiffness < aligned.stiffness * (1.0 + found.error))
    assert np.all(found.secant_stiffness > 0.0)
    assert np.all(found.secant_stiffness <= found.stiffness * ratio)
    matrix = found.face.mesh_matrix
    np.testing.assert_allclose(
        matrix, np.swapaxes(matrix, 1, 2), rtol=1e-9, atol=1e-9 * matrix[:, 0, 0].max()
    )
    assert np.linalg.eigvalsh(matrix).min() > -1e-9 * matrix[:, 0, 0].max()
    borne = found.line_load.sum(axis=(1, 2)) * PAIR.face_width / found.face_position.size
    np.testing.assert_allclose(borne, found.force, rtol=1e-9)


@pytest.mark.filterwarnings("ignore::base.RangeWarning")
@pytest.mark.parametrize("name", MOUNTED)
@pytest.mark.parametrize("moving", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_gears_however_they_are_mounted(bodies, aligned, name, moving):
    """Either gear, and both."""
    even = _cycle(bodies, None, moving_contact=True) if moving else aligned
    shaft = MOUNTED[name]
    for shafts in ((shaft, None), (None, shaft), (shaft, shaft)):
        found = _cycle(bodies, shafts, moving_contact=moving)
        if not found.converged:
            assert "the shafts give way by" in found.message
            assert not np.any(np.isfinite(found.stiffness))
            continue
        if moving:  # the pinion rolls on by what its shaft gives way: up to some per cent more or less
            assert np.all(found.stiffness > 0.0)
            assert np.all(found.stiffness < 1.1 * even.stiffness)
        else:
            _is_no_stiffer(found, even)


@pytest.mark.filterwarnings("ignore::base.RangeWarning")
@pytest.mark.parametrize(
    "name", ["overhung", *(pytest.param(one, marks=pytest.mark.slow) for one in MOUNTED if one != "overhung")]
)
def test_shafts_a_hundred_times_softer(bodies, name):
    """Refused with the reason; under a torque that they can bear, solved."""
    shaft = _softer(MOUNTED[name], 100.0)
    far = _cycle(bodies, (shaft, shaft))
    assert not far.converged
    assert "give stiffer shafts or bearings" in far.message
    light = 1e-3 * TORQUE
    found, even = (_cycle(bodies, one, light) for one in ((shaft, shaft), None))
    assert found.converged, found.message
    _is_no_stiffer(found, even)
    assert found.mean_stiffness < even.mean_stiffness * (1.0 + found.error)


@pytest.mark.parametrize("softer", [1e-4, 1e3, 1e6])
def test_stiffness_of_any_shaft(bodies, softer):
    """Cancellation of the shafts' compliance costs no digits that count; at 1e9 fewer are left than a sharing needs."""
    shaft = _softer(MOUNTED["between its bearings"], softer)
    force = 1e-3 / max(softer, 1.0)
    found, even = (_cycle(bodies, one, force) for one in ((shaft, shaft), None))
    assert found.converged, found.message
    _is_no_stiffer(found, even)
    if softer < 1.0:
        np.testing.assert_allclose(found.stiffness, even.stiffness, rtol=2e-2)


def test_a_tilt_that_opens_all_but_one_cell(bodies):
    shaft = Shaft((ShaftSegment(0.4, 0.006),), (Bearing(0.3, 2e8), Bearing(0.38, 2e8)), 0.28, 0.4)
    level = Shaft((ShaftSegment(0.4, 0.06),), (Bearing(0.0, 1e10), Bearing(0.4, 1e10)), 0.2, 0.4)
    with pytest.warns(RangeWarning, match="bears on"):
        found = _cycle(bodies, (shaft, level), 0.1, cells=4)
    assert found.converged, found.message
    assert np.count_nonzero(found.line_load.max(axis=1), axis=-1).min() == 1
    _is_no_stiffer(found, _cycle(bodies, None, 0.1, cells=4))
    row = int(np.argmin(np.count_nonzero(found.line_load.max(axis=1), axis=-1)))
    # a single cell has no tilt of its own: the mesh turns about it
    assert np.linalg.det(found.face.mesh_matrix[row]) == pytest.approx(
        0.0, abs=1e-9 * found.stiffness[row] * found.face.tilt_stiffness[row]
    )


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::base.RangeWarning")
def test_random_shafts(bodies):
    """As drawn in any range: solved without an absurd stiffness, or refused with the reason."""
    rng = np.random.default_rng(24)
    solved = 0
    for _ in range(60):
        shafts = []
        for _ in range(2):
            length = rng.uniform(0.06, 0.6)
            places = np.sort(rng.uniform(0.0, length, 2))
            places[1] = min(length, places[1] + 0.005)
            bearings = tuple(Bearing(float(place), 10.0 ** rng.uniform(6.0, 11.0)) for place in places)
            diameter = 10.0 ** rng.uniform(-2.2, -1.0)
            at = rng.uniform(0.011, length - 0.011)
            shafts.append(
                Shaft((ShaftSegment(length, diameter),), bearings, at, float(rng.choice([0.0, length])))
            )
        torque = 10.0 ** rng.uniform(-2.0, 2.0)
        found, even = (_cycle(bodies, one, torque) for one in (tuple(shafts), None))
        if found.converged:
            solved += 1
            _is_no_stiffer(found, even)
        else:
            assert "the shafts give way by" in found.message or "outside the path" in found.message
    assert solved > 20
