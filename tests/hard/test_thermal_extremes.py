"""Films with heat on which solvers fail: each is solved, or refused with the reason and a remedy."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from base import InputError, RangeWarning
from ehl import Meniscus, OilLayer, solve_thermal
from tests.ehl.test_thermal import OIL, SLIDING
from tests.hard.random_contacts import random_gear_contact, refused
from tests.validation.article import PITCH


@pytest.fixture(autouse=True)
def _known_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        yield


def held(film):
    """Hold a film to being solved soundly, or to being refused with a reason; whether it was solved."""
    if not film.converged:
        assert ": " in refused(film)
        return False
    assert film.error <= 0.01
    assert (film.thickness > 0.0).all()
    assert (film.pressure >= 0.0).all()
    assert film.load_error < 1e-4
    assert np.isfinite(film.temperature).all()
    # heat that goes round in a long inlet is followed sweep by sweep and settles last
    rolls = film.losses.rolling > film.losses.sliding
    assert abs(film.losses.closure) < (0.05 if rolls else 0.01)
    return True


def loaded(pressure):
    return replace(SLIDING, load=2 * math.pi * SLIDING.radius * pressure**2 / SLIDING.reduced_modulus)


@pytest.mark.parametrize("ratio", [2.0, -2.0, 1.9, 4.0])
def test_a_surface_at_rest_and_surfaces_against_each_other(ratio):
    """Sliding of twice the entrainment: one surface at rest; of four times: one runs back."""
    held(solve_thermal(replace(SLIDING, sliding=ratio * SLIDING.entrainment)))


def test_pure_rolling_at_100_m_s():
    """Two half metres of film: heated by the oil that runs back in the inlet alone."""
    held(solve_thermal(replace(SLIDING, entrainment=100.0, sliding=0.0)))


@pytest.mark.parametrize("pressure", [2e9, 3e9])
def test_very_high_pressure(pressure):
    held(solve_thermal(loaded(pressure)))


def test_pressure_viscosity_times_pressure_of_40():
    contact = loaded(1.6e9)
    held(solve_thermal(replace(contact, lubricant=replace(OIL, pressure_viscosity=25e-9))))


def test_thick_oil_that_runs_back_in_the_inlet():
    """Reverse flow in all of a long inlet, heavy heating by shear: eta0 beta u^2/k of 70."""
    oil = replace(OIL, viscosity=1.0)
    held(solve_thermal(replace(SLIDING, lubricant=oil, entrainment=5.0, sliding=2.0)))


@pytest.mark.parametrize("supply", [OilLayer(2e-8), Meniscus(-1.02 * SLIDING.half_width)])
def test_starved_and_hot(supply):
    assert held(solve_thermal(SLIDING, bulk_temperatures=(393.15, 413.15), supply=supply))


def test_a_reversal_of_entrainment_is_refused_with_the_reason():
    for speed in (0.0, -2.0):
        with pytest.raises(InputError, match="Without entrainment no steady film exists"):
            replace(SLIDING, entrainment=speed)


@pytest.mark.slow
def test_random_gear_contacts_are_solved():
    """Of those with eta0 beta u^2/k up to 10; 40 of the 400 of benchmarks/studies/thermal_errors.py."""
    rng = np.random.default_rng(3)
    solved, counted = 0, 0
    for _ in range(40):
        contact = random_gear_contact(rng)
        oil = contact.lubricant
        mild = oil.viscosity * oil.viscosity_slope * contact.entrainment**2 / oil.conductivity <= 10.0
        good = held(solve_thermal(contact))
        counted += mild
        solved += mild and good
    assert solved >= counted - 1


@pytest.mark.slow
@pytest.mark.parametrize(("ratio", "part"), [(1.0, 1.0), (2.0, 0.4), (-2.0, 1.0)])
def test_a_surface_at_rest_and_oil_that_yields_at_a_limiting_stress_alone(ratio, part):
    """The stress of every cell where the oil is viscous stands at its limit: friction near it, less by heat."""
    oil = replace(PITCH.lubricant, temperature=353.15, limiting_shear_ratio=0.047)
    contact = replace(PITCH, load=part * PITCH.load, sliding=ratio * PITCH.entrainment, lubricant=oil)
    film = solve_thermal(contact)
    assert film.converged, film.message
    assert 0.01 < math.copysign(1.0, ratio) * film.traction_coefficient < 0.047
    thins = solve_thermal(replace(contact, lubricant=replace(oil, eyring_stress=5e8)), start=film)
    assert film.traction_coefficient == pytest.approx(thins.traction_coefficient, rel=0.01)
