"""Every public result says what it found, how well and at what cost, in one line that one can read."""

from __future__ import annotations

import dataclasses
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
    "ContactGrazing": lambda: dynamics.contact_grazing(OSC, "frequency", BOUNDS, points=20),
    "Crisis": lambda: dynamics.boundary_crisis(saddle(), "frequency", (0.59, 0.61), points=20, periods=12),
    "Diagram": lambda: dynamics.diagram(OSC, "frequency", BOUNDS, periods=(1,), searches=1, swept=0),
    "FourierFit": lambda: dynamics.fit_fourier([1.2, 1.1, 0.9, 0.8]),
    "Identification": identified,
    "Locus": locus,
    "Manifold": lambda: dynamics.manifold(saddle(), "stable", length=3.0),
    "MultiSweep": lambda: dynamics.multi_sweep(OSC, "frequency", [0.6, 0.61], seeds=1, starts=3),
    "OrbitSet": orbits,
}


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
    assert result.message
    assert isinstance(result.converged, bool)
    assert result.error is None or math.isnan(result.error) or result.error >= 0.0
    described = quantities(result)
    plain = {"cost", "message", "converged", "error"}
    assert {f.name for f in dataclasses.fields(result)} - plain <= set(described)
    for figure in described.values():
        assert figure.figure.meaning
        dims = figure.figure.dims
        if dims and figure.figure.unit and not isinstance(figure.value, dict):
            assert np.ndim(figure.value) == len(dims), figure.name
