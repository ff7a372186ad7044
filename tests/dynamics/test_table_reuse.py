"""Along forces and the play what does not change is not tabulated again, and no digit of a sweep changes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator, sweep
from dynamics.flow.exact_flow import exact_flow
from dynamics.flow.flows import flow_of
from dynamics.flow.table_reuse import TableReuse
from dynamics.kernels import tables as kernels
from dynamics.motion import sweeps

OSCILLATOR = GearOscillator(
    FourierStiffness(1.0, (0.18, 0.05), (0.0, 1.0)), 0.05, 0.1, (0.2, 0.05), 0.6, 0.2, (0.3, 0.7)
)
FORCES = ["mean_force", "error_amplitude[0]", "error_amplitude[1]", "error_phase[0]", "error_phase[1]"]


@pytest.fixture
def filled(monkeypatch):
    """Solutions from which tables are filled on, call by call."""
    calls = []
    fill = kernels.fill

    def counted(packed, coef, edge, room, first):
        calls.append(first)
        fill(packed, coef, edge, room, first)

    monkeypatch.setattr(kernels, "fill", counted)
    return calls


@pytest.mark.parametrize("parameter", [*FORCES, "half_backlash"])
def test_tables_are_those_made_anew(parameter):
    line = TableReuse(OSCILLATOR, parameter, None)
    for value in (0.05, 0.3, 0.0, 0.11):
        here = OSCILLATOR.with_parameter(parameter, value)
        for made, fresh in (
            (line.at(here), exact_flow(here)),
            (line.at(here).finer(), exact_flow(here).finer()),
        ):
            np.testing.assert_array_equal(made.coef, fresh.coef)
            np.testing.assert_array_equal(made.edge, fresh.edge)
            np.testing.assert_array_equal(made.packed, fresh.packed)


@pytest.mark.parametrize("parameter", [*FORCES, "half_backlash"])
def test_a_sweep_tabulates_the_stiffness_once(filled, monkeypatch, parameter):
    values = np.linspace(0.05, 0.3, 9)
    found = sweep(OSCILLATOR, parameter, values, transient=200)
    assert found.converged
    orbits = filled.count(0) - 2  # that of the motion and the finer one; Newton's method makes its own
    assert orbits <= 9
    assert len(filled) - filled.count(0) == 2 * 9 - 2
    assert set(filled) == {0, 3 if parameter == "half_backlash" else 2}
    monkeypatch.setattr(sweeps, "flows_along", lambda o, p, t: lambda here: flow_of(here, t))
    anew = sweep(OSCILLATOR, parameter, values, transient=200)
    np.testing.assert_array_equal(found.states, anew.states)
    assert (found.labels, found.error) == (anew.labels, anew.error)


@pytest.mark.parametrize("parameter", ["frequency", "damping_ratio", "stiffness.mean", "stiffness.phases[1]"])
def test_what_touches_all_motions_is_made_anew(filled, parameter):
    oscillator = replace(OSCILLATOR, free_damping_ratio=0.02)
    sweep(oscillator, parameter, [0.5, 0.6, 0.7], transient=50)
    assert set(filled) == {0}
