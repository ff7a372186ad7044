"""Arcs between events on curves that are known: steps, cusps, switches that turn for a moment."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial import chebyshev

from gears.sharing.arc_series import lobatto
from gears.sharing.arcs import Arc, Arcs, graded
from gears.sharing.events import Sampled, arcs_alike, arcs_between_events

STEP, BACK, CUSP = 0.137, 0.62, 0.41
NAMES = ("step", "cusp")


def known(position):
    """A stiffness that steps at two switches, and a curve with a cusp at a corner of the geometry."""
    x = np.mod(position, 1.0)
    inside = np.minimum(x - STEP, BACK - x)
    step = np.where(inside >= 0, 2.0 + np.sin(3 * x), np.exp(x) / 2)
    cusp = np.where(x < CUSP, x**2, CUSP**2 * (1 - x) / (1 - CUSP))
    return Sampled(np.stack([step, cusp]), inside[:, None])


def exact(function, ends, count=400):
    """Integral by many Gauss points between breaks."""
    t, w = np.polynomial.legendre.leggauss(count)
    total = 0.0
    for low, high in pairwise(ends):
        total = total + 0.5 * (high - low) * np.sum(w * function(low + 0.5 * (high - low) * (1 + t)))
    return total


def test_means_extremes_and_harmonics_of_a_curve_with_steps_are_exact():
    found = arcs_between_events(known, NAMES, np.array([CUSP]), tolerance=1e-10)
    ends = [0.0, STEP, CUSP, BACK, 1.0]
    assert found.resolved
    np.testing.assert_allclose(found.events.position, ends, atol=1e-9)
    assert found.events.switched.tolist() == [-1, 0, -1, 0, -1]
    for row, name in enumerate(NAMES):
        mean, error = found.arcs.mean(name)
        true = exact(lambda x, row=row: known(x).curves[row], ends)
        assert abs(mean - true) < 5e-9
        assert error < 1e-8
        value, off = found.arcs.harmonics(name, np.array([1, 2, 7, 50]))
        for j, one, some in zip((1, 2, 7, 50), value, off, strict=True):
            true = 2 * exact(lambda x, row=row, j=j: known(x).curves[row] * np.exp(-2j * np.pi * j * x), ends)
            assert abs(one - true) < 1e-8
            assert some < 1e-8
    (least, _), (most, _) = found.arcs.extremes("cusp")
    assert least == pytest.approx(0.0, abs=1e-9)
    assert most == pytest.approx(CUSP**2, rel=1e-9)
    (least, _), (most, _) = found.arcs.extremes("step")
    assert most == pytest.approx(3.0 if np.pi / 6 < BACK else 2 + np.sin(3 * BACK), abs=1e-9)
    assert least == pytest.approx(0.5, rel=1e-9)


def test_a_series_is_the_curve():
    """Amplitude and phase of a cosine in the convention of the oscillator's stiffness."""

    def wave(x):
        return Sampled(np.stack([3 + 0.2 * np.cos(2 * np.pi * 2 * x + 0.7)]), np.zeros((len(x), 0)))

    arcs = arcs_between_events(wave, ("k",), np.zeros(0), tolerance=1e-10).arcs
    value, _ = arcs.harmonics("k", np.array([1, 2, 3]))
    np.testing.assert_allclose(np.abs(value), [0, 0.2, 0], atol=1e-8)
    assert np.angle(value[1]) == pytest.approx(0.7, abs=1e-7)
    assert arcs.moment("k", 2)[0] == pytest.approx(9 + 0.02, rel=1e-9)


def test_the_curve_is_given_on_both_sides_of_an_event():
    arcs = arcs_between_events(known, NAMES, np.array([CUSP]), tolerance=1e-10).arcs
    at = np.array([STEP, BACK, 1.0 + STEP])
    event = arcs.ends[[1, 3, 1]]
    before, after = (arcs.curve("step", event, side) for side in (True, False))
    np.testing.assert_allclose(before, [np.exp(STEP) / 2, 2 + np.sin(3 * BACK), np.exp(STEP) / 2], rtol=1e-7)
    np.testing.assert_allclose(
        after, [2 + np.sin(3 * STEP), np.exp(BACK) / 2, 2 + np.sin(3 * STEP)], rtol=1e-7
    )
    places = np.linspace(0.01, 0.99, 50)
    np.testing.assert_allclose(arcs.curve("step", places + 3), known(places).curves[0], rtol=1e-8)
    assert at.size == before.size


@pytest.mark.parametrize("width", [0.3, 0.02, 0.003])
def test_a_switch_that_turns_for_a_moment_is_found(width):
    """Between two samples of an arc: foreseen by the reserve's polynomial, which is smooth."""
    middle = 0.37

    def brief(x):
        inside = (0.5 * width) ** 2 - (x - middle) ** 2
        return Sampled(np.stack([np.where(inside >= 0, 2.0, 1.0)]), inside[:, None])

    found = arcs_between_events(brief, ("k",), np.zeros(0), tolerance=1e-8)
    assert found.arcs.mean("k")[0] == pytest.approx(1 + width, abs=1e-8)


def test_pitches_have_their_own_events():
    """Three pitches whose steps are at different places."""
    starts = np.array([0.2, 0.5, 0.8])

    def steps(x):
        pitch = np.minimum(np.floor(x).astype(int), 2)
        reserve = x - pitch - starts[pitch]
        return Sampled(np.stack([np.where(reserve >= 0, 2.0, 1.0)]), reserve[:, None])

    found = arcs_between_events(steps, ("k",), np.zeros(0), 3)
    np.testing.assert_allclose(found.events.position, [0, 0.2, 1, 1.5, 2, 2.8, 3], atol=1e-9)
    assert found.arcs.mean("k")[0] == pytest.approx(1.5, abs=1e-8)
    # once a pitch, whichever of the pitches
    value, _ = found.arcs.harmonics("k", np.array([1]))
    true = sum(2 * (1 - np.exp(-2j * np.pi * s)) / (-2j * np.pi) for s in starts) / 3
    assert abs(value[0] - true) < 1e-8


def test_slightly_different_gears_are_followed():
    def other(x):
        x = np.asarray(x)
        inside = np.minimum(x - STEP - 3e-4, BACK + 1e-5 - x)
        return Sampled(np.stack([np.where(inside >= 0, 2.0, 1.0), x]), inside[:, None])

    division = arcs_between_events(known, NAMES, np.array([CUSP]))
    arcs = arcs_alike(other, NAMES, division)
    assert arcs is not None
    assert arcs.mean("step")[0] == pytest.approx(1 + BACK - STEP - 3e-4 + 1e-5, abs=1e-8)
    # an event that is not there any more is said to be missed
    assert arcs_alike(lambda x: Sampled(np.ones((2, len(x))), np.ones((len(x), 1))), NAMES, division) is None


def test_arcs_converge_geometrically_and_their_estimate_is_above_the_error():
    def smooth(x):
        return 1 / (1 + 6 * (x - 0.4) ** 2)

    true = exact(smooth, [0.0, 1.0])
    before = 1.0
    for degree in (4, 8, 16, 32):
        at = 0.5 * (1 + lobatto(degree))
        arcs = Arcs(("k",), (Arc(0.0, 1.0, smooth(at)[None]),), 1)
        mean, estimate = arcs.mean("k")
        error = abs(mean - true)
        assert error < 0.05 * before
        assert error < estimate + 1e-14
        (_, _), (most, off) = arcs.extremes("k")
        assert abs(most - 1.0) < off + 1e-12
        before = error + 1e-13


@pytest.mark.parametrize("power", [2.0, 3.0])
def test_what_series_leave_out_is_what_coefficients_beyond_them_change(power):
    """Means and harmonics of curves whose coefficients fall by a power, with signs that follow no law."""
    rng, parts = np.random.default_rng(3), []
    for degree in (8, 16, 32):
        for _ in range(20):
            series = rng.normal(size=513) * np.arange(1, 514.0) ** -power
            short, best = (
                Arcs(("k",), (Arc(0.2, 0.9, chebyshev.chebval(lobatto(n), series)[None]),), 1)
                for n in (degree, 512)
            )
            (mean, off), (value, error) = short.mean("k"), short.harmonics("k", [1, 2, 3])
            true = np.append(value - best.harmonics("k", [1, 2, 3])[0], mean - best.mean("k")[0])
            parts.append(np.abs(true) / np.append(error, off))
    # of a normal distribution 0.67 of the deviation is the median, 1.64 the 90th percentile
    assert 0.3 < np.median(parts) < 1.2
    assert 0.8 < np.percentile(parts, 90) < 3.0


@pytest.mark.parametrize("degree", [8, 16, 32])
def test_where_a_contact_begins_the_estimate_is_above_the_error_and_below_that_of_half_the_degree(degree):
    def arcs(degree):
        place = graded(lobatto(degree), -1)[0]
        # the inverse of the logarithm of what it bears
        return Arcs(("k",), (Arc(0.2, 0.3, 1.0 / (8.0 - np.log(place + 1e-300))[None], -1),), 1)

    best = arcs(512).mean("k")[0]
    (mean, error), half = arcs(degree).mean("k"), arcs(degree // 2).mean("k")[0]
    assert abs(mean - best) < error < abs(half - best)


def test_the_error_of_an_arc_has_the_phase_of_its_place():
    """On a short arc it moves all harmonics by the same size, and along the phase of its middle alone."""
    arc = Arc(0.3, 0.31, np.abs(lobatto(8) - 0.3)[None])
    parts = Arcs(("k",), (arc,), 1).harmonics_and_parts("k", [1, 2])[1]
    largest = parts[:, np.argmax(np.abs(parts[0]))]
    phases = np.angle(largest * np.exp(2j * np.pi * np.array([1, 2]) * 0.305)) % np.pi
    assert np.minimum(phases, np.pi - phases) == pytest.approx(0.0, abs=0.07)
