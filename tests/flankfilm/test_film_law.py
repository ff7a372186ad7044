"""The law of a film that a meniscus holds: value, slope, and the flooded film as its bound."""

from __future__ import annotations

import numpy as np
import pytest

from ehl import LineContact, Lubricant, Meniscus, solve
from flankfilm.film_law import FilmLaw


def law(prop: float, exponent: float, flooded: float = 7e-7, slow: float = 0.12) -> FilmLaw:
    one = np.ones(1)
    return FilmLaw(1e-3 * one, 1000 * one, prop * one, exponent * one, flooded * one, slow * one)


def at(found: FilmLaw, force: float) -> tuple[float, float]:
    prop, slope = found(np.array([[1e-3]]), np.array([[force]]))
    return float(prop[0, 0]), float(slope[0, 0])


@pytest.mark.parametrize("prop", [1e-8, 1e-7, 6.9e-7])
@pytest.mark.parametrize("exponent", [0.3, 12.0, 400.0])
def test_value_and_slope_are_met_and_the_slope_is_the_derivative(prop: float, exponent: float):
    found = law(prop, exponent)
    value, slope = at(found, 1000.0)
    assert value == pytest.approx(prop, rel=1e-12)
    assert slope == pytest.approx(-exponent * prop / 1000.0, rel=1e-12)
    for force in (300.0, 990.0, 1010.0, 3000.0):
        step = 1e-4 * force / exponent
        apart = (at(found, force + step)[0] - at(found, force - step)[0]) / (2 * step)
        assert at(found, force)[1] == pytest.approx(apart, rel=1e-4, abs=1e-20)


def test_a_light_contact_leaves_the_meniscus_behind():
    found = law(1e-7, 12.0)
    for force in (20.0, 100.0, 300.0):
        flooded = 7e-7 * (force / 1000.0) ** -0.12
        assert 0 < at(found, force)[0] <= flooded
    assert at(found, 50.0)[0] == pytest.approx(7e-7 * 0.05**-0.12, rel=1e-3)
    assert at(found, 0.0)[1] == 0.0
    assert np.isfinite(at(found, 1e6)).all()


def test_without_lack_of_oil_the_power_law_stands():
    for found in (law(7e-7, 0.2), law(8e-7, 0.2), law(3e-7, 0.05)):
        exponent = float(found.exponent[0])
        assert at(found, 500.0)[0] == pytest.approx(float(found.prop[0]) * 0.5**-exponent, rel=1e-12)


def test_the_law_follows_films_behind_a_meniscus_that_stays():
    """Against films solved at other loads: close near by, and never wild, where the power law is thirty times too much.

    Rounds of new films need no more than that: the last one evaluates the law where it was solved.
    """
    oil = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9)

    def contact(load: float) -> LineContact:
        return LineContact(load=load, entrainment=2.58, radius=6.48e-3, reduced_modulus=2.2e11, lubricant=oil)

    middle = 2.5e5
    held = Meniscus(-1.1 * contact(middle).half_width)
    film, flooded = solve(contact(middle), supply=held), solve(contact(middle))
    n, m = (-f.prop_slope * middle / f.prop for f in (film, flooded))
    bounded = law(film.prop, n, flooded.prop, m)
    for factor, allowed in ((0.97, 0.02), (1.03, 0.02), (0.9, 0.1), (0.5, 1.0), (0.3, 1.0)):
        true = solve(contact(factor * middle), supply=held).prop
        error = abs(at(bounded, 1000.0 * factor)[0] / true - 1)
        assert error < allowed
        assert error < abs(film.prop * factor**-n / true - 1)
