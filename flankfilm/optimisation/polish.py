"""Local end of a search: trust regions without derivatives about the best point, then its neighbours."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from base import Array

if TYPE_CHECKING:
    from flankfilm.optimisation.task import Task
    from flankfilm.studies.study_file import Range

WIDEST_STEP = 0.05
"""First radius of the trust region, of each range."""

SMALLEST_STEP = 1e-3
"""Radius at which a polish ends, of each range."""

NEIGHBOURS = 0.01
"""Distance of the neighbours that are tried at the end, of each range; one for whole numbers."""

DIAGONALS = 2
"""Most varied keys whose neighbours are tried along the diagonals too."""

MARGIN = 1e-5
"""By how much a polish keeps off the limits, relative to their bounds: what it ends with must keep them."""


class Evaluate(Protocol):
    """Gives what a search needs of points of the unit cube."""

    def __call__(self, units: Array, tolerance: float, /) -> tuple[Array, Array]:
        """Objectives (points, m) and limits (points, k; allowed where <= 0) at a tolerance."""

    @property
    def remaining(self) -> int:
        """Points that may still be asked for."""

    def error(self, unit: Array, /) -> float:
        """Absolute error of the first objective at a point."""


@dataclass(frozen=True)
class Polish:
    """How a search ended.

    Attributes
    ----------
    converged : bool
        Whether no neighbour is better by more than the objective's error.
    rounds : int
        Trust regions that were run down; each further one began at a better neighbour.
    why : str
        In words.
    """

    converged: bool
    rounds: int
    why: str


def polish(task: Task, evaluate: Evaluate, best: Array) -> Polish:
    """Improve a point by itself, and try its neighbours, until none of them is better.

    Keys that are whole numbers are held in the trust regions (COBYQA, doi:10.14711/thesis-991013088355903412; model by
    quadratic interpolation, limits included) and moved by one among the neighbours.

    Parameters
    ----------
    task : Task
    evaluate : Evaluate
        Its ``left`` bounds the points.
    best : (keys,) array
        Best point of the search at the scene's tolerance, in the unit cube.
    """
    free = np.flatnonzero(~np.array(task.whole))
    at, rounds = best, 0
    while True:
        around = neighbours(task, at)
        if free.size:
            if evaluate.remaining < (need := 2 * free.size + 2 + len(around)):
                why = f"{evaluate.remaining} points were left for a polish, which takes {need} or more"
                return Polish(False, rounds, why)
            rounds += 1
            at, ended = _trust_region(task, evaluate, at, free, evaluate.remaining - len(around))
            if not ended:
                return Polish(
                    False,
                    rounds,
                    f"the points were used up before the polish's step fell below {SMALLEST_STEP:.1%} of each range",
                )
            around = neighbours(task, at)
        if evaluate.remaining < len(around):
            return Polish(False, rounds, "the points were used up before all neighbours were tried")
        better = _better(task, evaluate, at, around)
        if better is None:
            return Polish(True, rounds, _found(task, bool(free.size)))
        at = better


def _found(task: Task, polished: bool) -> str:
    step = f"the polish's step fell below {SMALLEST_STEP:.1%} of each range, and " if polished else ""
    away = f"{NEIGHBOURS:.0%} of a range" if polished else ""
    if any(task.whole):
        away += " or one whole number" if polished else "one whole number"
    return f"{step}no design {away} away is better by more than the objective's error"


def neighbours(task: Task, at: Array) -> Array:
    """Points around a point, within the ranges: one step along each key, and along the diagonals of few keys."""
    spans = tuple(task.asked.vary.values())

    def moved(span: Range, place: float, way: int) -> float:
        value = span.at(place)
        if way and span.whole and isinstance(value, int):
            return span.place(value + way)
        return place + way * NEIGHBOURS

    if len(spans) <= DIAGONALS:
        ways = np.array([way for way in itertools.product((-1, 0, 1), repeat=len(spans)) if any(way)])
    else:
        ways = np.concatenate([np.eye(len(spans), dtype=int), -np.eye(len(spans), dtype=int)])
    around = np.array(
        [[moved(*move) for move in zip(spans, at.tolist(), way, strict=True)] for way in ways.tolist()]
    )
    inside = np.all((around >= -1e-9) & (around <= 1.0 + 1e-9), axis=1)
    return np.asarray(np.clip(around[inside], 0.0, 1.0))


def _better(task: Task, evaluate: Evaluate, at: Array, around: Array) -> Array | None:
    """Best allowed neighbour, where it is better by more than the objective's error."""
    own, _ = evaluate(at[None], task.tolerances[1])
    objectives, limits = evaluate(around, task.tolerances[1])
    feasible_objective = np.where(np.all(limits <= 0, axis=1), objectives[:, 0], np.inf)
    least = int(np.argmin(feasible_objective))
    return around[least] if feasible_objective[least] < own[0, 0] - evaluate.error(at) else None


def _trust_region(task: Task, evaluate: Evaluate, start: Array, free: Any, points: int) -> tuple[Array, bool]:
    """Best allowed point of one run, and whether it ended by itself."""
    from scipy.optimize import NonlinearConstraint, minimize

    fine = task.tolerances[1]
    objectives, limits = evaluate(start[None], fine)
    first = float(objectives[0, 0])
    scale = abs(first) or 1.0
    seen = {tuple(start.tolist()): 0.0} if np.all(limits <= 0) else {}

    def at(x: Array) -> Array:
        whole = start.copy()
        whole[free] = np.clip(x, 0.0, 1.0)
        return whole

    def objective_and_limits(x: Array) -> tuple[float, Array]:
        objectives, limits = evaluate(at(x)[None], fine)
        value, kept = (objectives[0, 0] - first) / scale, limits[0]
        if value < 1e6 and np.all(kept <= 0):
            seen[tuple(at(x).tolist())] = value
        # a point that cannot be computed is bad, but not so bad that the quadratic model breaks
        return min(value, 1.0), np.minimum(kept, 1.0)

    solve: Any = minimize
    solution = solve(
        lambda x: objective_and_limits(x)[0],
        start[free],
        method="COBYQA",
        bounds=[(0.0, 1.0)] * free.size,
        constraints=[NonlinearConstraint(lambda x: objective_and_limits(x)[1], -np.inf, -MARGIN)]
        if task.limits
        else [],
        options={"maxfev": points, "initial_tr_radius": WIDEST_STEP, "final_tr_radius": SMALLEST_STEP},
    )
    best = min(seen, key=lambda point: seen[point], default=None)
    return (start if best is None else np.array(best)), bool(solution.status == 0)
