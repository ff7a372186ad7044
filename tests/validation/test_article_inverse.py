"""Parameters of the article's starved frequency scan from six of its printed points.

It prints D = 1.0 and says that the rest is as before, which is not so. Motions that do not touch the back flank
depend on F_m / eps only and not on D: eps stays .2, D unknown. No trial value is one of those that are found.
"""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from dynamics import (
    DynamicsError,
    Event,
    FourierStiffness,
    GearOscillator,
    continue_branch,
    find_orbit,
    identify,
    sweep,
)

SIX = (
    Event("saddle-node", "1-1-0", 0.43701658, 8),
    Event("period-doubling", "1-2-0", 0.43647824, 8),
    Event("saddle-node", "1-1-0", 0.53528214, 8),
    Event("period-doubling", "1-1-0", 0.53961873, 8, fitted=False),
    Event("period-doubling", "2-1-0", 0.78450762, 8, fitted=False),
    Event("period-doubling", "1-1-0", 1.691, 3, fitted=False),
)
ANY = GearOscillator(FourierStiffness(1.0, (0.2,), (0.0,)), 0.03, 0.1, 0.2, 0.4, 0.5, one_sided=True)


@pytest.fixture(scope="module")
def found():
    trials = {
        "damping_ratio": (0.015, 0.03, 0.05, 0.08),
        "stiffness.amplitudes[0]": (0.06, 0.12, 0.2, 0.3),
    }
    return identify(ANY, "frequency", SIX, trials, "mean_force", (0.005, 0.4), (0.3, 2.0))


def test_parameters_are_recovered(found):
    assert found.best.values == {
        "damping_ratio": 0.01,
        "stiffness.amplitudes[0]": 0.1,
        "mean_force": 0.05,
    }
    assert found.refined.values["damping_ratio"] == pytest.approx(0.01, rel=1e-5)
    assert found.refined.values["stiffness.amplitudes[0]"] == pytest.approx(0.1, rel=1e-5)


def test_events_that_were_not_used_are_met(found):
    """The period doublings of the other branches: 4e-8, 1e-6 and 4e-5 off, as the validation page has it."""
    assert found.converged
    assert found.best.matched == (0, 1, 2, 3, 4, 5)
    assert found.by_chance < 1e-6
    assert abs(found.best.off[3]) < 110
    assert abs(found.best.off[4]) < 5
    assert abs(found.best.off[5]) < 0.1


def test_what_the_points_cannot_see_is_named(found):
    assert found.unseen == ("half_backlash",)


def test_printed_backlash_then_meets_a_point_with_back_contact(found):
    """With D = 1.0 as printed the fold of 3-1-1, which was not used, lies at 2.47857059 (printed ...60)."""
    whole = dataclasses.replace(found.best.oscillator, half_backlash=1.0, one_sided=False)
    settled = sweep(whole, "frequency", np.linspace(0.4, 2.0, 41))
    assert settled.labels[-1] == "3-1-1"
    orbit = find_orbit(whole.with_parameter("frequency", 2.0), settled.states[-1, -1], periods=3)
    folds = continue_branch(orbit, "frequency", (1.9, 2.6)).special("saddle-node")
    assert min(abs(p.parameter - 2.47857060) for p in folds) < 2e-8


def test_too_few_events_are_refused():
    with pytest.raises(DynamicsError, match="fitted"):
        identify(ANY, "frequency", SIX[:1], {"damping_ratio": (0.01,)}, "mean_force", (0.01, 0.4), (0.3, 2.0))
