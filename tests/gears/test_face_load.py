"""Face-load factor of ISO 6336-1, method C: its two branches and what they come from."""

from __future__ import annotations

import numpy as np
import pytest

from gears import Gear, GearPair, GeometryError
from gears.closed_form import iso6336, iso6336_face_load

PAIR = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)


@pytest.mark.parametrize("torque", [60.0, 267.0, 600.0])
def test_factor_is_that_of_linear_slices(torque):
    """A row of springs that is pressed by a slanted edge until it carries the load."""
    found = iso6336_face_load(PAIR, torque, 20e-6)
    z = (np.arange(40_000) + 0.5) / 40_000
    mean = torque / (18 * 2e-3) / 40e-3
    low, high = 0.0, 1e-3
    for _ in range(60):
        pressed = 0.5 * (low + high)
        load = found.c_gamma_beta * 1e9 * np.maximum(pressed - 20e-6 * z, 0.0)
        low, high = (pressed, high) if load.mean() < mean else (low, pressed)
    assert load.max() / load.mean() == pytest.approx(found.K_Hbeta, rel=1e-4)
    assert min(found.b_cal, 1.0) == pytest.approx(np.mean(load > 0), abs=1e-4)


def test_stiffness_over_the_face_is_that_of_the_mesh_less_fifteen_per_cent():
    """c_gamma_beta = 0.85 c_gamma_alpha (ISO 6336-1, clause 7)."""
    found = iso6336_face_load(PAIR, 600.0, 20e-6)
    assert found.c_gamma_beta == pytest.approx(0.85 * iso6336(PAIR).c_gamma, rel=1e-12)


def test_both_branches_meet_and_no_misalignment_is_one():
    assert iso6336_face_load(PAIR, 600.0, 0.0).K_Hbeta == 1.0
    stiffness = iso6336_face_load(PAIR, 600.0, 1e-6).c_gamma_beta * 1e9
    edge = 2.0 * 600.0 / (18 * 2e-3) / 40e-3 / stiffness
    below, above = (iso6336_face_load(PAIR, 600.0, edge * part).K_Hbeta for part in (1 - 1e-9, 1 + 1e-9))
    assert below == pytest.approx(2.0, abs=1e-6)
    assert above == pytest.approx(2.0, abs=1e-6)


def test_faults_are_named_together():
    with pytest.raises(GeometryError) as told:
        iso6336_face_load(PAIR, -1.0, 1.0)
    assert "torque" in str(told.value)
    assert "misalignment" in str(told.value)
