"""The inverse problem, part by part: what would prove each wrong."""

from __future__ import annotations

import dataclasses
import math
import re
from pathlib import Path

import numpy as np
import pytest

from base import InputError
from dynamics import FourierStiffness, GearOscillator, continue_branch, find_orbit, find_orbits
from dynamics.branches.moved_special_points import marked
from dynamics.inverse import Event, OneOf, Ranged, identify
from dynamics.inverse.catalogue import CONTACT, DOUBLED, EVERY, Catalogue, Tally
from dynamics.inverse.events import MAX_TRIALS, Problem, checked
from dynamics.inverse.reduction import reduced, scaled
from dynamics.inverse.refinement import Fit, fit
from dynamics.inverse.rounding import rounded
from dynamics.inverse.scan import anchored, ranked, scan
from dynamics.inverse.scoring import directions, left_out, unseen
from tests.validation.article_motion import starved

ZETA, KAPPA, FORCE = "damping_ratio", "stiffness.amplitudes[0]", "mean_force"
BOUNDS = (0.3, 2.0)
TRUE = GearOscillator(FourierStiffness(1.0, (0.123457,), (0.0,)), 0.0234568, 0.0765433, 0.2, 0.4, 0.8)
SIDED = dataclasses.replace(TRUE, one_sided=True)
RANGES = {ZETA: Ranged(0.01, 0.08), KAPPA: Ranged(0.05, 0.3), FORCE: Ranged(0.02, 0.3)}


def contact_branch(here, bounds=BOUNDS):
    start = here.with_parameter("frequency", bounds[0])
    return continue_branch(find_orbit(start, start.rest_state()), "frequency", bounds, max_step=0.05)


@pytest.fixture(scope="module")
def points():
    """Special points of the motion in contact with the true parameters, one-sided."""
    return contact_branch(SIDED).points


def printed(points, digits=8):
    return [Event(p.kind, p.label.removeprefix("U"), round(p.parameter, digits), digits) for p in points]


def problem_of(here, events, unknowns=None, bounds=BOUNDS):
    return Problem(here, "frequency", tuple(events), RANGES if unknowns is None else unknowns, bounds)


def test_unknowns_are_parameters_of_the_oscillator(points):
    with pytest.raises(InputError, match="stiffness_of_the_shaft"):
        checked(
            TRUE, "frequency", printed(points), {**RANGES, "stiffness_of_the_shaft": OneOf((1.0,))}, BOUNDS
        )


def test_as_many_trials_as_allowed_are_taken_and_one_more_is_not(points):
    values = OneOf(tuple(np.linspace(0.01, 0.08, MAX_TRIALS).tolist()))
    events = printed(points)
    assert checked(TRUE, "frequency", events, {ZETA: values}, BOUNDS).unknowns[ZETA] is values
    more = OneOf((*values.values, 0.09))
    with pytest.raises(InputError, match=f"at most {MAX_TRIALS} combinations"):
        checked(TRUE, "frequency", events, {ZETA: more}, BOUNDS)


def test_all_faults_of_the_input_are_named():
    events = (Event("fold", "1-1", 3.0, 20, trust=0.0),)
    with pytest.raises(InputError) as raised:
        identify(TRUE, "frequency", events, {FORCE: Ranged(0.4, 0.2), "frequency": OneOf(())}, BOUNDS)
    text = str(raised.value)
    for where in (
        "kind",
        "label",
        "trust",
        "digits",
        "value",
        "unknowns['mean_force']",
        "['frequency']",
        "].values",
    ):
        assert where in text


def test_fewer_events_than_unknowns_are_refused(points):
    with pytest.raises(InputError, match="fitted"):
        identify(TRUE, "frequency", printed(points[:3]), RANGES, BOUNDS)


# ---- reduction


def test_one_sided_points_do_not_see_the_play_and_only_the_ratio_of_force_and_error(points):
    """Exact invariance of the computed points themselves, D by a factor of ten, both amplitudes by three."""
    other = dataclasses.replace(SIDED, half_backlash=8.0, mean_force=3 * TRUE.mean_force, error_amplitude=0.6)
    again = contact_branch(other).points
    assert [p.label for p in again] == [p.label for p in points]
    assert [p.parameter for p in again] == pytest.approx([p.parameter for p in points], rel=1e-11)


def test_scaled_oscillators_have_the_same_points_with_back_flank():
    a, b = contact_branch(TRUE), contact_branch(scaled(TRUE, 2.5))
    assert [p.parameter for p in b.points] == pytest.approx([p.parameter for p in a.points], rel=1e-11)


def test_what_is_left_out_at_first(points):
    open_side = printed(points)[:6]
    closed = Event("saddle-node", "3-1-1", 1.7, 4)
    both = {**RANGES, "half_backlash": Ranged(0.1, 2.0), "error_amplitude": Ranged(0.1, 0.4)}
    whole = reduced(problem_of(TRUE, [*open_side, closed], both))
    assert whole.first.oscillator.one_sided
    assert tuple(whole.first.unknowns) == (ZETA, KAPPA, FORCE)
    assert len(whole.first.events) == 6
    assert whole.held == ("error_amplitude",)
    assert whole.play is both["half_backlash"]
    blind = reduced(problem_of(TRUE, open_side, {**RANGES, "half_backlash": Ranged(0.1, 2.0)}))
    assert blind.held == ("half_backlash",)
    assert blind.play is None
    size = reduced(problem_of(TRUE, [*open_side, closed], {**RANGES, "error_amplitude": Ranged(0.1, 0.4)}))
    assert size.rescaled
    assert size.held == ()
    assert (size.play.low, size.play.high) == pytest.approx((0.8 * 0.2 / 0.4, 0.8 * 0.2 / 0.1))
    plain = reduced(problem_of(TRUE, [*open_side, closed]))
    assert plain.first.oscillator == TRUE


# ---- one parameter from one event


@pytest.mark.parametrize("index", [0, 1, 4])
def test_the_exact_event_gives_the_parameter_back(points, index):
    """Force unknown, all else right: one of the oscillators found is the true one, to the digits of the event."""
    event = dataclasses.replace(printed(points)[index], value=points[index].parameter)
    catalogue = Catalogue(problem_of(SIDED, [event]), Tally())
    found = anchored(catalogue, SIDED.with_parameter(FORCE, 0.2), event, FORCE)
    assert min(abs(here.mean_force / TRUE.mean_force - 1.0) for here in found) < 1e-11


def test_grazings_and_distrusted_events_are_the_last_choice(points):
    events = [
        Event("grazing", "1-0-0", 0.5, 4),
        Event("saddle-node", "3-1-1", 0.6, 4),
        Event("saddle-node", "1-1-0", 0.7, 4),
        Event("period-doubling", "1-1-0", 0.8, 4, trust=0.5),
        Event("saddle-node", "1-1-0", 0.9, 4, fitted=False),
    ]
    assert ranked(problem_of(TRUE, events)) == [2, 0, 1, 3]


# ---- other branches


def test_a_motion_of_three_periods_takes_part():
    """Starved scan: its 3-1-1 lies on an isola that no branch in contact leads to; its fold is met and gives D."""
    here = starved(2.4)
    fold = Event("saddle-node", "3-1-1", 2.478570588355, 12)
    catalogue = Catalogue(
        Problem(here, "frequency", (fold,), {"half_backlash": Ranged(0.3, 3.0)}, (1.8, 2.6)), Tally()
    )
    assert catalogue.partners(here, DOUBLED)[1] == (None,)
    partner = catalogue.partners(here, EVERY)[1][0]
    assert partner.parameter == pytest.approx(fold.value, abs=2e-12)
    orbits = find_orbits(here.with_parameter("frequency", 2.4), (3,)).orbits
    assert "3-1-1" in [o.label for o in orbits]
    play = [
        o.half_backlash
        for o in anchored(catalogue, here.with_parameter("half_backlash", 0.5), fold, "half_backlash")
    ]
    assert min(abs(d - 1.0) for d in play) < 1e-9


# ---- tracking


def test_points_are_followed_to_other_parameters_without_their_branch(points):
    """Against the points of a new branch, and the derivative against that difference."""
    names = (ZETA, KAPPA, FORCE)
    change = np.array([2e-5, -4e-5, 1e-5])
    there = SIDED
    for name, d in zip(names, change, strict=True):
        there = there.with_parameter(name, there.get(name) + d)
    new = contact_branch(there).points
    assert [p.kind for p in new] == [p.kind for p in points]
    for old, other in zip(points, new, strict=True):
        mark = marked(SIDED, "frequency", old)
        slopes = mark.slopes(names)
        moved = mark.moved(there, slopes @ change)
        assert moved.value == pytest.approx(other.parameter, abs=1e-12)
        first_order = slopes[2] @ change
        assert moved.place[:2] - mark.place[:2] == pytest.approx(slopes[:2] @ change, rel=5e-2, abs=3e-7)
        assert other.parameter - old.parameter == pytest.approx(first_order, rel=5e-2, abs=1e-7)


# ---- refinement and what it says


@pytest.fixture(scope="module")
def eight(points):
    """Eight events of six decimals, and a start 2 % beside the truth with their points there."""
    chosen = [p for p in points if p.kind != "grazing"][:8]
    events = printed(chosen, 6)
    start = SIDED
    for name, factor in ((ZETA, 1.02), (KAPPA, 0.98), (FORCE, 1.005)):
        start = start.with_parameter(name, factor * SIDED.get(name))
    return events, start


def start_of(problem, here):
    return Catalogue(problem, Tally()).start(here, CONTACT)[1]


def off_by(found):
    return max(abs(found.oscillator.get(n) / SIDED.get(n) - 1.0) for n in RANGES)


def test_least_squares_arrives_from_beside(eight):
    events, start = eight
    problem = problem_of(SIDED, events)
    found = fit(start_of(problem, start), tuple(RANGES))
    assert off_by(found) < 1e-4
    assert found.misfit < len(events) * math.log1p(1.0)


@pytest.mark.parametrize("wrong", [(0,), (1, 4), (4, 7), (5, 7)])
def test_misprints_lose_their_weight(eight, wrong):
    """One or two of eight printed 0.013 and 0.02 off: the parameters stay those of the others."""
    events, start = eight
    bad = list(events)
    for i, by in zip(wrong, (0.02, -0.013), strict=False):
        bad[i] = dataclasses.replace(events[i], value=events[i].value + by)
    problem = problem_of(SIDED, bad)
    found = fit(start_of(problem, start), tuple(RANGES))
    assert off_by(found) < 2e-4
    assert all((abs(off) > 1e3) == (i in wrong) for i, off in enumerate(found.off))


def test_an_event_left_out_is_foretold_by_the_others(eight):
    """A misprint is as far from what the others say as it was moved; the others are within a few units."""
    events, start = eight
    bad = [dataclasses.replace(events[0], value=events[0].value + 5e-4), *events[1:]]
    problem = problem_of(SIDED, bad)
    found = fit(start_of(problem, start), tuple(RANGES))
    rows = range(len(bad))
    off = left_out(found, tuple(RANGES), rows)
    assert off[0] == pytest.approx(-500.0, abs=30.0)
    assert max(abs(x) for x in off[1:]) < 30.0


def test_round_values_are_taken_where_they_are_worth_it_and_only_there(points):
    """Force 0.08 and kappa 0.12 are round, zeta 0.0234568 is not; the events have nine decimals."""
    here = SIDED.with_parameter(FORCE, 0.08).with_parameter(KAPPA, 0.12)
    chosen = [p for p in contact_branch(here).points if p.kind != "grazing"][:7]
    events = printed(chosen, 9)
    problem = problem_of(here, events)
    start = (
        here.with_parameter(FORCE, 0.0800004).with_parameter(KAPPA, 0.1199997).with_parameter(ZETA, 0.0234577)
    )
    found = fit(start_of(problem, start), tuple(RANGES))
    final, steps = rounded(found, tuple(RANGES), dict.fromkeys(RANGES, 1e-7), range(len(events)))
    taken = {s.parameter: (s.after, s.digits) for s in steps}
    assert taken[FORCE] == (0.08, 1)
    assert taken[KAPPA] == (0.12, 2)
    assert ZETA not in taken
    assert final.oscillator.damping_ratio == pytest.approx(TRUE.damping_ratio, rel=1e-5)
    assert all(s.cost < s.worth for s in steps)


def test_a_value_that_is_only_nearly_round_stays(points):
    """Force 0.0800004, which nine decimals separate from 0.08 by a thousand units."""
    here = SIDED.with_parameter(FORCE, 0.0800004)
    chosen = [p for p in contact_branch(here).points if p.kind != "grazing"][:7]
    events = printed(chosen, 9)
    problem = problem_of(here, events)
    found = fit(start_of(problem, here), tuple(RANGES))
    final, steps = rounded(found, tuple(RANGES), dict.fromkeys(RANGES, 1e-9), range(len(events)))
    assert FORCE not in {s.parameter for s in steps if s.digits < 5}
    assert final.oscillator.mean_force == pytest.approx(0.0800004, rel=1e-7)


def test_one_of_several_is_taken_whatever_it_costs(eight):
    events, start = eight
    problem = problem_of(SIDED, events, {**RANGES, KAPPA: OneOf((0.1, 0.13))})
    found = fit(start_of(problem, start), tuple(RANGES))
    final, steps = rounded(found, tuple(RANGES), dict.fromkeys(RANGES, 1e-6), range(len(events)))
    assert final.oscillator.get(KAPPA) == 0.13
    assert steps[0].cost > 10.0


# ---- sight


def test_the_scale_of_a_one_sided_motion_is_a_direction_nobody_sees(points):
    events = printed(points[:6])
    unknowns = {FORCE: Ranged(0.02, 0.3), "error_amplitude": Ranged(0.1, 0.4), KAPPA: Ranged(0.05, 0.3)}
    problem = problem_of(SIDED, events, unknowns)
    marks = tuple(marked(SIDED, "frequency", p) for p in points[:6])
    found = fit(Fit(problem, SIDED, marks), ())
    seen = directions(found, tuple(unknowns), range(6))
    assert [d.seen for d in seen] == [True, True, False]
    assert str(seen[2]) in ("mean_force with error_amplitude", "error_amplitude with mean_force")
    assert seen[2].parts[FORCE] == pytest.approx(seen[2].parts["error_amplitude"], rel=1e-6)
    assert "half_backlash" in unseen(found, range(6), seen)


# ---- the whole


@pytest.mark.slow
def test_parameters_are_found_from_eight_points_two_of_them_misprinted():
    """The true values are no trial values; the first choice as the exact event is a misprint too."""
    bounds = (0.35, 1.1)
    points = [p for p in contact_branch(TRUE, bounds).points if p.kind != "grazing"]
    events = printed(points, 6)[:8]
    assert len(events) == 8
    exact = ranked(problem_of(TRUE, events))[0]
    wrong = (exact, 5)
    for i, by in zip(wrong, (0.03, -0.001), strict=True):
        events[i] = dataclasses.replace(events[i], value=events[i].value + by)
    ranges = {
        ZETA: Ranged(0.015, 0.04, trials=2),
        KAPPA: Ranged(0.08, 0.2, trials=2),
        FORCE: Ranged(0.03, 0.2),
    }
    found = identify(TRUE, "frequency", events, ranges, bounds)
    assert found.converged
    assert found.by_chance < 1e-6
    assert set(found.best.outliers) == set(wrong)
    for name in ranges:
        assert found.best.values[name] == pytest.approx(TRUE.get(name), rel=3e-4)


def test_the_page_on_it_runs():
    page = Path(__file__).parents[2] / "docs" / "howto" / "identify.md"
    for code in re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        exec(compile(code, str(page), "exec"), {})


@pytest.mark.slow
def test_numbers_that_no_oscillator_has_are_not_identified(points):
    """Labels of a real scan with values at random: whatever is found is within reach of chance, and said so."""
    rng = np.random.default_rng(1)
    plain = [e for e in printed(points, 6) if e.kind != "grazing" and e.periods == 1]
    events = [dataclasses.replace(e, value=round(float(rng.uniform(0.36, 0.74)), 6)) for e in plain[:5]]
    ranges = {
        ZETA: Ranged(0.015, 0.04, trials=1),
        KAPPA: Ranged(0.08, 0.2, trials=2),
        FORCE: Ranged(0.03, 0.2),
    }
    found = identify(TRUE, "frequency", events, ranges, (0.35, 0.75), anchors=1)
    assert not found.converged
    assert found.by_chance > 0.01
    assert "not identified" in found.message


def test_trials_are_counted(points):
    events = printed([p for p in points if p.kind == "saddle-node"], 8)
    catalogue = Catalogue(
        problem_of(SIDED, events, {ZETA: Ranged(0.01, 0.08, trials=2), FORCE: RANGES[FORCE]}), Tally()
    )
    done = []
    found = scan(catalogue, 0, FORCE, lambda k, n: done.append((k, n)))
    assert done == [(1, 2), (2, 2)]
    assert len(found) >= 2
    assert found[0].misfit <= found[-1].misfit


@pytest.mark.slow
@pytest.mark.parametrize("off", [0.0, 3.6e-9, 1e-8])
def test_what_is_found_does_not_hang_on_last_digits(off):
    """At the upper bound the motion is chaotic: where Newton's method goes from there, last digits decide."""
    here = GearOscillator(FourierStiffness(1.0, (0.1,), (0.0,)), 0.01, 0.05 + off, 0.2, 0.4, 1.0)
    doubling = Event("period-doubling", "1-1-0", 0.53961770, 8)
    catalogue = Catalogue(Problem(here, "frequency", (doubling,), {}, (0.3, 0.8)), Tally())
    partner = catalogue.partners(here, DOUBLED)[1][0]
    assert partner.parameter == pytest.approx(doubling.value, abs=2e-7)
