"""Line contacts on which solvers fail: each is solved, or refused with the reason and a remedy."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from base import RangeWarning
from ehl import LineContact, Lubricant, solve, solve_path
from tests.ehl.films import sound
from tests.hard.random_contacts import random_contact, refused
from tests.validation.article import PITCH, SECTION_2


@pytest.fixture(autouse=True)
def _known_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        yield


def test_uniform_grids_of_the_source_article():
    # 130 equal steps on [-4, 1.2]; second-order upwinding runs into limit cycles at the pitch point
    for nodes in (129, 130):
        film = sound(solve(PITCH, nodes=nodes, domain=(-4.0, 1.2), grid="uniform"))
        assert film.central_moes == pytest.approx(5.8562, rel=0.005)
    film = sound(solve(SECTION_2, nodes=130, domain=(-4.0, 1.2), grid="uniform"))
    assert film.central_moes == pytest.approx(5.7187, rel=0.005)
    # the long inlet that this domain cuts off
    full = solve(SECTION_2)
    assert film.central_thickness / full.central_thickness == pytest.approx(0.974, abs=0.005)


def test_coarse_grids_never_give_a_negative_film():
    sound(solve(LineContact.from_moes(200.0, 15.0), nodes=65))
    film = sound(solve(LineContact.from_moes(100.0, 10.0), nodes=65, domain=(-4, 1.5), grid="uniform"))
    assert film.error > 0.05


@pytest.mark.parametrize("pressure", [3e9, 4e9])
def test_very_high_pressure(pressure):
    load = 2 * math.pi * PITCH.radius * pressure**2 / PITCH.reduced_modulus
    film = sound(solve(replace(PITCH, load=load)))
    assert film.contact.peak_pressure == pytest.approx(pressure)
    assert film.stiffness() > 0


@pytest.mark.parametrize(("M", "L"), [(200, 20), (200, 25), (1000, 25), (5000, 0), (5000, 1), (5000, 2)])
def test_heavy_contacts(M, L):
    film = sound(solve(LineContact.from_moes(M, L)))
    assert film.error < 0.005


@pytest.mark.parametrize("M", [500, 1000, 3000])
def test_soft_contacts(M):
    film = sound(solve(LineContact.from_moes(M, 0.0, compressible=False)))
    assert film.central_moes * M**0.2 == pytest.approx(2.49, rel=0.01)


@pytest.mark.parametrize("L", [5.0, 20.0])
@pytest.mark.parametrize("M", [1e-3, 0.01, 0.1])
def test_light_contacts(M, L):
    film = sound(solve(LineContact.from_moes(M, L)))
    assert film.minimum_moes * M == pytest.approx(2.448, rel=0.2 if M == 0.1 else 0.02)


def test_alpha_times_pressure_of_forty():
    contact = LineContact.from_moes(M=2 * math.pi * 4.0**2, L=10.0)
    assert contact.lubricant.pressure_viscosity * contact.peak_pressure == pytest.approx(40.0)
    sound(solve(contact))
    sound(solve(LineContact.from_moes(M=2 * math.pi * 4.0**2, L=10.0, roelands_z=1.0)))


def test_inlet_near_the_dry_contact():
    full = solve(PITCH).central_thickness
    last = full
    for inlet in (-1.5, -1.2, -1.1, -1.05, -1.03, -1.01, -1.003):
        film = sound(solve(PITCH, domain=(inlet, 1.5)))
        assert film.central_thickness < last
        last = film.central_thickness
    assert "inlet" in refused(solve(PITCH, domain=(-1.0, 1.5)))


@pytest.mark.slow
def test_speed_towards_zero():
    last = math.inf
    for u in (1.0, 1e-2, 1e-4):
        film = sound(solve(replace(PITCH, entrainment=u), tolerance=0.01))
        assert film.central_thickness < last
        assert film.stiffness() > 0
        last = film.central_thickness
    for u in (1e-7,):
        film = solve(replace(PITCH, entrainment=u))
        if not film.converged:
            assert "dry" in refused(film)
        else:
            sound(film)
    assert "dry" in refused(solve(replace(PITCH, entrainment=1e-12)))


def test_load_towards_zero():
    # a pair about to leave contact: the film grows as 1/w and never runs out of a solution
    for w in (1e3, 1.0, 1e-3, 1e-9):
        film = sound(solve(replace(PITCH, load=w)))
        martin = 4.896 * 0.075 * 2.579 * PITCH.radius / w
        assert film.minimum_thickness == pytest.approx(martin, rel=0.06 if w > 100 else 0.002)
        assert film.separation == pytest.approx(film.central_thickness, rel=0.2)
        assert film.stiffness() == pytest.approx(w / film.separation, rel=0.2)


def test_film_as_soft_as_the_tooth():
    # tooth 5.6e8 N/m at a face of 40 mm; an independent solver puts -dF/dh_c there at about 320 N
    forces = np.geomspace(20.0, 2000.0, 25)
    films = [sound(f) for f in solve_path([replace(PITCH, load=F / 0.04) for F in forces])]
    for definition, crossing in (("tangent", 320.0), ("approach", 310.0)):
        stiffness = np.array([0.04 * f.stiffness(definition) for f in films])
        soft = forces < 500
        assert (np.diff(stiffness[soft]) > 0).all()
        found = np.exp(np.interp(np.log(5.6e8), np.log(stiffness[soft]), np.log(forces[soft])))
        assert found == pytest.approx(crossing, rel=0.05)
    # where the bodies begin to flatten the separation hardly depends on the load: the film is nearly rigid
    slopes = np.array([f.separation_slope * f.contact.load / f.separation for f in films])
    assert (slopes < 0).all()
    assert slopes.max() > -0.05


def test_load_share_jumping_between_a_half_and_one():
    contacts = [replace(PITCH, load=PITCH.load * (0.5 if k % 2 else 1.0)) for k in range(20)]
    films = [sound(f) for f in solve_path(contacts)]
    for pair in (films[0::2], films[1::2]):
        values = [f.central_thickness for f in pair]
        assert max(values) / min(values) - 1 < 1e-6


def test_alternating_between_very_different_contacts():
    contacts = [replace(PITCH, load=10.0), PITCH, replace(PITCH, entrainment=1e-3), replace(PITCH, load=1e-3)]
    for film, contact in zip(solve_path(contacts * 2), contacts * 2, strict=True):
        assert sound(film).central_thickness == pytest.approx(solve(contact).central_thickness, rel=0.005)


@pytest.mark.slow
def test_map_of_moes_numbers():
    for M in np.geomspace(0.5, 5000, 25):
        for L in np.linspace(0, 25, 11):
            sound(solve(LineContact.from_moes(M, L)))


def check_random_contacts(number, sample, reference):
    """Solve random contacts; compare some with a fine grid."""
    rng = np.random.default_rng()
    films = [solve(random_contact(rng)) for _ in range(number)]
    for film in films:
        sound(film)
        # the separation falls with the load; near M = 0.8, L = 20 it stands still and the film is rigid
        assert film.separation_slope * film.contact.load / film.separation < 0.02
    beyond = above_half = compared = 0
    for film in films[:sample]:
        fine = solve(film.contact, nodes=reference)
        if not fine.converged:  # a grid given by its number of nodes has no other to fall back on
            continue
        compared += 1
        true = max(
            abs(film.central_thickness / fine.central_thickness - 1),
            abs(film.minimum_thickness / fine.minimum_thickness - 1),
        )
        beyond += true > film.error
        above_half += true > 2 * film.error
    assert compared >= 0.9 * sample
    return films, beyond, above_half


@pytest.mark.slow
def test_a_few_random_contacts():
    films, beyond, above_half = check_random_contacts(60, 12, 513)
    assert sum(f.cost.counts["restarts"] == 0 for f in films) >= 58
    assert beyond <= 1
    assert above_half == 0


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_random_contacts():
    films, beyond, above_half = check_random_contacts(2000, 200, 1025)
    # 99.9 % are expected; four more failures of the first start are chance
    assert sum(f.cost.counts["restarts"] == 0 for f in films) >= 1994
    # an estimate, no bound: 4 of 600 films, all of L > 15, were beyond it, by up to 1.29 times; more than 6 of 200 have
    # a chance of 4e-4
    assert beyond <= 6
    assert above_half <= 1


def test_grids_of_a_neighbour_give_way_to_own_ones():
    """A third contact on the first one's grids: at 257 nodes those have no solution, its own have."""
    oil = Lubricant(viscosity=0.075, pressure_viscosity=32.6e-9, density=910.0)
    second = LineContact(
        load=2.12729e5, entrainment=2.54357, radius=5.86887e-3, reduced_modulus=2.2e11, lubricant=oil
    )
    third = replace(second, load=2.15985e5, entrainment=2.54512, radius=5.91398e-3)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        first = solve(replace(second, load=0.858 * second.load))
        found = solve(third, start=solve(second, start=first))
        alone = solve(third)
    assert found.converged, found.message
    assert found.central_thickness == pytest.approx(alone.central_thickness, rel=0.005)
    assert found.minimum_thickness == pytest.approx(alone.minimum_thickness, rel=0.005)
