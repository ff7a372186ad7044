"""Fourier series of a sampled stiffness; conversions between the pair and the oscillator."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from base import InputError
from dynamics import FourierStiffness, Scaling, fit_fourier

phases = st.floats(-3.1, 3.1)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.floats(1e-3, 0.5), phases), max_size=5), st.integers(0, 3))
def test_series_is_recovered(terms, extra):
    exact = FourierStiffness(8e8, tuple(8e8 * a for a, _ in terms), tuple(p for _, p in terms))
    m = 2 * (len(terms) + extra) + 1
    at = (np.arange(m) + 0.5) / m
    fit = fit_fourier(exact(2 * np.pi * at), order=len(terms))
    assert fit.stiffness.mean == pytest.approx(8e8, rel=1e-13)
    np.testing.assert_allclose(fit.stiffness.amplitudes, exact.amplitudes, rtol=1e-10)
    turns = (np.array(fit.stiffness.phases) - exact.phases + np.pi) % (2 * np.pi) - np.pi
    np.testing.assert_allclose(turns, 0.0, atol=1e-9)
    assert fit.remainder_max < 1e-13
    scattered = np.sort(np.modf(at + 0.3 / m * np.sin(7.0 * np.arange(m)))[0])
    again = fit_fourier(exact(2 * np.pi * scattered), order=len(terms), positions=scattered)
    np.testing.assert_allclose(again.stiffness.amplitudes, exact.amplitudes, rtol=1e-8)


def test_remainder_is_parseval():
    m = 40
    theta = 2 * np.pi * (np.arange(m) + 0.5) / m
    k = 2.0 + 0.4 * np.cos(theta + 1) + 0.2 * np.cos(2 * theta) + 0.03 * np.cos(5 * theta - 2)
    fit = fit_fourier(k, order=1)
    assert fit.remainder_rms == pytest.approx(math.sqrt((0.2**2 + 0.03**2) / 2) / 2, rel=1e-12)
    np.testing.assert_allclose(fit.harmonics[:5], [0.2, 0.1, 0.0, 0.0, 0.015], atol=1e-14)
    assert len(fit.harmonics) == 19
    assert fit.order == 1


def test_phase_refers_to_the_start_of_the_period():
    """A step up at the start of the period, sampled at midpoints: cosines lag by a quarter turn (-sin's phase)."""
    k = np.where(np.arange(200) < 100, 2.0, 1.0)
    fit = fit_fourier(k, order=3)
    assert fit.stiffness.phases[0] == pytest.approx(-np.pi / 2, abs=1e-12)
    assert fit.stiffness.amplitudes[0] == pytest.approx(2 / np.pi, rel=1e-3)
    assert fit.stiffness(0.01) > 1.5 > fit.stiffness(-0.01)


def test_order_needs_samples():
    with pytest.raises(InputError, match="resolve 2"):
        fit_fourier([1.0, 2.0, 3.0, 2.0, 1.0], order=3)
    with pytest.raises(InputError, match="samples"):
        fit_fourier([1.0, np.nan, 2.0])
    with pytest.raises(InputError, match="condition"):
        fit_fourier([1.0, 2.0, 3.0], order=1, positions=[0.1, 0.1, 0.1])
    assert fit_fourier([3.0], order=0).stiffness.mean == 3.0


@pytest.fixture
def scaling():
    """Steel discs of 36 and 40 teeth, module 2 mm: m_e = 0.381 kg, f_n = 7.1 kHz."""
    return Scaling.from_inertias(
        inertias=(9.1e-4, 1.35e-3),
        base_radii=(33.829e-3, 37.588e-3),
        mean_stiffness=7.7e8,
        cycles_per_revolution=36,
        force=17736.0,
        mean_force=0.1,
    )


def test_scales(scaling):
    j1, j2, r1, r2 = 9.1e-4, 1.35e-3, 33.829e-3, 37.588e-3
    assert 1 / scaling.equivalent_mass == pytest.approx(r1**2 / j1 + r2**2 / j2)
    assert scaling.length == pytest.approx(17736.0 / 7.7e7)
    assert scaling.natural_frequency == pytest.approx(
        math.sqrt(7.7e8 / scaling.equivalent_mass) / (2 * math.pi)
    )
    mesh_hertz = 2000 / 60 * 36
    assert scaling.frequency_from_rpm(2000.0) == pytest.approx(mesh_hertz / scaling.natural_frequency)


@given(st.floats(1e-6, 1e6))
def test_ways_back(value):
    s = Scaling(0.381, 7.7e8, 231e-6, 36)
    for there, back in (
        (s.frequency_from_rpm, s.rpm),
        (s.frequency, s.speed),
        (s.mean_force, s.force),
        (s.scaled, s.displacement),
        (s.damping_ratio, s.damping),
    ):
        assert back(there(value)) == pytest.approx(value, rel=1e-14)


def test_velocity_is_the_change_of_displacement_in_time(scaling):
    def at(tau):  # X = 0.3 sin 2 tau
        return scaling.displacement(0.3 * math.sin(2 * tau)), scaling.time(tau)

    (x0, t0), (x1, t1) = at(0.4 - 1e-5), at(0.4 + 1e-5)
    assert scaling.velocity(0.6 * math.cos(0.8)) == pytest.approx((x1 - x0) / (t1 - t0), rel=1e-9)
    assert scaling.velocity(1.0) == pytest.approx(
        scaling.length * math.sqrt(7.7e8 / scaling.equivalent_mass), rel=1e-12
    )


def test_length_is_a_free_choice(scaling):
    """Two lengths give two oscillators with the same motion in metres."""
    from dynamics import find_orbit

    k = FourierStiffness(7.7e8, (1.386e8,), (0.2,))
    motions = []
    for length in (231e-6, 1e-6):
        s = Scaling(scaling.equivalent_mass, 7.7e8, length, 36)
        osc = s.oscillator(
            stiffness=k,
            damping_ratio=0.05,
            force=17736.0,
            error_amplitude=10e-6,
            half_backlash=25e-6,
            speed=700.0,
        )
        orbit = find_orbit(osc, (osc.half_backlash + osc.mean_force, 0.0), transient=100)
        motions.append([s.displacement(orbit.state[0]), s.velocity(orbit.state[1])])
    np.testing.assert_allclose(motions[0], motions[1], rtol=1e-11)


def test_physical_equation_is_met(scaling):
    """The scaled equation, written out in newtons."""
    k = FourierStiffness(7.7e8, (1.386e8,), (0.2,))
    osc = scaling.oscillator(
        stiffness=k,
        damping_ratio=0.05,
        force=17736.0,
        error_amplitude=10e-6,
        half_backlash=25e-6,
        speed=700.0,
    )
    t, x, v = 1.3e-4, 80e-6, 0.02
    m, w = scaling.equivalent_mass, 700.0 * 36
    newtons = 17736.0 + m * 10e-6 * w**2 * math.cos(w * t)
    newtons -= scaling.damping(0.05) * v + float(k(w * t)) * (x - 25e-6)
    tau = t * scaling.omega_n
    big_x, big_v = scaling.scaled(x), v / (scaling.length * scaling.omega_n)
    scaled = float(osc.force(tau)) - 0.1 * big_v
    scaled -= float(osc.stiffness(osc.frequency * tau)) * float(osc.deflection(big_x))
    assert newtons / m == pytest.approx(scaled * scaling.length * scaling.omega_n**2, rel=1e-12)
    assert scaling.time(tau) == pytest.approx(t)


def test_normalised():
    assert FourierStiffness(4.0, (1.0,), (0.3,)).normalised() == FourierStiffness(1.0, (0.25,), (0.3,))
