"""The law of a film that a meniscus holds: value, slope, and the flooded film as its bound."""

from __future__ import annotations

import numpy as np
import pytest

from ehl import LineContact, Lubricant, Meniscus, solve
from flankfilm.coupling.films.film_law import FilmLaw, HeldMeniscus
from flankfilm.files.cache import Cache
from flankfilm.scene.reader import validated
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import FILM


def law(
    separation: float, exponent: float, place: float = 1.1, flooded: float = 7e-7, slow: float = 0.12
) -> FilmLaw:
    one = np.ones(1)
    held = HeldMeniscus(place * one, flooded * one, slow * one)
    return FilmLaw(1e-3 * one, 1000 * one, separation * one, exponent * one, held)


def at(found: FilmLaw, force: float) -> tuple[float, float]:
    separation, slope = found(np.array([[1e-3]]), np.array([[force]]))
    return float(separation[0, 0]), float(slope[0, 0])


@pytest.mark.parametrize("separation", [1e-8, 1e-7, 6.9e-7])
@pytest.mark.parametrize(("exponent", "place"), [(0.3, 2.0), (4.0, 1.1), (15.0, 1.03), (600.0, 1.001)])
def test_value_and_slope_are_met_and_the_slope_is_the_derivative(
    separation: float, exponent: float, place: float
):
    found = law(separation, exponent, place)
    value, slope = at(found, 1000.0)
    assert value == pytest.approx(separation, rel=1e-9)
    assert slope == pytest.approx(-exponent * separation / 1000.0, rel=1e-9)
    edge = 1000.0 * place**2  # where the dry contact reaches the meniscus
    for force in (30.0, 300.0, 990.0, 1000.0 + 0.5 * (edge - 1000.0)):
        step = 1e-4 * (edge - force)
        apart = (at(found, force + step)[0] - at(found, force - step)[0]) / (2 * step)
        assert at(found, force)[1] == pytest.approx(apart, rel=1e-4)


def test_the_film_ends_where_the_contact_reaches_the_meniscus():
    found = law(1e-7, 4.0, place=1.1)
    forces = np.linspace(1000.0, 1215.0, 200)
    separations = np.array([at(found, force)[0] for force in forces])
    assert np.all(np.diff(separations) <= 0.0)
    assert at(found, 1209.999)[0] < 1e-11
    assert at(found, 1211.0) == (0.0, 0.0)


def test_a_light_contact_leaves_the_meniscus_behind():
    found = law(1e-7, 4.0)
    for force in (20.0, 100.0, 300.0):
        flooded = 7e-7 * (force / 1000.0) ** -0.12
        assert 0.5 * flooded < at(found, force)[0] <= flooded
    assert np.isfinite(at(found, 1e6)).all()


def test_where_a_pair_lets_go_the_law_goes_on_along_its_tangent():
    """Value and slope without a jump: Newton's method of the load sharing would step to and fro across one."""
    for found in (law(7e-7, 0.2), law(1e-7, 4.0)):
        edge = 10.0
        (separation, _), (before, slope) = at(found, edge), at(found, edge * (1 + 1e-7))
        for force in (edge * (1 - 1e-7), 5.0, 0.0):
            value, steep = at(found, force)
            assert value == pytest.approx(separation + slope * (force - edge), rel=1e-5)
            assert steep == pytest.approx(slope, rel=1e-5)
        assert before == pytest.approx(separation, rel=1e-6)


def test_relieved_teeth_with_a_film_share_their_load():
    """Pairs that let go within a position's step of the edge of the law."""
    relief = {"amount_um": 20.0, "length_mm": 2.0}
    raw = {
        "wants": ["stiffness"],
        "pair": {
            "module_mm": 2.0,
            "face_width_mm": 40.0,
            "pinion": {"teeth": 17, "profile_shift": 0.4, "bore_mm": 12.0, "tip_relief": relief},
            "wheel": {"teeth": 60, "profile_shift": 0.1, "tip_relief": relief},
        },
        "material": {"youngs_modulus_GPa": 200.2, "poisson_ratio": 0.3},
        "operating": {"pinion_torque_Nm": 150.0, "pinion_speed_rpm": 2000.0},
        "lubricant": {
            "viscosity_Pa_s": 0.075,
            "pressure_viscosity_per_GPa": 19.6,
            "density_kg_per_m3": 910.0,
        },
        "stiffness": {"model": "potential-energy"},
        "film": {"model": "dowson"},
    }
    cycle = Engine(validated(raw), Cache(None))[FILM]
    assert cycle.load_share.sum(axis=1) == pytest.approx(1.0, rel=1e-9)
    assert np.all(cycle.forces >= 0)


def test_without_lack_of_oil_the_power_law_stands():
    for found in (law(7e-7, 0.2), law(8e-7, 0.2), law(3e-7, 0.05)):
        exponent = float(found.exponent[0])
        assert at(found, 500.0)[0] == pytest.approx(float(found.separation[0]) * 0.5**-exponent, rel=1e-12)


def test_the_law_follows_films_behind_a_meniscus_that_stays():
    """Against films solved at other loads; at a third of the load a power law gives thirty times too much."""
    oil = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9)

    def contact(load: float) -> LineContact:
        return LineContact(load=load, entrainment=2.58, radius=6.48e-3, reduced_modulus=2.2e11, lubricant=oil)

    middle = 2.5e5
    held = Meniscus(-1.1 * contact(middle).half_width)
    film, flooded = solve(contact(middle), supply=held), solve(contact(middle))
    n, m = (-f.separation_slope * middle / f.separation for f in (film, flooded))
    bounded = law(film.separation, n, 1.1, flooded.separation, m)
    for factor, allowed in ((0.97, 0.002), (1.03, 0.002), (0.9, 0.01), (0.5, 0.1), (0.3, 0.15)):
        true = solve(contact(factor * middle), supply=held).separation
        error = abs(at(bounded, 1000.0 * factor)[0] / true - 1)
        assert error < allowed


def test_films_on_either_side_of_a_step_of_the_force_know_each_other():
    """A pair goes and the other bears twice as much: n falls, and power laws are 10 % off at the other force."""

    def separation(force):
        return 5e-7 * ((force / 200.0) ** -1.0 + (force / 200.0) ** -0.13)

    def exponent(force):
        light, heavy = (force / 200.0) ** -1.0, (force / 200.0) ** -0.13
        return (light + 0.13 * heavy) / (light + heavy)

    force = np.array([352.0, 172.0])
    law = FilmLaw(np.array([1e-3, 2e-3]), force, separation(force), exponent(force))
    for place in (1e-3, 1.3e-3, 2e-3):
        asked = np.array([[120.0, 172.0, 250.0, 352.0, 450.0]])
        found, slope = law(np.full_like(asked, place), asked)
        inner = slice(1, 4)
        np.testing.assert_allclose(found[:, inner], separation(asked)[:, inner], rtol=1e-3)
        np.testing.assert_allclose(found, separation(asked), rtol=0.02)
        step = 1e-3
        more, less = (law(np.full_like(asked, place), asked + d)[0] for d in (step, -step))
        np.testing.assert_allclose(slope, (more - less) / (2 * step), rtol=1e-5)
    # each is itself where it was solved
    assert law(np.array([[1e-3, 2e-3]]), force[None])[0][0] == pytest.approx(law.separation, rel=1e-14)
