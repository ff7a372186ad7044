"""Films where pairs come and go carry some load before flanks would touch: the law has to know how they fall."""

from __future__ import annotations

from unittest.mock import patch

import numpy as np
import pytest

import flankfilm as ff
from base import RangeWarning
from ehl import LineContact, Lubricant
from flankfilm.coupling.films import films
from flankfilm.coupling.films.films import FilmModel, PathFilms, films_of
from flankfilm.coupling.films.lubricated_path import with_light_ends
from gears import Gear, GearPair, TipRelief

OIL = Lubricant(0.066, 20e-9, 910.0)
RELIEF = TipRelief(5e-6, 0.5e-3)
FEW = GearPair(
    Gear(13, profile_shift=0.4495, tip_relief=RELIEF),
    Gear(11, profile_shift=0.3648, tip_alteration=-0.1, tip_relief=RELIEF),
    2e-3,
    40e-3,
)
TORQUE, SPEED = 21.5, 189.4


def contact(load: float) -> LineContact:
    return LineContact(load=load, entrainment=1.0, radius=3e-3, reduced_modulus=2.2e11, lubricant=OIL)


def test_light_contacts_stand_a_step_beside_the_loaded_ones_on_the_path():
    points, step = FEW.points, 0.05 * FEW.base_pitch
    rho1 = np.array([points.A + 2 * step, points.C, points.E - 2 * step])
    contacts = (contact(2e4), contact(4e4), contact(50.0))
    places, every, added = with_light_ends(FEW, rho1, contacts, SPEED, step, 100.0)
    np.testing.assert_allclose(places, [rho1[0] - step, *rho1, rho1[-1] + step], rtol=1e-14)
    assert added == (0, 4)
    assert every[1:4] == contacts
    assert [every[0].load, every[4].load] == [100.0, 50.0]  # no heavier than the one beside it
    path = FEW.path_at(places)
    assert every[0].entrainment == pytest.approx(path.entrainment(SPEED)[0])
    assert every[4].radius == pytest.approx(path.radius[4])
    films = tuple(map(str, range(5)))
    kept = PathFilms(places, films, films, added).loaded  # type: ignore[arg-type]
    assert kept.films == kept.flooded == ("1", "2", "3")
    assert kept.rho1.tolist() == rho1.tolist()


def test_no_light_contacts_beyond_the_path():
    points, step = FEW.points, 0.05 * FEW.base_pitch
    rho1 = np.array([points.A + 0.5 * step, points.C])
    places, every, added = with_light_ends(FEW, rho1, (contact(1e4),) * 2, SPEED, step, 10.0)
    assert added == (2,)
    assert len(every) == places.size == 3
    assert with_light_ends(FEW, rho1[:1], (contact(1e4),), SPEED, 1.0, 10.0)[2] == ()


def test_pairs_that_let_go_slowly_have_films_until_they_do():
    """A lightly loaded pair of few teeth: the mean stiffness of three times as many films; else .57 % more."""
    usual = ff.lubricated_cycle(FEW, TORQUE, SPEED, OIL, model="potential-energy")
    with patch.object(films, "FILM_POSITIONS", 120):
        many = ff.lubricated_cycle(FEW, TORQUE, SPEED, OIL, model="potential-energy")
    force = TORQUE / FEW.base_radii[0] / FEW.face_width
    assert usual.film.load[-1] < 0.05 * force
    assert usual.mean_stiffness == pytest.approx(many.mean_stiffness, rel=1e-3)


@pytest.mark.filterwarnings("error::base.RangeWarning")
def test_light_films_that_nothing_shows_warn_of_nothing():
    """The first of these is thicker than a thousandth of the radius; so it would be said if it were loaded."""
    contacts = tuple(LineContact(load, 2.0, 3e-3, 2.2e11, OIL) for load in (10.0, 4e4))
    rho1 = np.array([1e-3, 2e-3])
    found = films_of(FilmModel(), rho1, contacts, None, 0.01, beside=(0,))
    assert found.films[0].minimum_thickness > 3e-6
    assert found.beside == (0,)
    with pytest.raises(RangeWarning, match="film of about"):
        films_of(FilmModel(), rho1, contacts, None, 0.01)
