"""Errors by the cells of a face: greatest loads by how they bend, changes of sign, and what twice as many cells do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base.later import known
from fem import PairCompliance, compliance, mesh_cycle
from fem.contact import shared_contacts
from fem.contact.cell_laws import greatest_error
from fem.contact.face_errors import LEFT, cell_errors, half_as_many
from fem.pair.face_setting import FREE_ENDS, WALLS, FaceSetting
from gears import Alignment, Gear, GearPair, Lead

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)


def _means(cells, primitive):
    """Means over equal cells of (0, 1) of what has this primitive."""
    return cells * np.diff(primitive(np.linspace(0.0, 1.0, cells + 1)))


@pytest.mark.parametrize("top", [0.31, 0.5, 0.5078125, 0.617])
def test_what_the_greatest_cell_lacks_to_the_top_of_a_parabola(top):
    """Means of a parabola are its own: all of the error is known, and the last doubling was foreseen."""
    cells, fewer = (_means(n, lambda z: z - (z - top) ** 3 / 3.0) for n in (64, 32))
    assert greatest_error(cells, fewer) == pytest.approx(1.0 / cells.max() - 1.0, rel=1e-6)


@pytest.mark.parametrize("turned", [slice(None), slice(None, None, -1)])
def test_at_an_end_all_of_the_last_change_is_left(turned):
    """A load that is linear over the face: the end cell lacks half of what its neighbour does, at any number."""
    cells, fewer = (_means(n, lambda z: 2.0 * z - 0.5 * z**2)[turned] for n in (64, 32))
    assert greatest_error(cells, fewer) == pytest.approx(2.0 / cells.max() - 1.0, rel=1e-9)


def test_a_single_cell_that_bears_is_told_to_be_half_of_what_it_may_be():
    cells, fewer = (n * np.eye(n)[n // 4] for n in (64, 32))
    assert greatest_error(cells, fewer) == pytest.approx(0.5)


def test_a_parabola_that_foresaw_wrongly_is_an_error():
    """The top is flat where it was pointed with half as many cells."""
    cells, fewer = np.full(64, 1.0), np.full(32, 0.9)
    cells[31:33] += 1e-6
    fewer[15:17] += 0.05
    assert greatest_error(cells, fewer) == pytest.approx(0.25 * (1.0 - 0.95 - 0.05 / 8.0), rel=1e-3)


@pytest.mark.parametrize("few", [8, 6, 4])
def test_a_doubling_that_is_none_is_taken_for_its_part(few):
    """A load that is linear over the face: the end cell lacks of the whole what its own half does, by any number."""
    cells, fewer = (_means(n, lambda z: 2.0 * z - 0.5 * z**2) for n in (18, few))
    error = greatest_error(cells, fewer)
    assert error == pytest.approx(2.0 / cells.max() - 1.0, rel=1e-9)


@pytest.mark.parametrize("cells", [4, 6, 8, 10, 16, 64])
def test_half_as_many_cells_are_even_and_what_they_change_is_counted_by_their_number(cells):
    """Errors go with the length of a cell: what n/2 change is what n lack, what fewer change is more of it."""
    few, part = half_as_many(FaceSetting(cells))
    assert few.cells == {4: 2, 6: 2, 8: 4, 10: 4, 16: 8, 64: 32}[cells]
    assert part == pytest.approx(LEFT / (cells / few.cells - 1.0))


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(PAIR, tolerance=0.02)


@pytest.mark.parametrize("slope", [0.0, 4e-6, 9e-6])
def test_greatest_loads_are_off_by_about_what_is_told(bodies, slope):
    pair = replace(PAIR, wheel=replace(PAIR.wheel, lead=Lead(crowning=25e-6)))
    own = replace(bodies, pair=pair)
    given = {"alignment": Alignment(slope), "face_model": "walls"}
    few, many = (mesh_cycle(pair, 60.0, 8, own, cells=cells, **given).face for cells in (16, 64))
    for name, told in (("greatest_face_load_factor", few.error), ("greatest_line_load", few.line_load_error)):
        change = getattr(many, name) / getattr(few, name) - 1.0
        assert 0.5 * change < told < 2.0 * change


def test_errors_compare_the_greatest_loads_of_both_numbers_of_cells(bodies):
    """Walls: the greatest line load and factor of the cycle with half as many, wherever in the cycle they are."""
    given = {"alignment": Alignment(20e-6), "face_model": "walls"}
    most = {}
    for cells in (16, 8):
        face = mesh_cycle(PAIR, 60.0, 8, bodies, cells=cells, **given).face
        loads = face.line_load
        position, pair = np.unravel_index(int(loads.max(axis=-1).argmax()), loads.shape[:-1])
        summed = loads.sum(axis=-1)
        bearing = loads[np.arange(len(loads)), summed.argmax(axis=-1)]
        over_mean = bearing / bearing.mean(axis=-1, keepdims=True)
        most[cells] = face, loads[position, pair], over_mean[over_mean.max(axis=-1).argmax()]
    face, load, factor = most[16]
    assert face.line_load_error == pytest.approx(greatest_error(load, most[8][1]), rel=0.01)
    assert face.error == pytest.approx(greatest_error(factor, most[8][2]), rel=0.01)


def test_ends_that_change_nothing_add_no_error(bodies, monkeypatch):
    """Cells between walls, looked at as if their ends were free: the same without them, so that errors stay."""
    seen = []
    monkeypatch.setattr(
        shared_contacts, "cell_errors", lambda *given: seen.append(given) or cell_errors(*given)
    )
    mesh_cycle(PAIR, 60.0, 4, bodies, cells=16, alignment=Alignment(20e-6), face_model="walls")
    over, face, fine, coarse = seen.pop()
    walls, free = (
        cell_errors(over, replace(face, model=model), fine, coarse) for model in (WALLS, FREE_ENDS)
    )
    assert free.factor == pytest.approx(walls.factor, abs=1e-4)
    assert free.line_load == pytest.approx(walls.line_load, abs=1e-4)
    assert free.ends == pytest.approx(0.0, abs=1e-3)


def test_means_feel_less_of_what_changes_sign(bodies):
    """Cells change the tangent to either side within a cycle: its mean errs less than its extremes are told to."""
    found = mesh_cycle(
        PAIR, 50.0, 16, bodies, cells=16, alignment=Alignment(60e-6), face_model="walls", beyond_path=False
    )
    scatter = found.problem.scatter["stiffness"]
    assert 0.0 < scatter.of_mean < scatter.varying <= scatter.size
    assert found.errors["mean_stiffness"] < found.errors["greatest_stiffness"]


def test_what_cells_change_of_a_phase_may_be_a_size_with_others(bodies):
    """Fewer cells that shift the whole transmission error by 0.001 base pitches leave sizes of harmonics uncertain."""
    arcs = mesh_cycle(PAIR, 100.0, 8, bodies, cells=16, alignment=Alignment(20e-6), face_model="walls").arcs
    moved = tuple(replace(one, low=one.low + 1e-3, high=one.high + 1e-3) for one in arcs.arcs.arcs)
    fewer = replace(arcs.compared.fewer, arcs=replace(arcs.arcs, arcs=moved), share=1.0)
    others = known(replace(arcs.compared, before=None, fewer=fewer))
    size, told = replace(arcs, others=others, other=0.0).amplitudes(
        "transmission_error", np.array([1, 2]), over_mean=False
    )
    turned = 2.0 * np.pi * np.array([1, 2]) * 1e-3
    assert np.all(told > 0.5 * turned * size)
    assert np.all(told < turned * size)
