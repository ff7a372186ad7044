r"""What some events cannot see is left out first.

A motion that does not touch the back flank solves, with :math:`y = X - D`, an equation without D. That equation is
linear in y, F_m and eps together: its special points in any other parameter depend on F_m / eps alone. With the back
flank the same holds of F_m, eps and D together.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

from dynamics.inverse.events import Problem, Ranged, Unknown
from dynamics.model.oscillator import GearOscillator

PLAY, FORCE, ERROR = "half_backlash", "mean_force", "error_amplitude"


@dataclass(frozen=True, eq=False)
class Reduction:
    """A problem with fewer unknowns, and how to come back.

    Parameters
    ----------
    problem : Problem
        The whole one.
    first : Problem
        What is solved first: fewer unknowns, and the events that they decide.
    play : Unknown or None
        Range in which the backlash is sought next, with the events that touch the back flank; None if it is known, or
        nothing depends on it.
    rescaled : bool
        Whether the backlash is known and the scale of F_m and eps is what is really sought.
    held : tuple of str
        Unknowns that no event depends on; they keep the middle of their range.
    message : str
        What was left out.
    """

    problem: Problem
    first: Problem
    play: Unknown | None
    rescaled: bool
    held: tuple[str, ...]
    message: str

    @property
    def names(self) -> tuple[str, ...]:
        """Unknowns that can be found in the end."""
        return tuple(name for name in self.problem.unknowns if name not in self.held)

    def whole(self, here: GearOscillator) -> GearOscillator:
        """Oscillator of the whole problem for one of the first; without back flank where no event depends on it."""
        if PLAY in self.held:
            return here.with_parameter(PLAY, self.problem.unknowns[PLAY].middle)
        return dataclasses.replace(here, one_sided=self.problem.oscillator.one_sided)


def reduced(problem: Problem) -> Reduction:
    """Leave out what the events cannot see.

    Parameters
    ----------
    problem : Problem
        The whole problem.
    """
    here, unknowns = problem.oscillator, dict(problem.unknowns)
    open_side = [e for e in problem.events if e.one_sided or here.one_sided]
    closed_side = [e for e in problem.events if not (e.one_sided or here.one_sided)]
    tied = FORCE in unknowns and ERROR in unknowns
    fewer = len(unknowns) - tied - (PLAY in unknowns)
    enough = sum(e.fitted for e in open_side) >= fewer
    seen = any(e.fitted for e in closed_side)
    play: Unknown | None = None
    held: list[str] = []
    said: list[str] = []
    events, rescaled = problem.events, False
    if enough and (PLAY in unknowns or (tied and seen)):
        here = dataclasses.replace(here, one_sided=True)
        events = tuple(open_side)
        said.append(f"{len(open_side)} events do not touch the back flank and do not see {PLAY}")
    if PLAY in unknowns and here.one_sided:
        range_of_play = unknowns.pop(PLAY)
        if seen:
            play = range_of_play
        else:
            held.append(PLAY)
    if tied and (here.one_sided or PLAY in unknowns):
        range_of_error = unknowns.pop(ERROR)
        middle = range_of_error.middle
        here = here.with_parameter(ERROR, middle)
        said.append(f"only {FORCE} / {ERROR} is seen, {ERROR} is held")
        rescaled = here.one_sided and seen and PLAY not in problem.unknowns
        if rescaled:
            known = here.half_backlash * middle
            play = Ranged(known / range_of_error.high, known / range_of_error.low)
        else:
            held.append(ERROR)
    first = Problem(here, problem.parameter, events, unknowns, problem.bounds)
    return Reduction(problem, first, play, rescaled, tuple(held), "; ".join(said))


def scaled(here: GearOscillator, factor: float) -> GearOscillator:
    """Oscillator with all lengths multiplied: its motions are the same, times the factor."""
    for name in (PLAY, FORCE, ERROR):
        here = here.with_parameter(name, factor * here.get(name))
    return here
