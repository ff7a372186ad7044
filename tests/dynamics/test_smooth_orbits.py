"""Orbits, branches, sweeps and exponents of the stepwise flow, most of them against the exact flow's."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import dynamics
from base import InputError
from dynamics import (
    CompiledLaw,
    FourierStiffness,
    GearOscillator,
    PowerContact,
    SmoothOscillator,
    SqueezeFilm,
    Surface,
    TabulatedContact,
)
from dynamics.branches.arclength import follow
from dynamics.branches.branch import MEETS
from dynamics.branches.branch_problem import MapPoint, Steps
from dynamics.branches.sensitivity import map_derivatives
from dynamics.branches.stepwise_problem import PeriodMap
from dynamics.flow.exact_flow import exact_flow
from dynamics.flow.motions import turning_points

KAPPA = FourierStiffness(1.0, (0.18,), (0.0,))


def exact(frequency=0.55, **changes) -> GearOscillator:
    return GearOscillator(
        **({"stiffness": KAPPA, "damping_ratio": 0.05, "mean_force": 0.1, "error_amplitude": 0.2} | changes),
        frequency=frequency,
        half_backlash=0.2,
    )


def ours(frequency=0.55, **law) -> SmoothOscillator:
    options = {"stiffness": KAPPA, "half_backlash": 0.2, "exponent": 1.0} | law
    return SmoothOscillator(PowerContact(**options), 0.05, 0.1, 0.2, frequency)


@pytest.fixture(scope="module")
def exact_branch():
    return dynamics.continue_branch(dynamics.find_orbit(exact(), (0.4, 0.0)), "frequency", (0.5, 0.95))


def assert_same_points(branch, reference, tolerance):
    assert [(p.kind, p.boundary) for p in branch.points] == [(p.kind, p.boundary) for p in reference.points]
    for p, q in zip(branch.points, reference.points, strict=True):
        assert p.parameter == pytest.approx(q.parameter, abs=tolerance), p.kind
        assert p.state == pytest.approx(q.state, abs=1e-5)  # at a fold the state moves with the root
        if p.kind == "grazing":
            assert p.label == q.label
            assert p.tau == pytest.approx(q.tau, abs=1e-7)
            assert p.acceleration == pytest.approx(q.acceleration, abs=1e-7)


@pytest.mark.slow
def test_branch_has_the_exact_special_points(exact_branch):
    """Exponent 1: folds, grazings and the period doubling of the lubricated scan, to 1e-12."""
    orbit = dynamics.find_orbit(ours(), (0.4, 0.0))
    branch = dynamics.continue_branch(orbit, "frequency", (0.5, 0.95))
    assert branch.converged
    assert branch.error < 1e-11
    assert len(branch.special("saddle-node")) == 4
    assert branch.special("period-doubling")[0].parameter == pytest.approx(0.887241499860580, abs=1e-12)
    assert_same_points(branch, exact_branch, 1e-12)


def test_doubled_branch():
    """From the period doubling at 1.7687 on to period 2, the exact flow's orbit."""
    orbit = dynamics.find_orbit(ours(1.8), (0.3, 0.3), transient=300)
    (point,) = dynamics.continue_branch(orbit, "frequency", (1.75, 1.82)).special("period-doubling")
    doubled = dynamics.doubled_orbit(ours(1.8), "frequency", point, (1.6, 1.9))
    assert doubled.periods == 2
    branch = dynamics.continue_branch(doubled, "frequency", (1.72, 1.82), max_step=0.05)
    assert MEETS in branch.ended
    assert branch.values.max() == pytest.approx(point.parameter, abs=1e-3)
    at = int(np.argmin(np.abs(branch.values - 1.74)))
    theirs = dynamics.find_orbit(exact(branch.values[at]), branch.states[at], 2)
    assert theirs.periods == 2
    assert branch.states[at] == pytest.approx(theirs.state, abs=1e-10)


class ExactMap(PeriodMap):
    """The exact flow as a `PeriodMap`."""

    def evaluate(self, u):
        here, n = self.at(u), self.periods
        done = map_derivatives(here, u[:2] * self.scale, self.parameters, n)
        turns = turning_points(here, u[:2] * self.scale, n)[:, :3]
        turns[:, 0] /= here.period * n
        return MapPoint(
            u.copy(),
            self.values(u),
            here.period,
            done.state / self.scale,
            np.column_stack([done.jacobian, done.slope * (self.high - self.low) / self.scale]),
            math.exp(-2 * here.damping_ratio * here.period * n),
            done.counts,
            np.array([here.half_backlash, -here.half_backlash]),
            turns,
        )

    def flow(self, point):
        return exact_flow(self.at(point.u))


@pytest.mark.slow
def test_continuation_serves_any_period_map(exact_branch):
    problem = ExactMap(exact(), ("frequency",), 1, np.array([0.5]), np.array([0.95]), 0.4)
    start = dynamics.find_orbit(exact(), (0.4, 0.0))
    branch = follow(problem, start.state, 0.55, Steps(0.005, 0.02, 1e-8, 5000), None)
    assert_same_points(branch, exact_branch, 1e-12)


def test_orbits_are_the_exact_ones():
    for frequency, guess, periods in ((0.6, (0.5, 0.2), 1), (0.62, (0.1, 0.6), 1), (1.0, (0.3, 0.5), 3)):
        theirs = dynamics.find_orbit(exact(frequency), guess, periods, transient=300)
        orbit = dynamics.find_orbit(ours(frequency), theirs.state + 1e-5, periods)
        assert theirs.converged
        assert orbit.converged
        assert orbit.label == theirs.label
        assert orbit.state == pytest.approx(theirs.state, abs=1e-11)
        assert orbit.determinant == pytest.approx(theirs.determinant, rel=1e-12)
        assert orbit.multipliers == pytest.approx(theirs.multipliers, abs=1e-10)
        assert np.linalg.det(orbit.jacobian) == pytest.approx(orbit.determinant, rel=1e-10)
        assert orbit.error < 1e-11


def test_an_orbit_that_is_not_found_says_so():
    orbit = dynamics.find_orbit(ours(), (50.0, 30.0), max_iterations=1)
    assert not orbit.converged
    assert np.all(np.isnan(orbit.state))
    with pytest.raises(InputError, match="converged orbit"):
        dynamics.continue_branch(orbit, "frequency", (0.5, 0.6))


A, RATE, DAMPING = 0.8, 0.37, 0.05


def manufactured(theta, x, v, region, q):
    """Van der Pol's damping with a drive that keeps X = A cos theta a motion for every mu."""
    a, da = A * np.cos(theta), -RATE * A * np.sin(theta)
    drive = (1 - RATE * RATE) * a + 2 * DAMPING * da - q[0] * (1 - a * a) * da
    return x - q[0] * (1 - x * x) * v - drive


def test_neimark_sacker_where_it_is_known():
    """Along A cos theta the mean damping 2 zeta - mu (1 - A^2/2) vanishes at a known mu."""
    osc = SmoothOscillator(CompiledLaw(manufactured, (("mu", 0.1),)), DAMPING, 0.0, 0.0, RATE)
    orbit = dynamics.find_orbit(osc, (0.7, 0.01))
    assert orbit.state == pytest.approx((A, 0.0), abs=1e-12)
    assert orbit.determinant == pytest.approx(
        math.exp(-(2 * DAMPING - 0.1 * (1 - A**2 / 2)) * osc.period), rel=1e-12
    )
    branch = dynamics.continue_branch(orbit, "mu", (0.05, 0.3))
    (point,) = branch.special("neimark-sacker")
    assert [p.kind for p in branch.points] == ["neimark-sacker"]
    assert point.parameter == pytest.approx(2 * DAMPING / (1 - A**2 / 2), abs=1e-13)
    assert np.abs(point.multipliers) == pytest.approx((1.0, 1.0), abs=1e-12)
    assert branch.stable[branch.values < point.parameter - 1e-9].all()
    assert not branch.stable[branch.values > point.parameter + 1e-9].any()
    # beyond it the motion turns on a torus: no period, and an exponent that is zero
    beyond = osc.with_parameter("mu", point.parameter + 0.03)
    swept = dynamics.sweep(beyond, "mu", [point.parameter + 0.03], initial=(0.8, 0.05), transient=400)
    assert swept.labels == ("aperiodic",)
    exponents = dynamics.lyapunov_exponents(beyond, 1000, state=(0.8, 0.05), transient=400)
    assert abs(exponents.exponents[0]) < 3e-3
    assert exponents.exponents[1] < -0.01


def test_sweeps_meet_the_same_motions():
    values = np.linspace(0.52, 1.0, 9)
    for direction in ("up", "down"):
        theirs = dynamics.sweep(exact(), "frequency", values, direction)
        mine = dynamics.sweep(ours(), "frequency", values, direction, tolerance=1e-8)
        assert mine.labels == theirs.labels
        assert mine.converged
        assert mine.error < 1e-6
        for i in np.flatnonzero(mine.periods == 1):  # beside a period doubling motions still creep
            assert mine.states[i, -1] == pytest.approx(theirs.states[i, -1], abs=5e-4)


@pytest.mark.parametrize("frequency", [0.6, 1.05])
def test_sum_of_exponents(frequency):
    result = dynamics.lyapunov_exponents(ours(frequency), 200, tolerance=1e-10)
    assert np.sum(result.exponents) == pytest.approx(-0.1, abs=1e-10)


def test_sum_of_exponents_with_a_film_is_the_mean_damping():
    osc = ours(0.6, film=SqueezeFilm(0.3, 0.05))
    orbit = dynamics.find_orbit(osc, (0.5, 0.0), transient=100)
    result = dynamics.lyapunov_exponents(osc, 200, state=orbit.state, transient=50, tolerance=1e-10)
    assert np.sum(result.exponents) == pytest.approx(math.log(orbit.determinant) / osc.period, abs=1e-9)
    assert orbit.determinant < math.exp(-0.1 * osc.period)


def test_film_damps_in_the_gap_by_its_law():
    """In a symmetric gap the film takes c [..] V: the force and its derivatives at a few places."""
    osc = ours(film=SqueezeFilm(0.3, 0.05))
    at = dynamics.restoring_force(osc, 0.3, np.array([0.0, 0.1, -0.1, 0.3]), 0.7)
    gap = np.array([[0.2, 0.2], [0.1, 0.3], [0.3, 0.1], [0.0, 0.5]])
    film = 0.3 * (0.05 / (0.05 + gap)) ** 1.5
    contact = KAPPA(0.3) * np.array([0.0, 0.0, 0.0, 0.1])
    assert at[:, 0] == pytest.approx(contact + 0.7 * film.sum(axis=1), rel=1e-13)
    assert at[:, 2] == pytest.approx(film.sum(axis=1), rel=1e-13)


def table(power=1.15, count=24):
    """Deflections under rising forces with two harmonics."""
    angles = 2 * np.pi * (np.arange(count) + 0.5) / count
    stiff = 1.0 + 0.2 * np.cos(angles) + 0.05 * np.sin(2 * angles)
    forces = np.geomspace(1e-3, 2.0, 16)
    return forces, (forces / stiff[:, None]) ** (1 / power), angles


def test_table_gives_back_its_law():
    forces, deflections, angles = table()
    law = TabulatedContact.from_deflections(
        forces, deflections, half_backlash=0.2, order=2, first_angle=angles[0]
    )
    osc = SmoothOscillator(law, 0.05, 0.1, 0.2, 0.6)
    depth = np.linspace(0.05, 1.2, 40)
    theta = 0.7
    stiff = 1.0 + 0.2 * np.cos(theta) + 0.05 * np.sin(2 * theta)
    got = dynamics.restoring_force(osc, theta, 0.2 + depth)
    assert got[:, 0] == pytest.approx(stiff * depth**1.15, rel=1e-3)
    assert got[:, 1] == pytest.approx(1.15 * stiff * depth**0.15, rel=5e-3)
    assert dynamics.restoring_force(osc, theta, -0.2 - depth)[:, 0] == pytest.approx(-got[:, 0], rel=1e-13)
    finer = TabulatedContact.from_deflections(
        np.geomspace(1e-3, 2.0, 48),
        (np.geomspace(1e-3, 2.0, 48) / (forces[0] / deflections[:, :1] ** 1.15)) ** (1 / 1.15),
        half_backlash=0.2,
        order=2,
        first_angle=angles[0],
        intervals=96,
    )
    better = dynamics.restoring_force(replace_law(osc, finer), theta, 0.2 + depth)
    error = [np.max(np.abs(f[:, 0] / (stiff * depth**1.15) - 1)) for f in (got, better)]
    assert error[1] < error[0] / 8


@pytest.mark.parametrize("power", [1.5, 1.3])
def test_below_and_above_a_table_its_law_goes_on(power):
    """F = d^n: the secant is a power of the root of the depth, linear with n = 1.5; above goes the tangent."""
    forces = np.geomspace(0.2, 1.0, 5)
    law = TabulatedContact.from_deflections(
        forces, np.tile(forces ** (1 / power), (3, 1)), half_backlash=0.2, order=1, intervals=400
    )
    osc = SmoothOscillator(law, 0.05, 0.1, 0.2, 0.6)
    low, high = forces[0] ** (1 / power), 1.0

    def force(depth):
        return dynamics.restoring_force(osc, 0.7, 0.2 + np.asarray(depth))

    if power == 1.5:  # what goes on linearly is the law itself
        below = low * np.array([0.1, 0.3, 0.6, 0.9])
        assert force(below)[:, 0] == pytest.approx(below**1.5, rel=1e-4)
    above = high + np.array([0.1, 1.0, 3.0])
    # the slope at the end is that of the splines, on intervals of 1/200 there
    assert force(above)[:, 0] == pytest.approx(1.0 + power * (above - high), rel=5e-3)
    assert force(above)[:, 1] == pytest.approx(power, rel=5e-3)


def test_stiffer_angles_go_on_by_the_tangent_to_where_softer_ones_end():
    """F = c d^1.3 with c = 1.5 at the first of three angles, whose table ends before those of the others."""
    forces, c, n = np.geomspace(0.2, 1.0, 5), np.array([1.5, 1.0, 1.0]), 1.3
    law = TabulatedContact.from_deflections(
        forces, (forces / c[:, None]) ** (1 / n), half_backlash=0.2, order=1, intervals=400
    )
    end = 1.5 ** (-1 / n)
    depth = np.linspace(end, 1.0, 6)[1:-1]
    found = dynamics.restoring_force(SmoothOscillator(law, 0.05, 0.1, 0.2, 0.6), 0.0, 0.2 + depth)
    slope = n * 1.5 * end ** (n - 1.0)
    assert found[:, 0] == pytest.approx(1.0 + slope * (depth - end), rel=1e-3)
    assert found[:, 1] == pytest.approx(slope, rel=2e-3)


def replace_law(osc: SmoothOscillator, law) -> SmoothOscillator:
    return replace(osc, law=law)


def test_table_is_twice_differentiable():
    """Force, stiffness and its slope pass every knot and the end of the samples without a jump."""
    forces, deflections, angles = table()
    law = TabulatedContact.from_deflections(
        forces, deflections, half_backlash=0.0, order=2, first_angle=angles[0]
    )
    osc = SmoothOscillator(law, 0.05, 0.1, 0.2, 0.6)
    knots = law.knots[1:]
    h = 1e-7 * knots
    below, at, above = (dynamics.restoring_force(osc, 0.7, knots + s * h) for s in (-1.0, 0.0, 1.0))
    assert np.max(np.abs(above[:, 0] - below[:, 0]) / at[:, 0]) < 1e-6
    left, right = (at[:, 1] - below[:, 1]) / h, (above[:, 1] - at[:, 1]) / h
    scale = at[:, 1] / knots
    assert np.max(np.abs(right - left) / scale) < 1e-5


def test_straight_table_is_the_exact_flow():
    series = FourierStiffness(1.0, (0.18, 0.07), (0.4, -0.3))
    count = 9
    angles = 2 * np.pi * np.arange(count) / count
    forces = np.geomspace(1e-2, 2.0, 8)
    law = TabulatedContact.from_deflections(
        forces, forces / series(angles)[:, None], half_backlash=0.2, order=4
    )
    # a stiffness of two harmonics from its inverse: nine angles fix the four harmonics of the product
    done = dynamics.period_map(SmoothOscillator(law, 0.05, 0.1, 0.2, 0.6), (0.5, 0.2), 2)
    reference = dynamics.period_map(exact(0.6, stiffness=series), (0.5, 0.2), 2)
    assert done.state == pytest.approx(reference.state, abs=1e-10)


def test_bad_input_is_refused():
    forces, deflections, _ = table()
    with pytest.raises(InputError, match="frequency"):
        ours(frequency=0.0)
    with pytest.raises(InputError, match="half_backlash"):
        ours(half_backlash=-0.1)
    with pytest.raises(InputError, match="exponent"):
        ours(exponent=0.5)
    with pytest.raises(InputError, match="must be one of"):
        ours().with_parameter("kappa", 1.0)
    with pytest.raises(InputError, match="tolerance"):
        dynamics.period_map(ours(), (0.5, 0.2), tolerance=1e-17)
    with pytest.raises(InputError, match="rising with the force"):
        TabulatedContact.from_deflections(forces, deflections[:, ::-1], half_backlash=0.2)
    with pytest.raises(InputError, match="below half the angles"):
        TabulatedContact.from_deflections(forces, deflections, half_backlash=0.2, order=12)
    depths = np.linspace(0.0, 1.0, 9) ** 2
    uneven = (1.0 + 1.2 * np.cos(2 * np.pi * np.arange(8) / 8))[:, None] * depths
    with pytest.raises(InputError, match="grows with the depth"):
        TabulatedContact.from_forces(depths, uneven, half_backlash=0.2, order=1)
    with pytest.raises(InputError, match="thickness"):
        SqueezeFilm(0.1, 0.0)
    with pytest.raises(InputError, match="Name a parameter"):
        CompiledLaw(manufactured, (("mu", 0.1),), (Surface(parameter="d"),))


def cube(theta, x, v, region, q):
    return x**3


def corner(theta, x, v, region, q):
    return abs(x) * x


@pytest.mark.parametrize("function", [cube, corner])
def test_a_function_whose_derivative_is_wrong_is_refused(function):
    with pytest.raises(InputError, match="derivatives off"):
        dynamics.period_map(SmoothOscillator(CompiledLaw(function), 0.05, 0.1, 0.2, 0.6), (0.5, 0.2))
