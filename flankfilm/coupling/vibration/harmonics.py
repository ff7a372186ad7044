"""Fourier series of the curves of a mesh cycle, of any order, from harmonics that are integrated once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import dynamics
from base import Array, Cost, SolverError, Stopwatch
from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from gears.sharing.mesh_figures import SHOWN

RESOLVED = 150
"""Harmonics that are computed, so that what a low order drops can be seen; the rest follows from the whole."""

CURVES = {"secant": "secant_stiffness", "tangent": "stiffness"}
"""Curve of a mesh cycle that is a kind of stiffness."""


@dataclass(frozen=True, eq=False)
class Harmonics:
    """Harmonics of a curve of a mesh cycle.

    Attributes
    ----------
    mean, square : float
        Means of the curve and of its square.
    amplitudes, phases : (RESOLVED,) arrays
    position, values : (n,) arrays
        Positions in base pitches on both sides of every event, and the curve there.
    """

    mean: float
    square: float
    amplitudes: Array
    phases: Array
    position: Array
    values: Array

    def fit(self, order: int) -> dynamics.FourierFit:
        """Fourier series of an order, and what it leaves out."""
        watch = Stopwatch()
        mean, amplitudes, phases = self.mean, self.amplitudes[:order], self.phases[:order]
        remainder = max(self.square - mean**2 - 0.5 * float(np.sum(amplitudes**2)), 0.0)
        angle = 2 * np.pi * self.position[:, None] * np.arange(1, order + 1) + phases
        off = self.values - mean - np.cos(angle) @ amplitudes
        rms = float(np.sqrt(remainder)) / mean
        return dynamics.FourierFit(
            stiffness=dynamics.FourierStiffness(mean, tuple(amplitudes.tolist()), tuple(phases.tolist())),
            remainder_rms=rms,
            remainder_max=float(np.max(np.abs(off))) / mean,
            harmonics=tuple((self.amplitudes / mean).tolist()),
            condition=float(np.sqrt(2.0)),
            cost=Cost(watch.seconds, 2 * order + 1),
            message=f"{order} harmonics leave out {rms:.2g} of the mean",
        )


def harmonics_of(cycle: MeshCycle, kind: str) -> Harmonics:
    """Harmonics of a stiffness by exact integrals over the arcs between events.

    Parameters
    ----------
    cycle : MeshCycle
    kind : str
        ``"secant"`` or ``"tangent"``.

    Raises
    ------
    SolverError
        Where the cycle's contact has no solution at some positions.
    """
    if cycle.arcs is None:
        raise SolverError(f"no series of a mesh cycle without arcs: {cycle.message}")
    arcs, name = cycle.arcs.arcs, CURVES[kind]
    amplitudes, _ = arcs.harmonics(name, np.arange(1, RESOLVED + 1))
    return Harmonics(
        arcs.mean(name)[0],
        arcs.moment(name, 2)[0],
        np.abs(amplitudes),
        np.angle(amplitudes),
        cycle.dense_position,
        arcs.on_each(name, SHOWN),
    )
