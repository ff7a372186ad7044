"""Loci that close on themselves, and loci on which an orbit touches twice."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dynamics import (
    FourierStiffness,
    GearOscillator,
    continue_branch,
    continue_locus,
    find_orbit,
    find_orbits,
)
from tests.validation.article_motion import lubricated, starved


def test_locus_of_a_bubble_closes_however_small_it_is():
    """1-1-1 doubles at 0.28284 and back at 0.28874; in frequency and force both lie on one closed curve.

    The largest step allowed is as long as the whole curve.
    """
    (start,) = (o for o in find_orbits(starved(0.3), (1,)).orbits if o.label == "1-1-1")
    branch = continue_branch(start, "frequency", (0.25, 0.35))
    ends = [p for p in branch.special("period-doubling") if p.label == "1-1-1"]
    assert [round(p.parameter, 5) for p in ends] == [0.28284, 0.28874]
    bounds = ((0.1, 2.5), (0.01, 0.4))
    locus = continue_locus(starved(0.3), ends[0], ("frequency", "mean_force"), bounds, max_step=0.3)
    assert locus.ended == ("closed", "closed"), locus.message
    near = np.abs(locus.values - [ends[1].parameter, 0.05])
    steps = np.abs(np.diff(locus.values, axis=0)).max(axis=0)
    assert np.any(np.all(near <= steps, axis=1))
    width = np.array([b[1] - b[0] for b in bounds])
    gap = np.max(np.abs(locus.values[0] - locus.values[-1]) / width)
    assert gap < 0.3  # the last point is within a step of the first
    assert len(locus.values) < 300  # once round


def test_double_grazings_touch_twice():
    """Against another integrator. The first is a motion of unbroken contact, both minima of which touch X = D."""
    k2, force = "stiffness.amplitudes[1]", "mean_force"
    osc = GearOscillator(FourierStiffness(1.0, (0.18, 0.2), (0.0, 0.0)), 0.05, 0.3, 0.2, 0.4, 0.2)
    branch = continue_branch(find_orbit(osc, (0.5, 0.0)), force, (0.005, 0.4))
    touch = max((p for p in branch.special("grazing") if p.label == "1-0-0"), key=lambda p: p.parameter)
    locus = continue_locus(osc, touch, (force, k2), ((0.001, 1.0), (0.0, 0.9)))
    doubles = locus.special("double grazing")
    assert len(doubles) == 2
    for i, point in enumerate(doubles):
        end, extrema = integrated(point)
        assert end == pytest.approx(point.state, abs=1e-8)
        touching = np.abs(np.abs(extrema) - 0.2) < 1e-8
        assert touching.sum() == 2
        assert point.error < 1e-12
        if i == 0:
            assert np.all(extrema > 0.2 - 1e-8)


def integrated(point) -> tuple[np.ndarray, np.ndarray]:
    """State after a period and extrema of X on the way, by DOP853."""
    (f, k), w = point.values, 0.4

    def motion(t, y):
        stiff = 1.0 + 0.18 * np.cos(w * t) + k * np.cos(2 * w * t)
        spring = np.sign(y[0]) * max(abs(y[0]) - 0.2, 0.0)
        return [y[1], f + 0.2 * w * w * np.cos(w * t) - 0.1 * y[1] - stiff * spring]

    def turning(t, y):
        return y[1]

    found = solve_ivp(
        motion,
        (0.0, 2 * np.pi / w),
        point.state,
        method="DOP853",
        rtol=1e-12,
        atol=1e-13,
        max_step=0.02,
        events=turning,
    )
    return found.y[:, -1], found.y_events[0][:, 0]


def test_locus_ends_where_motion_grows_without_bound():
    """From the fold at 0.9342 the saddle nodes of 6.1 lead to infinity, in frequency and amplitude of the stiffness."""
    osc = lubricated(0.96)
    orbits = find_orbits(osc, (1,)).orbits
    folds = [p for o in orbits for p in continue_branch(o, "frequency", (0.6, 1.2)).special("saddle-node")]
    fold = next(p for p in folds if abs(p.parameter - 0.9342) < 1e-3)
    names = ("frequency", "stiffness.amplitudes[0]")
    found = continue_locus(osc, fold, names, ((0.3, 2.2), (0.0, 0.9)))
    assert found.converged
    assert set(found.ended) == {"the motion grows without bound", "bound"}
    far = np.max(np.abs(found.states), axis=1)
    assert far.max() > 1e3
    # where it does, D no longer counts: the parameters come to their limit as one over the size of the motion
    place = found.values[[int(np.argmin(np.abs(far - size))) for size in (1e2, 1e3, 1e4)]]
    off = np.linalg.norm(place[:2] - place[2], axis=1)
    assert off[0] / off[1] == pytest.approx(10.0, rel=0.3)
