"""Films over the face: the table against films, the even load, mirror, balance, light loads, what is refused."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import ehl
import fem
from base import InputError
from base.later import known
from fem.laws.local_law import film_yielding
from flankfilm import coupling
from flankfilm.coupling import FilmModel, Flanks, LoadedTeeth, LubricatedCycle, PlacedMeniscus, lubricate
from flankfilm.coupling.films import film_table
from flankfilm.coupling.films.film_table import HEAVIEST, LIGHTEST
from flankfilm.coupling.films.films import contacts_of
from flankfilm.coupling.films.least_film import least_of
from flankfilm.coupling.mesh.resolution import resolution_of
from gears import Alignment, Gear, GearPair, Lead
from gears.sharing.mesh_arcs import Compared

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
OIL = ehl.Lubricant(0.05, 19e-9, 870.0)
SPEED, TORQUE, CELLS = 200.0, 100.0, 8
FORMULA = FilmModel("dowson")
SLOPE = Alignment(20e-6)
Cycles = Callable[..., LubricatedCycle]


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, tolerance=0.02)


@pytest.fixture(scope="module")
def cycles(bodies) -> Cycles:
    def lubricated(
        film=FORMULA,
        torque=TORQUE,
        pair=PAIR,
        positions=8,
        cells=CELLS,
        alignment=SLOPE,
        speed=SPEED,
        oil=OIL,
        films=1.0,
    ):
        flanks = Flanks(alignment=alignment, cells=cells, face_model="walls")
        teeth = LoadedTeeth(pair, torque, compliance=replace(bodies, pair=pair), flanks=flanks)
        dry = teeth.cycle(positions)
        asked = resolution_of(0.01)
        asked = replace(asked, films=films * asked.films)
        return lubricate(teeth, dry, speed, oil, asked, film, profiles=False)

    return lubricated


@pytest.fixture(scope="module")
def heard(cycles) -> tuple[LubricatedCycle, list[str]]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = cycles(FilmModel())
    return found, [str(one.message) for one in caught]


@pytest.fixture(scope="module")
def solved(heard) -> LubricatedCycle:
    return heard[0]


def test_pressures_that_are_warned_of_are_those_of_contacts(heard):
    """The table reaches beyond the loads that cells have, and so do the pressures of its films."""
    found, said = heard
    greatest = found.film.greatest_pressure
    assert [one.split()[2] for one in said if "Hertz pressure" in one] == [f"{1e-9 * greatest:.2f}"]
    assert greatest == pytest.approx(np.nanmax(found.dry.contact.hertz_pressure), rel=0.05)
    path = PAIR.path_at(found.over_face.table.rho1)
    heaviest = ehl.LineContact(
        found.over_face.table.load[-1], 1.0, path.radius.min(), PAIR.reduced_modulus, OIL
    )
    assert heaviest.peak_pressure > 1.05 * greatest


def _film(rho1: float, load: float, supply: ehl.Meniscus | None = None) -> ehl.Film:
    path = PAIR.path_at(np.array([rho1]))
    u, radius = float(path.entrainment(SPEED)[0]), float(path.radius[0])
    return ehl.solve(ehl.LineContact(load, u, radius, PAIR.reduced_modulus, OIL), 1e-3, supply=supply)


def test_the_table_is_what_films_are_between_its_places_and_loads(solved):
    """Films solved by themselves, ten times as sharply, where the table has none: within what it says of itself."""
    table, over = solved.over_face.table, solved.over_face
    assert 0.0 < over.error < 0.01
    heaviest = HEAVIEST * solved.dry.contact.face.greatest_line_load
    assert table.load[[0, -1]] == pytest.approx([LIGHTEST * heaviest / HEAVIEST, heaviest])
    chance = np.random.default_rng(1)
    for _ in range(6):
        rho1 = chance.uniform(table.rho1[0], table.rho1[-1])
        load = np.exp(chance.uniform(*np.log(table.load[[0, -1]])))
        at = np.array([rho1]), np.array([load])
        film = _film(rho1, float(load))
        assert table.thickness("minimum_thickness", *at) == pytest.approx(
            film.minimum_thickness, rel=over.error
        )
        assert table.thickness("central_thickness", *at) == pytest.approx(
            film.central_thickness, rel=over.central_error
        )
        separation, _ = table(at[0], at[1] * PAIR.face_width)
        assert separation == pytest.approx(film.separation, rel=over.error)


def test_the_law_slopes_as_it_falls_at_all_loads(solved):
    """Below the lightest load and above the heaviest as well: Newton's method of the load share asks for it."""
    table = solved.over_face.table
    forces = PAIR.face_width * np.geomspace(0.1 * table.load[0], 3.0 * table.load[-1], 60)
    rho1, step = np.full(60, PAIR.points.C), 1e-5 * forces
    rise = (table(rho1, forces + step)[0] - table(rho1, forces - step)[0]) / (2.0 * step)
    separation, slope = table(rho1, forces)
    # curvature of the splines times the step, and both sides of the lightest and heaviest load
    np.testing.assert_allclose(slope, rise, rtol=1e-3, atol=1e-9 * float(np.max(np.abs(slope))))
    assert np.all(np.diff(separation) < 0.0)
    assert np.all(np.isfinite(table(rho1[:1], np.zeros(1))[0]))
    assert table(np.array([np.nan]), forces[:1]) == (0.0, 0.0)


def test_the_error_of_a_table_is_that_of_its_places_and_that_of_its_loads(solved):
    """Films that change along the path alone, and by the load alone: every second row of either misses them."""
    table = solved.over_face.table
    wave = np.cos(np.pi * np.arange(len(table.rho1)))[:, None], np.cos(np.pi * np.arange(len(table.load)))
    for along in wave:
        film = 1e-6 * (1.0 + 0.01 * along) * np.ones_like(table.separation)
        found = replace(table, central_thickness=film)
        assert found.central_error > 0.001
    assert replace(table, central_thickness=np.full_like(film, 1e-6)).central_error == pytest.approx(
        0.0, abs=1e-9
    )


def test_an_even_load_has_the_films_of_the_plane(cycles, bodies):
    """Cells between walls without alignment bear alike: mesh and films are those of a plane pair."""
    even = cycles(alignment=Alignment())
    teeth = LoadedTeeth(PAIR, TORQUE, compliance=bodies)
    plane = lubricate(teeth, teeth.cycle(8), SPEED, OIL, resolution_of(0.01), FORMULA, profiles=False)
    prop = np.abs(plane.transmission_error - plane.dry.transmission_error)  # what films prop the flanks apart
    assert np.all(np.abs(even.transmission_error - plane.transmission_error) < 2e-3 * prop)
    for kind in ("secant_stiffness", "stiffness"):
        change, other = (getattr(one, kind) / getattr(one.dry, kind) - 1.0 for one in (even, plane))
        np.testing.assert_allclose(change, other, rtol=0.02, atol=2e-5)
    np.testing.assert_allclose(even.least_film, plane.least_film, rtol=2e-3)
    assert even.over_face.side_flow == pytest.approx(0.0, abs=1e-9)


def test_without_cells_nothing_has_changed(cycles, bodies):
    teeth = LoadedTeeth(PAIR, TORQUE, compliance=bodies)
    plane = lubricate(teeth, teeth.cycle(8), SPEED, OIL, resolution_of(0.01), FORMULA, profiles=False)
    assert plane.over_face is None
    assert plane.rounds > 1


def test_films_are_thinnest_where_most_is_borne(solved):
    over, film = solved.over_face, solved.film
    face = solved.contact.face
    np.testing.assert_array_equal(over.line_load, face.line_load)
    width = PAIR.face_width / CELLS
    np.testing.assert_allclose(over.line_load.sum(axis=-1) * width, solved.forces, rtol=1e-9, atol=1e-6)
    assert over.least_film_place == over.face_position[0] < 0.0  # the end that the alignment closes
    assert np.nanmin(solved.least_film) == over.least_film
    # films of the most loaded cells, solved by themselves
    both = over.error + film.error
    assert over.least_film == pytest.approx(film.minimum_thickness.min(), rel=both)
    assert film.load.max() == over.line_load.max() > 1.3 * solved.forces.max() / PAIR.face_width
    assert over.greatest_film_pressure == pytest.approx(film.greatest_pressure, rel=0.01)
    assert over.end_zone < 0.02 * PAIR.face_width
    assert 0.0 < over.side_flow < 0.05
    mean = coupling.FilmModel().stiffness
    assert film.stiffness[mean].min() > 10.0 * solved.stiffness.max()


def test_widths_and_pressures_of_cells_are_those_of_hertz(solved):
    """b = (8 w R/(pi E'))^1/2 and p_H = (w E'/(2 pi R))^1/2, from loads and places of the cells."""
    over = solved.over_face
    bear, whole = np.isfinite(over.half_width), PAIR.points.E - PAIR.points.A
    on_path = (over.travel > 0.0) & (over.travel < whole)  # beyond it a tip edge bears
    assert np.array_equal(bear, on_path[..., None] & (over.line_load > 0.0))
    rho1 = np.broadcast_to(PAIR.points.A + over.travel[..., None], bear.shape)[bear]
    radius = rho1 * (1.0 - rho1 / (PAIR.path_of_contact().rho1 + PAIR.path_of_contact().rho2)[0])
    modulus, load = PAIR.reduced_modulus, over.line_load[bear]
    np.testing.assert_allclose(over.half_width[bear] ** 2, 8.0 * load * radius / (np.pi * modulus), rtol=1e-9)
    np.testing.assert_allclose(
        over.hertz_pressure[bear] ** 2, load * modulus / (2.0 * np.pi * radius), rtol=1e-9
    )
    assert over.end_zone == np.nanmax(over.half_width[..., 0])  # the alignment closes this end


def test_films_add_their_error_by_what_they_change_of_the_stiffness(solved):
    changed = np.abs(solved.secant_stiffness / solved.dry.secant_stiffness - 1.0).max()
    assert changed > 0.001
    own = solved.contact.error
    assert solved.error == pytest.approx(own + solved.over_face.error * changed, rel=1e-9)


def test_the_least_film_errs_as_films_do_and_by_what_lies_between_them(solved):
    film = solved.film
    value, off = least_of(film.minimum_thickness, film.load)
    assert off / value > 1e-3
    assert film.least_film_error == pytest.approx(np.hypot(film.error, off / value), rel=1e-12)


def test_an_alignment_turned_round_mirrors_the_films(cycles):
    one, other = (cycles(alignment=Alignment(turn * 20e-6)).over_face for turn in (1, -1))
    np.testing.assert_allclose(one.minimum_thickness, other.minimum_thickness[..., ::-1], rtol=1e-8)


def test_light_load_on_a_large_slope(cycles):
    """Cells that carry nothing have no film; oil spreads the load over more cells than touch without it."""
    light = cycles(torque=5.0, alignment=Alignment(60e-6), cells=16)
    over, dry = light.over_face, light.dry.contact.face
    assert dry.contact_pattern < 0.2
    idle = over.line_load < over.lightest_load
    assert idle.any()
    np.testing.assert_array_equal(np.isnan(over.minimum_thickness), idle | np.isnan(over.hertz_pressure))
    assert light.contact.face.contact_pattern >= dry.contact_pattern
    assert np.all(light.transmission_error < light.dry.transmission_error)  # films prop the flanks apart
    assert light.contact.face.greatest_line_load < dry.greatest_line_load
    assert over.least_film == pytest.approx(light.film.minimum_thickness.min(), rel=0.01)


def test_a_contact_that_ends_within_the_face(cycles):
    crowned = replace(PAIR, pinion=Gear(teeth=20, lead=Lead(crowning=150e-6)))
    over = cycles(pair=crowned, alignment=None, cells=16).over_face
    np.testing.assert_allclose(over.minimum_thickness, over.minimum_thickness[..., ::-1], rtol=1e-6)
    assert np.isnan(over.minimum_thickness[..., [0, -1]]).all()
    assert abs(over.least_film_place) < PAIR.face_width / 16


def test_the_secant_counts_what_films_of_cells_yield(cycles):
    """An even load over cells yields what a whole face does."""
    even = cycles(alignment=Alignment())
    table = even.over_face.table
    whole = film_yielding(table, even.rho1, even.forces, even.load_share)
    force = PAIR.normal_force(TORQUE)
    yielded = force / even.secant_stiffness - (force / even.contact.secant_stiffness)
    np.testing.assert_allclose(yielded, whole, rtol=1e-6)


@pytest.mark.slow
def test_arcs_with_films_over_the_face_have_the_curves(cycles):
    """Means of the arcs are those of many positions, secants counted alike."""
    found = cycles(positions=24)
    assert found.mean_secant_stiffness == pytest.approx(found.secant_stiffness.mean(), rel=2e-3)
    assert found.secant_stiffness_change < 0.0


def _relative(cycle: LubricatedCycle) -> np.ndarray:
    """Means, peak to peak, extremes and harmonics with what films err by, relative (10, 2)."""
    of_films = known(Compared(varied=cycle.arcs.compared.varied))
    found = replace(cycle.arcs, other=0.0, others=of_films)
    both = ("stiffness", "secant_stiffness")
    every = [found.mean(name) for name in both] + [found.range("transmission_error")]
    every += [found.extreme(name, greatest) for name in both for greatest in (False, True)]
    sizes, errors = found.amplitudes("stiffness", np.arange(1, 4), over_mean=True)
    return np.array([(one.value, one.error) for one in every] + list(zip(sizes, errors, strict=True)))


CASES = (100.0, 200.0, 0.05), (10.0, 1500.0, 0.05), (40.0, 600.0, 0.3)
"""Torque [N m], speed [rad/s] and viscosity [Pa s]: films change the stiffness by 1, 4 and 5 %."""


def _parts(cycles, torque: float, speed: float, viscosity: float) -> np.ndarray:
    """Errors over their estimates, against twice as many places and loads, and films solved ten times as sharply."""
    given = {"film": FilmModel(), "torque": torque, "speed": speed, "oil": replace(OIL, viscosity=viscosity)}
    found = _relative(cycles(**given))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(film_table, "PLACES", 2 * film_table.PLACES - 1)
        patch.setattr(film_table, "LOADS", 2 * film_table.LOADS - 1)
        finer = _relative(cycles(**given, films=0.1))
    return np.abs(found[:, 0] - finer[:, 0]) / found[:, 1]


@pytest.mark.long
@pytest.mark.slow
def test_figures_by_arcs_err_by_what_films_over_the_face_do(cycles):
    """28 of 30 figures are off by less than twice their estimates, and these do not lose touch with the errors."""
    parts = np.concatenate([_parts(cycles, *case) for case in CASES])
    assert np.sum(parts < 2.0) >= 28
    assert parts.max() < 5.0
    assert 0.05 < np.median(parts) < 1.0


def test_films_by_formula_err_by_their_interpolation_alone(cycles):
    formula = cycles().over_face.table
    assert formula.separation_shift is None
    assert [table.separation.shape for table, _ in formula.varied()] == [(5, 21), (9, 11)]


def test_films_that_err_move_the_figures_of_arcs(solved):
    """What is varied is in the errors of means: more than the mesh and the cells alone give."""
    arcs = solved.arcs
    off, *grids = solved.over_face.table.varied()
    np.testing.assert_allclose(
        off[0].separation / solved.over_face.table.separation - 1.0,
        solved.over_face.table.separation_shift,
        atol=1e-12,
    )
    assert 0.0 < np.abs(solved.over_face.table.separation_shift).max() <= solved.over_face.film_error
    by_films, rest = arcs.compared.varied[:3], arcs.compared.varied[3:]
    assert [share for _, share in by_films] == [1.0, *(share for _, share in grids)]
    without = replace(arcs, others=known(replace(arcs.compared, varied=rest)))
    for name in ("stiffness", "secant_stiffness"):
        whole, own = arcs.mean(name), without.mean(name)
        changes = [share * abs(own.value - other.mean(name)[0]) for other, share in by_films]
        assert whole.error == pytest.approx(np.hypot(own.error, np.linalg.norm(changes)), rel=1e-9)
        assert min(changes) > 0.0


@pytest.mark.slow
def test_a_layer_of_oil_and_roughness(cycles):
    flooded = cycles(FilmModel(), positions=4)
    thin = 0.4 * flooded.over_face.least_film
    starved = cycles(FilmModel(supply=ehl.OilLayer(thin)), positions=4).over_face
    assert np.nanmax(starved.minimum_thickness) < thin
    ground = ehl.Roughness(deviation=0.3e-6, density=3.3e9, tip_radius=4e-5)
    rough = cycles(FilmModel(roughness=ground), positions=4).over_face
    assert rough.least_film > flooded.over_face.least_film  # asperities carry a share


@pytest.mark.slow
def test_a_meniscus_that_stands_at_one_place_for_all_cells(cycles, bodies):
    """Even cells have the films of the plane, and yield as those do; on a slope films are as solved alone."""
    held = FilmModel(supply=ehl.Meniscus(-0.18e-3))  # 1.6 half-widths of the heaviest contacts
    even, teeth = cycles(held, alignment=Alignment()), LoadedTeeth(PAIR, TORQUE, compliance=bodies)
    plane = lubricate(teeth, teeth.cycle(8), SPEED, OIL, resolution_of(0.01), held, profiles=False)
    np.testing.assert_allclose(even.least_film, plane.least_film, rtol=2.0 * even.over_face.error)
    change, other = (one.stiffness / one.dry.stiffness - 1.0 for one in (even, plane))
    np.testing.assert_allclose(change, other, rtol=0.02)
    sloped, flooded = cycles(held).over_face, cycles(FilmModel()).over_face
    assert np.nanmin(flooded.minimum_thickness[3] / sloped.minimum_thickness[3]) > 1.02
    at = (3, 1, 5)
    rho1 = PAIR.points.A + sloped.travel[at[:2]]
    alone = _film(rho1, sloped.line_load[at], held.supply)
    assert sloped.minimum_thickness[at] == pytest.approx(alone.minimum_thickness, rel=sloped.error)


def test_what_is_refused(cycles, bodies):
    for film, where in (
        (FilmModel(supply=PlacedMeniscus(1.3)), "film.supply"),
        (FilmModel(supply=ehl.Meniscus(-0.05e-3)), "meniscus"),
        (FilmModel(definition="tangent"), "film.definition"),
    ):
        with pytest.raises(InputError) as told:
            cycles(film)
        assert where in str(told.value)
    flanks = Flanks(alignment=SLOPE, cells=CELLS, face_model="walls")
    dry = LoadedTeeth(PAIR, TORQUE, compliance=bodies, flanks=flanks).cycle(4)
    with pytest.raises(InputError, match="with cells of the face"):
        contacts_of(PAIR, dry, SPEED, OIL)


@pytest.mark.slow
@pytest.mark.parametrize("backlash", [15e-6, 8e-6])
def test_films_on_back_flanks_carry_as_rigid_cylinders_in_an_isoviscous_oil(cycles, backlash):
    r"""Martin's F = 4.896 eta u R b/h, over the path; h is the backlash and what the front flanks are apart."""
    cycle = cycles(FilmModel(), torque=2.0, pair=PAIR.with_backlash(backlash), alignment=Alignment()).contact
    rho1 = np.linspace(PAIR.points.A, PAIR.points.E, 2001)
    path = PAIR.path_at(rho1)
    product = np.trapezoid(path.entrainment(SPEED) * path.radius, rho1) / PAIR.base_pitch
    height = backlash + cycle.transmission_error.mean()
    martin = 4.896 * OIL.viscosity * product * PAIR.face_width / height
    # a sum over eight positions stands for the path, and viscosity grows a little
    assert cycle.opposite_force.mean() == pytest.approx(martin, rel=0.07)
    net = cycle.forces.sum(axis=1) - cycle.opposite_force
    np.testing.assert_allclose(net * PAIR.base_radii[0], 2.0, rtol=1e-9)


@pytest.mark.slow
def test_gears_that_jam_out_of_parallel_have_films_on_one_side(cycles):
    cycle = cycles(FORMULA, torque=2.0, pair=PAIR.with_backlash(15e-6)).contact
    assert not cycle.opposite_force.any()
    assert "the teeth jam" in cycle.message
    assert "which is left out" in cycle.message
