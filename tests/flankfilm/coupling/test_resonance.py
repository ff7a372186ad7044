"""Figures of a sweep's motions, and the error of the speed at which contact is first lost, held by other means."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator, contact_grazing, sweep, trajectory
from dynamics.flow import exact_flow
from dynamics.flow.motions import force_range
from dynamics.flow.samples import share_below
from flankfilm.coupling.speeds.swept_truncation import grazing_errors
from flankfilm.coupling.speeds.truncation import Longer
from flankfilm.coupling.vibration import contact_loss_error as first_loss
from flankfilm.coupling.vibration.resonance import vibration, vibrations

OSCILLATOR = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.65, half_backlash=0.2)


def test_figures_are_those_of_the_motion_sampled_finely():
    found = sweep(OSCILLATOR, "frequency", [0.5, 0.65])
    (force, separated, off, spread, error, _), *_ = vibrations(OSCILLATOR, [found])
    for i, value in enumerate((0.5, 0.65)):
        here = OSCILLATOR.with_parameter("frequency", value)
        state, periods = found.states[i, -1], int(found.periods[i])
        fine = trajectory(here, state, periods, points_per_period=20_000)
        assert force[i] == pytest.approx(
            force_range(here, state, periods, samples=20_000).greatest, rel=3 * error
        )
        assert spread[i] == pytest.approx(np.std(fine.x[:-1]), rel=3 * error)
        assert separated[i] == pytest.approx(np.mean(fine.x[:-1] < 0.2), abs=1e-3)
        assert separated[i] == pytest.approx(share_below(fine.x - 0.2), rel=2 * off[i])
    assert separated[0] == 0.0 < separated[1] < 1.0
    assert off[0] == 0.0 < off[1] < 1e-3
    assert error < 1e-3


def test_sweeps_share_the_tables_of_a_frequency_and_what_the_stiffness_is_there(monkeypatch):
    found = [sweep(OSCILLATOR, "frequency", [0.5, 0.65], way) for way in ("up", "down")]
    alone = [vibrations(OSCILLATOR, [swept])[0] for swept in found]
    tables, angles = [], []
    make, stiffness = exact_flow.tabulated, FourierStiffness.__call__
    monkeypatch.setattr(exact_flow, "tabulated", lambda *given: tables.append(given) or make(*given))
    monkeypatch.setattr(
        FourierStiffness, "__call__", lambda law, angle: angles.append(angle) or stiffness(law, angle)
    )
    for together, one in zip(vibrations(OSCILLATOR, found), alone, strict=True):
        np.testing.assert_array_equal(together.force, one.force)
        np.testing.assert_array_equal(together.spread, one.spread)
    assert len(tables) == 2
    assert len(angles) == 1


def test_a_motion_that_was_lost_has_no_figures():
    assert np.isnan(vibration(OSCILLATOR, np.array([np.nan, 0.0]), 1)[:4]).all()


def test_the_budget_of_the_first_loss_is_what_changed_stiffnesses_do():
    """Small errors: the linear budget is the change that the grazing itself shows."""
    mean, off, left = 2e-4, 3e-4, 5e-4
    cycle = SimpleNamespace(errors={"mean_secant_stiffness": mean})
    series: Any = SimpleNamespace(cycle=cycle, kind="secant", order=1, harmonic_error=np.array([off]))
    motion: Any = SimpleNamespace(oscillator=OSCILLATOR, series=series)

    def grazing(oscillator: GearOscillator) -> float:
        return contact_grazing(oscillator, "frequency", (0.6, 0.7), points=20).points[0].parameter

    here = grazing(OSCILLATOR)
    second = replace(OSCILLATOR, stiffness=FourierStiffness(1.0, (0.18, left), (0.0, 0.7)))
    (truncation,) = grazing_errors(Longer(second, second, ()), np.array([here]))
    found = first_loss.grazing_budget(motion, here, 1e-12, truncation)
    softer = grazing(replace(OSCILLATOR, mean_force=0.1 / (1.0 + mean))) * np.sqrt(1.0 + mean) / here - 1.0
    higher = grazing(replace(OSCILLATOR, stiffness=FourierStiffness(1.0, (0.18 + off,), (0.0,)))) / here - 1.0
    assert found["stiffness"] == pytest.approx(abs(softer) + abs(higher), rel=0.02)
    assert found["truncation"] == pytest.approx(abs(grazing(second) / here - 1.0), rel=1e-6)
    assert found["flow"] == 1e-12
