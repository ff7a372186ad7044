"""Answer of films with heat to an oscillating load: heat of oil and surfaces in closed form, limits, asperities."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import erf

from ehl import (
    LineContact,
    Lubricant,
    Meniscus,
    OilLayer,
    Roughness,
    film_response,
    solve,
    solve_mixed_thermal,
    solve_thermal,
    with_load_slopes,
)
from ehl.discrete.collocation import lobatto
from ehl.discrete.equations import Groups
from ehl.discrete.newton import newton
from ehl.discrete.solids import STEEL, oscillating_heating, surface_heating
from ehl.discrete.squeeze import Content, Squeeze
from ehl.discrete.thermal_oil import Heat, ThermalOil
from ehl.kernels.heat_kernels import heat_across
from ehl.solving.levels import Level
from ehl.solving.stepping import Laying, Moment, backwards, steady

pytestmark = pytest.mark.filterwarnings("ignore:Hertz pressure", "ignore:roughness", "ignore:mean shear")

OIL = Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
SLIDING = LineContact(2e5, 2.5, 6e-3, 2.26e11, OIL, sliding=1.0)
RATE = SLIDING.entrainment / SLIDING.half_width
RATES = RATE * np.array([0.0, 0.1, 0.3, 1.0, 2.0])
SUPPLIES = [None, Meniscus(-1.3 * SLIDING.half_width), OilLayer(2e-7)]
DIFFUSIVITY = STEEL.conductivity / (STEEL.density * STEEL.heat_capacity)


@pytest.mark.parametrize("thick", [1e-6, 5e-6, 2e-5])
def test_oil_at_rest_stores_heat_as_the_closed_form_has_it(thick):
    """k T'' = i omega rho c T - s between cold walls: T = s/(i omega rho c) [1 - cosh(q z)/cosh(q h/2)]."""
    across = lobatto()
    k, c, omega, source = 0.14, 860.0 * 2000.0, 3e4, 1e12
    T = np.zeros((2, across.zeta.size), complex)
    none, flow = np.zeros((2, across.zeta.size), complex), np.zeros((3, across.zeta.size), complex)
    heat_across(
        np.array([0.0, 1e-4, 2e-4]),
        np.full(2, thick, complex),
        flow,
        none + 1.0,
        *(none.copy() for _ in range(5)),
        np.zeros(2, complex),
        np.zeros((2, 2, 2), complex),
        np.zeros((2, 2), complex),
        np.full(2, 1j * omega * c * thick),
        none + source * thick,
        T.copy(),
        T,
        np.zeros((2, 2), complex),
        np.zeros((2, 2), complex),
        0.0,
        k,
        across.zeta,
        across.weights,
        across.derive,
        across.stiffness,
        across.sum_up,
        1,
        1,
        False,
    )
    q = np.sqrt(1j * omega * c / k)
    exact = source / (1j * omega * c) * (1.0 - np.cosh(q * thick * across.zeta) / np.cosh(0.5 * q * thick))
    np.testing.assert_allclose(T[1], exact, atol=1e-4 * np.abs(exact).max())


@pytest.mark.parametrize("speed", [0.0, 0.2, -0.5])
def test_a_surface_heated_evenly_is_a_half_space_in_one_dimension(speed):
    """In the middle of 70 lengths over which the waves die out."""
    omega = 3e4
    edges = np.linspace(-1e-3, 1e-3, 801)
    still = surface_heating(edges, speed, STEEL, 0.01)
    answer = oscillating_heating(still, edges, speed, STEEL, 0.01, omega)
    exact = 1.0 / (STEEL.conductivity * np.sqrt(1j * omega / DIFFUSIVITY))
    assert answer.sum(axis=1)[400] == pytest.approx(exact, rel=0.03)


def test_what_has_passed_a_source_carries_the_heat_that_it_gave_then():
    """Fast: int exp(-i omega s/u)/sqrt(pi k rho c u s) ds from 0 to x."""
    omega, u = 3e4, 20.0
    edges = np.linspace(0.0, 2e-3, 401)
    x = 0.5 * (edges[1:] + edges[:-1])
    still = surface_heating(edges, u, STEEL, 0.01)
    answer = oscillating_heating(still, edges, u, STEEL, 0.01, omega).sum(axis=1)
    lag = 1j * omega / u
    capacity = STEEL.conductivity * STEEL.density * STEEL.heat_capacity
    exact = erf(np.sqrt(lag * x)) / np.sqrt(capacity * u * lag)
    np.testing.assert_allclose(answer[20:], exact[20:], rtol=0.02)
    np.testing.assert_allclose(oscillating_heating(still, edges, u, STEEL, 0.01, 0.0), still, rtol=1e-12)


@pytest.mark.parametrize("supply", SUPPLIES)
def test_without_heat_they_are_those_of_the_isothermal_film(supply):
    cool = replace(SLIDING, lubricant=replace(OIL, eyring_stress=None), sliding=0.0)
    film = solve_thermal(cool, None, nodes=129, supply=supply)
    answer, iso = film_response(film, RATES), film_response(solve(cool, nodes=129, supply=supply), RATES)
    assert answer.compliance == pytest.approx(iso.compliance, rel=0.012)
    assert answer.central_compliance == pytest.approx(iso.central_compliance, rel=0.012)


@pytest.mark.parametrize("supply", SUPPLIES)
def test_slow_oscillations_are_steady_and_heat_counts(supply):
    film = with_load_slopes(solve_thermal(SLIDING, nodes=129, supply=supply))
    answer = film_response(film, RATES)
    assert answer.converged
    assert answer.compliance[0].real == pytest.approx(-film.separation_slope, rel=0.008)
    assert answer.static_stiffness == film.stiffness()
    assert (
        film_response(replace(film, separation_slope=np.nan), RATES[0]).static_stiffness
        == answer.static_stiffness
    )
    iso = film_response(solve(SLIDING, nodes=129, supply=supply), RATES)
    off = np.abs(answer.compliance / iso.compliance - 1.0)
    assert 0.008 < off[0] < off[3]
    back = film_response(film, -RATES[3])
    assert complex(back.compliance) == pytest.approx(np.conj(answer.compliance[3]), rel=2e-3)


class Marching(ThermalOil):
    """An oil from one moment to the next, by differences in time; surfaces carry heat with u."""

    def begin(self, moments: list[ThermalOil], times: list[float], rates: tuple[float, float, float]) -> None:
        last, before = moments[-1], moments[max(len(moments) - 2, 0)]
        self.moments, self.times, self.rates = moments, times, rates
        self.temperature, self.into, self.sigma = (
            values.copy() for values in (last.temperature, last.into, last.sigma)
        )
        self.before = last.before
        self.past = sum(
            rate
            * (
                old.temperature
                + (self.middles - old.middles)[:, None] * np.gradient(old.temperature, old.middles, axis=0)
            )
            for rate, old in zip(rates[1:], (last, before), strict=True)
        )

    def heat(self) -> Heat:
        heat = super().heat()
        capacity = self.contact.lubricant.heat_capacity * self.shear.density * self.shear.gap
        flux = np.array([*(old.into for old in self.moments), self.into])  # (times, 2, cells)
        ambient = heat.ambient.copy()
        for side, u in enumerate(self.contact.surface_speeds):
            ago = np.maximum(self.middles[:, None] - self.middles, 0.0) / u
            at = np.clip(self.times[-1] - ago, self.times[0], None)
            k = np.clip(np.searchsorted(self.times, at) - 1, 0, len(self.times) - 2)
            start, end = np.array(self.times)[k], np.array(self.times)[k + 1]
            part, cell = (at - start) / (end - start), np.arange(self.middles.size)
            then = (1.0 - part) * flux[k, side, cell] + part * flux[k + 1, side, cell]
            ambient[side] += (self.bodies[side] * (then - self.into[side])).sum(axis=1)
        return heat._replace(
            ambient=ambient, stores=capacity * self.rates[0], added=-capacity[:, None] * self.past
        )


def test_with_heat_they_are_those_of_films_followed_in_time():
    """A load that rises and falls by two thousandths, on surfaces so fast that no heat runs ahead in them."""
    omega, n, per_period, amplitude = 1.0 * RATE, 65, 240, 2e-3
    oil = replace(OIL, expansion=0.0)
    contact = replace(SLIDING, lubricant=oil)
    film = solve_thermal(contact, nodes=n)
    level = film.state.fine
    laying = Laying(level.contact, level.plan, n, None)
    full = Content.under(level.grid, level.groups, level.solution.P, level.solution.H).oil
    moments, oils, times = [replace(steady(0.0, level), content=full)], [level.oil], [0.0]
    separation, centre = [], []
    for time in 2 * np.pi / omega * np.arange(1, 2 * per_period + 1) / per_period:
        now = replace(contact, load=contact.load * (1 + amplitude * np.sin(omega * time)))
        plan, grid = laying.grid(now)
        groups, rates = Groups.on(now, grid), backwards(moments, time)
        last, before = moments[-1], moments[max(len(moments) - 2, 0)]
        middles = 0.5 * groups.length * (grid.nodes[1:] + grid.nodes[:-1])
        squeeze = Squeeze(
            grid,
            groups,
            rates[0],
            -rates[1] * last.content - rates[2] * before.content,
            (rates[0] * middles + rates[1] * last.middles + rates[2] * before.middles) / now.entrainment,
            now.entrainment,
        )
        times.append(time)
        marching = Marching(now, grid, groups, film.solids, level.oil.bulk)
        marching.begin(oils, times, rates)
        P, H0 = last.pressure / groups.pressure, last.level.solution.H0
        with np.errstate(all="ignore"):
            solution = newton(grid, groups, P, H0, oil=marching, squeeze=squeeze, done=1e-5)
        assert solution.converged
        content = Content.under(grid, groups, solution.P, solution.H).oil
        moments = [*moments[-2:], Moment(time, Level(now, plan, grid, solution), content, middles)]
        oils.append(marching)
        separation.append(moments[-1].figures.separation)
        centre.append(moments[-1].figures.central_thickness)
    wave = (
        2.0
        / per_period
        * np.exp(-1j * omega * np.array(times[-per_period:]))
        / (-1j * amplitude * contact.load)
    )
    answer = film_response(film, omega)
    for values, compliance in ((separation, answer.compliance), (centre, answer.central_compliance)):
        marched = -wave @ np.array(values)[-per_period:]
        assert abs(marched / complex(compliance) - 1.0) < 0.013


@pytest.mark.parametrize("supply", [None, OilLayer(2e-7)])
def test_asperities_share_slow_loads_of_warm_films_as_steady_ones(supply):
    film = solve_mixed_thermal(SLIDING, Roughness.of_deviation(6e-7), tolerance=2e-3, supply=supply)
    assert film.asperity_share > 0.02
    answer = film_response(film, 0.0)
    assert complex(answer.compliance).real == pytest.approx(-answer.film.separation_slope, rel=0.01)
    assert complex(answer.central_compliance).real == pytest.approx(-answer.film.central_slope, rel=0.02)
