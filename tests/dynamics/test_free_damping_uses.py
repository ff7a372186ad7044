"""Damping of its own in the dead zone, through run-ups, sweeps, crises and the inverse problem: none ignores it."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import dynamics
import dynamics.motion.run_ups
from dynamics import find_orbit, run_up
from dynamics.inverse import Event, Ranged, identify
from tests.dynamics.conftest import step_by_step
from tests.dynamics.test_drives import same_as
from tests.dynamics.test_free_damping import oscillator

BOUNDS = (0.66, 0.7)
"""Contact is lost in nearly every period."""


@pytest.mark.slow
def test_a_run_up_damps_in_the_backlash_as_the_integrator_does():
    """A single block, period by period with scipy's events: the last state, which every period before went into."""
    osc, start = oscillator(), np.array([0.5, 0.2])
    found = run_up(osc, BOUNDS, 16, state=start)
    at, before = start, BOUNDS[0]
    for k in range(16):
        frequency = math.sqrt(BOUNDS[0] ** 2 + (BOUNDS[1] ** 2 - BOUNDS[0] ** 2) * (k + 0.5) / 16)
        here = osc.with_parameter("frequency", frequency)
        at = here.with_frequency_step(at, before, frequency)
        at, _, _ = step_by_step(here, at, here.period)
        before = frequency
    assert found.separated[0] > 0.2
    assert found.state == pytest.approx(at, abs=1e-8)
    other = run_up(dataclasses.replace(osc, free_damping_ratio=None), BOUNDS, 16, state=start)
    assert np.max(np.abs(other.state - found.state)) > 1e-3


def test_a_run_up_with_the_same_damping_out_of_contact_has_the_same_digits():
    plain = oscillator(free_damping_ratio=None)
    same = oscillator(free_damping_ratio=plain.damping_ratio)
    ours, theirs = (run_up(osc, BOUNDS, 64, state=(0.5, 0.2)) for osc in (same, plain))
    for name in ("rms", "peak", "force_peak", "separated", "force_order", "state"):
        assert np.array_equal(getattr(ours, name), getattr(theirs, name)), name


def test_a_train_runs_up_with_it_as_the_pair_does(monkeypatch):
    monkeypatch.setattr(dynamics.motion.run_ups, "HELD", 1)
    osc = oscillator()
    drive = same_as(osc)
    slow = drive.with_parameter("frequency", BOUNDS[0])
    shift, rate = slow.error_motion(np.zeros(1))
    ours = run_up(drive, BOUNDS, 64, state=(0.5 + shift[0], 0.2 + rate[0]))
    theirs = run_up(osc, BOUNDS, 64, state=(0.5, 0.2))
    assert ours.rms == pytest.approx(theirs.rms, rel=1e-8)
    assert ours.separated == pytest.approx(theirs.separated, abs=1e-8)


@pytest.mark.slow
def test_identify_finds_the_damping_out_of_contact():
    """Folds and a grazing printed to six digits give it back; they lie elsewhere with that of contact."""
    osc = oscillator(frequency=0.64)
    branch = dynamics.continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.55, 0.68))
    events = [
        Event(point.kind, point.label.removeprefix("U"), round(point.parameter, 6), 6)
        for point in (*branch.special("saddle-node"), *branch.special("grazing"))
    ]
    unknowns = {"free_damping_ratio": Ranged(0.1, 0.4, 4)}
    found = identify(osc, "frequency", events, unknowns, (0.55, 0.68))
    assert found.best.values["free_damping_ratio"] == pytest.approx(0.2, rel=1e-3)
