"""Mean losses from forces, friction and sliding alone: identities, the closed form's load share, power balance."""

from __future__ import annotations

import numpy as np
import pytest

import fem
from flankfilm.coupling import Flanks, LoadedTeeth
from flankfilm.coupling.losses.heated_films import thinned
from flankfilm.coupling.losses.mean_losses import Carried, means_of
from gears import Gear, GearPair, GeometryError
from gears.closed_form import ohlendorf_loss_factor
from tests.validation.article import PAIR

SPEED = 150.0
TORQUE = 600.0
POWER = TORQUE * SPEED
ENDS = np.array([0.0, PAIR.line_of_action])


def constant(friction: float, rolling: float = 0.0, first: float = 0.5) -> Carried:
    return Carried(ENDS, *(np.full(2, one) for one in (friction, rolling, first)))


@pytest.fixture(scope="module")
def teeth() -> LoadedTeeth:
    bodies = fem.compliance(PAIR, tolerance=0.05)
    return LoadedTeeth(PAIR, TORQUE, compliance=bodies, flanks=Flanks(beyond_path=False, friction=0.05))


def test_constant_friction_loses_power_times_friction_times_loss_factor(teeth):
    cycle = teeth.cycle(12)
    factor = means_of(PAIR, cycle, SPEED, POWER, constant(1.0)).loss_factor
    found = means_of(PAIR, cycle, SPEED, POWER, constant(0.05))
    assert found.loss_factor == pytest.approx(factor, rel=1e-14)
    assert found.friction == pytest.approx(0.05, rel=1e-14)
    assert found.sliding_loss == pytest.approx(POWER * 0.05 * factor, rel=1e-13)
    assert means_of(PAIR, cycle, SPEED, POWER, constant(0.0)).mesh_loss == 0.0


def test_what_goes_in_goes_out_or_is_lost(teeth):
    cycle = teeth.cycle(12)
    assert cycle.contact is not None
    out = float(np.mean(cycle.contact.wheel_torque)) * SPEED * PAIR.base_radii[0] / PAIR.base_radii[1]
    lost = means_of(PAIR, cycle, SPEED, POWER, constant(0.05)).sliding_loss
    assert POWER - out == pytest.approx(lost, rel=1e-9)


def test_tip_edges_outside_the_path_lose_power_too():
    bodies = fem.compliance(PAIR, tolerance=0.05)
    free = LoadedTeeth(PAIR, TORQUE, compliance=bodies, flanks=Flanks(friction=0.05)).cycle(12)
    assert free.contact is not None
    found = means_of(PAIR, free, SPEED, POWER, constant(0.05))
    assert found.edge_loss > 0.1 * found.sliding_loss
    assert found.mesh_loss == pytest.approx(float(free.contact.friction_loss(SPEED).mean()), rel=1e-12)
    assert found.heat.sum() == pytest.approx(found.mesh_loss, rel=1e-12)


@pytest.mark.parametrize("first", [0.0, 0.3, 1.0])
def test_edges_heat_both_gears_alike_whatever_films_do(first):
    bodies = fem.compliance(PAIR, tolerance=0.05)
    free = LoadedTeeth(PAIR, TORQUE, compliance=bodies, flanks=Flanks(friction=0.05)).cycle(12)
    found = means_of(PAIR, free, SPEED, POWER, constant(0.05, first=first))
    films = found.sliding_loss * np.array([first, 1.0 - first])
    assert found.heat == pytest.approx(films + 0.5 * found.edge_loss, rel=1e-12)


@pytest.mark.parametrize("teeth_", [(36, 40), (20, 60), (25, 25)])
def test_ohlendorf_is_the_mean_over_two_pairs_that_share_evenly(teeth_):
    pair = GearPair(*(Gear(one) for one in teeth_), module=2e-3, face_width=20e-3)
    place = (np.arange(20000) + 0.5) / 20000
    total = 0.0
    for ahead in range(2):
        rho1 = pair.points.A + pair.base_pitch * (place + ahead)
        two = place + 1.0 <= pair.contact_ratio
        share = np.where(two, 0.5, 1.0 - ahead)
        inside = rho1 <= pair.points.E
        speeds = np.zeros(place.size)
        speeds[inside] = np.abs(pair.path_at(rho1[inside]).sliding(1.0))
        total += float(np.mean(share * speeds))
    assert ohlendorf_loss_factor(pair) == pytest.approx(total / pair.base_radii[0], rel=1e-4)


def test_ohlendorf_refuses_a_pitch_point_where_two_pairs_share():
    pair = GearPair(Gear(14, 0.8), Gear(60, -0.8), module=2e-3, face_width=20e-3)
    with pytest.raises(GeometryError, match="after C"):
        ohlendorf_loss_factor(pair)


def test_heat_is_parted_as_the_bodies_take_it(teeth):
    cycle = teeth.cycle(12)
    heat = means_of(PAIR, cycle, SPEED, POWER, constant(0.05, rolling=300.0, first=0.7)).heat
    assert heat[0] == pytest.approx(0.7 * heat.sum(), rel=1e-12)


def test_values_are_carried_along_the_path():
    rho1 = np.linspace(8e-3, 16e-3, 5)
    given = Carried(rho1, 0.02 + rho1, 100.0 * rho1, np.full(5, 0.5))
    between = given.at(np.array([7e-3, 9e-3, 16e-3]))
    assert between.friction == pytest.approx([0.028, 0.029, 0.036])
    assert given.over(given).friction == pytest.approx(1.0)
    nothing = Carried(rho1, np.zeros(5), np.zeros(5), np.full(5, 0.5))
    assert nothing.over(nothing).rolling == pytest.approx(1.0)
    assert given.thinned_to(3).rho1 == pytest.approx([8e-3, 12e-3, 16e-3])


def test_the_first_and_the_last_are_kept():
    assert thinned(9, 3).tolist() == [0, 4, 8]
    assert thinned(10, 4).tolist() == [0, 3, 6, 9]
    assert thinned(2, 9).tolist() == [0, 1]
