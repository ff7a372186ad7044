"""Asperities and films with heat: limits without heat and without asperities, balance, friction."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from base import InputError
from ehl import LineContact, Lubricant, OilLayer, Roughness, solve_mixed, solve_mixed_thermal, solve_thermal
from ehl.load_share import central_asperity_pressure

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
