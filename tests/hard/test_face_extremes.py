"""The face at its limits: contacts that end at an edge or on one cell, deep crowning, narrow and wide faces."""

from __future__ import annotations

import warnings
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import fem
import fem.elasticity.free_ends
import fem.influence.gear_face
from base import InputError, RangeWarning
from gears import Alignment, Gear, GearPair, Lead, Material, TipRelief, Topography

FREE = pytest.param("free-ends", marks=pytest.mark.slow)
PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
LINE_LOAD = 400e3
ON_FEW = "most loaded pair bears on"


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, 0.02)


def _cycle(bodies, load=LINE_LOAD, lead=None, across=0.0, slenderness=10.0, **more):
    pair = replace(PAIR, face_width=slenderness * PAIR.module)
    if lead is not None:
        pair = replace(pair, pinion=replace(pair.pinion, lead=lead))
    own = replace(bodies, pair=pair) if slenderness == 10.0 else fem.compliance(pair, 0.02)
    torque = load * pair.face_width * pair.base_radii[0]
    options = {"face_model": "walls", "alignment": Alignment(across)} | more
    found = fem.mesh_cycle(pair, torque, 8, own, **options)
    assert found.converged, found.message
    assert np.all(found.line_load >= 0.0)
    borne = found.line_load.sum(axis=(1, 2)) * pair.face_width / found.line_load.shape[2]
    np.testing.assert_allclose(borne, found.forces.sum(axis=1), rtol=1e-9)
    return found


@pytest.mark.parametrize("model", ["walls", FREE])
def test_contact_that_reaches_a_free_edge(bodies, model):
    """The length in contact grows with the load up to the far edge, which takes no load before."""
    lengths, far = [], []
    for part in (0.02, 0.1, 0.3, 1.0):
        load = _cycle(bodies, part * LINE_LOAD, across=20e-6, face_model=model).line_load[3].sum(axis=0)
        lengths.append(np.count_nonzero(load))
        far.append(load[-1])
        assert np.array_equal(np.flatnonzero(load), np.arange(lengths[-1]))
    assert lengths == sorted(lengths)
    assert lengths[0] < 32
    assert lengths[-1] == 64
    assert far[0] == far[1] == 0.0 < far[3]


@pytest.mark.parametrize("model", ["walls", FREE])
def test_hardly_any_load_on_60_um(bodies, model):
    with pytest.warns(RangeWarning, match=ON_FEW):
        found = _cycle(bodies, load=100.0, across=60e-6, face_model=model)
    assert found.face_load_factor.min() > 30.0
    assert found.face.error >= 0.25


@pytest.mark.parametrize("model", ["walls", FREE])
def test_slope_that_opens_all_but_one_cell(bodies, model):
    with pytest.warns(RangeWarning, match="bears on 1 of 64 cells"):
        found = _cycle(bodies, load=50.0, across=2e-3, face_model=model)
    assert np.all(np.count_nonzero(found.line_load.sum(axis=1), axis=1) == 1)
    np.testing.assert_allclose(found.face_load_factor, 64.0)


@pytest.mark.parametrize("model", ["walls", FREE])
@pytest.mark.parametrize("load", [LINE_LOAD, 0.05 * LINE_LOAD])
def test_crowning_of_200_um(bodies, load, model):
    found = _cycle(bodies, load, Lead(crowning=200e-6), face_model=model)
    np.testing.assert_allclose(found.line_load, found.line_load[..., ::-1], rtol=1e-7, atol=1e-3)
    assert found.face_load_factor.min() > 3.0
    assert np.all(found.line_load[:, :, 0] == 0.0)


@pytest.mark.parametrize("load", [LINE_LOAD, 0.05 * LINE_LOAD])
@pytest.mark.parametrize(
    "more", [{}, pytest.param({"moving_contact": True}, marks=pytest.mark.slow), {"beyond_path": False}]
)
def test_twists_up_to_their_limit(bodies, load, more):
    """Flanks that touch at opposite corners; the loaded end of the face changes within a base pitch."""
    for twist in (1e-3, -200e-6):
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message=ON_FEW, category=RangeWarning)
            found = _cycle(bodies, load, Lead(twist=twist), **more)
        assert found.face_load_factor.max() > 2.0
        ends = found.line_load.sum(axis=1)[:, [0, -1]]
        assert ends[:, 0].max() > 0.0 < ends[:, 1].max()


@pytest.mark.parametrize("form", [pytest.param("smooth", marks=pytest.mark.slow), "linear"])
def test_rough_tables_and_steps(bodies, form):
    """A wave of 20 um within three points either way; a step of 100 um from one point to the next."""
    rho, z = np.linspace(1e-3, 12e-3, 60), np.linspace(-0.5, 0.5, 50) * PAIR.face_width
    wave = 10e-6 * np.sin(2.1 * np.arange(60))[:, None] * np.cos(2.3 * np.arange(50))
    step = np.where(z > 3e-3, -100e-6, 0.0) + 0.0 * rho[:, None]
    for heights in (wave, step):
        found = _cycle(bodies, lead=Lead(topography=Topography(rho, z, heights, form)))
        assert found.face_load_factor.min() > 1.05
    beyond = found.face_position > 3e-3 + 0.04 * PAIR.face_width
    assert np.all(found.line_load[..., beyond] == 0.0)


@pytest.mark.parametrize("slenderness", [0.5, 2.0, 40.0])
def test_face_of_half_to_forty_modules(bodies, slenderness):
    """Slopes of equal angle: the wider the face, the more uneven."""
    found = _cycle(bodies, across=1e-6 * slenderness, slenderness=slenderness)
    ratio = found.face_load_factor.max()
    assert 1.0 < ratio < {0.5: 1.15, 2.0: 1.3, 40.0: 4.0}[slenderness]
    assert found.face.error < 0.06


@pytest.mark.slow
@pytest.mark.parametrize("slenderness", [0.5, 40.0])
def test_free_ends_of_half_and_forty_modules(bodies, slenderness):
    found = _cycle(bodies, slenderness=slenderness, face_model="free-ends")
    walls = _cycle(bodies, slenderness=slenderness)
    assert np.all(found.stiffness < walls.stiffness)
    # plane stress is softer by nu^2 at most
    assert np.all(found.stiffness > 0.9 * walls.stiffness)


@pytest.mark.slow
@pytest.mark.parametrize(("wider", "offset"), [(1.1, 0.0), (1.3, 2e-3)])
def test_free_ends_of_unequal_widths(bodies, wider, offset):
    """A body that goes on beyond the load holds its end: less yields there, and more is borne."""
    width = PAIR.face_width
    pinion = replace(PAIR.pinion, face_width=wider * width, face_offset=offset)
    pair = replace(PAIR, pinion=pinion, face_width=width)
    torque = LINE_LOAD * width * pair.base_radii[0]
    given = {"cells": 32, "alignment": Alignment(10e-6), "face_model": "free-ends"}
    found = fem.mesh_cycle(pair, torque, 8, replace(bodies, pair=pair), **given)
    same = fem.mesh_cycle(PAIR, torque, 8, bodies, **given)
    assert found.converged
    assert np.all(found.stiffness > same.stiffness)
    assert found.face.greatest_line_load > same.face.greatest_line_load


@pytest.mark.slow
def test_what_free_ends_leave_uncertain_is_told(bodies, monkeypatch):
    """Against pieces of half the length at the end and elements of 0.7 of it there."""
    found = _cycle(bodies, across=20e-6, face_model="free-ends")
    fem.forget_gears()
    half = partial(fem.elasticity.free_ends.half_face, last=0.5 * fem.elasticity.free_ends.LAST)
    monkeypatch.setattr(fem.influence.gear_face, "half_face", half)
    monkeypatch.setattr(fem.influence.gear_face, "ENDS_SIZES", fem.influence.gear_face.ENDS_SIZES.scaled(0.7))
    finer = _cycle(bodies, across=20e-6, face_model="free-ends")
    fem.forget_gears()
    factors = [one.face.greatest_face_load_factor for one in (found, finer)]
    assert 0.0 < abs(factors[1] / factors[0] - 1.0) < found.face.error
    assert abs(finer.mean_stiffness / found.mean_stiffness - 1.0) < 1e-3


@pytest.mark.slow
def test_cells_beside_a_tip_corner_do_not_take_turns():
    """Relieved plastics under heavy loads: cells bore 0 and 37 N/mm by turns, and D leapt by 1 % between torques."""
    relief = TipRelief(40e-6, 1.5e-3)
    first, second = Gear(35, tip_relief=relief), Gear(46, tip_relief=relief, lead=Lead(crowning=30e-6))
    pom = Material(2.8e9, 0.35, 1410.0)
    pair = GearPair(first, second, 2e-3, 17.5e-3, material=pom).with_backlash(900e-6)
    soft = fem.compliance(pair, tolerance=0.02)
    with pytest.warns(RangeWarning, match="0.08"):
        found = fem.mesh_cycle(
            pair, [24.5, 25.0], 10, soft, alignment=Alignment(20e-6), cells=16, face_model="walls"
        )
    for cycle in found:
        assert cycle.converged, cycle.message
        rises = np.diff(cycle.line_load, axis=-1) > 0.0
        assert np.all(np.count_nonzero(np.diff(rises, axis=-1), axis=-1) <= 1)  # up, then down
    slope = np.diff([cycle.force for cycle in found]) / (
        found[1].transmission_error - found[0].transmission_error
    )
    np.testing.assert_allclose(slope, found[0].stiffness, rtol=0.02)


def test_what_is_too_much_is_refused_by_name(bodies):
    with pytest.raises(InputError, match=r"alignment.in_plane = 0.006: .*at most 0.005 m. Give"):
        _cycle(bodies, across=6e-3)
    with pytest.raises(InputError, match="crowning"):
        _cycle(bodies, lead=Lead(crowning=2e-3))
