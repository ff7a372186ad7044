"""Curves of saddle nodes, period doublings and grazings in the plane of two parameters."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from base import Cost, Faults, Stopwatch
from dynamics.conditions import Condition, special_orbit
from dynamics.corrector import OrbitProblem
from dynamics.limits import NUMBER
from dynamics.locus_tracing import DoublePoint, Tracer
from dynamics.oscillator import GearOscillator
from dynamics.shooting import floquet_multipliers, motion_label
from dynamics.special import SpecialPoint, of_kind

__all__ = ["CODIMENSION_TWO", "DoublePoint", "Locus", "continue_locus"]

FloatArray = npt.NDArray[np.float64]
CODIMENSION_TWO = ("cusp", "saddle-node and grazing", "period-doubling and grazing", "double grazing")


@dataclass(frozen=True, eq=False)
class Locus:
    """A curve of special points in two parameters.

    Parameters
    ----------
    kind : str
        "saddle-node", "period-doubling" or "grazing".
    boundary : int
        At a grazing 1 for X = D, -1 for X = -D; else 0.
    parameters : tuple of str
        The two parameters.
    periods : int
        Period of the orbits, in excitation periods.
    values : ndarray, shape (m, 2)
        Parameters along the curve.
    states : ndarray, shape (m, 2)
        X and V at tau = 0.
    multipliers : ndarray of complex, shape (m, 2)
        Floquet multipliers.
    labels : tuple of str
        n-p-q.
    points : tuple of DoublePoint
        Points of codimension two in their order along the curve.
    ended : tuple of str
        Why the curve ended at its first and at its last point.
    error : float
        Largest estimated relative error of a point of codimension two.
    cost : Cost
        Effort.
    converged : bool
        Whether both ends are at a bound, at the start again, or at a grazing that ends the curve.
    message : str
        What happened.
    """

    kind: str
    boundary: int
    parameters: tuple[str, str]
    periods: int
    values: FloatArray
    states: FloatArray
    multipliers: npt.NDArray[np.complex128]
    labels: tuple[str, ...]
    points: tuple[DoublePoint, ...]
    ended: tuple[str, str]
    error: float
    cost: Cost
    converged: bool
    message: str

    def special(self, kind: str) -> list[DoublePoint]:
        """Points of codimension two of one kind.

        Parameters
        ----------
        kind : str
            One of `CODIMENSION_TWO`.

        Raises
        ------
        InputError
            If there is no such kind.
        """
        return of_kind(self.points, kind, CODIMENSION_TWO)

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        """The two parameters, shape (m, 2)."""
        return self.values.astype(dtype if dtype is not None else np.float64)


def continue_locus(
    oscillator: GearOscillator,
    point: SpecialPoint,
    parameters: tuple[str, str],
    bounds: tuple[tuple[float, float], tuple[float, float]],
    *,
    step: float = 0.005,
    max_step: float = 0.02,
    min_step: float = 1e-7,
    max_points: int = 2000,
    progress: Callable[[int, FloatArray], None] | None = None,
) -> Locus:
    """Follow a special point in two parameters, both ways.

    Unknowns are X, V and both parameters, equations that the orbit closes and that the special point's condition
    holds; all derivatives are exact, from the second derivatives of the map and those of the extrema.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator of the point: its value of the first parameter is replaced by the point's.
    point : SpecialPoint
        A saddle node, period doubling or grazing found in the first parameter.
    parameters : tuple of str
        The two parameters, as in `GearOscillator.with_parameter`.
    bounds : tuple
        Range of each parameter.
    step, max_step, min_step : float
        First, largest and smallest step, over the size of the motion and the width of the bounds.
    max_points : int
        Points in each direction.
    progress : callable, optional
        Called with the number of points and the parameters.

    Returns
    -------
    Locus
        The curve and its points of codimension two.

    Raises
    ------
    InputError
        If an argument is out of range, or the point cannot be met again.
    """
    watch = Stopwatch()
    faults = Faults()
    start = oscillator.with_parameter(parameters[0], point.parameter)
    if parameters[0] == parameters[1]:
        faults.add("parameters", parameters, "must be two different parameters", "name another one")
    low, high = np.empty(2), np.empty(2)
    for k in range(2):
        low[k], high[k] = (faults.number(f"bounds[{k}][{i}]", bounds[k][i], NUMBER) for i in range(2))
        value = start.get(parameters[k])
        if not low[k] < high[k]:
            faults.add(f"bounds[{k}]", bounds[k], "must have the lower value first", "give (low, high)")
        elif not low[k] <= value <= high[k]:
            faults.add("point", value, f"must have its {parameters[k]} within bounds", "widen the bounds")
    limit = faults.whole("max_points", max_points, 1, 10**6, "2000 is usual")
    faults.raise_if_any()
    scale = max(float(np.max(np.abs(point.state))), start.half_backlash, 1e-300)
    problem = OrbitProblem(start, parameters, point.periods, low, high, scale)
    phase = 0.0 if math.isnan(point.tau) else (point.tau / (point.periods * start.period)) % 1.0
    condition = Condition(
        point.kind, point.boundary, 0 if point.kind != "grazing" else int(np.sign(point.acceleration)), phase
    )
    guess = problem.unknowns(point.state, [start.get(name) for name in parameters])
    first = special_orbit(problem, condition, guess, np.array([0.0, 0.0, 0.0, 1.0]))
    if first is None:
        faults.add(
            "point",
            point.parameter,
            "must be a point that can be met again",
            "next to a grazing, start elsewhere",
        )
        faults.raise_if_any()
        raise AssertionError
    tracers = []
    for sign in (-1.0, 1.0):
        tracer = Tracer(problem, condition, first, sign, (step, max_step, min_step), limit, progress)
        tracer.run()
        tracers.append(tracer)
        if tracer.ended == "closed":
            break
    return _locus(problem, condition, tracers, watch)


def _locus(problem: OrbitProblem, condition: Condition, tracers: list[Tracer], watch: Stopwatch) -> Locus:
    """Join the two directions into one record."""
    back = tracers[0]
    points, double = back.points[::-1], back.double[::-1]
    ended = [back.ended]
    if len(tracers) == 2:
        points, double = points + tracers[1].points[1:], double + tracers[1].double
    ended.append(tracers[-1].ended)
    good = all(e in ("bound", "closed", "ends at a grazing", "the extremum that touches ends") for e in ended)
    first, second = problem.parameters
    return Locus(
        condition.kind, condition.boundary, (first, second), problem.periods,
        np.array([p.values for p in points]), np.array([p.state for p in points]),
        np.array([floquet_multipliers(p.trace, p.determinant) for p in points], dtype=np.complex128),
        tuple(motion_label(problem.periods, p.counts) for p in points), tuple(double), (ended[0], ended[1]),
        max((p.error for p in double), default=0.0),
        Cost(watch.seconds, 4, len(points), 4 * problem.periods * len(points)), good,
        f"{len(points)} points, {len(double)} of codimension two; ended: {ended[0]}, {ended[1]}",
    )  # fmt: skip
