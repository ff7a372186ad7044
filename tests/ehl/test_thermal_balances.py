"""Balances of a film with heat, from its record alone: shear on both surfaces, mass, heat of compression."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ehl import STEEL, Solid, ThermalFilm, solve_thermal
from ehl.kernels.heat_kernels import compression_response
from tests.ehl.test_thermal import OIL, SLIDING

pytestmark = pytest.mark.filterwarnings("ignore:Hertz pressure", "ignore:mean shear stress")

IDEAL = Solid(1e5, 1e4, 5e3)
"""A body that takes all heat and stays at its bulk temperature."""


@pytest.fixture(scope="module")
def film() -> ThermalFilm:
    return solve_thermal(SLIDING)


def mean(film: ThermalFilm) -> np.ndarray:
    """Mean temperature across the film by the Lobatto rule of its places, whose weights are 1/P^2 but for a factor."""
    assert film.temperature is not None
    n = film.temperature.shape[1] - 1
    last = np.polynomial.Legendre.basis(n)
    weights = 1.0 / last(np.concatenate([[-1.0], np.sort(last.deriv().roots().real), [1.0]])) ** 2
    return np.asarray(film.temperature @ weights / weights.sum())


def test_the_shear_on_both_surfaces_holds_the_pressure(film):
    """Equilibrium of a column of oil: tau_2 - tau_1 = h p', place by place."""
    stress, b = film.shear_stress, SLIDING.half_width
    apart, push = stress[:, 1] - stress[:, 0], film.thickness * np.gradient(film.pressure, film.x)
    inside = (np.abs(film.x) > 0.3 * b) & (np.abs(film.x) < 0.85 * b)
    np.testing.assert_allclose(apart[inside], push[inside], rtol=0.01)
    assert np.abs(apart).max() == pytest.approx(np.abs(push).max(), rel=0.01)
    assert np.trapezoid(apart, film.x) == pytest.approx(2.0 * film.rolling_friction, rel=1e-3)


def flow_at_the_top(film: ThermalFilm) -> tuple[float, float]:
    """Mass flow over rho0 u [m] where pressure has its maximum and moves no oil, by rho h there; and the oil's rise."""
    oil, slope = film.contact.lubricant, np.diff(film.pressure)
    j = int(np.flatnonzero((slope[:-1] > 0.0) & (slope[1:] <= 0.0))[0]) + 1
    rise = mean(film) - oil.temperature
    density = oil.density_ratio(film.pressure)[0] * (1.0 - oil.expansion * rise)
    return float(density[j] * film.thickness[j]), float(rise[j])


def test_oil_that_is_warm_is_thinner_by_weight(film):
    """What flows is rho(p, T) h u in the middle, 26 K above the inlet's temperature; the shear there moves 0.1 %."""
    flow, rise = flow_at_the_top(film)
    assert rise > 20.0
    assert flow == pytest.approx(film.flow, rel=0.003)


def test_what_a_film_cost_are_pressures_and_the_separation(film):
    """Pressures vanish at both ends: two unknowns fewer than nodes, and the separation."""
    assert film.cost.unknowns == film.x.size - 1


def test_heat_of_compression_is_followed_downstream():
    """Newton's derivative of mean temperatures by pressures, cell by cell in plain words."""
    chance = np.random.default_rng(5)
    nodes = np.cumsum(chance.uniform(0.05, 0.3, 7))
    response = chance.uniform(0.1, 1.0, (6, 2))
    found = compression_response(nodes, response)
    for k in range(7):
        pressure = np.eye(7)[k]
        cells, warmed = np.empty(6), 0.0
        for f in range(6):
            warmed = response[f, 0] * warmed + response[f, 1] * (pressure[f + 1] - pressure[f])
            cells[f] = warmed
        middles = 0.5 * (nodes[1:] + nodes[:-1])
        inside = np.interp(nodes[1:-1], middles, cells)
        lengths = np.diff(nodes)
        by_neighbours = (lengths[1:] * cells[:-1] + lengths[:-1] * cells[1:]) / (lengths[1:] + lengths[:-1])
        np.testing.assert_allclose(by_neighbours, inside, rtol=1e-12)  # linear between the middles
        np.testing.assert_allclose(found[1:-1, k], inside, rtol=1e-12, atol=1e-15)


def test_oil_that_is_held_warm_has_the_density_of_its_temperature():
    """Without heat and with an even viscosity warmth changes the density alone, all over: same film, less of it."""
    oil = replace(OIL, viscosity_slope=1e-9, expansion=2e-3)
    contact = replace(SLIDING, lubricant=oil)
    cool, warm = (solve_thermal(contact, None, (T, T), nodes=129) for T in (353.15, 400.15))
    assert warm.central_thickness == pytest.approx(cool.central_thickness, rel=1e-6)
    assert warm.flow / cool.flow == pytest.approx(1.0 - 47.0 * 2e-3, rel=1e-6)


def test_oil_warms_as_it_is_compressed_and_cools_as_it_expands():
    """Rolling between ideal bodies: a source beta T u p' makes a rise of beta T u p' h^2/(12 k), odd about the middle.

    What little heat shear makes there is even. The heat of compression is in the balance of the whole.
    """
    contact = replace(SLIDING, sliding=0.0)
    film = solve_thermal(contact, (IDEAL, IDEAL), nodes=257)
    oil, b, x, T = contact.lubricant, contact.half_width, film.x, mean(film)
    source = oil.expansion * T * contact.entrainment * np.gradient(film.pressure, x)
    expected = source * film.thickness**2 / (12.0 * oil.conductivity)
    for place in (0.3, 0.4, 0.5):
        rise, wanted = (
            np.interp(-place * b, x, some) - np.interp(place * b, x, some) for some in (T, expected)
        )
        assert wanted > 0.5
        assert rise == pytest.approx(wanted, rel=0.03)
    assert abs(film.losses.closure) < 0.012  # that of compression is 0.021


@pytest.mark.parametrize("load", [2e5, 20e3, 8e3])
@pytest.mark.parametrize("sliding", [-2.0, 1.0])
def test_heat_closes_between_bodies_of_unequal_temperatures(load, sliding):
    """Oil that runs back in the inlet carries heat at the temperature of its layer, the hot body's or the cold one's.

    Without it 3 to 20 % of the heat that goes through were missing; what is left settles last.
    """
    contact = replace(SLIDING, load=load, sliding=sliding)
    for bulk in ((383.0, 343.0), (343.0, 383.0)):
        film = solve_thermal(contact, (STEEL, STEEL), bulk, 0.02)
        assert film.converged, film.message
        through = abs(film.losses.first_body) + abs(film.losses.second_body)
        missing = film.losses.closure * (film.losses.dissipation + film.losses.compression)
        assert abs(missing) < 0.02 * through
