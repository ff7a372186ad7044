"""Compiled code against the same code interpreted: the compiler may not change a figure beyond rounding.

The interpreted pass is also the one in which the lines of the kernels can be counted as run or not run.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import subprocess
import sys
from types import SimpleNamespace
from typing import Any

import pytest

from tests import compiled

MOTION = """
import dataclasses, json
import numpy as np
import dynamics
from dynamics.flow.motions import turning_points
from dynamics.branches.sensitivity import map_derivatives

both = dynamics.GearOscillator(
    stiffness=dynamics.FourierStiffness(1.0, (0.18, 0.05), (0.0, 0.4)),
    damping_ratio=0.05, mean_force=0.1, error_amplitude=0.2, frequency=0.62, half_backlash=0.2,
)
found = {}
pairs = {
    "both sides": both,
    "one side": dataclasses.replace(both, one_sided=True),
    "damping jumps": dataclasses.replace(both, free_damping_ratio=0.3),
}
for name, pair in pairs.items():
    for x, v in ((0.3, 0.0), (0.0, 0.9), (-0.7, -0.4)):
        image = dynamics.period_map(pair, (x, v), 2)
        found[f"map, {name}, {x}"] = [*image.states.ravel(), *image.jacobian.ravel(), *image.counts.ravel()]
    rates = map_derivatives(pair, (0.3, 0.0))
    found[f"first derivatives, {name}"] = rates.slope
    found[f"second derivatives, {name}"] = rates.second
    found[f"turns, {name}"] = turning_points(pair, (0.3, 0.1))
    orbit = dynamics.find_orbit(pair, (0.3, 0.0), 1)
    found[f"orbit, {name}"] = [*orbit.state, *np.abs(orbit.multipliers)]
branch = dynamics.continue_branch(dynamics.find_orbit(both, (0.3, 0.0)), "frequency", (0.6, 0.66))
found["special points"] = [point.parameter for point in branch.points]
found["basins"] = dynamics.basins(both, (-1.0, 1.0, 2), (-1.0, 1.0, 2), limit=6).labels
found["sweep"] = dynamics.sweep(both, "frequency", [0.6], transient=4, keep=8, max_period=4).states
found["exponents"] = dynamics.lyapunov_exponents(both, periods=20, transient=0).exponents
found["orbits"] = sorted(orbit.state[0] for orbit in dynamics.find_orbits(both, (1,), starts=3, batches=2).orbits)
chain = dynamics.DriveOscillator(
    [[1.0, 0.0], [0.0, 2.0]], [[0.1, 0.0], [0.0, 0.1]], [[0.5, -0.2], [-0.2, 0.4]], [1.0, -1.0], both.stiffness, 0.05,
    [0.1, -0.1], 0.2, 0.62, 0.2, free_mesh_damping=0.1,
)
image = dynamics.period_map(chain, (0.5, 0.2, 0.1, -0.3))
found["map of a drive"] = [*image.states.ravel(), *image.jacobian.ravel(), *image.counts.ravel()]
found["motion of a drive"] = dynamics.trajectory(chain, (0.5, 0.2, 0.1, -0.3), 1, 8).columns()
found["basins of a drive"] = dynamics.basins(chain, (-1.0, 1.0, 2), (-1.0, 1.0, 2), limit=4).labels
found["exponents of a drive"] = dynamics.lyapunov_exponents(chain, periods=20, transient=0).exponents
print(json.dumps({name: np.ravel(values).astype(float).tolist() for name, values in found.items()}))
"""
FILM = """
import json
from ehl import LineContact, Lubricant, solve

oil = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
film = solve(LineContact(load=2.2e5, entrainment=2.579, radius=6.48e-3, reduced_modulus=2.2e11, lubricant=oil))
kept = {"film": [film.minimum_thickness, film.central_thickness, film.flow], "pressure": film.pressure.tolist()}
print(json.dumps(kept))
"""


def run(code: str) -> dict[str, Any]:
    """What code prints, run here: the session's kernels are compiled, or read as they are for all sessions."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(compile(code, "<kernels>", "exec"), {})
    return json.loads(said.getvalue())


def interpreted(code: str) -> dict[str, Any]:
    """What code prints in a process that compiles nothing."""
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        timeout=250,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize(("code", "near"), [(MOTION, 1e-9), (FILM, 1e-9)], ids=["motion", "film"])
def test_compiled_code_computes_what_is_written(code: str, near: float):
    compiled, read = run(code), interpreted(code)
    assert compiled.keys() == read.keys()
    for name, values in compiled.items():
        assert read[name] == pytest.approx(values, rel=near, abs=near * max(map(abs, values), default=0.0)), (
            name
        )


@pytest.mark.parametrize(
    ("workers", "source", "times"), [(2, "TESTPATHS", 1), (1, "TESTPATHS", 0), (2, "ARGS", 0)]
)
def test_only_the_whole_suite_on_several_workers_compiles_beforehand(monkeypatch, workers, source, times):
    commands = []
    done = SimpleNamespace(stdout="films: was ready, 0.2 s")
    monkeypatch.setattr(compiled.subprocess, "run", lambda command, **_: commands.append(command) or done)
    said = []
    config = SimpleNamespace(
        args_source=pytest.Config.ArgsSource[source],
        get_terminal_writer=lambda: SimpleNamespace(line=said.append),
    )
    compiled.pytest_xdist_setupnodes(config, [object()] * workers)
    assert [command[1:] for command in commands] == [["-m", "flankfilm", "warm-up"]] * times
    assert said == [done.stdout] * times
