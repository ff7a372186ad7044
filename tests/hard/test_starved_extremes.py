"""Starved line contacts on which solvers fail: each is solved, or refused as the dry contact that it nearly is."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from base import RangeWarning
from ehl import LineContact, Lubricant, Meniscus, OilLayer, Roughness, solve, solve_mixed
from ehl.discrete.asperities import LAWS
from ehl.discrete.method import METHOD
from tests.ehl.films import sound
from tests.hard.random_contacts import random_contact, refused
from tests.validation.article import PITCH

# load [N/m], speed [m/s], radius [m], viscosity [Pa s], its exponent [1/Pa] and layer [m], by Moes' numbers and the
# layer over the flooded flow; on coarse grids trials fail between the start and the meniscus
THIN_LAYERS = {
    "M 2117, L 2.6, 3 %": (6.75803e06, 0.0715168, 0.0345528, 0.0093743, 1.80634e-08, 5.66581e-10),
    "M 1619, L 3.3, 2 %": (5.50777e06, 0.0500498, 0.0345924, 0.0151993, 2.22514e-08, 4.89999e-10),
    "M 1535, L 2.8, 3 %": (4.87069e06, 0.124479, 0.024563, 0.00748661, 1.64226e-08, 6.72384e-10),
    "M 1934, L 1.9, 3 %": (7.36174e06, 0.130526, 0.0492026, 0.00512583, 1.49221e-08, 5.99877e-10),
    "M 2393, L 3.1, 5 %": (4.76088e06, 0.0576605, 0.0219535, 0.00710911, 2.16567e-08, 6.53153e-10),
    "M 1986, L 4.2, 2 %": (6.58638e06, 0.0687187, 0.0276857, 0.0131402, 2.59709e-08, 5.64192e-10),
    "M 1204, L 2.7, 2 %": (1.01757e07, 0.222459, 0.0486305, 0.0150183, 1.37358e-08, 1.1011e-09),
    "M 3161, L 1.9, 5 %": (9.55242e06, 0.0588736, 0.0438463, 0.00804195, 1.50838e-08, 6.92449e-10),
    "M 2383, L 1.8, 4 %": (9.50073e06, 0.121596, 0.0496031, 0.0059908, 1.33153e-08, 7.74239e-10),
    "M 1868, L 1.8, 3 %": (2.74611e06, 0.0572321, 0.011555, 0.00742371, 1.08937e-08, 2.0765e-10),
    "M 1900, L 2.2, 3 %": (5.76461e06, 0.0766773, 0.0303366, 0.00899516, 1.46136e-08, 4.95398e-10),
}


@pytest.fixture(autouse=True)
def _known_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        yield


def test_starved_contacts_down_to_the_edge():
    for X in (-1.3, -1.03, -1.01, -1.002, -1.0005):
        for load in (PITCH.load, 1e-2 * PITCH.load):
            contact = replace(PITCH, load=load)
            film = sound(solve(contact, supply=Meniscus(X * contact.half_width), tolerance=0.01))
            assert film.stiffness() > 0
    film = solve(PITCH, supply=Meniscus(-(1 + 1e-7) * PITCH.half_width))
    if film.converged:
        assert sound(film).central_thickness < 1e-12
    else:
        assert "inlet" in refused(film)


@pytest.mark.slow
def test_supply_towards_zero():
    last = math.inf
    for layer in (1e-7, 1e-8, 1e-9):
        film = sound(solve(PITCH, supply=OilLayer(layer)))
        assert film.flow == pytest.approx(layer, rel=1e-8)
        assert film.central_thickness < last
        last = film.central_thickness
    assert "inlet" in refused(solve(PITCH, supply=OilLayer(1e-14)))


def test_starved_and_light():
    # a pair about to leave contact: a layer thinner than what the light contact would take
    for load in (1e4, 1e2, 1.0):
        contact = replace(PITCH, load=load)
        flooded = sound(solve(contact))
        film = sound(solve(contact, supply=OilLayer(0.3 * flooded.flow)))
        assert film.flow == pytest.approx(0.3 * flooded.flow, rel=1e-8)
        assert film.stiffness() > flooded.stiffness()


QUICK = 3  # the others take 2049 nodes and 5 to 20 s


@pytest.mark.parametrize(
    "name",
    [
        *list(THIN_LAYERS)[:QUICK],
        *(pytest.param(n, marks=pytest.mark.slow) for n in list(THIN_LAYERS)[QUICK:]),
    ],
)
def test_layers_whose_meniscus_starts_do_not_reach_at_once(name):
    load, speed, radius, viscosity, exponent, layer = THIN_LAYERS[name]
    contact = LineContact(load, speed, radius, 2.2e11, Lubricant(viscosity, exponent))
    film = sound(solve(contact, supply=OilLayer(layer)))
    assert film.flow == pytest.approx(layer, rel=1e-8)
    assert film.inlet > -1.001 * contact.half_width
    # inside the contact hardly any oil flows under pressure: rho h = h_oil
    density = contact.lubricant.density_ratio(np.interp(0.0, film.x, film.pressure))[0]
    assert film.central_thickness * density == pytest.approx(layer, rel=2e-3)


@pytest.mark.parametrize("load", [0.5, 1.5, 2.3])
def test_layers_close_to_what_the_inlet_takes(load):
    """M 490, L 3.5 with 99.5 % of the flooded flow, which hardly follows the meniscus: cold, from neighbours."""
    contact = LineContact(1.046012e7, 0.1987358, 0.04226990, 2.2e11, Lubricant(0.1231442, 1.0538e-8))
    layer = OilLayer(1.709213e-7)
    alone = sound(solve(contact, supply=layer))
    assert alone.starved
    assert alone.flow == pytest.approx(layer.thickness, rel=1e-8)
    near = sound(
        solve(contact, supply=layer, start=solve(replace(contact, load=load * contact.load), supply=layer))
    )
    assert near.starved
    assert near.flow == pytest.approx(layer.thickness, rel=1e-8)
    assert near.central_thickness == pytest.approx(alone.central_thickness, rel=alone.error + near.error)


def test_layers_as_good_as_none_are_refused_as_dry_contacts_or_solved():
    """M 3899, L 1.6 with 3 and 0.1 % of the flooded flow: the thicker film is a 170 000th of the flattening b^2/2R."""
    contact = LineContact(8.7165e6, 0.0565692, 0.036157, 2.2e11, Lubricant(0.0055525, 1.40549e-08))
    assert contact.film_parameter(2.95879e-10) < METHOD.dry
    starved_soundly(contact, 2.95879e-10)
    message = refused(solve(contact, supply=OilLayer(1e-11)))
    assert "below 1e-05" in message
    assert "take the contact as dry" in message


def starved_soundly(contact, layer):
    """Solve with a layer; one of h R/b^2 below 1e-5 may be refused, as the dry contact that it nearly is."""
    film = solve(contact, supply=OilLayer(layer))
    if contact.film_parameter(layer) < METHOD.dry and not film.converged:
        assert "take the contact as dry" in refused(film)
        return
    sound(film)
    if film.starved:
        assert film.flow == pytest.approx(layer, rel=1e-8), (contact, layer)


def check_random_supplies(number):
    """Starve random contacts: a meniscus 0.003 to 3 b ahead, a layer of 2 to 95 % of the flooded flow."""
    rng = np.random.default_rng()
    for _ in range(number):
        contact = random_contact(rng)
        meniscus = Meniscus(-(1 + 10 ** rng.uniform(-2.5, 0.5)) * contact.half_width)
        sound(solve(contact, supply=meniscus))
        starved_soundly(contact, 10 ** rng.uniform(-1.7, -0.02) * sound(solve(contact)).flow)


def test_a_few_random_supplies():
    check_random_supplies(8)


@pytest.mark.slow
def test_random_supplies():
    check_random_supplies(300)


def check_random_neighbours(number):
    """Starve and roughen random contacts, from one of .3 to 3 times the load and .5 to 2 times the speed."""
    rng = np.random.default_rng()
    for _ in range(number):
        contact = random_contact(rng)
        load, speed = 10 ** rng.uniform(-0.5, 0.5), 2 ** rng.uniform(-1, 1)
        other = replace(contact, load=load * contact.load, entrainment=speed * contact.entrainment)
        flooded = sound(solve(contact))
        layer = OilLayer(10 ** rng.uniform(-1.7, 0.1) * flooded.flow)
        X = 1 + 10 ** rng.uniform(-2.5, 0.5)
        for fed, fed_other in ((layer, layer), *[[Meniscus(-X * c.half_width) for c in (contact, other)]]):
            alone, before = solve(contact, supply=fed), solve(other, supply=fed_other)
            near = sound(solve(contact, supply=fed, start=before if before.converged else None))
            off = abs(near.central_thickness / alone.central_thickness - 1)
            assert off < near.error + alone.error, (contact, fed, other)
            if near.starved != alone.starved:  # a layer as thick as what the inlet takes, within the errors
                short = abs(alone.central_thickness / flooded.central_thickness - 1)
                assert short < near.error + alone.error, (contact, fed, other)
        sigma, law = 10 ** rng.uniform(-0.5, 0.7) * alone.central_thickness, str(rng.choice(LAWS))
        rough = Roughness.of_deviation(sigma, law=law)
        alone, before = (solve_mixed(c, rough, supply=s) for c, s in ((contact, fed), (other, fed_other)))
        near = solve_mixed(contact, rough, supply=fed, start=before if before.converged else None)
        assert alone.converged == near.converged, (contact, fed, other, rough)
        if alone.converged and alone.asperity_share:
            h = alone.central_thickness
            pressure, slope = rough.under_film(h, contact.reduced_modulus, contact.peak_pressure)
            allowed = (near.error + alone.error) * (1 - slope * h / pressure)
            assert abs(near.asperity_share / alone.asperity_share - 1) < allowed, (contact, fed, other, rough)


def test_a_few_random_neighbours():
    check_random_neighbours(2)


@pytest.mark.slow
def test_random_neighbours():
    check_random_neighbours(100)
