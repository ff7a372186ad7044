"""Searches: differential evolution for one objective, NSGA-II for several, each in two phases of tolerance."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from base import InputError
from flankfilm.optimisation.task import Task

Array = NDArray[np.float64]

Evaluate = Callable[[Array, float], tuple[Array, Array]]
"""Objectives (points, m) and limits (points, k; allowed where <= 0) of points of the unit cube at a tolerance."""

FAILED = 1e30
"""Objective and limit of a point that could not be computed."""

FIRST_PHASE = 0.6
"""Part of the evaluations that the first, coarse phase gets."""


def search(task: Task, evaluate: Evaluate) -> None:
    """Spend the evaluations of a task: first coarse over all the ranges, then fine from where that led."""
    find = _one if len(task.objectives) == 1 else _several
    first = round(FIRST_PHASE * task.asked.evaluations)
    coarse, fine = task.tolerances
    led_to = find(task, evaluate, coarse, first, None)
    find(task, evaluate, fine, task.asked.evaluations - first, led_to)


def _generations(task: Task, evaluations: int) -> int:
    return max(1, evaluations // task.asked.population - 1)


def _one(task: Task, evaluate: Evaluate, tolerance: float, evaluations: int, start: Array | None) -> Array:
    """Differential evolution (Storn and Price, doi:10.1023/A:1008202821328); the last population."""
    from scipy.optimize import NonlinearConstraint, differential_evolution

    def limits(x: Array) -> Array:
        return evaluate(np.atleast_2d(x.T), tolerance)[1].T.reshape(len(task.limits), *x.shape[1:])

    # the stubs know neither objectives of many points at once nor plain lists of bounds
    evolve: Any = differential_evolution
    found = evolve(
        lambda x: evaluate(np.atleast_2d(x.T), tolerance)[0][:, 0],
        [(0.0, 1.0)] * len(task.asked.vary),
        maxiter=_generations(task, evaluations),
        init=_latin(task) if start is None else start,
        constraints=NonlinearConstraint(limits, -np.inf, 0.0) if task.limits else (),
        rng=task.asked.seed,
        polish=False,
        tol=1e-6,
        updating="deferred",
        vectorized=True,
    )
    population: Array = np.clip(found.population, 0.0, 1.0)
    return population


def _latin(task: Task) -> Array:
    from scipy.stats import qmc

    return np.asarray(
        qmc.LatinHypercube(len(task.asked.vary), rng=task.asked.seed).random(task.asked.population)
    )


def _several(
    task: Task, evaluate: Evaluate, tolerance: float, evaluations: int, start: Array | None
) -> Array:
    """NSGA-II (Deb and others, doi:10.1109/4235.996017); the last population."""
    try:
        from pymoo.algorithms.moo.nsga2 import NSGA2
        from pymoo.core.problem import Problem
        from pymoo.optimize import minimize
    except ImportError as fault:
        remedy = "Install it: python -m pip install 'flankfilm[optimise]'; or minimise one output"
        raise InputError.at("minimise", "several outputs", "needs the library pymoo", remedy) from fault

    class Pair(Problem):
        def __init__(self) -> None:
            super().__init__(
                n_var=len(task.asked.vary),
                n_obj=len(task.objectives),
                n_ieq_constr=len(task.limits),
                xl=0.0,
                xu=1.0,
            )

        def _evaluate(self, x: Array, out: dict[str, Any], *args: Any, **kwargs: Any) -> None:
            out["F"], out["G"] = evaluate(x, tolerance)

    found = minimize(
        Pair(),
        NSGA2(pop_size=task.asked.population, sampling=_latin(task) if start is None else start),
        ("n_gen", _generations(task, evaluations) + 1),
        seed=task.asked.seed,
    )
    return np.asarray(found.pop.get("X"))


def front(objectives: Array, allowed: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Rows that no other allowed row equals or betters in all objectives, in the order of the first one."""
    rows = np.flatnonzero(allowed)
    values = objectives[rows]
    kept = []
    for i, row in enumerate(rows):
        better = np.all(values <= values[i], axis=1) & np.any(values < values[i], axis=1)
        if not better.any():
            kept.append(int(row))
    kept.sort(key=lambda row: tuple(objectives[row]))
    return np.array(kept, dtype=np.intp)
