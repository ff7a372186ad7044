"""Losses over the face: an even load loses what a plane pair does, cells add up, balance, errors."""

from __future__ import annotations

import numpy as np
import pytest

import ehl
import fem
import flankfilm as ff
from flankfilm.coupling import Flanks, MeshLosses
from flankfilm.coupling.films.line_contacts import line_contacts, with_sliding
from flankfilm.coupling.losses.heated_films import HeatedOil, heated_films
from flankfilm.coupling.losses.heated_table import HeatedTable, heated_table
from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth
from gears import Alignment, Gear, GearPair

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(300e-6)
OIL = ehl.Lubricant(0.05, 19e-9, 870.0, temperature=353.15, eyring_stress=5e6)
SPEED, TORQUE = 200.0, 100.0
STEELS = (ehl.STEEL, ehl.STEEL)


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, tolerance=0.05)


def _flanks(alignment: Alignment | None) -> Flanks:
    return Flanks() if alignment is None else Flanks(alignment=alignment, cells=8, face_model="walls")


@pytest.fixture(scope="module")
def table(bodies) -> HeatedTable:
    cycle = LoadedTeeth(PAIR, TORQUE, compliance=bodies, flanks=_flanks(Alignment(20e-6))).cycle(4)
    oil = HeatedOil(STEELS, None, 0.1, 0.05)
    return heated_table(PAIR, cycle, SPEED, OIL, oil, (353.15, 353.15), (5, 3))


def test_the_table_has_its_films_at_its_places(table):
    place, load = np.meshgrid(table.rho1, table.load, indexing="ij")
    for figure in ("friction", "minimum_thickness", "rolling"):
        own = np.array([getattr(row, figure) for row in table.rows])
        np.testing.assert_allclose(table.at(figure, place, load), own, rtol=1e-9)
    assert table.rho1[2] == PAIR.points.C
    hottest = max(film.oil_temperature_rise for film in table.films)
    assert table.at("oil_rise", place, load).max() == pytest.approx(hottest)
    # beyond the table stands its nearest
    beyond = table.at("friction", table.rho1[:1], 0.1 * table.load[-1:])
    assert beyond == pytest.approx(table.rows[0].friction[-1])


def test_halves_of_the_table_keep_its_ends(table):
    for along, other in ((0, table.every_second(0)), (1, table.every_second(1))):
        kept = (other.rho1, other.load)[along]
        whole = (table.rho1, table.load)[along]
        assert kept.size == (whole.size + 1) // 2
        assert kept[[0, -1]].tolist() == whole[[0, -1]].tolist()
    assert len(table.every_second(1).rows[0].films) == 2
    assert table.every_second(0).rho1[1] == PAIR.points.C


def lost(bodies, alignment: Alignment | None, **more) -> MeshLosses:
    given = {"tolerance": 0.02, "positions": 8, "compliance": bodies, **more}
    return ff.mesh_losses(PAIR, TORQUE, SPEED, OIL, flanks=_flanks(alignment), **given)


@pytest.fixture(scope="module")
def aligned(bodies) -> MeshLosses:
    return lost(bodies, Alignment(20e-6))


@pytest.mark.slow
def test_an_even_load_loses_what_a_plane_pair_does(bodies):
    plane, even = lost(bodies, None), lost(bodies, Alignment())
    assert plane.over_face is None
    both = plane.error + even.error
    assert both < 0.1
    for figure in ("mean_friction", "sliding_loss", "mesh_loss"):
        assert getattr(even, figure) == pytest.approx(getattr(plane, figure), rel=both)
    # sampled at eight and at three times as many positions
    assert even.loss_factor == pytest.approx(plane.loss_factor, rel=0.02)
    np.testing.assert_allclose(even.path.minimum_thickness, plane.path.minimum_thickness, rtol=0.02)


@pytest.mark.slow
def test_cells_add_up(aligned):
    over, path = aligned.over_face, aligned.path
    width = PAIR.face_width / 8
    both = over.sliding_loss + over.rolling_loss
    assert width * over.mean_loss.sum() == pytest.approx(width * both.sum() / 8, rel=1e-12)
    # the loss on the path at these positions is that of three times as many
    assert width * over.mean_loss.sum() == pytest.approx(
        aligned.sliding_loss + aligned.rolling_loss, rel=2.0 * aligned.error
    )
    assert path.sliding_loss.sum() == pytest.approx(width * over.sliding_loss.sum(), rel=0.01)
    assert aligned.heat.sum() == pytest.approx(aligned.mesh_loss, rel=1e-9)


@pytest.mark.slow
def test_the_end_that_bears_most_is_the_hottest_and_has_the_least_film(aligned):
    over, path = aligned.over_face, aligned.path
    cell = np.unravel_index(int(np.nanargmax(over.contact_temperature)), over.contact_temperature.shape)[2]
    assert cell == int(np.argmax(over.line_load.sum(axis=(0, 1)))) == 0
    assert np.argmax(over.mean_loss) == 0
    rise = aligned.greatest_contact_temperature - 353.15
    assert over.greatest_cell_temperature - 353.15 == pytest.approx(rise, rel=0.05)
    assert np.nanmin(over.minimum_thickness) == pytest.approx(path.least_film, rel=0.03)
    assert path.load.max() == over.line_load.max()


@pytest.mark.slow
def test_gears_take_up_what_their_surroundings_take_away(bodies):
    warm = lost(
        bodies, Alignment(20e-6), heat_transfer=(8.0, 9.0), ambient_temperature=313.15, tolerance=0.05
    )
    assert warm.bulk_temperatures == pytest.approx(313.15 + warm.heat / np.array([8.0, 9.0]), abs=1.0)


@pytest.mark.slow
def test_a_film_of_cold_gears_is_reached_from_that_of_warm_ones():
    """At 3 GPa and 48 C neither the film at 80 C nor none at all is near enough; half as far is."""
    at = np.array([PAIR.points.A])
    contacts = with_sliding(PAIR, at, line_contacts(PAIR, at, np.array([4.554e5]), SPEED, OIL), SPEED)
    oil = HeatedOil(STEELS, None, 0.1, 0.05)
    warm = heated_films(at, contacts, oil, (353.15, 353.15))
    cold = heated_films(at, contacts, oil, (321.13, 320.56), warm).films[0]
    assert cold.contact == contacts[0]
    assert cold.oils is not None
    assert cold.oils[0].bulk.tolist() == [321.13, 320.56]
    less = heated_films(at, contacts, oil, (322.0, 321.5), warm).films[0]
    assert less.minimum_thickness < cold.minimum_thickness == pytest.approx(less.minimum_thickness, rel=0.1)
