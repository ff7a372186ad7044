"""Asperities and films with heat: limits without heat and without asperities, balance, friction."""

from __future__ import annotations

import math
import re
import warnings
from dataclasses import replace

import numpy as np
import pytest

from base import InputError, RangeWarning
from ehl import LineContact, Lubricant, OilLayer, Roughness, solve_mixed, solve_mixed_thermal, solve_thermal
from ehl.solving.load_share import central_asperity_pressure

OIL = Lubricant(0.02, 17e-9, 860.0, temperature=363.15, eyring_stress=5e6)
SLIDING = LineContact(2e5, 2.5, 6e-3, 2.26e11, OIL, sliding=1.0)


def ground(deviation: float) -> Roughness:
    return Roughness(deviation=deviation, density=0.04 / (150 * deviation**2), tip_radius=150 * deviation)


def test_without_heat_and_sliding_it_is_the_isothermal_film():
    still = replace(SLIDING, sliding=0.0, lubricant=replace(OIL, eyring_stress=None))
    warm = solve_mixed_thermal(still, ground(0.3e-6), solids=None, tolerance=0.003)
    cold = solve_mixed(still, ground(0.3e-6), 0.003)
    assert warm.asperity_share == pytest.approx(cold.asperity_share, rel=0.01)
    assert warm.central_thickness == pytest.approx(cold.central_thickness, rel=0.003)
    assert warm.traction_coefficient == pytest.approx(0.0, abs=1e-6)


def test_smooth_flanks_leave_the_film_all():
    rough, smooth = solve_mixed_thermal(SLIDING, ground(1e-9)), solve_thermal(SLIDING)
    assert rough.asperity_share == 0.0
    assert rough.traction_coefficient == pytest.approx(smooth.traction_coefficient, rel=1e-9)


@pytest.mark.parametrize("deviation", [0.1e-6, 0.3e-6, 0.8e-6])
def test_asperities_carry_what_their_share_asks_and_more_than_without_heat(deviation):
    roughness = ground(deviation)
    found = solve_mixed_thermal(SLIDING, roughness, tolerance=0.003)
    assert found.converged
    assert found.film.contact.load == pytest.approx((1 - found.asperity_share) * SLIDING.load, rel=1e-12)
    carried = float(roughness.pressure(found.plane_distance, SLIDING.reduced_modulus)[0])
    asked = central_asperity_pressure(SLIDING, roughness, found.asperity_share)
    # a hundredth of the odds: their pressure and what is asked change by about as much
    assert math.log(carried / asked) == pytest.approx(0.0, abs=0.02)
    # the step of the odds that is left, and what the film's error makes of the share
    assert found.asperity_share_error > (1.0 - found.asperity_share) * 0.003
    assert found.asperity_share > found.isothermal.asperity_share
    assert found.film_ratio < found.isothermal.film_ratio


def test_friction_is_that_of_film_and_asperities_by_their_shares():
    found = solve_mixed_thermal(SLIDING, ground(0.3e-6), boundary_friction=0.12)
    s, film = found.asperity_share, found.film.traction_coefficient
    assert found.traction_coefficient == pytest.approx((1 - s) * film + 0.12 * s, rel=1e-12)
    assert found.asperity_loss == pytest.approx(0.12 * s * SLIDING.load * SLIDING.sliding, rel=1e-12)
    turned = solve_mixed_thermal(replace(SLIDING, sliding=-1.0), ground(0.3e-6), boundary_friction=0.12)
    assert turned.traction_coefficient == pytest.approx(-found.traction_coefficient, rel=1e-3)


def test_a_neighbour_and_a_thin_layer():
    first = solve_mixed_thermal(SLIDING, ground(0.3e-6))
    near = replace(SLIDING, load=1.03 * SLIDING.load)
    from_it, alone = (
        solve_mixed_thermal(near, ground(0.3e-6), start=first),
        solve_mixed_thermal(near, ground(0.3e-6)),
    )
    assert from_it.asperity_share == pytest.approx(alone.asperity_share, rel=0.02)
    starved = solve_mixed_thermal(SLIDING, ground(0.3e-6), supply=OilLayer(0.1e-6))
    assert starved.converged
    assert starved.asperity_share > first.asperity_share


def test_faults_are_named_together():
    with pytest.raises(InputError) as told:
        solve_mixed_thermal(SLIDING, "rough", boundary_friction=3.0)
    assert "roughness" in str(told.value)
    assert "boundary_friction" in str(told.value)


GEAR_OIL = replace(Lubricant.from_iso_vg(100, 363.15), eyring_stress=7e6)
LOADS = (3e4, 6e4, 1.2e5, 2.4e5)


def frictions(law, entrainment):
    drawn = Roughness.from_drawing(0.4e-6, law=law)
    contact = LineContact(LOADS[0], entrainment, 8.5e-3, 2.3e11, GEAR_OIL, sliding=0.3 * entrainment)
    films = [solve_mixed_thermal(replace(contact, load=load), drawn, tolerance=0.02) for load in LOADS]
    return np.array([(film.traction_coefficient, film.asperity_share) for film in films]).T


@pytest.mark.parametrize("entrainment", [0.1, 1.0, 5.0, 20.0])
def test_friction_of_drawn_surfaces_rises_with_the_load(entrainment):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)  # of the oil's pressures
        warnings.filterwarnings("error", "roughness: elastic asperities")
        friction, _ = frictions(None, entrainment)
    assert (np.diff(friction) > 0.0).all()


def test_elastic_asperities_say_that_their_friction_falls_with_the_load():
    """By how much: their share falls nearly as the gap's pressure over Hertz', differences of films show it too."""
    with pytest.warns(RangeWarning, match="their part of the friction falls") as caught:
        friction, share = frictions("greenwood-tripp", 1.0)
    assert (np.diff(friction) < 0.0).any()
    assert (np.diff(share) < 0.0).all()
    found = [re.search(r"about (\d+)%", str(one.message)) for one in caught]
    said = [float(one[1]) / 100 for one in found if one]
    assert len(said) == len(LOADS)
    film = (friction - 0.1 * share) / (1 - share)
    lost = -np.diff(share) * (0.1 - (film[1:] + film[:-1]) / 2) / ((friction[1:] + friction[:-1]) / 2)
    middle = (np.array(said)[1:] + said[:-1]) / 2
    np.testing.assert_allclose(middle, lost, rtol=0.15)


def test_lost_friction_is_not_warned_of_where_nothing_slides_or_asperities_carry_hardly_anything():
    still = LineContact(1e5, 1.0, 8.5e-3, 2.3e11, GEAR_OIL)
    fast = replace(still, entrainment=40.0, sliding=4.0)
    drawn, fine = (Roughness.from_drawing(mean, law="greenwood-tripp") for mean in (0.1e-6, 0.05e-6))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)  # of the oil's pressures
        warnings.filterwarnings("error", "roughness: elastic asperities")
        assert solve_mixed_thermal(still, drawn, tolerance=0.02).asperity_share > 0.01
        assert solve_mixed_thermal(fast, fine, tolerance=0.02).asperity_share < 1e-4


@pytest.mark.parametrize("supply", [None, OilLayer(0.1e-6)])
def test_nodes_are_those_asked_for(supply):
    film = solve_mixed_thermal(SLIDING, ground(0.3e-6), supply=supply, nodes=97)
    assert film.converged
    assert film.film.x.size == film.isothermal.film.x.size == 97
    alone = solve_mixed_thermal(SLIDING, ground(0.3e-6), supply=supply)
    assert film.central_thickness == pytest.approx(alone.central_thickness, rel=film.error + alone.error)
    with pytest.raises(InputError, match="nodes"):
        solve_mixed_thermal(SLIDING, ground(0.3e-6), nodes=3)
