"""What an optimisation gave, and what it may claim: its errors, the designs that tie, the gain on the start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from base import Array, Cost, plot, view
from flankfilm.figures.views import register
from flankfilm.optimisation.polish import Polish
from flankfilm.optimisation.search import FAILED
from flankfilm.optimisation.task import Task
from flankfilm.studies.outputs import ERROR_OF, ROUNDING, exact
from flankfilm.studies.row import RowResult
from flankfilm.studies.study_file import Value

LAST = 0.25
"""Part of the fine points whose gain says whether a front still moves."""

STILL = 0.01
"""Gain of the front's hypervolume by these below which it stands still."""


@dataclass(frozen=True, eq=False)
class Evaluation:
    """One point: tolerance, values of the keys, and what came of it."""

    tolerance: float
    values: tuple[Value, ...]
    result: RowResult


@dataclass(frozen=True)
class Gain:
    """An objective of the scene as it stands against the best one found.

    Attributes
    ----------
    objective : str
    start, best : float
        In the unit of the output.
    share : float
        Gain over the start's value; negative where nothing betters it.
    told_apart : bool
        Whether the two differ by more than their errors.
    """

    objective: str
    start: float
    best: float
    share: float
    told_apart: bool


@dataclass(frozen=True, eq=False)
class Optimum:
    """What an optimisation gave.

    Attributes
    ----------
    task : Task
    evaluations : tuple of Evaluation
        In the order in which they were asked for, without the scene as it stands.
    best : ndarray of int
        Evaluations at the scene's tolerance that keep the limits and that none betters: one, or the front.
    computed : int
        Evaluations of this run; the others were there.
    seconds : float
        Wall time of this run.
    start : Evaluation or None
        The scene as it stands; None where its keys make no scene.
    polish : Polish or None
        How the local end came out; None for a front.
    """

    task: Task
    evaluations: tuple[Evaluation, ...]
    best: NDArray[np.intp]
    computed: int
    seconds: float
    start: Evaluation | None = None
    polish: Polish | None = None

    def __repr__(self) -> str:
        """One line: points, those that are best, error, whether it converged, seconds."""
        which = f"{len(self.tied)} tie" if len(self.best) == 1 else f"{len(self.best)} on the front"
        settled = "converged" if self.converged else "not converged"
        return (
            f"Optimum({self.points} points, {which}, error {self.error:.1e}, {settled}, {self.seconds:.3g} s)"
        )

    _repr_html_ = view
    plot = plot

    @property
    def points(self) -> int:
        """Points of the whole search, the scene as it stands among them."""
        asked = {(evaluation.tolerance, evaluation.values) for evaluation in self.evaluations}
        return len(asked | ({(self.start.tolerance, self.start.values)} if self.start is not None else set()))

    @property
    def cost(self) -> Cost:
        """Wall time of this run, and the points computed in it."""
        return Cost(self.seconds, counts={"points": self.computed})

    @property
    def error(self) -> float:
        """Relative error of the first objective at the first of the best."""
        return self.error_of(self.task.objectives[0], self.evaluations[self.best[0]].result)

    def error_of(self, objective: str, result: RowResult) -> float:
        """Relative error of an objective at a point; the scene's tolerance where the point has none."""
        return error_of(self.task, objective, result)

    @property
    def converged(self) -> bool:
        """Whether the polish ended by itself, or the front stood still."""
        return self.polish.converged if self.polish is not None else self.moved < STILL

    @property
    def message(self) -> str:
        """What that means here, with a remedy where it did not converge."""
        if self.polish is not None:
            why = self.polish.why
        else:
            why = (
                f"the last quarter of the fine points raised the hypervolume of the front by {self.moved:.2g}"
            )
            why += f" of itself; {STILL:g} and less stands still"
        asked = self.task.asked.evaluations
        remedy = "" if self.converged else f"; give more than {asked} evaluations, such as {2 * asked}"
        return f"{'converged' if self.converged else 'not converged'}: {why}{remedy}"

    @property
    def moved(self) -> float:
        """Part of the front's hypervolume that the last quarter of the fine points brought; nan without a front."""
        objectives, allowed = self._judged()
        rows = np.flatnonzero(allowed)
        if len(self.task.objectives) < 2:
            return float("nan")
        early = rows[: round((1.0 - LAST) * rows.size)]
        whole = objectives[self.best]
        low, span = whole.min(axis=0), np.ptp(whole, axis=0)
        unit = (objectives - low) / np.where(span > 0, span, 1.0)
        return 1.0 - _volume(unit[early]) / _volume(unit[rows])

    @property
    def tied(self) -> NDArray[np.intp]:
        """Evaluations that differ from the best by no more than the objectives' errors, the best included."""
        objectives, allowed = self._judged()
        within_error = np.zeros(len(self.evaluations), dtype=bool)
        for place in self.best:
            result = self.evaluations[place].result
            errors = [self.error_of(name, result) for name in self.task.objectives]
            slack = np.abs(objectives[place]) * np.array(errors)
            within_error |= np.all(objectives <= objectives[place] + slack, axis=1)
        return np.flatnonzero(within_error & allowed)

    def tied_ranges(self) -> dict[str, tuple[float, float]]:
        """Minimum and maximum value of every varied key among the designs that tie."""
        values = np.array([self.evaluations[i].values[: len(self.task.asked.vary)] for i in self.tied])
        ends = zip(values.min(axis=0).tolist(), values.max(axis=0).tolist(), strict=True)
        return dict(zip(self.task.asked.vary, ends, strict=True))

    @property
    def gains(self) -> tuple[Gain, ...]:
        """Every objective of the scene as it stands against the best one found; none where that has no value."""
        if self.start is None or self.start.result.fault:
            return ()
        improvements = []
        for column, (name, sign) in enumerate(zip(self.task.objectives, self.task.signs, strict=True)):
            own = self.start.result.values[column]
            values = [self.evaluations[i].result.values[column] for i in self.best]
            place = int(np.argmin(sign * np.array(values)))
            least = values[place]
            ends = ((own, self.start), (least, self.evaluations[self.best[place]]))
            slack = max(abs(value) * self.error_of(name, at.result) for value, at in ends)
            share = sign * (own - least) / (abs(own) or 1.0)
            improvements.append(Gain(name, own, least, share, abs(own - least) > slack))
        return tuple(improvements)

    @property
    def start_keeps(self) -> bool:
        """Whether the scene as it stands keeps the limits."""
        if self.start is None:
            return False
        return bool(np.all(judged(self.task, [self.start.result])[1] <= 0))

    @property
    def allowed(self) -> NDArray[np.bool_]:
        """Of each evaluation: whether it could be computed and keeps the limits."""
        results = [e.result for e in self.evaluations]
        kept: NDArray[np.bool_] = np.all(judged(self.task, results)[1] <= 0, axis=1)
        return np.asarray(kept & np.array([not r.fault for r in results]))

    def _judged(self) -> tuple[Array, NDArray[np.bool_]]:
        """Objectives, and which evaluations may be best."""
        fine = np.array([e.tolerance == self.task.tolerances[1] for e in self.evaluations])
        return judged(self.task, [e.result for e in self.evaluations])[0], fine & self.allowed


def judged(task: Task, results: Sequence[RowResult]) -> tuple[Array, Array]:
    """Objectives with the sign of minimisation, and limits, allowed where <= 0, relative to their bounds.

    A failed point is the worst of all.
    """
    values = np.array([result.values for result in results]).reshape(-1, len(task.outputs))
    limits = [
        sign * (values[:, task.outputs.index(name)] - bound) / (abs(bound) or 1.0)
        for name, sign, bound in task.limits
    ]
    objectives = values[:, : len(task.signs)] * np.array(task.signs)
    # the search asks for no point at all where none keeps the limits
    kept = np.array(limits).reshape(len(limits), len(results)).T
    return np.where(np.isfinite(objectives), objectives, FAILED), np.where(np.isfinite(kept), kept, FAILED)


def error_of(task: Task, objective: str, result: RowResult) -> float:
    """Relative error of an objective at a point: its own, rounding, or else the scene's tolerance."""
    if exact(objective):
        return ROUNDING
    name = ERROR_OF.get(objective)
    own = float("nan") if name is None else result.values[task.outputs.index(name)]
    return own if np.isfinite(own) else task.tolerances[1]


def _volume(unit: Array) -> float:
    """Hypervolume below points, up to a corner a tenth beyond the front's ends."""
    from pymoo.indicators.hv import HV

    return float(HV(ref_point=np.full(unit.shape[1], 1.1))(unit)) if len(unit) else 0.0


register()
