"""What a film with heat answers to its load: the isothermal limit, films at other loads, refusals."""

from dataclasses import replace

import pytest

from base import InputError
from ehl import (
    Meniscus,
    OilLayer,
    Roughness,
    solve,
    solve_mixed,
    solve_mixed_thermal,
    solve_thermal,
    with_load_slopes,
)
from tests.ehl.test_thermal import OIL, SLIDING

pytestmark = pytest.mark.filterwarnings(
    "ignore:Hertz pressure", "ignore:mean shear stress", "ignore:roughness"
)


def test_without_heat_they_are_those_of_the_isothermal_film():
    cool = replace(SLIDING, lubricant=replace(OIL, eyring_stress=None), sliding=0.0)
    iso = solve(cool, nodes=129)
    film = with_load_slopes(solve_thermal(cool, None, nodes=129))
    assert film.central_slope == pytest.approx(iso.central_slope, rel=1e-3)
    assert film.stiffness() == pytest.approx(iso.stiffness(), rel=film.errors.approach_stiffness)
    assert film.errors.approach_stiffness < 0.05


def test_with_heat_they_are_those_between_films_at_other_loads():
    light, film, heavy = (
        solve_thermal(replace(SLIDING, load=g * SLIDING.load), nodes=129, tolerance=0.002)
        for g in (0.9, 1.0, 1.1)
    )
    assert film.stiffness("tangent") != film.stiffness("tangent")  # nan before
    film = with_load_slopes(film)
    step = 0.2 * SLIDING.load
    assert film.central_slope == pytest.approx(
        (heavy.central_thickness - light.central_thickness) / step, rel=0.02
    )
    # each of these grids was laid for another film: the separation ripples by more than on one grid
    assert film.separation_slope == pytest.approx(
        (heavy.separation - light.separation) / step, rel=0.05 + film.errors.approach_stiffness
    )
    assert film.stiffness("tangent") > 0


STARVED = [Meniscus(-1.5 * SLIDING.half_width), OilLayer(2e-7)]
COOL = replace(SLIDING, lubricant=replace(OIL, eyring_stress=None), sliding=0.0)
GROUND = Roughness(deviation=0.6e-6, density=0.04 / (150 * 0.6e-6**2), tip_radius=150 * 0.6e-6)


@pytest.mark.parametrize("supply", STARVED)
def test_without_heat_starved_ones_are_those_of_the_isothermal_film(supply):
    iso = solve(COOL, nodes=129, supply=supply)
    film = with_load_slopes(solve_thermal(COOL, None, nodes=129, supply=supply))
    assert film.central_slope == pytest.approx(iso.central_slope, rel=3e-3)
    assert film.separation_slope == pytest.approx(iso.separation_slope, rel=3e-3)
    assert film.errors.approach_stiffness == pytest.approx(iso.errors.approach_stiffness, abs=0.01)


@pytest.mark.parametrize("supply", STARVED)
def test_with_heat_starved_ones_are_those_between_films_at_other_loads(supply):
    film = with_load_slopes(solve_thermal(SLIDING, nodes=129, supply=supply))
    assert film.starved
    light, heavy = (
        solve_thermal(replace(SLIDING, load=g * SLIDING.load), nodes=129, tolerance=1e-4, supply=supply)
        for g in (0.97, 1.03)
    )
    for name, slope in (("separation", film.separation_slope), ("central_thickness", film.central_slope)):
        difference = (getattr(heavy, name) - getattr(light, name)) / (0.06 * SLIDING.load)
        assert slope == pytest.approx(difference, rel=0.01), name
    assert film.stiffness("approach") == -1.0 / film.separation_slope


@pytest.mark.parametrize("supply", [None, *STARVED])
def test_rough_ones_are_those_between_films_at_other_loads(supply):
    film = with_load_slopes(solve_mixed_thermal(SLIDING, GROUND, tolerance=1e-3, supply=supply))
    assert 0.01 < film.asperity_share < 0.9
    light, heavy = (
        solve_mixed_thermal(replace(SLIDING, load=g * SLIDING.load), GROUND, tolerance=1e-3, supply=supply)
        for g in (0.95, 1.05)
    )
    for name, slope in (("separation", film.separation_slope), ("central_thickness", film.central_slope)):
        difference = (getattr(heavy, name) - getattr(light, name)) / (0.1 * SLIDING.load)
        assert slope == pytest.approx(difference, rel=0.01), name
    assert film.stiffness() == film.film.stiffness() * film.gap_slope + film.asperity_stiffness


def test_rough_ones_without_heat_are_those_of_the_isothermal_film():
    iso = solve_mixed(COOL, GROUND, tolerance=1e-3)
    film = with_load_slopes(solve_mixed_thermal(COOL, GROUND, solids=None, tolerance=1e-3))
    for name in ("separation_slope", "central_slope", "asperity_stiffness"):
        assert getattr(film, name) == pytest.approx(getattr(iso, name), rel=0.01), name


def test_smooth_flanks_leave_the_slopes_of_the_film():
    smooth = replace(GROUND, deviation=1e-9, density=0.04 / (150 * 1e-18), tip_radius=150e-9)
    film = with_load_slopes(solve_mixed_thermal(SLIDING, smooth))
    assert film.separation_slope == with_load_slopes(film.film).separation_slope
    assert film.asperity_stiffness == 0.0


def test_a_film_without_solution_is_refused():
    newtonian = replace(SLIDING.lubricant, eyring_stress=None)
    unresolved = solve_thermal(replace(SLIDING, lubricant=newtonian, sliding=30.0))
    assert not unresolved.converged
    for refused in (unresolved, solve(COOL, nodes=65)):
        with pytest.raises(InputError, match="must be a solved ThermalFilm"):
            with_load_slopes(refused)
