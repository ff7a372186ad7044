"""Orbits found without being known, whole diagrams, and loci in two parameters."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from base import InputError
from dynamics import (
    GearOscillator,
    contact_grazing,
    continue_branch,
    continue_locus,
    diagram,
    doubled_orbit,
    find_orbit,
    find_orbits,
    period_map,
    sweep,
)
from dynamics.branches.sensitivity import map_derivatives
from tests.validation import article_motion


def lubricated(frequency: float = 0.5, **changes) -> GearOscillator:
    return article_motion.lubricated(frequency, **changes)


@pytest.fixture(scope="module")
def whole():
    return diagram(lubricated(), "frequency", (0.5, 1.9), max_period=8, searches=9)


@pytest.fixture(scope="module")
def first_branch():
    return continue_branch(find_orbit(lubricated(), (0.35, 0.0)), "frequency", (0.5, 1.2))


@pytest.mark.parametrize("frequency", [0.6, 1.04, 1.45, 1.64])
def test_orbits_found_are_orbits_and_their_indices_add_up(frequency):
    osc = lubricated(frequency=frequency)
    found = find_orbits(osc, (1, 2, 3, 4))
    assert found.converged, found.message
    for orbit in found.orbits:
        image = period_map(osc, orbit.state, orbit.periods)
        assert np.max(np.abs(image.state - orbit.state)) < 1e-12 * max(1.0, np.max(np.abs(image.jacobian)))
        assert np.linalg.det(image.jacobian) == pytest.approx(
            orbit.determinant, abs=1e-12 * max(1.0, np.max(np.abs(image.jacobian)) ** 2)
        )
    points = np.array([o.state for o in found.orbits])
    gaps = np.max(np.abs(points[:, None] - points[None]), axis=2) + np.eye(len(points))
    assert gaps.min() > 1e-6  # none twice
    if frequency == 0.6:
        assert [o.label for o in found.orbits] == ["1-0-0", "U1-1-0", "1-1-1"]
    if frequency == 1.64:
        assert "4-3-0" in {o.label for o in found.orbits}


def test_index_shows_a_missing_orbit():
    """A search from one start finds one of three orbits; the sum of indices is then wrong unless it is a lone node."""
    osc = lubricated(frequency=0.6)
    all_three = find_orbits(osc, (1,))
    saddle = next(o for o in all_three.orbits if not o.stable)
    assert sum(1 if o.stable else -1 for o in all_three.orbits) == 1
    product = np.prod(1.0 - saddle.multipliers)
    assert product < 0  # index -1: without one of the nodes the sum is 0


def test_every_attractor_of_sweeps_is_in_the_diagram(whole):
    assert whole.converged, whole.message
    values = np.linspace(0.51, 1.89, 60)
    for direction in ("up", "down"):
        swept = sweep(lubricated(), values=values, direction=direction)
        for value, label in zip(values, swept.labels, strict=True):
            if not label.startswith(("1-", "2-", "3-", "4-")):
                continue  # aperiodic, or of a period that was not searched for and that no doubling leads to
            stable = {
                b.labels[i]
                for b in whole.branches
                for i in np.flatnonzero(np.abs(b.values - value) < 0.03)
                if b.stable[i]
            }
            assert label in stable, (value, label)


def test_diagram_holds_the_isolas_and_no_branch_twice(whole):
    closed = [b for b in whole.branches if b.ended == ("closed", "closed")]
    assert sorted(b.periods for b in closed) == [3, 6, 7]
    assert {"3-3-2", "U3-2-2"} <= set(next(b for b in closed if b.periods == 3).labels)
    spans = [(b.periods, round(b.values.min(), 3), round(b.values.max(), 3)) for b in whole.branches]
    assert len(set(spans)) == len(spans)
    assert all(o.parent is None or whole.branches[o.parent].periods * 2 == b.periods for o, b in zip(
        whole.origins, whole.branches, strict=True))  # fmt: skip
    assert all("beyond max_period" in text for text in whole.left_out)


def test_isola_between_two_searches_is_met_by_sweeps():
    """The one search looks for period 1 only; 3-3-2 is stable from 0.88883 to 0.90243."""
    for swept, periods in ((0, {1, 2}), (40, {1, 2, 3})):
        found = diagram(
            lubricated(), "frequency", (0.885, 0.905), periods=(1,), searches=1, swept=swept, max_period=3
        )
        assert {b.periods for b in found.branches} == periods


def test_special_points_of_the_whole_diagram(whole):
    assert len(whole.table()) == sum(len(b.points) for b in whole.branches)
    assert np.asarray(whole).shape[1] == 5
    assert pickle.loads(pickle.dumps(whole)).message == whole.message
    for point in whole.special("period-doubling") + whole.special("saddle-node"):
        osc = lubricated(frequency=point.parameter)
        image = period_map(osc, point.state, point.periods)
        det = np.exp(-2 * osc.damping_ratio * osc.period * point.periods)
        sign = -1 if point.kind == "saddle-node" else 1
        size = max(1.0, np.max(np.abs(image.jacobian)))
        assert np.max(np.abs(image.state - point.state)) < 1e-13 * size
        # the trace has a square-root corner next to a grazing; elsewhere it is met to rounding
        assert abs(1 + det + sign * np.trace(image.jacobian)) < 1e-9 * size
        assert point.error < 1e-12


def test_doubled_branches_begin_where_the_single_one_doubles(whole):
    """At its ends a doubled branch is within a step of the parameter of the period doubling."""
    doublings = [p.parameter for p in whole.special("period-doubling")]
    for branch, origin in zip(whole.branches, whole.origins, strict=True):
        if origin.parent is None:
            continue
        for end in (branch.values[0], branch.values[-1]):
            assert min(abs(end - p) for p in doublings) < 0.02 * 1.4


def test_doubled_orbit(first_branch):
    (point,) = first_branch.special("period-doubling")
    orbit = doubled_orbit(lubricated(), "frequency", point, (0.5, 1.2))
    assert orbit is not None
    assert orbit.periods == 2
    with pytest.raises(InputError, match="period-doubling"):
        doubled_orbit(lubricated(), "frequency", first_branch.special("grazing")[0], (0.5, 1.2))


PLANE = ("frequency", "stiffness.amplitudes[0]")


def test_grazing_locus_is_that_of_the_linear_orbit(first_branch):
    """Against the contact orbit's grazing for each kappa, and the closed form at kappa = 0."""
    point = first_branch.special("grazing")[0]
    locus = continue_locus(lubricated(), point, PLANE, ((0.3, 1.5), (0.0, 0.6)))
    assert locus.converged
    assert locus.ended == ("bound", "bound")
    assert locus.values[0] == pytest.approx([0.578072859698843, 0.0], rel=0, abs=1e-12)
    for frequency, kappa in locus.values[::20]:
        found = np.asarray(contact_grazing(lubricated(kappa=kappa), bounds=(0.4, 0.9)))
        assert np.min(np.abs(found - frequency)) < 1e-12


def test_loci_pass_through_the_points_of_branches(first_branch):
    """The same points by a branch at another kappa, which has no part in the locus."""
    other = continue_branch(find_orbit(lubricated(kappa=0.3), (0.35, 0.0)), "frequency", (0.5, 1.2))
    for kind in ("saddle-node", "period-doubling"):
        for point in first_branch.special(kind):
            locus = continue_locus(lubricated(), point, PLANE, ((0.3, 1.5), (0.18, 0.3)), max_step=0.05)
            at_bound = [float(v[0]) for v in locus.values if v[1] == 0.3]
            for frequency in at_bound:
                assert min(abs(p.parameter - frequency) for p in other.special(kind)) < 1e-11


def test_period_doubling_meets_the_grazing(first_branch):
    """Near kappa = 0.179, omega = 0.887, seen from the grazing's locus and by where that of the doubling ends."""
    touch = min(first_branch.special("grazing"), key=lambda p: abs(p.parameter - 0.88635))
    locus = continue_locus(lubricated(), touch, PLANE, ((0.8, 1.0), (0.1, 0.25)))
    (double,) = locus.special("period-doubling and grazing")
    assert double.values == pytest.approx([0.887, 0.179], abs=5e-4)
    osc = lubricated(kappa=double.values[1], frequency=double.values[0])
    image = period_map(osc, double.state)
    assert np.max(np.abs(image.state - double.state)) < 1e-13
    (doubling,) = first_branch.special("period-doubling")
    end = continue_locus(lubricated(), doubling, PLANE, ((0.8, 1.5), (0.1, 0.6)))
    assert "ends at a grazing" in end.ended
    gaps = np.abs(end.values - double.values).max(axis=1)
    assert gaps.min() < 1e-5


def test_cusp_from_both_folds(first_branch):
    """With more damping two saddle nodes meet: the same cusp from either, and none of the two beyond it."""
    folds = [p for p in first_branch.special("saddle-node") if p.parameter > 0.8]
    assert len(folds) == 2
    plane = ("frequency", "damping_ratio")
    cusps = []
    for fold in folds:
        locus = continue_locus(lubricated(), fold, plane, ((0.6, 1.1), (0.03, 0.3)), max_points=300)
        (cusp,) = locus.special("cusp")
        cusps.append(cusp.values)
    assert cusps[0] == pytest.approx(cusps[1], rel=0, abs=1e-10)
    zeta = float(cusps[0][1])
    for more, number in ((0.995, 2), (1.005, 0)):
        start = find_orbit(lubricated(damping_ratio=more * zeta), (0.35, 0.0))
        branch = continue_branch(start, "frequency", (0.5, 1.2))
        near = [p for p in branch.special("saddle-node") if abs(p.parameter - cusps[0][0]) < 0.02]
        assert len(near) == number


def test_locus_of_a_touch_does_not_depend_on_the_backlash(first_branch):
    point = first_branch.special("grazing")[0]
    locus = continue_locus(lubricated(), point, ("frequency", "half_backlash"), ((0.5, 0.8), (0.1, 1.0)))
    assert np.ptp(locus.values[:, 0]) < 1e-13


def test_extremum_slopes_carry_a_touch(first_branch):
    """d omega/d kappa along the grazing locus against the linear orbit's own grazing, by a difference."""
    point = first_branch.special("grazing")[0]
    locus = continue_locus(lubricated(), point, PLANE, ((0.6, 0.7), (0.17, 0.19)), max_step=0.002)
    i = len(locus.values) // 2
    slope = np.diff(locus.values[i : i + 2], axis=0)[0]
    there = [
        np.asarray(contact_grazing(lubricated(kappa=k), bounds=(0.6, 0.7)))[0]
        for k in locus.values[i : i + 2, 1]
    ]
    assert slope[0] == pytest.approx(np.diff(there)[0], rel=1e-6)
    assert map_derivatives(lubricated(), point.state, ("frequency",)).slope.shape == (2, 1)


def test_one_number_of_periods_may_stand_alone():
    assert [c.periods for c in find_orbits(lubricated(), 2, starts=2, batches=0).counts] == [2]
    found = diagram(lubricated(), bounds=(0.8, 0.9), periods=1, searches=1, swept=0, max_period=1)
    assert [branch.periods for branch in found.branches] == [1]


def test_bad_input(first_branch):
    with pytest.raises(InputError) as error:
        find_orbits(lubricated(), (0,), ((1.0, 0.0), (0.0, np.nan)), starts=0)
    assert {f.where for f in error.value.faults} == {
        "periods",
        "starts",
        "region[0]",
        "region[1][1]",
        "region[1]",
    }
    with pytest.raises(InputError, match="bounds"):
        diagram(lubricated(), "frequency", (1.0, 0.5))
    point = first_branch.points[0]
    with pytest.raises(InputError, match="different parameters"):
        continue_locus(lubricated(), point, ("frequency", "frequency"), ((0.5, 1.0), (0.5, 1.0)))
    with pytest.raises(InputError, match="within bounds"):
        continue_locus(lubricated(), point, PLANE, ((0.9, 1.0), (0.1, 0.2)))
