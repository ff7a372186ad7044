"""The examples of the inverse problem run, and find what their page says."""

from __future__ import annotations

import pytest

from tests.example_scripts import example


@pytest.mark.slow
def test_the_starved_frequency_scan_is_identified(capsys):
    (found,) = example("identify_scans").main(["6.2"])
    assert found.converged
    assert tuple(found.best.values.values()) == (0.01, 0.1, 0.05, 1.0)
    assert "half_backlash" in capsys.readouterr().out


@pytest.mark.slow
def test_a_drawn_oscillator_is_found_back_from_points_with_two_misprints():
    recoveries = example("identify_recoveries")
    here, events, rng = recoveries.drawn(3)
    spoilt = recoveries.misprinted(events, 2, rng)
    assert sum(a != b for a, b in zip(events, spoilt, strict=True)) == 2
    found = recoveries.identify(here, "frequency", spoilt, recoveries.RANGES, recoveries.BOUNDS)
    assert found.converged
    assert recoveries.off(found, here) < 1e-3
