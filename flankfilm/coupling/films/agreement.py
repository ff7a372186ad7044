"""Fixed point of films and of what depends on them: rounds that follow one another until nothing changes any more."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from base import SolverError

__all__ = ["MOST_ROUNDS", "in_agreement"]

MOST_ROUNDS = 12

Round = TypeVar("Round")


def in_agreement(
    first: Round,
    following: Callable[[Round], Round],
    agrees: Callable[[Round], bool],
    lacking: Callable[[Round], str],
) -> tuple[Round, int]:
    """Follow rounds until one agrees with what it was computed from.

    Parameters
    ----------
    first : Round
        Films with all that depends on them, and by how much that has changed.
    following : callable
        Gives the round after a round.
    agrees : callable
        Whether the changes of a round are within their limits.
    lacking : callable
        Says what still changes in the last round, with a remedy.

    Returns
    -------
    Round
        That agrees.
    int
        Number of rounds.

    Raises
    ------
    SolverError
        Where `MOST_ROUNDS` rounds do not agree.

    Examples
    --------
    >>> in_agreement(8.0, lambda x: 0.5 * x, lambda x: x < 1.5, "{} is left".format)
    (1.0, 4)
    """
    state, rounds = first, 1
    while not agrees(state):
        if rounds == MOST_ROUNDS:
            raise SolverError(lacking(state))
        state, rounds = following(state), rounds + 1
    return state, rounds
