"""Lyapunov exponents and basins of attraction."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from dynamics import (
    FourierStiffness,
    GearOscillator,
    basins,
    find_orbit,
    lyapunov_exponents,
    lyapunov_scan,
    period_map,
)
from tests.validation.article_motion import lubricated


@pytest.mark.parametrize(
    ("frequency", "zeta"), [(0.5, 0.05), (1.04, 0.05), (1.04, 0.01), (2.0, 0.0), (0.05, 0.05)]
)
def test_sum_is_exact(article, frequency, zeta):
    result = lyapunov_exponents(article(frequency=frequency, damping_ratio=zeta), periods=2000, transient=500)
    assert abs(np.asarray(result).sum() + 2 * zeta) <= 1e-13


def test_exponents_of_a_node(article):
    """Of a periodic orbit: logarithms of the multipliers over the period. 2-2-1 has real ones at 1.28."""
    osc = article(frequency=0.64)
    orbit = find_orbit(osc, (0.5, 0.2), transient=400)
    assert orbit.stable
    result = lyapunov_exponents(osc, periods=4000, state=orbit.state, transient=0)
    exact = np.log(np.abs(orbit.multipliers)) / (orbit.periods * osc.period)
    # the frame turns into the eigenvector once: an error of order 1 over the time
    np.testing.assert_allclose(result.exponents, exact, rtol=0, atol=3.0 / (4000 * osc.period))
    assert result.message == "periodic"


def test_exponents_of_a_focus():
    osc = GearOscillator(FourierStiffness(1.0), 0.07, 0.5, 0.1, 1.1, half_backlash=0.1)
    result = lyapunov_exponents(osc, periods=5000)
    np.testing.assert_allclose(result.exponents, [-0.07, -0.07], rtol=0, atol=1e-4)


def test_chaos(article):
    """Against a product of the period's Jacobians, made orthogonal by numpy."""
    osc = article(frequency=1.04)
    result = lyapunov_exponents(osc, periods=4000, state=(0.3, 0.0), transient=100)
    assert result.message == "chaotic"
    assert result.exponents[0] > 0.05
    state, frame, total = np.array([0.3, 0.0]), np.eye(2), 0.0
    for _ in range(20):  # few enough for two chaotic motions to stay together
        image = period_map(osc, state)
        frame, r = np.linalg.qr(image.jacobian @ frame)
        total += np.log(abs(r[0, 0]))
        state = image.state
    short = lyapunov_exponents(osc, periods=20, state=(0.3, 0.0), transient=0)
    assert short.exponents[0] == pytest.approx(total / (20 * osc.period), rel=1e-9)
    other = lyapunov_exponents(osc, periods=4000, state=(-0.2, 0.3), transient=100)
    spread = np.hypot(other.standard_error, result.standard_error)
    assert abs(other.exponents[0] - result.exponents[0]) < 5 * spread


def test_scan_of_both_exponents(article):
    values = np.linspace(0.95, 1.2, 11)
    scan = lyapunov_scan(article(), "frequency", values, periods=600, transient=200)
    assert scan.exponents.shape == scan.standard_errors.shape == (11, 2)
    assert np.max(np.abs(scan.exponents.sum(axis=1) + 0.1)) <= 1e-13
    assert scan.defect <= 1e-13
    np.testing.assert_allclose(scan.standard_errors[:, 0], scan.standard_errors[:, 1], rtol=1e-6)
    chaotic = scan.exponents[:, 0] > 3 * scan.standard_errors[:, 0]
    assert np.any(chaotic)
    assert not np.all(chaotic)
    assert np.asarray(scan).shape == (11, 5)
    # the same as one by one, the state handed on
    state = None
    for i in range(3):
        one = lyapunov_exponents(article(frequency=values[i]), 600, state=state, transient=200)
        assert one.exponents.tolist() == scan.exponents[i].tolist()
        state = one.state
    with pytest.raises(InputError) as error:
        lyapunov_scan(article(), "frequency", [], periods=3)
    assert {f.where for f in error.value.faults} == {"values", "periods"}


def test_scan_says_where_motion_is_lost():
    osc = GearOscillator(FourierStiffness(1.0, (0.9,), (0.0,)), 0.0, 0.1, 0.2, 2.0, half_backlash=0.1)
    scan = lyapunov_scan(osc, "damping_ratio", [0.0, 0.5], periods=2000, state=(1.0, 1.0), transient=3000)
    assert np.isnan(scan.exponents[0, 0])
    assert np.all(np.isfinite(scan.exponents[1]))
    assert not scan.converged
    assert "unbounded at 1" in scan.message


def test_too_short_an_average_is_said(article):
    with pytest.raises(InputError, match="periods"):
        lyapunov_exponents(article(), periods=5)
    result = lyapunov_exponents(article(frequency=1.04), periods=20)
    assert result.standard_error > 0


@pytest.fixture(scope="module")
def hysteresis():
    osc = lubricated(0.6)
    return osc, basins(osc, x=(-1, 1, 40), v=(-1, 1, 30))


def test_basins_in_the_hysteresis(hysteresis):
    _, result = hysteresis
    assert result.labels.shape == (40, 30)
    assert result.converged
    assert {a.label for a in result.attractors} == {"1-0-0", "1-1-1"}
    assert sum(a.share for a in result.attractors) == pytest.approx(1.0)
    assert pickle.loads(pickle.dumps(result)).labels.tolist() == result.labels.tolist()


def test_every_start_is_where_it_ends(hysteresis):
    """X along the first axis, and each label is the attractor that a plain iteration ends on."""
    osc, result = hysteresis
    for i in range(0, 40, 5):
        for j in range(0, 30, 7):
            end = period_map(osc, (result.x[i], result.v[j]), skip=400).state
            apart = [np.min(np.max(np.abs(a.states - end), axis=1)) for a in result.attractors]
            assert int(np.argmin(apart)) == result.labels[i, j]
            assert min(apart) < 1e-9


def test_basins_mirror(hysteresis):
    osc, result = hysteresis
    reverse = replace(osc, mean_force=-osc.mean_force, error_amplitude=-osc.error_amplitude)
    mirror = basins(reverse, x=(-1, 1, 40), v=(-1, 1, 30))
    names = np.array([a.label for a in result.attractors])[result.labels]
    mirrored = np.array([a.label for a in mirror.attractors])[mirror.labels]
    # exits above and entries below change places: 1-1-1 stays what it is, 1-0-0 rests on the other flank
    assert np.array_equal(mirrored[::-1, ::-1], names)


def test_chaos_beyond_its_crisis_is_a_transient(article):
    """At omega 1.119741 the chaotic attractor meets the manifold of U3-3-1: below it every start comes to 6-4-4."""
    transient, lasting = (basins(article(frequency=w), x=(-1, 1, 12), v=(-1, 1, 12)) for w in (1.11, 1.13))
    assert [a.label for a in transient.attractors] == ["6-4-4"]
    assert transient.converged
    assert {a.label for a in lasting.attractors} == {"aperiodic", "6-4-4"}
    assert lasting.converged
    assert all(a.orbit is None or a.orbit.stable for a in lasting.attractors)


def test_a_motion_that_has_not_settled_is_not_called_chaos():
    """Next to no damping, so that 20 limits are over long before the motion is at rest on its orbit."""
    osc = GearOscillator(FourierStiffness(1.0), 1e-5, 2.0, 0.1, 0.7, half_backlash=0.1)
    result = basins(osc, x=(1.5, 3.0, 5), v=(-0.5, 0.5, 4), limit=5)
    assert np.all(result.labels == -1)
    assert result.attractors == ()
    assert not result.converged
    assert "unsettled: raise limit" in result.message
    settled = basins(osc, x=(1.5, 3.0, 5), v=(-0.5, 0.5, 4), limit=100_000)
    assert [a.label for a in settled.attractors] == ["1-0-0"]
    assert settled.converged


def test_motion_without_damping_is_aperiodic():
    osc = GearOscillator(FourierStiffness(1.0), 0.0, 2.0, 0.1, np.sqrt(0.5), half_backlash=0.1)
    result = basins(osc, x=(1.9, 2.3, 3), v=(-0.1, 0.1, 2), limit=50)
    assert [a.label for a in result.attractors] == ["aperiodic"]


def test_unbounded_starts():
    osc = GearOscillator(FourierStiffness(1.0, (0.9,), (0.0,)), 0.0, 0.1, 0.2, 2.0, half_backlash=0.1)
    result = basins(osc, x=(-1, 1, 3), v=(-1, 1, 3), limit=3000)
    assert np.all(result.labels[[0, 0, 2, 2], [0, 2, 0, 2]] == -2)
    assert "without bound" in result.message


def test_bad_axes(article):
    with pytest.raises(InputError) as error:
        basins(article(), x=(0, np.nan, 10), v=(0, 1, 0), radius=2.0)
    assert {f.where for f in error.value.faults} == {"x[1]", "v[2]", "radius"}


def test_progress(article):
    seen = []
    basins(article(), x=(0, 1, 5), v=(0, 1, 5), progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (25, 25)
