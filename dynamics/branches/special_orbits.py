"""What singles a special orbit out of a branch: a function of the orbit that is zero there, with its gradient."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from base import Array
from dynamics.branches.branch import SpecialPoint
from dynamics.branches.branch_problem import BranchProblem, MapPoint
from dynamics.branches.corrector import rounding
from dynamics.model.protocol import EPS, PeriodicOscillator

PRODUCTS = {"saddle-node": "fold", "period-doubling": "flip", "neimark-sacker": "torus"}
"""Kinds that a function of the multipliers singles out, and the attribute of a point that holds it."""


@dataclass(frozen=True)
class Condition:
    """A condition on an orbit.

    Parameters
    ----------
    kind : str
        "saddle-node", "period-doubling", "neimark-sacker" or "grazing".
    boundary : int
        At a grazing 1 for X = D, -1 for X = -D, else 0.
    kindred : int
        At a grazing the sign of X'' of the extremum, else 0.
    phase : float
        At a grazing about where in the orbit's period the extremum lies.
    """

    kind: str
    boundary: int = 0
    kindred: int = 0
    phase: float = 0.0

    @classmethod
    def of(cls, here: PeriodicOscillator, point: SpecialPoint) -> Condition:
        """Condition that a special point meets, `here` the oscillator with the point's parameter value."""
        if point.kind != "grazing":
            return cls(point.kind, point.boundary)
        phase = 0.0 if math.isnan(point.tau) else (point.tau / (point.periods * here.period)) % 1.0
        return cls(point.kind, point.boundary, int(np.sign(point.acceleration)), phase)

    def nearest(self, point: MapPoint) -> int:
        """Extremum that is meant; -1 if there is none."""
        if len(point.extrema) == 0:
            return -1
        gap = np.abs((point.extrema[:, 0] - self.phase + 0.5) % 1.0 - 0.5)
        gap[point.extrema[:, 2] * self.kindred <= 0.0] = np.inf
        at = int(np.argmin(gap))
        return at if np.isfinite(gap[at]) else -1

    def measure(self, problem: BranchProblem, point: MapPoint) -> float:
        """Quantity that is zero at the special orbit; nan if there is no such extremum."""
        if self.kind in PRODUCTS:
            return float(getattr(point, PRODUCTS[self.kind]))
        at = self.nearest(point)
        if at < 0:
            return float("nan")
        level = point.levels[0 if self.boundary == 1 else 1]
        return float(point.extrema[at, 1] - level) / problem.scale

    def rows(self, problem: Any, point: Any) -> Array:
        """Derivatives of map less state and of the measure by the unknowns of a `problem_of`."""
        bend = problem.bend(point)
        closing = bend.first - np.eye(point.size, len(point.u))
        if self.kind in PRODUCTS:
            return np.array([*closing, getattr(bend, PRODUCTS[self.kind])])
        slope: Array = bend.extrema[self.nearest(point)].copy()
        slope[point.size :] -= self.boundary * problem.widenings / problem.scale
        return np.array([*closing, slope])


def noise_of(u: Array, periods: int) -> float:
    """What is left of an orbit and its condition over the stretch of the map: more of a small motion far out."""
    return max(1e-11, 64.0 * EPS * periods * float(np.max(np.abs(u))))


def special_orbit(
    problem: Any,
    condition: Condition,
    guess: Array,
    across: Array | None = None,
    refinement: int = 1,
    limit: int = 12,
) -> Any:
    """Newton's method for an orbit that meets a condition; None if it does not arrive.

    With one parameter the orbit is isolated. With two, it is sought in the plane across . (u - guess) = 0. Derivatives
    are those of a `problem_of`; where they are exact convergence is quadratic away from grazings.
    """
    u, noise = guess, noise_of(guess, problem.periods)
    best, kept = np.inf, None
    for iteration in range(limit):
        point = problem.evaluate(u, refinement)
        if point is None:
            return None
        gap = [*(point.image - u[: point.size]), condition.measure(problem, point)]
        rows = [*condition.rows(problem, point)]
        if across is not None:
            gap.append(across @ (u - guess))
            rows.append(across)
        off, matrix = np.array(gap), np.array(rows)
        if not (np.all(np.isfinite(off)) and np.all(np.isfinite(matrix))):
            return None
        # the determinant and trace of the measure are as exact as the entries of the Jacobian
        size = float(np.max(np.abs(off))) / max(1.0, float(np.max(np.abs(point.jacobian))))
        closed = point.residual <= rounding(point, problem.periods)
        if size < best or (closed and kept is not None and kept.residual > rounding(kept, problem.periods)):
            best, kept = size, point
        elif best < noise and kept is not None and kept.residual <= rounding(kept, problem.periods):
            break
        try:
            step = np.linalg.solve(matrix, -off)
        except np.linalg.LinAlgError:
            return None
        length = float(np.max(np.abs(step)))
        if not length < 0.3:
            return None
        if closed and (length < 1e-15 or (best < noise and length < 0.01 * noise)):
            break
        u = u + step
        if iteration > 4 and best > 1e-3:
            return None
    if kept is None or not (best < noise and kept.residual <= rounding(kept, problem.periods)):
        return None
    return kept
