"""Damping of the mesh by its films: by hand at one contact, in the mean over the path, refusals."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest

import ehl
from base import InputError
from flankfilm.coupling import FilmDamping, FilmModel, MeshCycle, PlacedMeniscus, film_damping, mesh_cycle
from flankfilm.coupling.vibration.film_damping import POSITIONS
from tests.ehl.films import quiet
from tests.validation.article import FACE, OIL, PAIR, PITCH

SPEED = 2000.0 * math.pi / 30.0
LOOSE = PAIR.with_backlash(50e-6)
MASS = 0.381  # kg, of the article's pair with solid bodies


@cache
def flooded(tolerance: float) -> FilmDamping:
    """Damping by films that have all the oil they take, at 3e4 rad/s."""
    cycle = mesh_cycle(LOOSE, 60.0, model="ishikawa")
    return film_damping(cycle, LOOSE, 60.0, SPEED, OIL, frequency=3e4, tolerance=tolerance)


def damping_ratio_at_the_pitch_point(share: float, mesh: float) -> float:
    omega = 2.0 * math.pi * 7100.0
    film = quiet(replace(PITCH, load=share * PITCH.load), tolerance=1e-3)
    compliance = complex(ehl.film_response(film, omega).compliance) / FACE
    return (1.0 / (1.0 / mesh + compliance)).imag / omega / (2.0 * MASS * omega)


def damping_by_hand(
    cycle: MeshCycle, position: float, solved: Callable[[ehl.LineContact], ehl.Film | ehl.MixedFilm]
) -> float:
    """Damping of the loose pair at 3e4 rad/s: every pair's teeth in series with its film [N s/m]."""
    at, total = int(np.argmin(np.abs(cycle.position - position))), 0.0
    for rho1, force, share in zip(cycle.rho1[at], cycle.forces[at], cycle.load_share[at], strict=True):
        if not force > 0.0:
            continue
        path = LOOSE.path_at(np.array([rho1]))
        contact = ehl.LineContact(
            force / LOOSE.face_width,
            float(path.entrainment(SPEED)[0]),
            float(path.radius[0]),
            LOOSE.reduced_modulus,
            OIL,
        )
        compliance = complex(ehl.film_response(solved(contact), 3e4).compliance) / LOOSE.face_width
        slope = share * cycle.stiffness[at]
        total += (1.0 / (1.0 / slope + compliance)).imag / 3e4
    return float(total)


@pytest.mark.parametrize(("share", "known"), [(1.0, 0.003), (0.03, 0.058), (0.01, 0.14)])
def test_one_film_in_series_with_the_mean_mesh_stiffness(share, known):
    # an independent throw-away solver, with the whole load at C on 19 N/(mm um)
    assert damping_ratio_at_the_pitch_point(share, 7.6e8) == pytest.approx(known, rel=0.07)


def test_the_mean_over_the_path_is_that_of_the_films_by_hand():
    cycle = mesh_cycle(LOOSE, 60.0, model="ishikawa")
    found = film_damping(cycle, LOOSE, 60.0, SPEED, OIL, frequency=3e4)
    solved = partial(quiet, tolerance=0.005)
    assert found.damping_curve[7] == pytest.approx(
        damping_by_hand(cycle, found.position[7], solved), rel=0.02
    )
    assert found.damping == pytest.approx(np.mean(found.damping_curve))
    critical = 2.0 * found.equivalent_mass * found.natural_frequency
    assert found.damping_ratio == pytest.approx(found.damping / critical)


def test_of_many_positions_few_are_solved_evenly_about_the_middle():
    cycle = mesh_cycle(LOOSE, 60.0, model="ishikawa", positions=6 * POSITIONS)
    found = film_damping(cycle, LOOSE, 60.0, SPEED, OIL, frequency=3e4, tolerance=0.05)
    assert found.position == pytest.approx(
        (np.arange(POSITIONS) + 0.5) / POSITIONS, abs=0.6 / cycle.position.size
    )
    assert found.damping == pytest.approx(np.mean(found.damping_curve))


def test_films_damp_light_loads_and_slow_oscillations_most():
    ratio = {}
    for torque in (600.0, 60.0, 6.0):
        cycle = mesh_cycle(LOOSE, torque, model="ishikawa")
        ratio[torque] = film_damping(cycle, LOOSE, torque, SPEED, OIL, tolerance=0.02)
    assert ratio[6.0].damping_ratio > 10.0 * ratio[60.0].damping_ratio
    assert abs(ratio[600.0].damping_ratio) < 0.002
    slow = film_damping(cycle, LOOSE, 6.0, SPEED, OIL, frequency=1e3, tolerance=0.02)
    assert slow.damping > ratio[6.0].damping
    assert "not known" in slow.message


def test_a_meniscus_is_held_and_what_has_no_answer_is_refused():
    cycle = mesh_cycle(LOOSE, 60.0, model="ishikawa")
    held = film_damping(
        cycle,
        LOOSE,
        60.0,
        SPEED,
        OIL,
        film=FilmModel(supply=PlacedMeniscus(1.3)),
        frequency=3e4,
        tolerance=0.02,
    )
    assert held.damping != pytest.approx(flooded(0.02).damping, rel=0.05)
    with pytest.raises(InputError, match="formula"):
        film_damping(cycle, LOOSE, 60.0, SPEED, OIL, film=FilmModel("dowson"))
    with pytest.raises(InputError, match="frequency"):
        film_damping(cycle, LOOSE, 60.0, SPEED, OIL, frequency=-1.0)


@pytest.mark.parametrize(
    "film",
    [FilmModel(supply=ehl.OilLayer(2e-7)), FilmModel(roughness=ehl.Roughness.of_deviation(8e-7))],
    ids=["layer", "rough"],
)
def test_layers_and_asperities_answer_as_films_by_hand(film):
    cycle = mesh_cycle(LOOSE, 60.0, model="ishikawa")
    found = film_damping(cycle, LOOSE, 60.0, SPEED, OIL, film=film, frequency=3e4, tolerance=0.01)

    def solved(contact: ehl.LineContact) -> ehl.Film | ehl.MixedFilm:
        if film.roughness is None:
            return ehl.solve(contact, 0.01, supply=film.supply)
        return ehl.solve_mixed(contact, film.roughness, 0.01)

    total = damping_by_hand(cycle, found.position[7], solved)
    assert found.damping_curve[7] == pytest.approx(total, rel=0.03)
    assert found.damping != pytest.approx(flooded(0.01).damping, rel=0.02)
