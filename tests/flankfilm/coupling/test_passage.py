"""The film of one pair of teeth over time: slow gears have steady films, fast ones a dent; refusals."""

import math

import numpy as np
import pytest

from base import InputError
from flankfilm.coupling import Flanks, mesh_cycle, passage_film
from tests.validation.article import OIL, PAIR, TORQUE

LOOSE = PAIR.with_backlash(50e-6)
SPEED = 2000.0 * math.pi / 30.0

pytestmark = pytest.mark.filterwarnings("ignore::base.RangeWarning")


@pytest.fixture(scope="module")
def cycle():
    return mesh_cycle(LOOSE, TORQUE, tolerance=0.01)


@pytest.mark.slow
def test_load_handed_on_in_mid_path_dents_the_film(cycle):
    found = passage_film(cycle, LOOSE, SPEED, OIL, tolerance=0.02)
    assert found.converged
    # one pair carries all around C and then hands on half within half a millimetre: 2 b/u are .8 mm of the path
    assert found.greatest_difference == pytest.approx(-0.084, abs=0.015)
    assert LOOSE.points.C < found.greatest_at < LOOSE.points.C + 1.5e-3
    far = found.rho1 > LOOSE.points.C + 3e-3
    assert np.abs(found.difference[far]).max() < 0.015
    assert found.thinnest < found.steady_thinnest
    # the load is that of the cycle, and comes at its time
    for at in (5, 40, 70):
        same = np.isclose(cycle.rho1, found.rho1[at], rtol=1e-9)
        assert found.load[at] * LOOSE.face_width == pytest.approx(float(cycle.forces[same][0]), rel=1e-6)
    way = SPEED * LOOSE.base_radii[0] * (found.time[-1] - found.time[0])
    assert way == pytest.approx(found.rho1[-1] - found.rho1[0], rel=1e-9)


@pytest.mark.slow
def test_pairs_whose_contacts_last_long_have_steady_films(cycle):
    """At a twentieth of the load contacts are narrower and oil passes sooner: less of a dent."""
    light = mesh_cycle(LOOSE, TORQUE / 20.0, tolerance=0.01)
    less = passage_film(light, LOOSE, SPEED, OIL, tolerance=0.02)
    assert abs(less.greatest_difference) < 0.05


def test_loads_that_jump_are_refused(cycle):
    closed = mesh_cycle(LOOSE, TORQUE, model="ishikawa")
    held = mesh_cycle(LOOSE, TORQUE, tolerance=0.01, flanks=Flanks(beyond_path=False))
    for one in (closed, held):
        with pytest.raises(InputError, match="jump from pair to pair"):
            passage_film(one, LOOSE, SPEED, OIL)
    with pytest.raises(InputError, match="speed"):
        passage_film(cycle, LOOSE, -1.0, OIL)
