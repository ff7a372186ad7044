"""Two events of one branch: a scan whose parameters are known is found among trial values, and is round."""

from __future__ import annotations

import numpy as np
import pytest

from base import InputError
from dynamics import FourierStiffness, GearOscillator, continue_branch, find_orbit
from dynamics.inverse import Event, OneOf, by_two_events
from tests.example_scripts import example

OSC = GearOscillator(FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.4, 0.4, half_backlash=0.8)
GRAZING = Event("grazing", "1-0-0", 0.55869, 5)


def test_the_known_scan_is_found_and_is_round():
    events = GRAZING, Event("period-doubling", "1-2-0", 0.63434, 5)
    found = by_two_events(OSC, events, OneOf((0.39, 0.405)), {"damping_ratio": OneOf((0.05, 0.06))})
    (row,) = found.values[found.rounded]
    # printed to five decimals, the ratio is known to a part in 1e5
    assert row == pytest.approx([0.06, 0.4, 0.1], rel=1e-4)
    assert found.converged
    assert found.by_chance < 0.01


def test_every_solution_meets_both_events():
    events = GRAZING, Event("period-doubling", "1-2-0", 0.63434, 5)
    found = by_two_events(OSC, events, OneOf((0.37, 0.39, 0.405)), {"damping_ratio": OneOf((0.05,))})
    for damping, frequency, force in found.values:
        here = GearOscillator(OSC.stiffness, damping, force, 0.6, frequency, 0.8)
        branch = continue_branch(find_orbit(here, (1.4, 0.4), transient=2000), "error_amplitude", (0.4, 0.8))
        values = [p.parameter for p in branch.special("period-doubling")]
        assert np.min(np.abs(np.array(values) - 0.63434)) < 1e-6


def test_the_example_finds_the_scan_that_is_known(capsys):
    example("identify_pairs").main(["6.3"])
    assert "damping_ratio 0.06, stiffness.amplitudes[0] 0.5, frequency 0.4" in capsys.readouterr().out


def test_other_events_are_refused():
    with pytest.raises(InputError, match="grazing of 1-0-0"):
        by_two_events(OSC, (GRAZING, GRAZING), OneOf((0.3, 0.4)), {})
