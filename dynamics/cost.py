"""What a result took."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Cost"]


@dataclass(frozen=True)
class Cost:
    """What a result took.

    Parameters
    ----------
    seconds : float
        Wall time [s]; the first call in a fresh environment includes compilation.
    unknowns : int
        Unknowns of the equations solved; 0 where nothing is solved.
    iterations : int
        Newton iterations, over all solutions.
    periods : int
        Excitation periods integrated.
    """

    seconds: float
    unknowns: int
    iterations: int
    periods: int
