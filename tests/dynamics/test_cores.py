"""On several cores the numbers are those of one."""

import threading

import numpy as np
import pytest

from base import threads
from dynamics import FourierStiffness, GearOscillator, basins, sweep
from dynamics.flow.exact_flow import ExactFlow
from dynamics.motion import sweeps
from dynamics.motion.up_and_down import up_and_down


def oscillator(frequency: float) -> GearOscillator:
    stiffness = FourierStiffness(1.0, (0.18,), (0.0,))
    return GearOscillator(stiffness, 0.05, 0.1, 0.2, frequency, half_backlash=0.2)


@pytest.fixture
def on(monkeypatch):
    return lambda number: monkeypatch.setattr(threads, "cores", lambda: number)


def test_basins(on):
    found = []
    for number in (1, 3):
        on(number)
        found.append(basins(oscillator(0.6), (-1, 1, 40), (-1, 1, 40)))
    np.testing.assert_array_equal(found[0].labels, found[1].labels)
    assert found[0].cost.periods == found[1].cost.periods
    assert len(set(found[0].labels.ravel().tolist())) == 2


@pytest.mark.parametrize("parameter", ["frequency", "error_amplitude"])
def test_sweeps_up_and_down(on, parameter):
    values = np.linspace(0.15, 0.35, 12) if parameter == "error_amplitude" else np.linspace(0.5, 0.7, 12)
    on(2)
    found = up_and_down(oscillator(0.6), parameter, values, transient=300)
    for way in ("up", "down"):
        alone = sweep(oscillator(0.6), parameter, values, way, transient=300)
        np.testing.assert_array_equal(found[way].states, alone.states)
        assert (found[way].labels, found[way].error) == (alone.labels, alone.error)
        assert found[way].direction == way


@pytest.mark.parametrize("number", [1, 2])
def test_errors_of_both_ways_take_one_finer_flow_for_each_value(on, monkeypatch, number):
    on(number)
    made: list[float] = []
    real = ExactFlow.finer

    def finer(flow):
        made.append(flow.packed[4])
        return real(flow)

    monkeypatch.setattr(ExactFlow, "finer", finer)
    values = np.linspace(0.5, 0.6, 6)
    found = up_and_down(oscillator(0.6), "frequency", values, transient=300)
    assert sorted(made) == values.tolist()
    assert 0.0 < found["up"].error < 1e-12
    assert 0.0 < found["down"].error < 1e-12


def test_an_interrupt_ends_both_ways(on, monkeypatch):
    """One way fails at its third value; the other, of 5000 values, is not waited for."""
    on(2)
    visited = []
    real = sweeps._settle

    def settle(here, *rest, **options):
        if threading.current_thread() is threading.main_thread():
            visited.append(here.frequency)
            if len(visited) == 3:
                raise KeyboardInterrupt
        else:
            others.append(here.frequency)
        return real(here, *rest, **options)

    others: list[float] = []
    monkeypatch.setattr(sweeps, "_settle", settle)
    with pytest.raises(KeyboardInterrupt):
        up_and_down(oscillator(0.6), "frequency", np.linspace(0.5, 0.7, 5000))
    assert len(others) < 2500
