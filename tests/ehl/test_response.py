"""Answer of a film to an oscillating load: static limit, rigid closed form, symmetry, grids, refusals."""

import math
from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from ehl import (
    LineContact,
    Lubricant,
    Meniscus,
    OilLayer,
    Roughness,
    film_response,
    solve_mixed,
)
from ehl.discrete.equations import fluxes
from ehl.films.frequency import FilmResponse
from ehl.solving.stepping import Laying, Moment, advance, backwards, steady
from tests.ehl.films import quiet
from tests.validation.article import PITCH

LIGHT = replace(PITCH, load=0.03 * PITCH.load)


def rate(contact: LineContact) -> float:
    """u/b [1/s]."""
    return contact.entrainment / contact.half_width


@pytest.mark.parametrize("contact", [PITCH, LIGHT, LineContact.from_moes(20.0, 10.0)])
def test_slow_oscillations_meet_the_approach_stiffness(contact):
    film = quiet(contact, tolerance=1e-3)
    answer = film_response(film, 0.0)
    assert answer.stiffness == pytest.approx(film.stiffness("approach"), rel=1e-5)
    # and, without any derivative of the package, the difference of films on grids of their own
    light, heavy = (quiet(replace(contact, load=contact.load * f), tolerance=1e-4) for f in (0.98, 1.02))
    secant = 0.04 * contact.load / (light.separation - heavy.separation)
    assert answer.stiffness == pytest.approx(secant, rel=0.01)
    assert answer.static_stiffness == film.stiffness("approach")


def test_the_least_and_the_central_film_follow_slow_loads():
    film = quiet(PITCH, tolerance=1e-3)
    answer = film_response(film, 0.0)
    light, heavy = (quiet(replace(PITCH, load=PITCH.load * f), tolerance=1e-4) for f in (0.98, 1.02))
    for name, found in (
        ("minimum_thickness", answer.least_compliance),
        ("central_thickness", answer.central_compliance),
    ):
        yielded = (getattr(light, name) - getattr(heavy, name)) / (0.04 * PITCH.load)
        assert found.real == pytest.approx(yielded, rel=0.03), name


def test_a_real_load_gives_a_real_film():
    film = quiet(PITCH)
    at = rate(PITCH) * np.array([0.3, 1.0, 4.0])
    forth, back = film_response(film, at), film_response(film, -at)
    assert np.array_equal(back.compliance, np.conj(forth.compliance))
    assert np.array_equal(back.damping, forth.damping)


def test_a_rigid_cylinder_has_the_damping_of_the_closed_form():
    # constant viscosity, inlet at -infinity: F = 4.895 eta u R/h0, -dF/d(dh0/dt) = 6.548 eta (R/h0)^1.5, per face
    eta, u, R, E = 0.05, 1.0, 0.01, 2.2e11
    oil = Lubricant(eta, 0.0, 900.0, compressible=False)
    load = 1e-3 * math.sqrt(2 * eta * u / (E * R)) * E * R
    film = quiet(LineContact(load, u, R, E, oil), tolerance=1e-3)
    h0 = 4.895 * eta * u * R / load
    assert film.separation == pytest.approx(h0, rel=5e-4)
    answer = film_response(film, u / math.sqrt(h0 * R) * np.array([0.0, 0.01, 0.1, 1.0]))
    assert answer.damping == pytest.approx(np.full(4, 6.548 * eta * (R / h0) ** 1.5), rel=2e-3)
    assert answer.stiffness == pytest.approx(np.full(4, load / h0), rel=2e-3)


def test_errors_cover_what_finer_grids_change():
    at = rate(PITCH) * np.array([0.0, 0.1, 0.5, 1.0, 2.0, 3.0])
    coarse, fine = (film_response(quiet(PITCH, nodes=n), at) for n in (129, 513))
    off = np.abs(coarse.compliance / fine.compliance - 1.0)
    assert (off < coarse.relative_error).all()
    assert (off[:4] < 0.02).all()
    assert coarse.error == np.max(coarse.relative_error)


def test_damping_of_a_loaded_film_falls_with_frequency():
    film = quiet(PITCH, tolerance=1e-3)
    slow, mesh = film_response(film, [0.0, 2.0 * np.pi * 7100.0]).damping
    assert 7.0 < slow / mesh < 20.0  # physics: seven to twenty times


def test_a_meniscus_that_stays_is_held_in_the_answer_too():
    film = quiet(PITCH, supply=Meniscus(-1.1 * PITCH.half_width))
    assert film_response(film, 0.0).stiffness == pytest.approx(film.stiffness("approach"), rel=1e-5)


@pytest.mark.parametrize("supply", [None, Meniscus(-1.1 * PITCH.half_width)])
@pytest.mark.parametrize("law", ["greenwood-tripp", "zhou-hoeprich"])
def test_asperities_share_slow_loads_as_steady_ones(law, supply):
    mixed = solve_mixed(PITCH, Roughness.of_deviation(8e-7, law=law), 1e-3, supply)
    assert mixed.asperity_share > 0.02
    answer = film_response(mixed, 0.0)
    assert answer.compliance.real == pytest.approx(-mixed.separation_slope, rel=1e-4)
    assert answer.central_compliance.real == pytest.approx(-mixed.central_slope, rel=1e-4)
    assert answer.static_stiffness == -1.0 / mixed.separation_slope


def test_asperities_carry_what_a_film_that_is_squeezed_fast_gives_back():
    mixed, film = solve_mixed(PITCH, Roughness.of_deviation(8e-7, law="greenwood-tripp")), quiet(PITCH)
    at = rate(PITCH) * np.array([0.1, 1.0, 3.0])
    rough, smooth = film_response(mixed, at), film_response(film, at)
    assert (np.abs(rough.central_compliance) < np.abs(film_response(mixed.film, at).central_compliance)).all()
    assert np.array_equal(film_response(mixed, -at).compliance, np.conj(rough.compliance))
    fine = Roughness(1e-9, 0.04 / (1e-9 * 1e-6), 1e-6)
    bare = film_response(solve_mixed(PITCH, fine), at)
    assert bare.compliance == pytest.approx(smooth.compliance, rel=1e-6)


LAYERS = [0.3, 0.6, 0.9]  # of the flooded flow


@pytest.mark.parametrize("part", LAYERS)
def test_behind_a_layer_slow_oscillations_are_steady_and_fast_ones_leave_the_meniscus(part):
    film = quiet(PITCH, nodes=257, supply=OilLayer(part * quiet(PITCH).flow))
    held = quiet(PITCH, nodes=257, supply=Meniscus(film.inlet))
    slow = film_response(film, 0.0)
    assert slow.compliance.real == pytest.approx(-film.separation_slope, rel=2e-4)
    assert slow.central_compliance.real == pytest.approx(-film.central_slope, rel=2e-4)
    # what a meniscus takes up or leaves in half an oscillation falls with its time
    at = rate(PITCH) * np.array([0.1, 100.0])
    behind, ahead = film_response(film, at), film_response(held, at)
    off = np.abs(behind.central_compliance / ahead.central_compliance - 1.0)
    assert off[1] < 0.03 < 0.5 < off[0]


def test_asperities_share_slow_loads_behind_a_layer():
    mixed = solve_mixed(PITCH, Roughness.of_deviation(8e-7), 1e-3, OilLayer(0.5 * quiet(PITCH).flow))
    assert mixed.asperity_share > 0.02
    answer = film_response(mixed, 0.0)
    assert answer.compliance.real == pytest.approx(-mixed.separation_slope, rel=2e-4)
    assert answer.central_compliance.real == pytest.approx(-mixed.central_slope, rel=2e-4)


def fed(moments: list[Moment], time: float, contact: LineContact, laying: Laying, layer: float) -> Moment:
    """Film at a time behind the meniscus that takes up what a layer brings, by the secant of its place."""

    def missing(place: float) -> tuple[float, Moment]:
        moment = advance(moments, time, contact, replace(laying, supply=Meniscus(place)))
        assert moment is not None
        level = moment.level
        factors = backwards(moments, time)
        now = [moment, moments[-1], moments[-2] if len(moments) > 1 else moments[-1]]
        ends = [one.level.grid.nodes[0] * one.level.groups.length for one in now]
        content, middle, end = (
            sum(f * v for f, v in zip(factors, values, strict=True))
            for values in ([one.content[0] for one in now], [one.middles[0] for one in now], ends)
        )
        P, H = level.solution.P, level.solution.H
        film = level.groups.gap * np.mean(
            level.groups.lubricant.density_ratio(level.groups.pressure * P[:2])[0] * H[:2]
        )
        flow = -fluxes(level.grid, level.groups, P, H, level.grid.quick)[0][0] * level.groups.gap
        u = contact.entrainment
        return layer * (u - end) - (flow * u - middle * film) - content, moment

    last = moments[-1]
    place = last.level.grid.nodes[0] * last.level.groups.length
    other = place * (1.0 + 1e-4)
    miss, moment = missing(place)
    for _ in range(20):
        next_miss, moment = missing(other)
        if abs(next_miss) < 1e-9 * layer * contact.entrainment:
            return moment
        place, other, miss = other, other - next_miss * (other - place) / (next_miss - miss), next_miss
    raise AssertionError


@pytest.mark.parametrize("omega", [0.3, 1.0])
def test_behind_a_layer_they_are_those_of_films_followed_in_time(omega):
    """A load that rises and falls by a hundredth from the steady film on: the last period, by its first harmonic."""
    film = quiet(PITCH, nodes=65, supply=OilLayer(0.6 * quiet(PITCH).flow))
    level, b_u = film.state.fine, 1.0 / rate(PITCH)
    laying, layer = Laying(level.contact, level.plan, 65, None), level.flow
    moments, per_period, periods = [steady(0.0, level)], 60, 2
    times = 2 * np.pi * b_u / omega * np.arange(1, periods * per_period + 1) / per_period
    centre, separation = [], []
    for time in times:
        contact = replace(PITCH, load=PITCH.load * (1 + 0.01 * np.sin(omega / b_u * time)))
        moments = [*moments[-2:], fed(moments, time, contact, laying, layer)]
        centre.append(moments[-1].figures.central_thickness)
        separation.append(moments[-1].figures.separation)
    wave = 2.0 / per_period * np.exp(-1j * omega / b_u * times[-per_period:]) / (-1j * 0.01 * PITCH.load)
    answer: FilmResponse = film_response(film, omega / b_u)
    for values, compliance in ((separation, answer.compliance), (centre, answer.central_compliance)):
        marched = -wave @ np.array(values)[-per_period:]
        assert abs(marched / complex(compliance) - 1.0) < 0.02


def test_shapes_are_those_of_the_frequencies():
    film = quiet(PITCH, nodes=65)
    assert film_response(film, 1e4).compliance.shape == ()
    assert film_response(film, [[1e4, 2e4]]).damping.shape == (1, 2)


def test_what_cannot_be_answered_is_refused_with_the_reason():
    film = quiet(PITCH, nodes=65)
    for refused, word in (
        (replace(film, converged=False, message="more nodes"), "converged"),
        (PITCH, "Film"),
    ):
        with pytest.raises(InputError, match=word):
            film_response(refused, 0.0)
    for frequency in ("fast", [], [math.nan], math.inf):
        with pytest.raises(InputError, match="frequency"):
            film_response(film, frequency)
