"""Continuation: the points are orbits, the special points are what they are called, nothing is missed."""

from __future__ import annotations

import itertools
import pickle
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from base import InputError
from dynamics import (
    FourierStiffness,
    GearOscillator,
    continue_branch,
    find_orbit,
    find_orbits,
    period_map,
    sweep,
)
from dynamics.flow.motions import turning_points
from tests.validation.article_motion import lubricated, starved


@pytest.fixture(scope="module")
def scan():
    osc = lubricated(0.5)
    return osc, continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.3, 1.3))


def test_both_ends_are_reached(scan):
    _, branch = scan
    assert branch.converged
    assert branch.ended == ("bound", "bound")
    assert branch.values[0] == pytest.approx(0.3, abs=1e-15)
    assert branch.values[-1] == pytest.approx(1.3, abs=1e-15)
    assert np.asarray(branch).shape == (len(branch.values), 3)
    assert pickle.loads(pickle.dumps(branch)).ended == branch.ended


def test_points_are_orbits(scan):
    osc, branch = scan
    for i in range(0, len(branch.values), 7):
        here = osc.with_parameter("frequency", float(branch.values[i]))
        image = period_map(here, branch.states[i])
        assert np.max(np.abs(image.state - branch.states[i])) < 1e-13
        assert branch.stable[i] == (np.max(np.abs(np.linalg.eigvals(image.jacobian))) < 1.0)
        counts = image.counts.sum(axis=0)
        assert branch.labels[i] == f"{'' if branch.stable[i] else 'U'}1-{counts[0]}-{counts[1]}"


def test_special_points_are_what_they_are_called(scan):
    osc, branch = scan
    kinds = {p.kind for p in branch.points}
    assert kinds == {"saddle-node", "period-doubling", "grazing"}
    for p in branch.points:
        here = osc.with_parameter("frequency", p.parameter)
        image = period_map(here, p.state)
        # rounding of the map, which its derivative stretches, as in dynamics.branches.corrector
        rounding = 1.5e-14 * max(1.0, float(np.max(np.abs(image.jacobian))))
        assert np.max(np.abs(image.state - p.state)) < rounding
        det, trace = here_determinant(here), np.trace(image.jacobian)
        if p.kind == "saddle-node":
            assert 1 + det - trace == pytest.approx(0.0, abs=1e-12)
        elif p.kind == "period-doubling":
            assert 1 + det + trace == pytest.approx(0.0, abs=1e-12)
        else:
            turns = turning_points(here, p.state)
            assert np.min(np.abs(turns[:, 1] - p.boundary * 0.2)) < 1e-14
            assert p.acceleration == pytest.approx(float(here.force(p.tau)), rel=1e-6)
        assert p.error < 1e-12


def here_determinant(osc) -> float:
    return float(np.exp(-2 * osc.damping_ratio * osc.period))


def test_labels_change_at_grazings_only(scan):
    _, branch = scan
    counts = [label.removeprefix("U") for label in branch.labels]
    changes = sum(a != b for a, b in itertools.pairwise(counts))
    assert changes == len(branch.special("grazing"))


def test_stability_changes_at_special_points_only(scan):
    _, branch = scan
    changes = int(np.sum(branch.stable[1:] != branch.stable[:-1]))
    assert changes == len(branch.special("saddle-node")) + len(branch.special("period-doubling"))
    assert [p.kind for p in branch.points if p.kind != "grazing"] == ["saddle-node"] * 4 + ["period-doubling"]


def test_period_doubling_by_shooting(scan, article):
    """The same point by a root search on the multipliers of orbits found one by one, without continuation."""
    _, branch = scan
    (point,) = branch.special("period-doubling")

    def flip(frequency: float) -> float:
        orbit = find_orbit(article(frequency=frequency), point.state)
        assert orbit.converged
        return float((1 + orbit.multipliers[0]) * (1 + orbit.multipliers[1]))

    assert brentq(flip, 0.8868, 0.8885, xtol=1e-15) == pytest.approx(point.parameter, abs=1e-12)


def test_saddle_node_by_shooting(scan, article):
    """Two orbits exist before the fold and none after; their distance falls as the square root."""
    _, branch = scan
    for point, side in zip(branch.special("saddle-node")[:2], (-1, 1), strict=True):
        off = 1e-6
        image = period_map(article(frequency=point.parameter), point.state).jacobian
        values, vectors = np.linalg.eig(image)
        along = np.real(vectors[:, np.argmin(np.abs(values - 1))])
        apart = {}
        for n in (1, 4):
            osc = article(frequency=point.parameter + side * n * off)
            pair = [find_orbit(osc, point.state + s * 2e-3 * np.sqrt(n) * along) for s in (-1, 1)]
            assert all(o.converged for o in pair)
            apart[n] = np.linalg.norm(pair[0].state - pair[1].state)
        assert apart[4] / apart[1] == pytest.approx(2.0, rel=0.02)
        assert not find_orbit(article(frequency=point.parameter - side * 1e-4), point.state).converged or (
            np.linalg.norm(
                find_orbit(article(frequency=point.parameter - side * 1e-4), point.state).state - point.state
            )
            > 0.05
        )


def test_steps_do_not_matter(scan):
    osc, branch = scan
    again = continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.3, 1.3), step=0.003, max_step=0.05)
    assert [p.kind for p in again.points] == [p.kind for p in branch.points]
    np.testing.assert_allclose(
        [p.parameter for p in again.points], [p.parameter for p in branch.points], rtol=0, atol=1e-12
    )


def test_the_other_way_round(scan):
    osc, branch = scan
    end = osc.with_parameter("frequency", float(branch.values[-1]))
    again = continue_branch(find_orbit(end, branch.states[-1]), "frequency", (0.3, 1.3))
    np.testing.assert_allclose(
        [p.parameter for p in again.points], [p.parameter for p in branch.points], rtol=0, atol=1e-12
    )


def test_mirror_image(scan):
    osc, branch = scan
    reverse = replace(osc, mean_force=-osc.mean_force, error_amplitude=-osc.error_amplitude)
    mirror = continue_branch(find_orbit(reverse, (-0.35, 0.0)), "frequency", (0.3, 1.3))
    assert [p.boundary for p in mirror.points] == [-p.boundary for p in branch.points]
    np.testing.assert_allclose(
        [p.parameter for p in mirror.points], [p.parameter for p in branch.points], rtol=0, atol=1e-13
    )


@pytest.mark.parametrize(
    ("parameter", "bounds"),
    [
        ("error_amplitude", (0.15, 0.25)),
        ("mean_force", (0.05, 0.15)),
        ("half_backlash", (0.1, 0.4)),
        ("stiffness.amplitudes[0]", (0.05, 0.3)),
        ("stiffness.phases[0]", (-0.5, 0.5)),
        ("damping_ratio", (0.01, 0.1)),
    ],
)
def test_other_parameters(article, parameter, bounds):
    osc = article(frequency=0.62)
    branch = continue_branch(find_orbit(osc, (0.4, 0.0)), parameter, bounds)
    assert branch.converged, branch.message
    for p in branch.points:
        image = period_map(osc.with_parameter(parameter, p.parameter), p.state)
        assert np.max(np.abs(image.state - p.state)) < 1e-13


def test_longer_period(article):
    start = sweep(article(), values=[1.3, 1.4], keep=32)
    orbit = find_orbit(article(frequency=1.4), start.states[-1, -1], periods=2)
    assert orbit.label == "2-1-1"
    branch = continue_branch(orbit, "frequency", (1.2, 1.7))
    assert branch.periods == 2
    assert branch.converged
    stable = branch.values[branch.stable]
    # the up sweep of 400 values finds 2-1-1 from 1.293 to 1.579
    assert stable.min() < 1.293
    assert stable.max() > 1.579


def test_bad_input(article):
    orbit = find_orbit(article(frequency=0.5), (0.35, 0.0))
    with pytest.raises(InputError) as error:
        continue_branch(orbit, "frequency", (0.6, 0.55), step=0.0)
    assert {f.where for f in error.value.faults} == {"bounds", "orbit", "step"}
    with pytest.raises(InputError, match="kind"):
        continue_branch(orbit, "frequency", (0.49, 0.51)).special("hopf")


def test_end_of_patience_is_said(article):
    branch = continue_branch(
        find_orbit(article(frequency=0.5), (0.35, 0.0)), "frequency", (0.3, 1.3), max_points=5
    )
    assert not branch.converged
    assert "max_points" in branch.message


def test_branch_that_grows_without_bound_goes_to_the_edge_of_the_linear_resonance():
    """Far out backlash does not count: the branch tends to where the linear equation's multiplier is -1, as D/A."""
    (start,) = (o for o in find_orbits(starved(1.7), (2,)).orbits if o.label == "2-1-1")
    branch = continue_branch(start, "frequency", (0.1, 2.5))
    assert branch.converged
    assert branch.ended == ("the motion grows without bound",) * 2
    for value in branch.values[[0, -1]]:
        linear = starved(float(value), half_backlash=0.0)
        least = np.linalg.eigvals(period_map(linear, (0.0, 0.0)).jacobian).real.min()
        assert abs(least + 1.0) < 2e-3
    assert {round(float(v), 3) for v in branch.values[[0, -1]]} == {1.954, 2.045}


@pytest.mark.parametrize(
    ("parameter", "reach"),
    [
        ("mean_force", 0.01), ("error_amplitude[0]", 0.02), ("error_amplitude[1]", 0.02), ("error_phase[1]", 0.1),
        ("half_backlash", 0.02), ("damping_ratio", 0.01), ("stiffness.amplitudes[0]", 0.02),
    ],
)  # fmt: skip
def test_points_are_orbits_whatever_the_parameter_touches(parameter, reach):
    """Forces touch one of the tabulated solutions, the play none of them: what is kept must still be right."""
    osc = GearOscillator(
        FourierStiffness(1.0, (0.18,), (0.0,)),
        0.05,
        0.1,
        (0.2, 0.03),
        0.6,
        half_backlash=0.2,
        error_phase=(0.2, 0.5),
    )
    middle = osc.get(parameter)
    branch = continue_branch(find_orbit(osc, (0.5, 0.2)), parameter, (middle - reach, middle + reach))
    assert len(branch.values) > 4
    for value, state in zip(branch.values[::3], branch.states[::3], strict=True):
        image = period_map(osc.with_parameter(parameter, float(value)), state)
        assert image.state == pytest.approx(state, abs=1e-13)


def test_points_far_apart_miss_no_pair_of_grazings():
    """Two grazings between neighbours cancel in the counts: steps must be short enough to see both."""
    osc = GearOscillator(FourierStiffness(1.0, (0.1,), (0.0,)), 0.01, 0.05, 0.2, 0.3, 1.0)
    start = find_orbit(osc, osc.rest_state(), transient=2000)
    far, near = (continue_branch(start, "frequency", (0.3, 0.8), max_step=step) for step in (0.05, 0.01))
    assert [(p.kind, p.label) for p in far.points] == [(p.kind, p.label) for p in near.points]
    places = [np.array([p.parameter for p in branch.points]) for branch in (far, near)]
    assert len(places[0]) == 12
    np.testing.assert_allclose(*places, rtol=1e-9)
