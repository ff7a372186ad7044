"""Strips of pressure instead of lines where cells are narrow: the mean of K_0, definite matrices, torques apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import k0

from fem import PairCompliance, compliance, mesh_cycle
from fem.pair.wide_contact import beyond_logarithm
from gears import Alignment, Gear, GearPair, Lead

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
LINE_LOAD = 400e3


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(PAIR, tolerance=0.02)


def _cycle(bodies, pair, torque, cells, across):
    own, options = replace(bodies, pair=pair), {"beyond_path": False, "face_model": "walls"}
    return mesh_cycle(pair, torque, 8, own, cells=cells, alignment=Alignment(across), **options)


@pytest.mark.parametrize("wave", [0.1, 1.0, 3.0, 10.0])
def test_a_strip_is_the_mean_of_lines(wave):
    """Mean of K_0 over both places in the strip, by angles whose grids never meet."""
    first, second = (np.pi * (np.arange(n) + 0.5) / n for n in (2000, 1501))
    apart = np.abs(np.cos(first)[:, None] - np.cos(second))
    mean = np.mean(k0(wave * apart))
    line = -np.log(0.5 * wave) - np.euler_gamma + np.log(2.0)
    assert float(beyond_logarithm(np.array(wave))) == pytest.approx(mean - line, abs=2e-3)


@pytest.mark.parametrize("slenderness", [0.5, 2.0])
def test_narrow_faces_settle_with_more_cells(bodies, slenderness):
    """Cells from twice to a twentieth of the contact's width; lines alone have no solution there."""
    width = slenderness * PAIR.module
    pair = replace(PAIR, face_width=width)
    torque = LINE_LOAD * width * pair.base_radii[0]
    found = [_cycle(bodies, pair, torque, cells, 20e-6 * width / 20e-3) for cells in (16, 64, 128)]
    factors = np.array([one.face_load_factor for one in found])
    assert np.all(factors[0] > 1.02)
    np.testing.assert_allclose(factors[1], factors[2], rtol=0.01)
    for one in found:
        load = one.line_load.sum(axis=1)
        assert np.all(np.diff(load, axis=1) < 0.0)


def test_a_torque_s_answer_does_not_depend_on_the_others(bodies):
    """Light ones bear on lines, heavy ones on strips of their own width."""
    torques = [2.0, 100.0, 400.0]
    together = _cycle(bodies, PAIR, torques, 64, 40e-6)
    for torque, one in zip(torques, together, strict=True):
        alone = _cycle(bodies, PAIR, torque, 64, 40e-6)
        np.testing.assert_allclose(alone.line_load, one.line_load, rtol=1e-7, atol=1e-6 * one.line_load.max())
        np.testing.assert_allclose(alone.stiffness, one.stiffness, rtol=1e-7)


def test_ends_of_a_concave_flank_bear(bodies):
    pair = replace(PAIR, pinion=replace(PAIR.pinion, lead=Lead(crowning=-200e-6)))
    with pytest.warns(match="deflect by"):
        found = _cycle(bodies, pair, LINE_LOAD * pair.face_width * pair.base_radii[0], 64, 0.0)
    load = found.line_load.sum(axis=1)
    np.testing.assert_allclose(load, load[:, ::-1], rtol=1e-6, atol=1e-3)
    assert np.all(load[:, 32] == 0.0)
