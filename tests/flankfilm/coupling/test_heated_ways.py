"""Films with heat of several contacts: with asperities, and contacts by way of which others are reached."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import ehl
from flankfilm.coupling.losses.heated_films import HeatedOil, _between, _by_way, heated_films

COLD, HOT = (ehl.Lubricant(eta, 19e-9, 870.0) for eta in (0.1, 0.02))
ONE = ehl.LineContact(1e5, 2.0, 5e-3, 2.2e11, COLD, sliding=-1.0)
OTHER = ehl.LineContact(4e5, 3.0, 8e-3, 2.2e11, HOT, sliding=2.0)


def test_films_between_rough_flanks_are_those_that_share_the_load():
    """One film for each contact, friction by the shares of film and asperities: more of it where these carry more."""
    ground = ehl.Roughness(deviation=0.3e-6, density=3.3e9, tip_radius=4e-5)
    oil = HeatedOil((ehl.STEEL, ehl.STEEL), ground, 0.12, 0.05)
    hot = replace(HOT, temperature=353.15, eyring_stress=5e6)
    contacts = [ehl.LineContact(2e5, speed, 8e-3, 2.2e11, hot, sliding=1.0) for speed in (4.0, 2.0)]
    found = heated_films(np.array([8e-3, 9e-3]), contacts, oil, (353.15, 353.15))
    assert [one.film for one in found.mixed] == list(found.films)
    assert len(found.films) == 2
    share = found.asperity_share
    assert 0.0 < share[0] < share[1] < 1.0
    film = np.abs([one.traction_coefficient for one in found.films])
    assert found.friction == pytest.approx(film + share * (0.12 - film))


@pytest.mark.parametrize(("part", "load"), [(0.0, 1e5), (0.5, 2e5), (1.0, 4e5)])
def test_a_contact_between_two_has_its_share_of_both_and_the_oil_of_the_second(part, load):
    found = _between(ONE, OTHER, part)
    assert found.load == pytest.approx(load)
    assert found.entrainment == pytest.approx(2.0 + part)
    assert found.radius == pytest.approx(5e-3 + part * 3e-3)
    assert found.sliding == pytest.approx(-1.0 + part * 3.0)
    assert found.lubricant == HOT


def test_a_film_by_way_of_others_is_the_film():
    """From a film of a quarter of its load and 30 K less to it by steps: as solved from nothing."""
    oil, hot = (
        HeatedOil((ehl.STEEL, ehl.STEEL), None, 0.1, 0.01),
        replace(HOT, temperature=353.15, eyring_stress=5e6),
    )
    near = ehl.solve_thermal(
        replace(ONE, lubricant=hot, sliding=1.0), oil.solids, (323.15, 323.15), oil.tolerance
    )
    contact, bulk = replace(OTHER, lubricant=hot), (353.15, 363.15)
    found = _by_way(contact, oil, bulk, near)
    alone = ehl.solve_thermal(contact, oil.solids, bulk, oil.tolerance)
    assert found.converged
    assert found.contact == contact
    for name in ("minimum_thickness", "traction_coefficient", "oil_temperature_rise"):
        assert getattr(found, name) == pytest.approx(getattr(alone, name), rel=0.03)
