"""Starved film of a published gear pair's pitch point, against an independent study with other code.

A separate study for this project gives the tangent stiffness at a face of 40 mm with the meniscus held, by the
starved film over the flooded one: 0.81 9.1e10, 0.51 3.3e10, 0.14 1.4e10, 0.05 1.2e10 N/m. It also found that a minimum
film below 0.1 um, the published criterion of starvation, needs the meniscus at about -1.03 b, an oil layer of about
0.11 um. Its films are given to two digits only, which is what the tolerance allows for.
"""

import numpy as np
import pytest

from ehl import Meniscus, OilLayer
from tests.ehl.films import quiet
from tests.validation.article import FACE, PITCH


def test_stiffness_of_the_starved_film_with_the_meniscus_held():
    flooded = quiet(PITCH)
    places = np.array([-1.5, -1.3, -1.17, -1.1, -1.03, -1.01])
    films = [quiet(PITCH, supply=Meniscus(X * PITCH.half_width)) for X in places]
    ratio = np.array([f.central_thickness for f in films]) / flooded.central_thickness
    stiffness = np.array([FACE * f.stiffness("tangent") for f in films])
    for at, known in [(0.81, 9.1e10), (0.51, 3.3e10), (0.14, 1.4e10), (0.05, 1.2e10)]:
        found = np.exp(np.interp(at, ratio[::-1], np.log(stiffness[::-1])))
        assert found == pytest.approx(known, rel=0.05), at


def test_what_a_minimum_film_of_a_tenth_of_a_micrometre_takes():
    film = quiet(PITCH, supply=OilLayer(0.11e-6))
    assert film.converged
    assert film.minimum_thickness == pytest.approx(0.088e-6, rel=0.02)
    assert film.inlet / PITCH.half_width == pytest.approx(-1.03, abs=0.002)
    assert quiet(PITCH, supply=OilLayer(0.13e-6)).minimum_thickness > 0.1e-6
