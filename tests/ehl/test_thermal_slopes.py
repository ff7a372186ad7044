"""What a film with heat answers to its load: the isothermal limit, films at other loads, refusals."""

from dataclasses import replace

import pytest

from base import InputError
from ehl import solve, solve_thermal, with_load_slopes
from tests.ehl.test_thermal import OIL, SLIDING

pytestmark = pytest.mark.filterwarnings("ignore:Hertz pressure", "ignore:mean shear stress")


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


def test_a_film_without_solution_is_refused():
    newtonian = replace(SLIDING.lubricant, eyring_stress=None)
    unresolved = solve_thermal(replace(SLIDING, lubricant=newtonian, sliding=30.0))
    assert not unresolved.converged
    with pytest.raises(InputError, match="must be a solved ThermalFilm"):
        with_load_slopes(unresolved)
