"""What a fit is worth: matches expected by chance, what the data leave open, what they cannot see, events left out."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from base import Array, quantity, record
from dynamics.inverse.events import Problem
from dynamics.inverse.matching import Line
from dynamics.inverse.refinement import Fit, refit
from dynamics.model.reasons import FITTED


@record
class Direction:
    """A direction in the space of the unknowns, and how well the events see it."""

    no_error = FITTED

    headline = ("strength",)

    strength: float = quantity(
        "1",
        "singular value of the sensitivity: units of the last decimals by which all events together move when the "
        "unknowns change along the direction by their own size (phases by 1 rad)",
    )
    parts: dict[str, float] = quantity(
        "1", "part of each unknown in the direction by name; the squares add up to one"
    )

    @property
    def seen(self) -> bool:
        """Whether such a change moves the events by a unit."""
        return self.strength >= 1.0

    def __str__(self) -> str:
        """Unknowns that take part, the largest part first."""
        most = max(abs(p) for p in self.parts.values())
        names = sorted(self.parts, key=lambda n: -abs(self.parts[n]))
        return " with ".join(n for n in names if abs(self.parts[n]) > 0.1 * most)


def probabilities(problem: Problem, lines: Sequence[Line], off: Iterable[float]) -> Array:
    r"""Probability that a point of the kind and label lies as near to each event by chance.

    :math:`\min(1, 2 n |\mu - \mu_e| / w)` for n such points in a range of width w; at least half a unit counts.

    Parameters
    ----------
    problem : Problem
        Events.
    lines : sequence of sequences of SpecialPoint
        All points known.
    off : iterable of float
        Differences in units; nan where there is no partner.
    """
    chance = np.ones(len(problem.events))
    for i, (event, distance) in enumerate(zip(problem.events, off, strict=True)):
        if math.isfinite(distance):
            number = sum(event.fits(p) for line in lines for p in line)
            near = max(abs(distance), 0.5) * event.unit
            chance[i] = min(1.0, 2.0 * max(number, 1) * near / problem.width)
    return chance


def by_chance(problem: Problem, chance: Array, unknowns: int, trials: int) -> float:
    r"""Trials expected to match as well if the events lay at random.

    As many events as unknowns can always be met: the best fitted ones are set aside, in
    :math:`\binom{m}{k}` ways. The product x of the other n probabilities, those of events that were not fitted among
    them, is as small in :math:`x \sum_{j<n} (-\ln x)^j / j!` of all cases (R. A. Fisher's way to combine tests).

    Parameters
    ----------
    problem : Problem
        Events.
    chance : ndarray, shape (events,)
        Of `probabilities`.
    unknowns, trials : int
        Their numbers.
    """
    fitted = sorted(problem.fitted, key=lambda i: float(chance[i]))
    spare = [i for i in range(len(chance)) if i not in fitted[:unknowns]]
    ways = math.comb(len(fitted), unknowns)
    if not spare:
        return float(trials * ways)
    log = float(np.sum(np.log(chance[spare])))
    tail = math.fsum((-log) ** j / math.factorial(j) for j in range(len(spare)))
    return float(trials * ways * min(1.0, math.exp(log) * tail))


def spread(fit: Fit, names: Sequence[str], rows: Sequence[int]) -> dict[str, float]:
    """What one unit of the last decimal of each of these events leaves open of each unknown, to first order."""
    matrix = fit.sensitivity(names, rows)
    if len(rows) < len(names) or not np.all(np.isfinite(matrix)):
        return dict.fromkeys(names, math.nan)
    size = _sizes(fit, names)
    left_open = size * np.sum(np.abs(np.linalg.pinv(matrix * size, rcond=1e-14)), axis=1)
    return dict(zip(names, left_open.tolist(), strict=True))


def directions(fit: Fit, names: Sequence[str], rows: Sequence[int]) -> tuple[Direction, ...]:
    """Singular directions of the sensitivity of these events to these parameters, the best seen first."""
    matrix = fit.sensitivity(names, rows)
    matrix = matrix[np.all(np.isfinite(matrix), axis=1)] * _sizes(fit, names)
    matrix = np.vstack([matrix, np.zeros((len(names), len(names)))])
    _, strengths, rows_of_v = np.linalg.svd(matrix, full_matrices=False)
    return tuple(
        Direction(float(s), dict(zip(names, parts.tolist(), strict=True)))
        for s, parts in zip(strengths, rows_of_v, strict=True)
    )


def unseen(fit: Fit, rows: Sequence[int], seen: Sequence[Direction]) -> tuple[str, ...]:
    """Directions that the events do not see, and known parameters on which none of them depends."""
    unknown = {fit.problem.parameter, *(name for direction in seen for name in direction.parts)}
    known = [name for name in fit.oscillator.parameters if name not in unknown]
    matrix = fit.sensitivity(known, rows) * _sizes(fit, known)
    idle = [n for n, column in zip(known, matrix.T, strict=True) if np.all(np.abs(column) < 1e-6)]
    return (*(str(d) for d in seen if not d.seen), *(idle if len(rows) else ()))


def left_out(fit: Fit, names: Sequence[str], rows: Sequence[int]) -> tuple[float, ...]:
    """Difference of each event from what the others say of it, in units; nan where they are too few."""
    off = [math.nan] * len(fit.marks)
    for i in range(len(off)):
        if i not in rows:
            off[i] = float(fit.off[i])
        elif len(rows) > len(names):
            off[i] = float(refit(fit, names, [j for j in rows if j != i], limit=8).off[i])
    return tuple(off)


def _sizes(fit: Fit, names: Sequence[str]) -> Array:
    """What a change is measured by: the value itself, 1 rad for phases."""
    return np.array([1.0 if "phase" in n else max(abs(fit.oscillator.get(n)), 1e-3) for n in names])
