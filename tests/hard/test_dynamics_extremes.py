"""The exact flow where others lose their footing: grazes, no backlash, negative stiffness, extreme frequencies."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator, continue_branch, find_orbit, period_map, trajectory
from dynamics.branches.grazing import contact_orbit
from dynamics.flow.exact_flow import exact_flow
from tests.validation.article_motion import lubricated


def oscillator(kappa=0.18, phi=0.0, **changes) -> GearOscillator:
    return lubricated(kappa=kappa, phase=phi, **changes)


def plain_taylor(osc: GearOscillator, state, periods: int = 1, steps: int = 4000, order: int = 20, share=1.0):
    """Twin without tables: a Taylor step of the equation as it stands, in plain numpy, bisection for the crossings."""
    d, w = osc.half_backlash, osc.frequency
    h = share * osc.period / steps
    x, v = map(float, state)

    def series(t, y, v, spring):
        k = np.zeros(order + 1)
        g = np.zeros(order + 1)
        k[0], g[0] = osc.stiffness.mean, osc.mean_force
        factor = 1.0
        for n in range(order + 1):
            for j, (a, p) in enumerate(zip(osc.stiffness.amplitudes, osc.stiffness.phases, strict=True), 1):
                k[n] += a * j**n * factor * np.cos(j * w * t + p + n * np.pi / 2)
            g[n] += osc.error_amplitude * w**2 * factor * np.cos(w * t + osc.error_phase + n * np.pi / 2)
            factor *= w / (n + 1)
        c = np.zeros(order + 1)
        c[0], c[1] = y, v
        for n in range(order - 1):
            total = g[n] - 2 * osc.damping_ratio * (n + 1) * c[n + 1] - spring * np.dot(k[: n + 1], c[n::-1])
            c[n + 2] = total / ((n + 1) * (n + 2))
        return c[::-1]

    for i in range(periods * steps):
        t, left = (i % steps) * h, h
        for _ in range(20):
            region = 1 if x > d or (x == d and v > 0) else -1 if x < -d or (x == -d and v < 0) else 0
            c = series(t, x - region * d, v, float(region != 0 or d == 0))
            x_new = np.polyval(c, left) + region * d
            inside = abs(x_new) <= d if region == 0 else x_new * region >= d
            if inside:
                x, v = x_new, np.polyval(np.polyder(c), left)
                break
            low, high = 0.0, left
            target = (d if x_new > d else -d) if region == 0 else region * d
            for _ in range(80):
                middle = 0.5 * (low + high)
                there = np.polyval(c, middle) + region * d
                out = (there - target) * (1 if x_new > target else -1) > 0
                low, high = (low, middle) if out else (middle, high)
            x, v = target, float(np.polyval(np.polyder(c), high))
            t, left = t + high, left - high
    return np.array([x, v])


@pytest.mark.parametrize("depth", [10.0**-n for n in range(2, 15)])
@pytest.mark.parametrize("sign", [1, -1])
def test_grazing_depth(depth, sign):
    """An orbit that passes the limit by 1e-2 to 1e-14: the crossing is seen, and not seen on the other side."""
    # a change of the mean force moves the contact orbit rigidly if kappa = 0
    osc = oscillator(kappa=0.0, frequency=0.5)
    clear = contact_orbit(osc).clearance
    osc = osc.with_parameter("mean_force", osc.mean_force - clear - sign * depth)
    orbit = contact_orbit(osc)
    assert orbit.clearance == pytest.approx(-sign * depth, rel=0, abs=2e-16)
    image = period_map(osc, orbit.state)
    assert image.counts[0, 0] == (sign > 0)
    law = 4 * np.sqrt(2) / 3 * orbit.acceleration**-0.5 * depth**1.5
    off = np.max(np.abs(image.state - orbit.state))
    assert off < (3 * law if sign > 0 else 0.0) + 1e-15
    finer = period_map(exact_flow(osc, refinement=2), orbit.state)
    np.testing.assert_allclose(image.state, finer.state, rtol=0, atol=2e-15)
    change = 2 * np.sqrt(2) * orbit.acceleration**-0.5 * np.sqrt(depth)
    rounding = np.sqrt(1e-16 / depth) * change  # the depth itself is known to 1e-16
    np.testing.assert_allclose(image.jacobian, finer.jacobian, rtol=0, atol=4 * rounding + 1e-13)


def test_no_backlash_is_the_limit_of_little():
    none = period_map(oscillator(half_backlash=0.0), (0.05, 0.2), periods=3)
    little = period_map(oscillator(half_backlash=1e-13), (0.05, 0.2), periods=3)
    np.testing.assert_allclose(little.states, none.states, rtol=0, atol=5e-12)
    np.testing.assert_allclose(little.jacobian, none.jacobian, rtol=0, atol=5e-11)
    assert np.array_equal(little.counts, none.counts)
    assert none.counts.sum() > 0
    tiny = period_map(oscillator(half_backlash=1e-300), (0.05, 0.2), periods=3)
    np.testing.assert_allclose(tiny.states, none.states, rtol=0, atol=1e-14)


@pytest.mark.parametrize("kappa", [1.5, 3.0, 5.0])
@pytest.mark.parametrize("zeta", [0.0, 0.05, 2.0])
def test_negative_stiffness(kappa, zeta):
    osc = oscillator(kappa=kappa, damping_ratio=zeta, frequency=0.9)
    image = period_map(osc, (0.4, 0.1))
    size = max(1.0, np.max(np.abs(image.jacobian)))
    np.testing.assert_allclose(
        image.state, plain_taylor(osc, (0.4, 0.1), steps=1000), rtol=0, atol=1e-12 * size
    )
    j = image.jacobian
    scale = abs(j[0, 0] * j[1, 1]) + abs(j[0, 1] * j[1, 0])
    assert abs(np.linalg.det(j) - np.exp(-2 * zeta * osc.period)) <= 1e-13 * max(scale, 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("zeta", [0.0, 2.0])
@pytest.mark.parametrize("frequency", [0.3, 1.3])
def test_damping(zeta, frequency):
    osc = oscillator(damping_ratio=zeta, frequency=frequency)
    image = period_map(osc, (0.4, -0.3))
    size = max(1.0, np.max(np.abs(image.jacobian)))
    np.testing.assert_allclose(image.state, plain_taylor(osc, (0.4, -0.3)), rtol=0, atol=1e-12 * size)
    if zeta:
        orbit = find_orbit(osc, (0.3, 0.0), transient=50)
        assert orbit.stable
        assert orbit.error < 1e-13


def test_fast_excitation():
    osc = oscillator(frequency=50.0, error_amplitude=0.002)
    image = period_map(osc, (0.3, 0.05), periods=4)
    np.testing.assert_allclose(
        image.state, plain_taylor(osc, (0.3, 0.05), periods=4, steps=400), rtol=0, atol=1e-13
    )
    assert find_orbit(osc, (0.3, 0.0), transient=5000).label == "1-0-0"


def test_slow_excitation_with_many_crossings():
    """A light load that is reversed by nothing but vibration: a period of 314 with a hundred crossings."""
    osc = oscillator(frequency=0.02, damping_ratio=0.0005, mean_force=0.01, half_backlash=0.05)
    start = (0.5, 0.3)
    motion = trajectory(osc, start, periods=1, points_per_period=100)
    assert len(motion.events) > 100
    image = period_map(osc, start)
    stretch = np.max(np.abs(image.jacobian))
    np.testing.assert_allclose(
        image.state, plain_taylor(osc, start, steps=3000), rtol=0, atol=1e-12 * stretch
    )
    assert period_map(osc, start).counts.sum() == np.sum(
        ((motion.events[:, 1] > 0) & (motion.events[:, 3] == 0)) | (motion.events[:, 3] == -1)
    )


@pytest.mark.parametrize(("zeta", "d"), [(0.0, 0.0), (0.05, 0.2)])
def test_multipliers_beyond_a_single_shot(zeta, d):
    """Parametrically unstable over a long period: the map stretches by 1e14 to 1e20, and the orbit is found."""
    osc = oscillator(kappa=1.5, frequency=0.02, half_backlash=d, damping_ratio=zeta)
    orbit = find_orbit(osc, (0.3, 0.0))
    assert orbit.converged, orbit.message
    assert abs(orbit.multipliers[0]) > 1e13
    # rounding, times how far a stretch stretches (1e3), times their number (124)
    assert orbit.error < 3e-11
    assert np.prod(orbit.multipliers) == pytest.approx(orbit.determinant, rel=1e-12)
    # each stretch, integrated by the twin without tables, ends where the next begins
    cells = exact_flow(osc).cells
    firsts = np.round(np.linspace(0, cells, len(orbit.nodes) + 1)).astype(int)
    for i in range(0, len(orbit.nodes), 17):
        turn = 2 * np.pi * firsts[i] / cells
        there = dataclasses.replace(
            osc,
            stiffness=FourierStiffness(1.0, (1.5,), (turn,)),
            error_phase=turn,
        )
        share = (firsts[i + 1] - firsts[i]) / cells
        end = plain_taylor(there, orbit.nodes[i], steps=200, share=share)
        size = np.max(np.abs(orbit.nodes))
        np.testing.assert_allclose(end, orbit.nodes[(i + 1) % len(orbit.nodes)], rtol=0, atol=1e-10 * size)
    if d == 0.0:  # the linear equation: the same multipliers in any motion
        jacobian = period_map(osc, (0.0, 0.0)).jacobian
        assert orbit.multipliers[0] == pytest.approx(np.trace(jacobian), rel=1e-9)


def test_thousand_periods_of_rest():
    """A state at rest inside the play, without any force, stays to the last bit."""
    osc = oscillator(mean_force=0.0, error_amplitude=0.0)
    assert period_map(osc, (0.1, 0.0), periods=1, skip=999).state.tolist() == [0.1, 0.0]


def test_period_doubling_on_a_grazing():
    """kappa = 0.179: both within 2e-9 of each other, where the trace has a square-root corner."""
    osc = oscillator(kappa=0.179, frequency=0.5)
    branch = continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.5, 1.2))
    assert branch.converged, branch.message
    (doubling,) = branch.special("period-doubling")
    touch = min(branch.special("grazing"), key=lambda p: abs(p.parameter - doubling.parameter))
    assert abs(touch.parameter - doubling.parameter) < 1e-8
    image = period_map(osc.with_parameter("frequency", doubling.parameter), doubling.state)
    exact = np.exp(-2 * 0.05 * 2 * np.pi / doubling.parameter)
    assert 1 + exact + np.trace(image.jacobian) == pytest.approx(0.0, abs=1e-9)


def test_newton_at_a_fold():
    """Right at the saddle node the step halves every time, and the orbit is still found or refused, never guessed."""
    osc = oscillator(frequency=0.6555759637891123)
    orbit = find_orbit(osc, (0.43, 0.0))
    if orbit.converged:
        assert np.max(np.abs(period_map(osc, orbit.state).state - orbit.state)) < 1e-13
    beyond = find_orbit(oscillator(frequency=0.6556), (0.43, 0.0))
    assert not beyond.converged or beyond.label != "1-0-0"


def test_branch_with_next_to_no_backlash():
    osc = oscillator(half_backlash=1e-13, frequency=0.5)
    branch = continue_branch(find_orbit(osc, (0.1, 0.0)), "frequency", (0.5, 0.8))
    assert branch.converged, branch.message
    touches = [p.parameter for p in branch.special("grazing") if p.boundary == 1]
    assert touches[0] == pytest.approx(0.633533993217297, rel=0, abs=1e-12)


def test_137_crossings_and_more():
    """omega = 0.02: one period of 314 with some hundred crossings, each seen: the same on cells of half the size."""
    osc = oscillator(frequency=0.02, damping_ratio=0.0005, mean_force=0.01, half_backlash=0.02)
    start = (0.3, 0.1)
    motion = trajectory(osc, start, periods=1, points_per_period=10)
    assert len(motion.events) >= 137
    coarse, fine = (period_map(exact_flow(osc, r), start) for r in (1, 2))
    assert np.array_equal(coarse.counts, fine.counts)
    stretch = np.max(np.abs(coarse.jacobian))
    np.testing.assert_allclose(coarse.state, fine.state, rtol=0, atol=1e-12 * stretch)


def test_chaos_by_its_statistics():
    """Two chaotic motions part within 60 periods, whatever the precision; what they do on average is the same."""
    osc = oscillator(frequency=1.04)
    batches, length = 60, 60
    means = []
    for refinement, start in ((1, (0.3, 0.0)), (2, (0.3, 1e-9))):
        image = period_map(exact_flow(osc, refinement), start, batches * length, skip=200)
        figures = np.column_stack([image.states, image.states**2, image.counts])
        means.append(figures.reshape(batches, length, -1).mean(axis=1))
    apart = period_map(osc, (0.3, 0.0), 260).states[-1] - period_map(osc, (0.3, 1e-9), 260).states[-1]
    assert np.max(np.abs(apart)) > 1e-3
    a, b = (m.mean(axis=0) for m in means)
    spread = np.sqrt(sum(m.var(axis=0, ddof=1) / batches for m in means))
    assert np.all(np.abs(a - b) <= 5 * spread)  # the exits are one a period throughout


def test_hardly_any_damping_takes_long_and_is_still_followed():
    """zeta 1e-4: determinants of 1 - 1e-3, resonances a thousand times the static answer."""
    osc = oscillator(damping_ratio=1e-4, error_amplitude=1e-4, frequency=0.9)
    orbit = find_orbit(osc, osc.rest_state())
    assert orbit.converged
    assert abs(np.prod(orbit.multipliers)) == pytest.approx(np.exp(-4e-4 * np.pi / 0.9), rel=1e-12)
    branch = continue_branch(orbit, "frequency", (0.9, 1.1))
    assert branch.converged
    assert {p.kind for p in branch.points} >= {"saddle-node", "grazing"}


def test_rectangular_stiffness_of_101_harmonics_is_the_limit_of_two_constant_ones():
    """Between two values of k the equation has solutions of its own: the series is held against them, in contact."""
    high, low, n = 1.2, 0.8, 101
    j = np.arange(1, n + 1)
    amplitudes = 2.0 * (high - low) / (np.pi * j) * np.sin(0.5 * np.pi * j)
    series = FourierStiffness(1.0, tuple(np.abs(amplitudes)), tuple(np.where(amplitudes < 0, np.pi, 0.0)))
    osc = GearOscillator(series, 0.05, 0.1, 0.0, 0.7, 0.0)
    half = np.pi / 0.7

    def propagator(k: float, time: float) -> np.ndarray:
        w = np.sqrt(k - 0.05**2)
        c, s, decay = np.cos(w * time), np.sin(w * time), np.exp(-0.05 * time)
        return decay * np.array([[c + 0.05 / w * s, s / w], [-k / w * s, c - 0.05 / w * s]])

    # high in the first and the last quarter of a period
    whole = propagator(high, 0.5 * half) @ propagator(low, half) @ propagator(high, 0.5 * half)
    found = period_map(osc, osc.rest_state()).jacobian
    # a harmonic left out, of frequency j w, moves X by its amplitude over (j w)^2, and V by that over j w
    left = np.arange(n + 2, 100_000, 2)
    off = 2.0 * (high - low) / np.pi * np.array([np.sum(1.0 / left**3) / 0.7**2, np.sum(1.0 / left**2) / 0.7])
    assert np.all(np.abs(found - whole) < 3.0 * off[:, None] * np.max(np.abs(whole)))
    assert np.linalg.det(found) == pytest.approx(np.linalg.det(whole), rel=1e-12)


def test_fifty_harmonics_of_the_error_are_the_sum_of_their_answers():
    """In contact with constant stiffness every harmonic answers by itself."""
    w, j = 0.13, np.arange(1, 51)
    errors, phases = 2e-4 / j, 0.37 * j
    osc = GearOscillator(FourierStiffness(1.0), 0.05, 0.5, tuple(errors), w, 0.1, tuple(phases))
    response = errors * (j * w) ** 2 * np.exp(1j * phases) / (1.0 - (j * w) ** 2 + 0.1j * j * w)
    orbit = find_orbit(osc, osc.rest_state())
    assert orbit.state[0] == pytest.approx(0.6 + np.sum(response.real), rel=1e-12)
    assert orbit.state[1] == pytest.approx(np.sum((1j * j * w * response).real), rel=1e-10, abs=1e-14)


@pytest.mark.parametrize("share", [1e-2, 1e-5])
def test_a_pair_at_next_to_no_load_between_far_flanks(share: float):
    """Load and error a hundredth and 1e-5 of usual: the equation is the same with all lengths in proportion."""

    def points(size: float, **changes) -> list[tuple[str, float]]:
        osc = GearOscillator(
            FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1 * size, 0.2 * size, 0.6, half_backlash=10.0, **changes
        )  # fmt: skip
        branch = continue_branch(find_orbit(osc, osc.rest_state()), "frequency", (0.45, 1.2))
        assert branch.converged
        assert branch.ended == ("bound", "bound")
        return [(p.kind, p.parameter) for p in branch.points]

    full, light = points(1.0, one_sided=True), points(share)
    assert [kind for kind, _ in light] == [kind for kind, _ in full]
    assert [at for _, at in light] == pytest.approx([at for _, at in full], abs=1e-8)
