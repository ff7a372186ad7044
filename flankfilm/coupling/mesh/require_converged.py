"""Results of the floors below, refused where their solver does not believe them."""

from __future__ import annotations

from typing import TypeVar

from base import Result, SolverError

R = TypeVar("R", bound=Result)


def believed(solution: R, what: str) -> R:
    """Hand back a result that converged.

    Raises
    ------
    SolverError
        Of `what` did not.
    """
    if not solution.converged:
        raise SolverError(f"{what}: {solution.message}")
    return solution
