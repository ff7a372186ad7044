"""The law of tip corners: the strips' at any place and force, smooth across A and E, alike in the mirror."""

from __future__ import annotations

import numpy as np
import pytest

import fem
from fem.laws.corner_surface import _Corner, corner_surfaces, rolling_surface
from fem.laws.mesh_setup import MeshSetup
from gears import Gear, GearDeviations, GearPair, Material, TipRelief
from gears.tooth.deviations import WearDepth

STEEL, POM = Material(206e9, 0.3, 7850.0), Material(2.8e9, 0.38, 1400.0)
RELIEF = TipRelief(20e-6, 0.8e-3)


def pair_of(relief=None, material=(STEEL, POM)):
    first, second = (Gear(z, profile_shift=x, tip_relief=relief) for z, x in ((19, 0.2), (45, -0.1)))
    return GearPair(first, second, 1.5e-3, 12e-3, material=material).with_backlash(100e-6)


def asked(pair, corner, turned=0, **options):
    bodies = fem.compliance(pair, tolerance=0.005, tip_edges=True)
    return _Corner(MeshSetup(pair, 1, **options), bodies, corner, turned, 0.0)


def places_and_forces(corner, seed):
    """Places on the flank and beyond its end [m], and forces whose half-widths are 0.02 to 0.1 modules [N]."""
    rng, module = np.random.default_rng(seed), corner.setup.pair.module
    away = module * np.exp(rng.uniform(np.log(1e-4), np.log(0.12), (2, 30)))
    force = np.sort((module * rng.uniform(0.02, 0.1, 30) / float(corner.half_width())) ** 2)
    return corner.origin - away[0], corner.origin + away[1], force


@pytest.mark.parametrize("corner", [0, 1])
@pytest.mark.parametrize(
    ("relief", "radius", "off"),
    [(None, 0.0, 1e-4), (None, 50e-6, 3e-4), (RELIEF, 0.0, 1e-3), (RELIEF, 20e-6, 1e-3)],
)
def test_surfaces_are_the_laws_by_strips(corner, relief, radius, off):
    """At random places and forces, as parts of what a pair yields."""
    known = asked(pair_of(relief), corner, tip_rounding=radius)
    points = known.setup.pair.points
    yields = float(known.bodies.own(np.array([points.C]))[0])
    surfaces = corner_surfaces(known.setup, known.bodies, corner, 0.6)
    inside, outside, force = places_and_forces(known, 10 + corner)
    wanted = known.inside(inside, force), known.outside(outside, force)[0]
    for surface, place, by_strips in zip(surfaces, (inside, outside), wanted, strict=True):
        law = surface.held(np.ones((len(place), 1), dtype=bool), place, np.zeros(len(place)))
        got = law.value_and_slope(np.repeat(force[:, None], len(place), axis=1))[0] / force[:, None]
        np.testing.assert_allclose(got.T, by_strips, atol=off * yields)
        assert np.abs(by_strips).max() > 0.02 * yields


def test_worn_flanks_are_left_before_their_end_and_have_laws_beyond_it():
    """Where wear tapers off at the end of the path the gap of the corner closes first, and opens then."""
    pair = GearPair(Gear(23, bore_radius=0.01), Gear(25, bore_radius=0.01), 2e-3, 0.04, material=STEEL)
    roll = np.radians([15.0, 25.0, 35.0]) * pair.base_radii[1]
    worn = GearDeviations(wear=WearDepth(roll, np.array([0.0, 1e-6, 0.0])))
    known = asked(pair, 1, deviations=(None, worn))
    assert known.origin < 0.0
    yields = float(known.bodies.own(np.array([pair.points.C]))[0])
    surface = corner_surfaces(known.setup, known.bodies, 1, 0.6)[1]
    _, outside, force = places_and_forces(known, 3)
    law = surface.held(np.ones((len(outside), 1), dtype=bool), outside, np.zeros(len(outside)))
    got = law.value_and_slope(np.repeat(force[:, None], len(outside), axis=1))[0] / force[:, None]
    np.testing.assert_allclose(got.T, known.outside(outside, force)[0], atol=1e-3 * yields)
    assert np.all(surface.covered(outside) > 0.0)


@pytest.mark.parametrize(("radius", "step"), [(0.0, 1e-4), (50e-6, 1e-12)])
@pytest.mark.parametrize("corner", [0, 1])
def test_nothing_steps_where_the_contact_leaves_the_flank(corner, radius, step):
    """Both sides have the same law by strips at A and E; of sharp corners they read it between other points."""
    known = asked(pair_of(), corner, tip_rounding=radius)
    yields = float(known.bodies.own(np.array([known.setup.pair.points.C]))[0])
    _, _, force = places_and_forces(known, 1)
    beyond, gap, _ = known.outside(np.zeros(1), force)
    np.testing.assert_allclose(
        known.inside(np.zeros(1), force)[0], beyond[0] + gap / force, atol=step * yields
    )


def test_slopes_are_derivatives():
    known = asked(pair_of(), 0)
    inside, outside, force = places_and_forces(known, 3)
    for surface, place in zip(
        corner_surfaces(known.setup, known.bodies, 0, 0.6), (inside, outside), strict=True
    ):
        law = surface.held(np.ones((len(place), 1), dtype=bool), place, np.zeros(len(place)))
        less, more = (law.value_and_slope(force * (1 + step))[0] for step in (-1e-5, 1e-5))
        slope = law.value_and_slope(force)[1]
        np.testing.assert_allclose((more - less) / (2e-5 * force), slope, atol=1e-6 * np.abs(slope).max())


def test_equal_gears_have_equal_corners_in_the_mirror():
    """In turns of the gear that is touched nothing tells pinion and wheel apart."""
    pair = GearPair(Gear(24), Gear(24), 2e-3, 0.02)
    bodies = fem.compliance(pair, tolerance=0.005, tip_edges=True)
    first, second = (rolling_surface(MeshSetup(pair, 1), bodies, corner, 0.6, 0.0) for corner in (0, 1))
    place, force = np.linspace(-0.2e-3, 0.8e-3, 41), np.geomspace(30.0, 1e4, 41)
    mine, other = first.at(place, force), second.at(place, force)
    for name in ("approach", "slope", "push", "less"):
        value = getattr(mine, name)
        np.testing.assert_allclose(getattr(other, name), value, atol=1e-5 * np.abs(value).max())


def test_laws_of_contacts_on_the_flank_and_beyond_its_end_are_one():
    """Every contact keeps its own, in whatever order they stand."""
    known = asked(pair_of(), 0)
    surface = corner_surfaces(known.setup, known.bodies, 0, 0.6)[0]
    at, places = np.array([[True, False, True, True]]), np.array([-2e-5, 3e-5, 1e-5])
    whole = surface.held(at, places, np.array([1e-10, 2e-10, 3e-10]))
    first, last = np.array([[True, False, False, True]]), np.array([[False, False, True, False]])
    parts = surface.held(first, places[[0, 2]], np.array([1e-10, 3e-10]))
    parts = parts.with_others(surface.held(last, places[[1]], np.array([2e-10])))
    force = np.array([10.0, 200.0, 3e3])
    assert np.array_equal(parts.at, at)
    for value, same in zip(parts.value_and_slope(force), whole.value_and_slope(force), strict=True):
        assert np.array_equal(value, same)
