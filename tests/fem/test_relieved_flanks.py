"""Relieved flanks: where they touch, and nothing steps where corners begin to press."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fem.contact.solver import solve_contact
from fem.laws.mesh_setup import MeshSetup
from fem.laws.relieved_flanks import SPAN, touch
from fem.laws.tip_geometry import gap_at, lever_ratio
from gears import Gear, GearPair, TipRelief

STEP = 5e-4
FORMS = [(10e-6, 2e-3, "linear"), (26e-6, 1.2e-3, "linear"), (20e-6, 3e-3, "parabolic")]


def relieved(*numbers):
    relief = TipRelief(*numbers)
    gears = Gear(36, bore_radius=0.01675, tip_relief=relief), Gear(40, bore_radius=0.01875, tip_relief=relief)
    return GearPair(*gears, 2e-3, 0.04)


def solved(pair, bodies, places, torque=600.0):
    """Deflection and tangent with the unloaded part, at places of the line of action [m]."""
    at = (np.asarray(places) - pair.points.A) / pair.base_pitch
    found = solve_contact(MeshSetup(pair, 1).at(at), bodies, np.array([torque / pair.base_radii[0]]), None)
    assert not found.refusal(0)
    return found.share.transmission_error[0, 0] + found.touch[0], found.share.stiffness[0, 0]


@pytest.fixture(scope="module")
def bodies_of(article_bodies):
    """The same teeth, whose relief no finite element knows."""
    return lambda pair: replace(article_bodies, pair=pair, tip_strips=article_bodies.tips)


@pytest.mark.parametrize("amount", [1e-9, 1e-6, 5e-6, 20e-6])
@pytest.mark.parametrize(("length", "form"), [(1.5e-3, "linear"), (3e-3, "parabolic")])
def test_nothing_steps_where_relieved_corners_begin_to_press(bodies_of, amount, length, form):
    pair = relieved(amount, length, form)
    for end in {*MeshSetup(pair, 1).ends, *MeshSetup(pair, 1).flanks.touching_ends}:
        for torque in (60.0, 600.0):
            (before, after), tangent = solved(pair, bodies_of(pair), end + np.array([-1e-9, 1e-9]), torque)
            assert after == pytest.approx(before, rel=0.5 * STEP)
            assert tangent[1] == pytest.approx(tangent[0], rel=STEP)


def test_without_relief_left_it_is_the_plain_law(article_pair, article_bodies, bodies_of):
    pair = relieved(1e-15, 2e-3, "parabolic")
    for end in MeshSetup(pair, 1).ends:
        places = end + np.linspace(-0.4e-3, 0.4e-3, 7)
        plain, eased = solved(article_pair, article_bodies, places), solved(pair, bodies_of(pair), places)
        np.testing.assert_allclose(eased[0], plain[0], rtol=1e-9)
        np.testing.assert_allclose(eased[1], plain[1], rtol=1e-6)


@pytest.mark.parametrize("numbers", FORMS)
def test_they_touch_where_the_gap_is_least(numbers):
    """By brute force over points of the wheel's flank, on the path and a little outside."""
    pair = relieved(*numbers)
    given, line = MeshSetup(pair, 1), pair.line_of_action
    # slope and curvature are differences over SPAN on either side: the kink at the start of linear relief is rounded by
    # a quarter of its slope over that length
    steepness = numbers[0] / numbers[1]
    rounded = steepness * SPAN * pair.module / 4 if numbers[2] == "linear" else 2e-9
    places = np.concatenate(
        [e + np.linspace(-0.1e-3, 2.5e-3, 14) * s for e, s in zip(given.ends, (1, -1), strict=True)]
    )
    found = touch(given.flanks, places, given.removed)
    for k, place in enumerate(places):
        low, high = line - place - 2e-3, min(line - place + 2e-3, given.rounds[1].rho)
        points = np.linspace(low, high, 40_001)
        gap, where = gap_at(pair.base_radii, line, place, points)
        gap = gap + (given.removed[0](where) + given.removed[1](points)) / found.lever[0, k]
        gap = np.where(where > given.rounds[0].rho, np.inf, gap)
        assert found.gap[k] == pytest.approx(gap.min(), abs=rounded)


def test_the_force_stands_on_the_flank_without_relief():
    """Before C the wheel's flank is relieved, so that the lever about the pinion stays; after C it is the other way."""
    pair = relieved(20e-6, 3e-3, "parabolic")
    given = MeshSetup(pair, 1)
    start, end = given.ends
    near = touch(given.flanks, np.array([start, end]) + np.array([0.3e-3, -0.3e-3]), given.removed)
    np.testing.assert_allclose([near.lever[0, 0], near.lever[1, 1]], 1.0, atol=5e-4)
    assert near.lever[0, 1] < 0.99
    assert near.lever[0, 1] == pytest.approx(lever_ratio(pair, near.rho[1, 1], end - 0.3e-3, 0), abs=1e-4)


def test_forces_deflections_and_gaps_are_those_along_the_common_normals(bodies_of):
    """A turn D closes kappa D along a normal whose lever about the pinion's axis is kappa r_b1."""
    pair = relieved(20e-6, 3e-3, "parabolic")
    bodies, force = bodies_of(pair), 300.0 / pair.base_radii[0]
    found = solve_contact(MeshSetup(pair, 16, beyond_path=False), bodies, np.array([force]), None)
    candidates, leaning = found.candidates, 0
    for row, forces in enumerate(found.share.forces[0, 0]):
        on = np.flatnonzero(forces)
        rho, kappa = candidates.rho[:, row, on], candidates.lever[0, row, on]
        yielding = bodies.bulk(*rho, candidates.leaning[:, row, on]) @ forces[on]
        yielding += bodies.hertz(candidates.place[row, on], candidates.curvature[row, on]).approach(
            forces[on]
        )
        gap = candidates.gap[0, row] - candidates.gap[0, row].min()
        turn = found.share.transmission_error[0, 0, row]
        np.testing.assert_allclose(yielding, kappa * (turn - gap[on]), rtol=1e-9)
        assert kappa @ forces[on] == pytest.approx(force, rel=1e-12)
        leaning += np.count_nonzero(np.abs(kappa - 1.0) > 1e-3)
    assert leaning > 4


def test_least_gap_is_well_below_that_of_the_nominal_place():
    """Reading relief where involutes would touch errs by R h'^2/2: a micrometre of twenty."""
    pair = relieved(20e-6, 3e-3, "parabolic")
    given = MeshSetup(pair, 1)
    place = np.array([given.ends[0]])
    nominal = given.removed[0](place) + given.removed[1](pair.line_of_action - place)
    assert 0.5e-6 < float(nominal[0] - touch(given.flanks, place, given.removed).gap[0]) < 2e-6


@pytest.mark.parametrize("shift", [0.0, 0.1, 0.14])
def test_flanks_that_begin_at_their_base_circle_have_no_hollow(shift):
    """No flank is looked at below its base circle, where one would have a curvature radius that is no number."""
    relief = TipRelief(10e-6, 0.5e-3)
    with np.errstate(invalid="raise"):
        for teeth in (17, 34, 40):
            gears = Gear(17, shift, tip_relief=relief), Gear(teeth, tip_relief=relief)
            assert MeshSetup(GearPair(*gears, 2e-3, 0.02), 8).flanks.gentle
