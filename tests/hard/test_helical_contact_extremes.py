"""Loaded contact of helical pairs at the ends of what is accepted: solved, or refused with key, range and remedy."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest

from base import InputError
from fem import MeshCycle, compliance, mesh_cycle
from gears import Gear, GearPair

ANGLE = radians(20.0)
TEETH = Gear(18), Gear(23)


def _pair(angle: float = ANGLE, width: float = 5e-3, **more) -> GearPair:
    pinion, wheel = more.pop("teeth", TEETH)
    return GearPair(pinion, wheel, module=1e-3, face_width=width, helix_angle=angle, **more)


def _solved(pair: GearPair, torque: float = 4.0, cells: int = 16) -> MeshCycle:
    """With the torque carried, no load where a gap is, tangents above secants of lines that all touch."""
    cycle = mesh_cycle(pair, torque, 5, compliance(pair, tolerance=0.05), cells=cells)
    assert cycle.converged, cycle.message
    lines = cycle.lines
    assert lines is not None
    across = cycle.forces.sum(axis=1) * pair.helix.base_cosine
    np.testing.assert_allclose(across, torque / pair.base_radii[0], rtol=1e-9)
    assert lines.axial_force == pytest.approx(pair.axial_force(torque), rel=1e-9)
    load, gap = np.nan_to_num(lines.line_load), np.nan_to_num(lines.gap)
    assert load.min() >= 0.0
    assert np.abs(load * gap).max() == 0.0
    assert np.all(cycle.stiffness > 0.0)
    assert np.all(cycle.secant_stiffness > 0.0)
    return cycle


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("angle", [45.0, -45.0])
def test_the_steepest_helix(angle: float) -> None:
    cycle = _solved(_pair(radians(angle)))
    assert np.ptp(cycle.transmission_error) < 0.2 * cycle.transmission_error.mean()


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("overlap", [0.01, 0.999, 1.0])
def test_a_whole_overlap_and_hardly_any(overlap: float) -> None:
    """Across a whole overlap nothing jumps. The axial force bends a disc of .1 modules, by 1 % more with finer ends."""
    width = overlap * np.pi * 1e-3 / np.sin(ANGLE)
    cycle = _solved(_pair(width=float(width)), torque=4.0 * overlap)
    assert cycle.lines is not None
    swing = np.ptp(cycle.lines.whole_length) / cycle.lines.whole_length.mean()
    assert swing < 1e-9 or overlap != 1.0
    assert swing < 0.01 or overlap < 0.9
    assert np.ptp(cycle.transmission_error) < 0.06 * cycle.transmission_error.mean() or overlap < 0.9
    assert 1e-3 < cycle.error < 0.05


@pytest.mark.parametrize("angle", [45.1, -50.0])
def test_angles_beyond_the_range_name_it(angle: float) -> None:
    with pytest.raises(InputError) as raised:
        _pair(radians(angle))
    (fault,) = raised.value.faults
    assert "helix_angle" in fault.where
    assert "0.785398" in fault.allowed
    assert fault.remedy
