"""Cells of the face: even loads, symmetry, balance, free ends, faults."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from fem import PairCompliance, compliance, mesh_cycle
from fem.contact.cell_matrix import cell_matrix
from fem.influence.flank_variable import FlankVariable, RootVariable
from fem.influence.gear_face import AxialHarmonics
from fem.influence.series import CrossSeries, FlankSeries
from fem.pair.face_compliance import pair_ends, pair_waves
from fem.pair.face_setting import FaceSetting
from gears import Alignment, Gear, GearPair, Lead, LeadTrace

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
TORQUE = 100.0


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(PAIR, tolerance=0.02)


def _cycle(bodies, pair=PAIR, torque=TORQUE, cells=16, face_model="walls", **more):
    own = bodies if pair == PAIR else replace(bodies, pair=pair)
    return mesh_cycle(pair, torque, 8, own, cells=cells, face_model=face_model, **more)


def test_even_load_between_walls_is_the_plane_s(bodies):
    plane, cells = mesh_cycle(PAIR, TORQUE, 8, bodies), _cycle(bodies)
    assert np.allclose(cells.face_load_factor, 1.0, atol=1e-9)
    for name in ("transmission_error", "stiffness", "secant_stiffness", "forces", "pair_stiffness"):
        np.testing.assert_allclose(getattr(cells, name), getattr(plane, name), rtol=1e-9, atol=1e-3)
    assert plane.face is None
    assert plane.line_load is None


@pytest.mark.parametrize("model", ["walls", pytest.param("free-ends", marks=pytest.mark.slow)])
def test_forces_add_up_and_nothing_pulls(bodies, model):
    found = _cycle(bodies, alignment=Alignment(30e-6), face_model=model)
    width = PAIR.face_width / 16
    assert (found.line_load >= 0.0).all()
    np.testing.assert_allclose(found.line_load.sum(axis=-1) * width, found.forces, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(found.load_share.sum(axis=1), 1.0, rtol=1e-12)
    factor = found.face_load_factor
    assert factor.min() > 1.1
    assert found.face.error < 0.15
    # the end that the alignment closes bears most
    assert found.face_position[found.line_load[3].sum(axis=0).argmax()] < 0.0


@pytest.mark.parametrize("model", ["walls", pytest.param("free-ends", marks=pytest.mark.slow)])
def test_alignment_turned_round_mirrors_the_face(bodies, model):
    one, other = (_cycle(bodies, alignment=Alignment(turn * 20e-6), face_model=model) for turn in (1, -1))
    np.testing.assert_allclose(one.line_load, other.line_load[..., ::-1], rtol=1e-8, atol=1e-3)
    np.testing.assert_allclose(one.transmission_error, other.transmission_error, rtol=1e-10)


def test_a_measured_lead_is_the_modification_that_it_traces(bodies):
    straight = LeadTrace([-10e-3, 10e-3], [10e-6, -10e-6], form="linear")
    place = np.linspace(-10e-3, 10e-3, 401)
    bulge = LeadTrace(place, -15e-6 * (place / 10e-3) ** 2)
    for trace, designed in ((straight, Lead(slope=20e-6)), (bulge, Lead(crowning=15e-6))):
        one, other = (
            _cycle(bodies, replace(PAIR, wheel=replace(PAIR.wheel, lead=lead)))
            for lead in (Lead(trace=trace), designed)
        )
        np.testing.assert_allclose(one.line_load, other.line_load, rtol=0, atol=2e-4 * one.line_load.max())
        np.testing.assert_allclose(one.transmission_error, other.transmission_error, rtol=1e-5)


def test_a_slope_of_the_lead_undoes_an_alignment(bodies):
    pair = replace(PAIR, pinion=replace(PAIR.pinion, lead=Lead(slope=20e-6)))
    found = _cycle(bodies, pair, alignment=Alignment(-20e-6))
    assert np.allclose(found.face_load_factor, 1.0, atol=1e-9)


def test_crowning_loads_the_middle_and_is_symmetric(bodies):
    pair = replace(PAIR, wheel=replace(PAIR.wheel, lead=Lead(crowning=15e-6)))
    found = _cycle(bodies, pair)
    np.testing.assert_allclose(found.line_load, found.line_load[..., ::-1], rtol=1e-8, atol=1e-3)
    assert found.line_load[4].sum(axis=0).argmax() in (7, 8)


def test_light_load_lifts_off_and_heavy_load_evens_out(bodies):
    factors = [
        float(_cycle(bodies, torque=torque, alignment=Alignment(30e-6)).face_load_factor.max())
        for torque in (5.0, 50.0, 200.0)
    ]
    assert factors[0] > factors[1] > factors[2] > 1.0
    light = _cycle(bodies, torque=5.0, alignment=Alignment(30e-6))
    assert light.face.contact_pattern < 1.0


@pytest.mark.slow
def test_compliances_are_symmetric_and_free_ends_yield_more(bodies):
    """Maxwell and Betti; taking walls away can but add to what a load yields."""
    rho1 = np.array([[PAIR.points.A + 0.2 * PAIR.base_pitch, PAIR.points.A + 1.2 * PAIR.base_pitch]])
    rho = np.stack([rho1, PAIR.line_of_action - rho1])
    waves = pair_waves(bodies, rho, 12)[0]
    np.testing.assert_array_equal(waves, np.swapaxes(waves, 0, 1))
    edges, width = np.linspace(-0.5, 0.5, 13) * PAIR.face_width, PAIR.face_width
    ends = pair_ends(bodies, rho, (edges, edges), (width, width))[0].reshape(24, 24)
    np.testing.assert_allclose(ends, ends.T, atol=1e-12 * np.abs(ends).max())
    assert np.linalg.eigvalsh(ends).min() > -1e-6 * np.abs(ends).max()


def test_free_ends_of_a_narrow_face_yield_more_and_alike_at_both_ends(bodies):
    """What they add to cells between walls is symmetric, mirrored in the middle, and works against no load."""
    pair = replace(PAIR, face_width=PAIR.module)
    own, cells = replace(bodies, pair=pair), 8
    rho1 = np.array([[pair.points.A + 0.2 * pair.base_pitch, pair.points.A + 1.2 * pair.base_pitch]])
    rho = np.stack([rho1, pair.line_of_action - rho1])
    walls, free = (
        cell_matrix(FaceSetting(cells, model=model), own, rho, own.bulk(rho1))[0]
        for model in ("walls", "free-ends")
    )
    more = free - walls
    np.testing.assert_allclose(more, more.T, atol=1e-12 * np.abs(more).max())
    turned = more.reshape(2, cells, 2, cells)[:, ::-1, :, ::-1].reshape(more.shape)
    np.testing.assert_allclose(more, turned, atol=1e-9 * np.abs(more).max())
    assert np.linalg.eigvalsh(more).min() > -1e-6 * np.abs(more).max()
    even = np.repeat([1.0, 0.0], cells) / cells
    assert 1.05 < (even @ free @ even) / (even @ walls @ even) < 1.0 / (1.0 - 0.3**2)  # nearly plane stress
    stress = compliance(PAIR, tolerance=0.05, plane="stress")
    for gear, (load, point) in enumerate((rho[0, 0], rho[1, 0, ::-1])):
        ends = cell_matrix(FaceSetting(cells), own, rho, np.zeros((1, 2, 2)), (gear,))[0]
        flat, thick = ((one.pinion, one.wheel)[gear].cross(1, load, point) for one in (stress, own))
        change = (flat - thick).item() / pair.face_width  # less on the one gear, more on the other
        assert even @ ends @ even[::-1] == pytest.approx(change, rel=0.25)


def test_waves_on_a_neighbour_are_those_of_the_neighbour_that_is_asked_for():
    """Chebyshev series over both places, for each of two neighbours by itself, as numpy sums them."""
    span, chance = (2.0, 4.0), np.random.default_rng(3)
    cross = chance.normal(size=(2, 3, 3, 2))
    load, point = np.array([2.3, 3.9]), np.array([3.1, 2.2])
    tables = np.concatenate([cross[..., :1], np.zeros_like(cross[..., 1:])], axis=-1)
    constant = AxialHarmonics(
        5.0,
        FlankSeries(RootVariable(span, 5.0), np.zeros((2, 2))),
        {tooth: CrossSeries(FlankVariable(span), table) for tooth, table in enumerate(tables, 1)},
    )
    for tooth in (1, 2):
        found = constant.cross_at(tooth, load, point, np.array([0.5, 3.0]))
        wanted = np.polynomial.chebyshev.chebval2d(load - 3.0, point - 3.0, cross[tooth - 1, :, :, 0])
        np.testing.assert_allclose(found, np.repeat(wanted[:, None], 2, axis=1), rtol=1e-12)


@pytest.mark.parametrize("cells", [7, 8.5, 2])
def test_cells_are_even_and_whole(bodies, cells):
    with pytest.raises(InputError, match="cells"):
        mesh_cycle(PAIR, TORQUE, 8, bodies, cells=cells)


def test_faults_are_named_together(bodies):
    with pytest.raises(InputError) as told:
        mesh_cycle(PAIR, TORQUE, 8, bodies, cells=7, alignment=Alignment(0.1))
    text = str(told.value)
    assert all(name in text for name in ("cells", "alignment.in_plane"))
    with pytest.raises(InputError, match="end_relief_length"):
        replace(PAIR, pinion=Gear(teeth=20, lead=Lead(end_relief=1e-5)))


def test_figures_of_arcs_count_the_cells(bodies):
    """What twice the cells change is told, of each figure for itself: the secant feels little of it."""
    tilted = Alignment(in_plane=20e-6)
    few, many = (_cycle(bodies, PAIR, cells=cells, alignment=tilted) for cells in (16, 32))
    for name in ("mean_stiffness", "greatest_stiffness"):
        change = abs(getattr(many, name) / getattr(few, name) - 1.0)
        assert 0.5 * change < few.errors[name] < 5.0 * change
    assert few.errors["mean_secant_stiffness"] < 0.5 * few.errors["mean_stiffness"]


def test_contacts_end_within_cells(bodies):
    """The tangent does not leap with every cell that touches, which with 16 cells were 4 % of it."""
    torques, tilted = TORQUE * np.linspace(0.3, 1.0, 5), Alignment(60e-6)
    few, many = (
        np.array([one.stiffness for one in _cycle(bodies, torque=torques, cells=cells, alignment=tilted)])
        for cells in (16, 128)
    )
    assert np.abs(few / many - 1.0).max() < 0.01
    assert abs(few.mean() / many.mean() - 1.0) < 3e-3


def test_tangent_is_the_slope_between_torques_where_contacts_end_within_cells(bodies):
    """But for how the load changes where within a cell."""
    torques = TORQUE * (0.3 + np.array([-1e-3, 0.0, 1e-3]))
    less, at, more = _cycle(bodies, torque=torques, cells=64, alignment=Alignment(60e-6))
    slope = (more.force - less.force) / (more.transmission_error - less.transmission_error)
    np.testing.assert_allclose(at.stiffness, slope, rtol=2e-3)


@pytest.mark.parametrize(
    "lead", [Lead(), Lead(crowning=30e-6), Lead(end_relief=20e-6, end_relief_length=4e-3)]
)
def test_without_load_the_first_place_of_the_face_touches(bodies, lead):
    """Not the middle of the first cell, which would be 7.5 um away with four of them."""
    pair = replace(PAIR, pinion=replace(PAIR.pinion, lead=lead))
    found = _cycle(bodies, pair, 1e-4, 4, alignment=Alignment(60e-6))
    touch = found.unloaded_transmission_error
    assert np.all(np.abs(found.transmission_error - touch) < 0.2e-6)
