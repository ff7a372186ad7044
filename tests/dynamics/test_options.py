"""The numbers of the method: they are those of the page, and decide answers that tests can see."""

from __future__ import annotations

import re
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from dynamics import (
    FourierStiffness,
    GearOscillator,
    basins,
    lyapunov_exponents,
    motion_spectrum,
    sweep,
)
from dynamics.attraction import basins as basin_search
from dynamics.attraction.covers import Cover
from dynamics.model.options import OPTIONS
from dynamics.motion import exponents, spectra, sweeps
from dynamics.motion.sweeps import repeat_after

PAGE = Path(__file__).parents[2] / "docs" / "theory" / "dynamics.md"
CHAOS = GearOscillator(FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.778, 0.4, half_backlash=0.8)


def test_the_page_has_the_numbers_in_use():
    rows = dict(re.findall(r"^\| `(\w+)` \| (\S+) \|", PAGE.read_text(encoding="utf-8"), re.MULTILINE))
    assert {name: str(value) for name, value in asdict(OPTIONS).items()} == {
        name: rows.get(name) for name in asdict(OPTIONS)
    }


def test_motions_repeat_within_a_millionth():
    states = np.ones((8, 2))
    for change, n in ((0.9e-6, 1), (1.1e-6, 2)):
        states[::2] = 1.0 - change
        assert repeat_after(states, 4) == n


def test_the_sign_of_an_exponent_takes_three_standard_errors(monkeypatch):
    result = lyapunov_exponents(CHAOS, 400)
    share = abs(result.exponents[0]) / result.standard_error
    assert result.message == "chaotic"
    monkeypatch.setattr(exponents, "OPTIONS", replace(OPTIONS, sure=1.01 * share))
    assert lyapunov_exponents(CHAOS, 400).message.startswith("average more periods")


def test_a_motion_that_does_not_repeat_has_lines_at_multiples_of_a_64th(monkeypatch):
    state = sweep(CHAOS, "frequency", [CHAOS.frequency]).states[0, -1]
    assert np.diff(motion_spectrum(CHAOS, state, 0).order)[0] == pytest.approx(1 / 64)
    monkeypatch.setattr(spectra, "OPTIONS", replace(OPTIONS, spectrum_periods=32))
    assert np.diff(motion_spectrum(CHAOS, state, 0).order)[0] == pytest.approx(1 / 32)


def test_a_motion_creeps_to_an_orbit_if_it_changes_by_two_per_cent(monkeypatch):
    """Little damping leaves a part in two hundred of a disturbance after the longest transient."""
    slow = GearOscillator(FourierStiffness(1.0), 1e-4, 0.1, 0.0, 0.6137, half_backlash=0.0)
    start = 1.005 * slow.rest_state()
    assert sweep(slow, "frequency", [slow.frequency], initial=start).periods[0] > 0
    monkeypatch.setattr(sweeps, "OPTIONS", replace(OPTIONS, creep=1e-9))
    assert sweep(slow, "frequency", [slow.frequency], initial=start).periods[0] == 0


def test_chaos_of_a_basin_is_told_by_three_motions_at_most(monkeypatch):
    grid = ((1.055, 1.065, 2), (0.455, 0.463, 2))
    assert [a.label for a in basins(CHAOS, *grid, limit=100).attractors] == ["aperiodic"]
    monkeypatch.setattr(basin_search, "OPTIONS", replace(OPTIONS, chaos_trials=0))
    assert basins(CHAOS, *grid, limit=100).attractors == ()


def test_a_cover_has_four_cells_of_a_128th_around_the_attractor():
    states = np.stack(np.meshgrid(np.linspace(0.0, 1.0, 257), np.linspace(0.0, 1.0, 257)), -1).reshape(-1, 2)
    cover = Cover.of(states)
    beside = np.array([[1.0 + cells / 128, 0.5] for cells in (3.9, 4.1)])
    assert cover.outside(beside).tolist() == [False, True]
