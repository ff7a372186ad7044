"""Searches: differential evolution for one objective, NSGA-II for several, each in two phases of tolerance."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from base import InputError
from flankfilm.optimisation.polish import Evaluate, Polish, polish
from flankfilm.optimisation.task import Task

Array = NDArray[np.float64]


FAILED = 1e30
"""Objective and limit of a point that could not be computed."""

FIRST_PHASE = {True: 0.5, False: 0.6}
"""Part of the evaluations that the first, coarse phase gets: with one objective, and with several."""

SECOND_PHASE = {True: 0.3, False: 0.4}
"""Part that the fine one gets; what is left of one objective's is for the polish."""


def search(task: Task, evaluate: Evaluate) -> Polish | None:
    """Spend the evaluations of a task: coarse over all the ranges, fine from where that led, then by itself the best.

    Returns
    -------
    Polish or None
        How the local end came out; None for several objectives, whose front has none.
    """
    single = len(task.objectives) == 1
    find = _one if single else _several
    coarse, fine = task.tolerances
    first, second = (round(part[single] * task.asked.evaluations) for part in (FIRST_PHASE, SECOND_PHASE))
    led_to = find(task, evaluate, coarse, first, None)
    last = find(task, evaluate, fine, second, led_to)
    return polish(task, evaluate, last[0]) if single else None


def _generations(task: Task, evaluations: int) -> int:
    """Generations after the first one."""
    return max(0, evaluations // task.population - 1)


def _one(task: Task, evaluate: Evaluate, tolerance: float, evaluations: int, start: Array | None) -> Array:
    """Differential evolution (Storn and Price, doi:10.1023/A:1008202821328); the last population, the best first."""
    from scipy.optimize import NonlinearConstraint, differential_evolution

    def limits(x: Array) -> Array:
        return evaluate(np.atleast_2d(x.T), tolerance)[1].T.reshape(len(task.limits), *x.shape[1:])

    # the stubs know neither objectives of many points at once nor plain lists of bounds
    evolve: Any = differential_evolution
    solution = evolve(
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
    population: Array = np.clip(solution.population, 0.0, 1.0)
    return population


def _latin(task: Task) -> Array:
    """First population: spread over the ranges, with the scene as it stands where that lies in them."""
    from scipy.stats import qmc

    population = np.asarray(
        qmc.LatinHypercube(len(task.asked.vary), rng=task.asked.seed).random(task.population)
    )
    if (start := task.places(task.start.values)) is not None:
        population[0] = start
    return population


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

    solution = minimize(
        Pair(),
        NSGA2(pop_size=task.population, sampling=_latin(task) if start is None else start),
        ("n_gen", _generations(task, evaluations) + 1),
        seed=task.asked.seed,
    )
    return np.asarray(solution.pop.get("X"))


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
