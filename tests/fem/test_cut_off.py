"""Contacts whose pressure a tip corner cuts off: nothing steps at A and E, nor where the flank's own law takes over."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import fem
from fem.contact.solver import solve_contact
from fem.elasticity.flamant import hertz_half_width, hertz_indentation
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.influence.strip_contact import flat_kernel, from_the_corner, smoothed
from fem.influence.tip_strips import sharp_layout
from fem.laws.corner_law import CornerLaw, CornerSurface
from fem.laws.corner_surface import corner_surfaces, up_to
from fem.laws.cut_off import FADE, FAR, cut_off
from fem.laws.mesh_setup import MeshSetup
from fem.laws.relieved_flanks import plain_touch
from fem.laws.tip_geometry import lever_ratio, opening, unloaded_gap
from gears import Gear, GearPair, Material

LAW = PlaneElasticity("strain", 206e9, 0.3)
STEP = 5e-4


def solved(pair, bodies, torque, position):
    """Deflection, tangent and forces at positions [base pitches from A]."""
    found = solve_contact(
        MeshSetup(pair, 1).at(np.asarray(position)), bodies, np.array([torque / pair.base_radii[0]]), None
    )
    assert not found.refusal(0)
    share = found.share
    return share.transmission_error[0, 0], share.stiffness[0, 0], share.forces[0, 0]


def ends(pair):
    """Positions of A and E [base pitches from A]."""
    return 0.0, (pair.points.E - pair.points.A) / pair.base_pitch


def near(bodies, corner, distance):
    """Place of the contact at a distance from a corner along its flank [m], and the radius of relative curvature."""
    gear, line = (bodies.pinion, bodies.wheel)[corner], bodies.pair.line_of_action
    rho = np.sqrt(gear.rho_end**2 - 2 * gear.base_radius * distance)
    return (rho if corner == 0 else line - rho), rho * (line - rho) / line


def law_at(bodies, corner, distance):
    """Law that the corner adds at distances from it along its flank (n,) [m]."""
    place, _ = near(bodies, corner, np.asarray(distance))
    gear, setup = (bodies.pinion, bodies.wheel)[corner], MeshSetup(bodies.pair, 1)
    rho = place if corner == 0 else bodies.pair.line_of_action - place
    surface, _ = corner_surfaces(setup, bodies, corner, 0.6)
    rounded = up_to(rho, gear.rho_range[1], gear.module)[0]
    further = (gear.own(rounded) - gear.own(rho)) / bodies.pair.face_width
    return surface.held(np.ones((len(rho), 1), dtype=bool), rho - gear.rho_end, further)


@pytest.fixture
def nothing_inside(monkeypatch):
    """Flanks have their own law up to A and E."""
    held = CornerSurface.held

    def outside(surface, at, place, further):
        law = held(surface, at, place, further)
        inside = surface.reach[1] == 0.0
        return CornerLaw(at, law.log_force, 0.0 * law.quotient, 0.0 * law.slope) if inside else law

    monkeypatch.setattr(CornerSurface, "held", outside)


@pytest.fixture(scope="module")
def plastic():
    steel, pom = Material(206e9, 0.3, 7850.0), Material(2.8e9, 0.38, 1400.0)
    pair = GearPair(Gear(teeth=17), Gear(teeth=51), 2e-3, 0.02, material=(steel, pom))
    return pair, fem.compliance(pair, tip_edges=True)


@pytest.mark.parametrize("torque", [1.0, 60.0, 600.0, 1500.0])
def test_nothing_steps_at_A_and_E(article_pair, article_bodies, torque):
    for end in ends(article_pair):
        (before, after), tangent, forces = solved(
            article_pair, article_bodies, torque, [end - 1e-6, end + 1e-6]
        )
        assert after == pytest.approx(before, rel=0.1 * STEP)
        assert tangent[1] == pytest.approx(tangent[0], rel=STEP)
        loaded = [np.sort(row[row > 0]) for row in forces]
        np.testing.assert_allclose(loaded[1], loaded[0], atol=0.2 * STEP * forces.sum(axis=1).max())


@pytest.mark.parametrize("radius", [1e-6, 20e-6, 100e-6])
def test_nothing_steps_at_a_rounding(article_pair, article_bodies, radius):
    given = MeshSetup(article_pair, 1, tip_rounding=radius)
    for place in given.ends:
        at = (place - article_pair.points.A) / article_pair.base_pitch + np.array([-1e-6, 1e-6])
        force = np.array([600.0 / article_pair.base_radii[0]])
        before, after = solve_contact(given.at(at), article_bodies, force, None).share.transmission_error[
            0, 0
        ]
        assert after == pytest.approx(before, rel=STEP)


def test_nothing_steps_with_a_plastic_wheel(plastic):
    pair, bodies = plastic
    for end in ends(pair):
        for torque in (0.5, 4.0):
            approach, tangent, _ = solved(pair, bodies, torque, [end - 1e-6, end + 1e-6])
            assert approach[1] == pytest.approx(approach[0], rel=STEP)
            assert tangent[1] == pytest.approx(tangent[0], rel=STEP)


@pytest.mark.usefixtures("nothing_inside")
def test_without_the_strips_inside_it_would_step(article_pair, article_bodies):
    approach, _, _ = solved(article_pair, article_bodies, 600.0, [-1e-6, 1e-6])
    assert abs(approach[1] / approach[0] - 1) > 4 * STEP


@pytest.mark.parametrize("torque", [60.0, 600.0, 1500.0])
def test_curves_are_smooth_where_the_flanks_law_takes_over(article_pair, article_bodies, torque):
    """Second differences fall with the square of the intervals; at a corner they fall in proportion, at a step not."""
    position = np.linspace(0.02, 0.21, 153)
    approach, tangent, forces = solved(article_pair, article_bodies, torque, position)
    assert np.all((forces > 0).sum(axis=1) == 2)
    for curve, ratio in ((approach, 0.12), (tangent, 0.3)):
        fine, coarse = (np.abs(np.diff(curve[::every], n=2)).max() for every in (1, 4))
        assert fine < ratio * coarse
        assert fine < 0.2 * STEP * curve.mean()


def test_the_cycle_moves_little(article_pair, article_bodies, request):
    with_strips = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies)
    request.getfixturevalue("nothing_inside")
    without = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies)
    for name in ("stiffness", "secant_stiffness"):
        mean, before = getattr(with_strips, name).mean(), getattr(without, name).mean()
        assert mean == pytest.approx(before, rel=1e-3)
        assert mean > before  # the flank's own law is too soft


@pytest.mark.parametrize("corner", [0, 1])
@pytest.mark.parametrize("part", [0.0, 0.3, 0.9])
def test_the_correction_is_that_of_narrow_strips(article_pair, article_bodies, corner, part):
    """Against the contact solved by an active set on even strips, 1/40 of a half-width each."""
    bodies, pair, load = article_bodies, article_pair, 260e3
    width, gear = pair.face_width, (bodies.pinion, bodies.wheel)[corner]
    a = float(hertz_half_width(load, near(bodies, corner, 0.0)[1], 2 * LAW.plane_modulus / 2))
    place, _ = near(bodies, corner, part * a)
    edges = np.arange(max(0.0, part - 1.7) * a, (part + 2) * a, a / 40)
    middle, strip = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    rho = np.sqrt(gear.rho_end**2 - 2 * gear.base_radius * middle)
    radii, first = pair.base_radii[:: 1 if corner == 1 else -1], np.array([place])
    first = first if corner == 1 else pair.line_of_action - first
    gaps, where = unloaded_gap(radii, pair.line_of_action, first, rho)
    tip = bodies.tips[corner].on(middle, strip)
    angle = opening(radii, pair.line_of_action, first, where, rho)
    lever = tip.lever(angle[0])
    kernel = tip.leaning(angle)[0] - tip.hub_windup * np.outer(lever, lever)
    kernel += flat_kernel(middle, strip, LAW, pair.module)
    levers = np.ones_like(where) if corner == 1 else lever_ratio(pair, where, np.array([place])[:, None])
    wanted = bearing(kernel, gaps[0], levers[0], load)
    law = law_at(bodies, corner, [part * a])
    flank = float(bodies.hertz(np.array([place])).approach(np.array([load * width]))[0])
    rho_here = np.array([place if corner == 0 else pair.line_of_action - place])
    flank += load * float(gear.own(rho_here)[0] - gear.hub_windup)
    got = flank + float(law.value_and_slope(np.array([load * width]))[0][0])
    assert abs(got - flank) > 10 * abs(got - wanted) > 0
    assert got == pytest.approx(wanted, rel=STEP)


def bearing(kernel, gaps, levers, load):
    """Approach of strips that bear a line load, counted by their levers, by an active set."""
    active = np.ones(len(gaps), dtype=bool)
    for _ in range(100):
        on = np.flatnonzero(active)
        matrix = np.block([[kernel[np.ix_(on, on)], -levers[on, None]], [levers[None, on], 0.0]])
        *pressure, approach = np.linalg.solve(matrix, np.append(-gaps[on], load))
        whole = np.zeros(len(gaps))
        whole[on] = pressure
        after = (whole > 0) | (~active & (kernel @ whole + gaps < levers * approach))
        if np.array_equal(after, active):
            return approach
        active = after
    raise AssertionError("no solution")


def test_small_contacts_and_far_ones_have_the_flanks_own_law(article_bodies):
    pair = article_bodies.pair
    for corner in (0, 1):
        for distance in (0.01 * 2e-3, 0.05 * 2e-3):
            place, radius = near(article_bodies, corner, np.array([distance]))
            load = np.pi * LAW.plane_modulus * (distance / FADE[1]) ** 2 / (8 * radius)
            force = 0.99 * load * pair.face_width
            assert cut_off(article_bodies, corner, plain_touch(pair, place), place, force) == 0.0
            law = law_at(article_bodies, corner, [distance])
            own = 5e-10  # what a pair yields per force [m/N]
            value, slope = law.value_and_slope(force)
            assert abs(value[0]) < 1e-4 * own * force[0]
            assert abs(slope[0]) < 1e-3 * own
        law = law_at(article_bodies, corner, [FAR[1] * 2e-3, 1.2 * FAR[1] * 2e-3])
        np.testing.assert_allclose(law.quotient, 0.0, atol=1e-24)


def test_the_correction_is_smooth_and_its_slope_is_its_derivative(article_bodies):
    law = law_at(article_bodies, 1, np.array([0.0, 0.02, 0.05, 0.1]) * 2e-3)
    force = np.geomspace(3.0, 5e4, 400)[:, None] * np.ones(4)
    ahead, behind = (law.value_and_slope(force * (1 + h))[0] for h in (1e-5, -1e-5))
    slope = law.value_and_slope(force)[1]
    own = 5e-10  # what a pair yields per force [m/N]
    np.testing.assert_allclose(slope, (ahead - behind) / (2e-5 * force), atol=1e-5 * own)
    assert np.abs(np.diff(slope, axis=0)).max() < 0.01 * own


def test_a_smoothed_law_by_strips_is_hertz():
    """A contact that spreads from its middle, with its mirror image: coarse strips give the elliptic pressure's law."""
    module, radius = 2e-3, 5e-3
    distance, width = sharp_layout(module)
    mirror = np.concatenate([-distance[::-1], distance])
    both = flat_kernel(mirror, np.concatenate([width[::-1], width]), LAW, module)[len(distance) :]
    kernel = 2 * (both[:, : len(distance)][:, ::-1] + both[:, len(distance) :])
    gaps = (distance**2 / (2 * radius))[None]
    force, raw = from_the_corner(kernel, gaps, np.zeros(1), np.ones_like(gaps))
    load = np.geomspace(100.0, 5e5, 50)
    a = hertz_half_width(2 * load, np.array(radius), LAW.plane_modulus)
    wanted = 2 * 2 * load * hertz_indentation(a, LAW, module)
    error = [
        np.abs(CubicSpline(np.sqrt(force[0]), law[0])(np.sqrt(load)) / wanted - 1).max()
        for law in (raw, smoothed(force, raw))
    ]
    assert error[1] < STEP
    assert error[0] > 3 * error[1]


def test_beyond_the_strips_the_correction_grows_in_proportion(article_bodies):
    law = law_at(article_bodies, 1, np.array([0.0, 0.05]) * 2e-3)
    last = np.exp(law.log_force[[-1, -1]])
    (one, rises), (much, steep) = (law.value_and_slope(last * part) for part in (1.0 + 1e-9, 1e4))
    np.testing.assert_allclose(much, 1e4 * one, rtol=1e-6)
    np.testing.assert_allclose(steep, rises, rtol=1e-6)
