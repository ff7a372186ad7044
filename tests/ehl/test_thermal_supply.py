"""Starved films with heat: the isothermal limit, what a layer holds, and what starvation does to friction."""

from dataclasses import replace

import pytest

from base import InputError
from ehl import LineContact, Lubricant, Meniscus, OilLayer, solve, solve_thermal
from tests.ehl.test_thermal import OIL, SLIDING

pytestmark = pytest.mark.filterwarnings("ignore:Hertz pressure", "ignore:mean shear stress")

NEAR = Meniscus(-1.5 * SLIDING.half_width)
THIN = OilLayer(2e-7)


@pytest.mark.parametrize("supply", [NEAR, THIN, OilLayer(2e-6)])
def test_without_heat_it_is_the_starved_isothermal_film(supply):
    cool = replace(SLIDING, lubricant=replace(OIL, eyring_stress=None), sliding=0.0)
    iso = solve(cool, nodes=129, supply=supply)
    film = solve_thermal(cool, None, nodes=129, supply=supply)
    assert film.supply == supply
    assert film.central_thickness == pytest.approx(iso.central_thickness, rel=3e-4)
    assert film.minimum_thickness == pytest.approx(iso.minimum_thickness, rel=3e-4)
    assert film.flow == pytest.approx(iso.flow, rel=3e-4)


def test_a_layer_passes_whatever_the_heat():
    full = solve_thermal(SLIDING)
    for layer in (2e-8, 2e-7, 0.9 * full.flow):
        film = solve_thermal(SLIDING, supply=OilLayer(layer))
        assert film.converged, film.message
        assert film.flow == pytest.approx(layer, rel=2e-4)
        assert abs(film.losses.closure) < 0.002
        assert abs(film.traction_coefficient) > abs(full.traction_coefficient)
    assert solve_thermal(SLIDING, supply=OilLayer(1.1 * full.flow)).central_thickness == pytest.approx(
        full.central_thickness, rel=1e-9
    )


@pytest.mark.parametrize("supply", [NEAR, THIN, OilLayer(2e-6)])
@pytest.mark.parametrize("growth", [0.8, 1.1])
def test_a_neighbour_saves_steps_and_changes_nothing(supply, growth):
    heavier = replace(SLIDING, load=growth * SLIDING.load)
    alone = solve_thermal(heavier, supply=supply)
    film = solve_thermal(heavier, supply=supply, start=solve_thermal(SLIDING, supply=supply))
    assert film.starved == alone.starved == (supply != OilLayer(2e-6))
    assert film.cost.iterations < 0.7 * alone.cost.iterations
    for name in ("central_thickness", "minimum_thickness", "separation", "flow"):
        assert getattr(film, name) == pytest.approx(getattr(alone, name), rel=film.error)
    assert film.traction_coefficient == pytest.approx(alone.traction_coefficient, rel=film.traction_error)


@pytest.mark.parametrize("near", [None, NEAR, THIN])
@pytest.mark.parametrize("supply", [None, NEAR, THIN])
def test_a_start_that_was_supplied_otherwise_serves_as_well(supply, near):
    start = solve_thermal(SLIDING, supply=near)
    alone, film = solve_thermal(SLIDING, supply=supply), solve_thermal(SLIDING, supply=supply, start=start)
    assert film.converged
    assert film.central_thickness == pytest.approx(alone.central_thickness, rel=film.error)
    assert film.inlet == pytest.approx(alone.inlet, rel=0.01)


def test_a_near_meniscus_thins_the_film_and_keeps_its_place():
    film, full = solve_thermal(SLIDING, supply=NEAR), solve_thermal(SLIDING)
    assert film.inlet == pytest.approx(NEAR.position, rel=1e-9)
    assert film.central_thickness < 0.8 * full.central_thickness


def test_bad_supplies_are_refused():
    with pytest.raises(InputError, match="edge of the dry contact"):
        solve_thermal(SLIDING, supply=Meniscus(-0.5 * SLIDING.half_width))


@pytest.mark.parametrize("supply", ["near meniscus", "flooded"])
def test_a_limit_that_follows_the_pressure_takes_none_of_the_inlet(supply):
    """Pressure builds up from zero as if nothing yielded, on the grid of the tolerance and on a finer one."""
    oil = Lubricant(
        0.016,
        15e-9,
        831.0,
        temperature=373.15,
        viscosity_slope=0.029,
        eyring_stress=9.8e6,
        limiting_shear_ratio=0.047,
    )
    contact = LineContact(3.65e5, 8.65, 6.67e-3, 2.26e11, oil, sliding=-5.38)
    near = Meniscus(-1.275 * contact.half_width) if supply == "near meniscus" else None
    free = replace(contact, lubricant=replace(oil, limiting_shear_ratio=None))
    for nodes in (129, 257):
        limited, whole = (solve_thermal(c, nodes=nodes, supply=near) for c in (contact, free))
        assert limited.minimum_thickness == pytest.approx(whole.minimum_thickness, rel=1e-4)
        assert limited.central_thickness == pytest.approx(whole.central_thickness, rel=1e-4)
