"""Length of the lines of contact over the mesh cycle: closed forms against each other and against drawn lines."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gears import ContactLines, Gear, GearPair, GeometryError, contact_lines

ratios = st.floats(1.0, 2.6)
overlaps = st.floats(0.0, 4.0)


def lines_of(degrees: float, face_width: float = 40e-3) -> ContactLines:
    gears = Gear(36), Gear(40)
    return contact_lines(GearPair(*gears, 2e-3, face_width, helix_angle=math.radians(degrees)))


def drawn_length(pair: GearPair, position: float) -> float:
    """Length of the lines in the plane of action, cut at the ends of path and face [m]."""
    start, end, half = pair.points.A, pair.points.E, 0.5 * pair.face_width
    slope, total = math.tan(pair.base_helix_angle), 0.0
    for line in range(-20, 20):
        middle = pair.points.A + (position + line) * pair.base_pitch
        # x = middle + slope z
        low, high = sorted(((start - middle) / slope, (end - middle) / slope))
        total += max(min(high, half) - max(low, -half), 0.0)
    return total / math.cos(pair.base_helix_angle)


@pytest.mark.parametrize("degrees", [-35.0, 3.0, 10.0, 20.0, 45.0])
def test_lines_drawn_in_the_plane_of_action_are_as_long(degrees):
    pair = GearPair(Gear(25, 0.1), Gear(40), 2e-3, 30e-3, helix_angle=math.radians(degrees))
    lines, position = contact_lines(pair), np.linspace(-1.0, 2.0, 31)
    drawn = [drawn_length(pair, float(t)) for t in position]
    assert np.allclose(lines.length(position), drawn, rtol=1e-12, atol=1e-15)


@settings(deadline=None)
@given(ratios, overlaps)
def test_mean_period_continuity_and_extremes(ratio, overlap):
    lines = ContactLines(ratio, overlap, 1.0)
    t = (np.arange(4000) + 0.5) / 4000
    length = lines.length(t)
    assert lines.mean == ratio
    assert length.mean() == pytest.approx(ratio, abs=2e-3)
    assert np.allclose(lines.length(t + 7.0), length, atol=1e-9 / max(overlap, 1e-3))
    assert length.min() >= lines.minimum - 1e-9
    assert length.max() <= lines.maximum + 1e-9
    assert lines.minimum <= lines.mean * (1 + 1e-12)
    if overlap > 0.05:  # no steps, bends of slope 1/eps_beta
        assert np.abs(np.diff(length)).max() <= 2.0 / overlap / 4000 + 1e-12
        assert length.min() == pytest.approx(lines.minimum, abs=1e-2)
        assert length.max() == pytest.approx(lines.maximum, abs=1e-2)


@settings(deadline=None)
@given(ratios, st.floats(0.01, 4.0))
def test_the_least_length_is_that_of_the_fractions_of_both_ratios(ratio, overlap):
    """AGMA 908-B89 and ISO/TR 6336-30: eps_a - n_a n_b/eps_b, or with both complements where n_a + n_b > 1."""
    n_a, n_b = ratio % 1.0, overlap % 1.0
    short = n_a * n_b if n_a + n_b <= 1.0 else (1.0 - n_a) * (1.0 - n_b)
    assert ContactLines(ratio, overlap, 1.0).minimum == pytest.approx(ratio - short / overlap, rel=1e-9)


@settings(deadline=None)
@given(ratios, st.floats(0.3, 4.0))
def test_harmonics_of_the_length(ratio, overlap):
    lines = ContactLines(ratio, overlap, 1.0)
    sampled = np.fft.rfft(lines.length((np.arange(4096) + 0.5) / 4096)) / 4096
    assert np.allclose(2 * np.abs(sampled[1:6]) / ratio, lines.harmonics(5), rtol=0, atol=1e-5)


def test_even_lengths_at_whole_ratios():
    for ratio, overlap in ((1.56, 1.0), (1.56, 3.0), (2.0, 0.4), (2.0, 0.0)):
        lines = ContactLines(ratio, overlap, 0.04)
        assert lines.minimum == pytest.approx(lines.maximum, rel=1e-12)
        assert np.allclose(lines.harmonics(4), 0.0, atol=1e-15)
    assert ContactLines(1.56, 0.999, 1.0).minimum == pytest.approx(1.56 - 0.44 * 0.001 / 0.999, rel=1e-9)
    near, spur = ContactLines(1.56, 0.01, 1.0), ContactLines(1.56, 0.0, 1.0)
    assert (near.minimum, near.maximum) == pytest.approx((spur.minimum, spur.maximum)) == (1.0, 2.0)


@pytest.mark.parametrize("degrees", [1e-3, 1e-6, 1e-9, 1e-12])
def test_a_slight_helix_has_the_steps_of_spur_gears(degrees):
    slight, spur = lines_of(degrees), lines_of(0.0)
    inside = np.concatenate([np.linspace(0.01, 0.69, 9), np.linspace(0.71, 0.99, 9)])
    assert np.allclose(slight.length(inside), spur.length(inside), rtol=1e-8)
    assert spur.length(0.35) == 2 * 40e-3
    assert spur.length(0.85) == 40e-3
    assert spur.length(0.0) == 1.5 * 40e-3  # where a pair comes, the mean of before and after
    assert slight.minimum == pytest.approx(40e-3)
    assert slight.maximum == pytest.approx(80e-3)


def test_both_hands_have_equal_lengths():
    t = np.linspace(0, 1, 50)
    assert np.array_equal(lines_of(20.0).length(t), lines_of(-20.0).length(t))


def test_no_harmonics_are_refused():
    with pytest.raises(GeometryError, match="number"):
        lines_of(20.0).harmonics(0)
