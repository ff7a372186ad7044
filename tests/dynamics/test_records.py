"""Every public result says what it found, how well and at what cost, in one line that one can read."""

from __future__ import annotations

import dataclasses
import inspect
import math

import numpy as np
import pytest

import dynamics
import dynamics.inverse
from base import Cost, Result, quantities
from tests.validation.article_motion import lubricated

OSC = lubricated(0.6)
BOUNDS = (0.62, 0.67)


def orbits():
    return dynamics.find_orbits(OSC, (1,))


def branch():
    return dynamics.continue_branch(dynamics.find_orbit(OSC.with_parameter("frequency", 0.64), (0.35, 0.0)),
                                    "frequency", BOUNDS)  # fmt: skip


def saddle():
    return next(orbit for orbit in orbits().orbits if not orbit.stable)


def grid():
    return dynamics.basins(OSC, (-1.0, 1.0, 6), (-1.0, 1.0, 6), limit=500)


def locus():
    (fold,) = branch().special("saddle-node")
    return dynamics.continue_locus(OSC, fold, ("frequency", "mean_force"), ((0.6, 0.7), (0.095, 0.105)))


def identified():
    events = [dynamics.inverse.Event(p.kind, p.label, p.parameter, 12) for p in branch().points]
    range_of_force = {"mean_force": dynamics.inverse.OneOf((0.1,))}
    return dynamics.inverse.identify(OSC, "frequency", events, range_of_force, BOUNDS)


RESULTS = {
    "BasinBoundary": lambda: dynamics.basin_boundary(
        OSC, grid().attractors, ((-1.0, 1.0), (-1.0, 1.0)), cells=4, levels=2
    ),
    "BasinResult": grid,
    "Branch": branch,
    "ContactGrazing": lambda: dynamics.contact_grazing(OSC, "frequency", BOUNDS, points=20),
    "ChaosEnd": lambda: dynamics.chaos_end(
        dynamics.GearOscillator(dynamics.FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.778, 0.4, 0.8),
        "error_amplitude",
        (1.06, 0.459),
        (0.7795, 0.79),
        periods=2000,
        starts=2,
    ),
    "Crisis": lambda: dynamics.boundary_crisis(saddle(), "frequency", (0.59, 0.61), points=20, periods=12),
    "Diagram": lambda: dynamics.diagram(OSC, "frequency", BOUNDS, periods=(1,), searches=1, swept=0),
    "FourierFit": lambda: dynamics.fit_fourier([1.2, 1.1, 0.9, 0.8]),
    "Identification": identified,
    "Locus": locus,
    "LyapunovResult": lambda: dynamics.lyapunov_exponents(OSC, 50),
    "LyapunovScan": lambda: dynamics.lyapunov_scan(OSC, "frequency", [0.6, 0.61], 50),
    "Manifold": lambda: dynamics.manifold(saddle(), "stable", length=3.0),
    "MapResult": lambda: dynamics.period_map(OSC, (0.35, 0.0)),
    "MultiSweep": lambda: dynamics.multi_sweep(OSC, "frequency", [0.6, 0.61], seeds=1, starts=3),
    "Orbit": lambda: dynamics.find_orbit(OSC, (0.35, 0.0)),
    "OrbitSet": orbits,
    "PairScan": lambda: dynamics.inverse.by_two_events(
        OSC,
        (
            dynamics.inverse.Event("grazing", "1-0-0", 0.5, 2),
            dynamics.inverse.Event("period-doubling", "1-1-0", 0.6, 2),
        ),
        dynamics.inverse.OneOf((0.4, 0.5)),
        {},
    ),
    "RunUp": lambda: dynamics.run_up(OSC, (0.6, 0.61), 64),
    "Spectrum": lambda: dynamics.motion_spectrum(OSC, dynamics.find_orbit(OSC, (0.35, 0.0)).state),
    "SweepResult": lambda: dynamics.sweep(OSC, "frequency", [0.6, 0.61]),
    "Trajectory": lambda: dynamics.trajectory(OSC, (0.35, 0.0)),
}


def test_every_public_result_is_among_them():
    """A record with a cost is a result."""
    public = {
        name
        for package in (dynamics, dynamics.inverse)
        for name in package.__all__
        if inspect.isclass(value := getattr(package, name)) and "cost" in inspect.get_annotations(value)
    }
    assert public <= set(RESULTS)


@pytest.mark.parametrize("name", sorted(RESULTS))
def test_results_say_what_they_are_in_one_line(name: str):
    result = RESULTS[name]()
    assert type(result).__name__ == name
    line = repr(result)
    assert line.startswith(f"{name}(")
    assert len(line) <= 200
    assert "\n" not in line
    assert isinstance(result, Result)
    assert isinstance(result.cost, Cost)
    assert isinstance(result.message, str)
    assert isinstance(result.converged, bool)
    assert result.error is None or math.isnan(result.error) or result.error >= 0.0
    described = quantities(result)
    arrays = {f.name for f in dataclasses.fields(result) if isinstance(getattr(result, f.name), np.ndarray)}
    assert arrays <= set(described)
    for figure in described.values():
        assert figure.figure.meaning
        dims = figure.figure.dims
        if dims and figure.figure.unit and not isinstance(figure.value, dict):
            assert np.ndim(figure.value) == len(dims), figure.name
