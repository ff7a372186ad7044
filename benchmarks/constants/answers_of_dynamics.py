"""Answers of dynamics for the study of constants: motions, branches with their special points, sweeps, basins."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

import dynamics
from dynamics import FourierStiffness, GearOscillator

OSC = GearOscillator(
    stiffness=FourierStiffness(mean=1.0, amplitudes=(0.18,), phases=(0.0,)),
    damping_ratio=0.05,
    mean_force=0.1,
    error_amplitude=0.2,
    frequency=0.6,
    half_backlash=0.2,
)
CHAOTIC = replace(OSC, frequency=1.13)
SPEEDS, NEAR = (0.5, 1.2), (0.5, 0.2)
BOX = ((-1.0, 1.0), (-1.0, 1.0))


def _drive() -> Any:
    mass, stiff = np.diag([2.0, 0.9, 1.3, 3.0]), np.diag([0.05, 0.0, 0.0, 0.1])
    for i, j, k in ((0, 1, 0.8), (2, 3, 0.6)):
        row = np.zeros(4)
        row[i], row[j] = 1.0, -1.0
        stiff += k * np.outer(row, row)
    return dynamics.DriveOscillator(
        mass=mass,
        damping=0.02 * mass + 0.03 * stiff,
        stiffness=stiff,
        direction=[0.0, 1.0, 1.0, 0.0],
        mesh_stiffness=FourierStiffness(1.0, (0.18, 0.05), (0.3, 1.0)),
        mesh_damping=0.03,
        mean_force=[0.1, 0.0, 0.0, 0.12],
        error_amplitude=(0.1, 0.02),
        error_phase=(0.4, 1.0),
        frequency=0.9,
        half_backlash=0.15,
    )


def _smooth() -> Any:
    law = dynamics.PowerContact(stiffness=OSC.stiffness, half_backlash=0.2, exponent=1.1)
    return dynamics.SmoothOscillator(law, 0.05, 0.1, 0.2, 0.55)


def _figure(value: Any, error: Any = 0.0) -> tuple[Any, float]:
    """Value, and its error in the same unit from a relative one."""
    value = np.asarray(value)
    return value, float(np.max(error, initial=0.0)) * float(np.max(np.abs(value), initial=0.0))


def _orbit(orbit: Any) -> dict[str, Any]:
    labels = np.array([float(orbit.periods), *map(float, orbit.counts)])
    parts = np.sort(np.abs(orbit.multipliers))
    return {
        "state": _figure(orbit.state, orbit.error),
        "multipliers": _figure(parts, orbit.error),
        "counts": (labels, 0.0),
    }


def _points(branch: Any) -> dict[str, Any]:
    """Parameters of special points, in their order."""
    kinds = sorted({point.kind for point in branch.points})
    points = {kind: sorted(branch.special(kind), key=lambda point: point.parameter) for kind in kinds}
    return {
        kind: _figure([point.parameter for point in those], [point.error for point in those])
        for kind, those in points.items()
    }


def _branch(orbit: Any, name: str, span: tuple[float, float]) -> dict[str, Any]:
    return _points(dynamics.continue_branch(orbit, name, span))


def _swept(record: Any, *names: str) -> dict[str, Any]:
    return {name: _figure(getattr(record, name), record.error or 0.0) for name in names}


def _sweep(system: Any, values: Sequence[float], way: str) -> dict[str, Any]:
    return _swept(
        dynamics.sweep(system, "frequency", np.asarray(values), way), "states", "periods", "impacts"
    )


def _basins() -> dict[str, Any]:
    pool = dynamics.basins(OSC, (-1.0, 1.0, 24), (-1.0, 1.0, 24))
    shares = sorted(attractor.share for attractor in pool.attractors)
    return {"shares": _figure(shares, pool.error or 0.0)}


def _exponents() -> dict[str, Any]:
    chaos = dynamics.lyapunov_exponents(CHAOTIC, 1000)
    return {"exponents": (np.asarray(chaos.exponents), float(np.max(chaos.standard_errors)))}


def _run_up() -> dict[str, Any]:
    return _swept(dynamics.run_up(OSC, (0.4, 1.0), 800), "rms", "peak", "force_rms", "force_peak")


def _hunted() -> dict[str, Any]:
    orbits = dynamics.find_orbits(OSC, (1, 2, 3)).orbits
    return {"multipliers": _figure(sorted(float(np.max(np.abs(orbit.multipliers))) for orbit in orbits))}


def _locus() -> dict[str, Any]:
    fold = dynamics.continue_branch(dynamics.find_orbit(OSC, NEAR), "frequency", SPEEDS).special(
        "saddle-node"
    )[0]
    locus = dynamics.continue_locus(OSC, fold, ("frequency", "mean_force"), (SPEEDS, (0.05, 0.2)))
    return {"ends": _figure(np.sort(locus.values[[0, -1]], axis=0), locus.error)}


def _structure() -> dict[str, Any]:
    saddle = next(orbit for orbit in dynamics.find_orbits(CHAOTIC, (3,)).orbits if orbit.label == "U3-3-1")
    crisis = dynamics.boundary_crisis(saddle, "frequency", (1.116, 1.13), points=300, periods=60)
    return {"crisis": _figure(crisis.parameter, crisis.error)}


def _edge() -> dict[str, Any]:
    pool = dynamics.basins(OSC, (-1.0, 1.0, 24), (-1.0, 1.0, 24))
    edge = dynamics.basin_boundary(OSC, pool.attractors, BOX, levels=4)
    saddles = dynamics.edge_saddles(OSC, pool.attractors[0], rays=4)
    sizes = sorted(float(np.max(np.abs(orbit.multipliers))) for orbit in saddles)
    return {"counts": _figure(edge.counts), "saddles": _figure(sizes)}


def _series() -> dict[str, Any]:
    angle = np.linspace(0.0, 2.0 * np.pi, 50, endpoint=False)
    fit = dynamics.fit_fourier(1.0 + 0.2 * np.cos(angle) ** 3, order=4)
    mass, stiff = np.diag([1.0, 2.0]), np.array([[2.0, -1.0], [-1.0, 1.5]])
    return {
        "fit": _figure(fit.stiffness(angle)),
        "modal": _figure(dynamics.modal_damping(mass, stiff, [0.01, 0.02])),
    }


DYNAMICS: dict[str, Callable[[], dict[str, Any]]] = {
    "series": _series,
    "orbit": lambda: _orbit(dynamics.find_orbit(OSC, NEAR)),
    "orbit of a drive": lambda: _orbit(dynamics.find_orbit(_drive(), np.zeros(8), transient=300)),
    "orbit of a smooth law": lambda: _orbit(dynamics.find_orbit(_smooth(), (0.4, 0.0))),
    "branch": lambda: _branch(dynamics.find_orbit(OSC, NEAR), "frequency", SPEEDS),
    "branch of a drive": lambda: _branch(
        dynamics.find_orbit(_drive(), np.zeros(8), transient=300), "frequency", (0.895, 0.905)
    ),
    "branch of a smooth law": lambda: _branch(
        dynamics.find_orbit(_smooth(), (0.4, 0.0)), "frequency", (0.5, 0.6)
    ),
    "sweep": lambda: _sweep(OSC, np.linspace(0.3, 1.0, 12).tolist(), "up"),
    "sweep of a drive": lambda: _sweep(_drive(), [0.85, 0.9], "down"),
    "basins": _basins,
    "exponents": _exponents,
    "run-up": _run_up,
    "all motions": _hunted,
    "locus": _locus,
    "crisis": _structure,
    "edge": _edge,
}
