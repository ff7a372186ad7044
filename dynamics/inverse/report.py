"""Records of what was found, and their table."""

from __future__ import annotations

from dataclasses import dataclass

from base import Cost
from dynamics.inverse.events import Event
from dynamics.inverse.rounding import Rounding
from dynamics.inverse.scoring import Direction
from dynamics.oscillator import GearOscillator

__all__ = ["Candidate", "Identification"]


@dataclass(frozen=True, eq=False)
class Candidate:
    """Parameters that explain events.

    Parameters
    ----------
    oscillator : GearOscillator
        With the parameters found; one-sided if no event tells where the back flank is.
    values : dict
        Unknown to value.
    spread : dict
        Unknown to what one unit of the last decimal of each event that agrees leaves open, to first order.
    found : tuple of float
        Where each event lies with these parameters; nan if it has no partner.
    off : tuple of float
        Difference to the printed value, in units of its last decimal.
    weights : tuple of float
        Weight of each event in the last fit, over its trust; 0 if it was not fitted.
    left_out : tuple of float
        Difference of each event from what the others say of it, in units; nan where they are too few to say.
    matched, unmatched : tuple of int
        Events that have a partner so near that chance would bring one there in less than 1 of 100 cases; the others.
    outliers : tuple of int
        Fitted events that the fit came to disregard: no partner, or beyond three times the scale of the differences.
    misfit : float
        Sum over the fitted events of trust times ln(1 + difference in units).
    by_chance : float
        Trials expected to match as well if the events lay at random.
    """

    oscillator: GearOscillator
    values: dict[str, float]
    spread: dict[str, float]
    found: tuple[float, ...]
    off: tuple[float, ...]
    weights: tuple[float, ...]
    left_out: tuple[float, ...]
    matched: tuple[int, ...]
    unmatched: tuple[int, ...]
    outliers: tuple[int, ...]
    misfit: float
    by_chance: float


@dataclass(frozen=True, eq=False)
class Identification:
    """What the events say about the parameters.

    Parameters
    ----------
    events : tuple of Event
        As given.
    best : Candidate or None
        Refined, with round values; None if no trial has any of the events that were tried as the exact one.
    refined : Candidate or None
        The same before rounding.
    roundings : tuple of Rounding
        What rounding cost and is worth.
    competitors : tuple of Candidate
        Other refined trials, the better first, that are not the same parameters.
    trials : int
        Trials scanned.
    by_chance : float
        Trials expected to match as well as the refined one if the events lay at random.
    directions : tuple of Direction
        Singular directions of the unknowns, the best seen first.
    unseen : tuple of str
        Unknowns, or unknowns together, that the matched events cannot see, and known parameters that none depends on.
    reduction : str
        What was left out at first, and why.
    error : float
        Median difference of the fitted events that agree, in units of their last decimals.
    cost : Cost
        Effort; iterations are branches followed.
    converged : bool
        Whether more events agree than there are unknowns, those not fitted included, and by_chance is below 0.01.
    message : str
        What was found.
    """

    events: tuple[Event, ...]
    best: Candidate | None
    refined: Candidate | None
    roundings: tuple[Rounding, ...]
    competitors: tuple[Candidate, ...]
    trials: int
    by_chance: float
    directions: tuple[Direction, ...]
    unseen: tuple[str, ...]
    reduction: str
    error: float
    cost: Cost
    converged: bool
    message: str

    def table(self) -> str:
        """Events, parameters, rounding and competitors as text."""
        lines = [self.message]
        if self.reduction:
            lines.append(f"first: {self.reduction}")
        if self.best is not None and self.refined is not None:
            lines += ["", *self._events(self.best), "", *self._parameters(self.best, self.refined)]
        if self.unseen:
            lines += ["", "not seen: " + "; ".join(self.unseen)]
        for other in self.competitors:
            values = ", ".join(f"{n} {v:.6g}" for n, v in other.values.items())
            lines.append(
                f"competitor: {values}; {len(other.matched)} matched, misfit {other.misfit:.1f}, "
                f"by chance {other.by_chance:.1e}"
            )
        lines += ["", f"{self.trials} trials, {self.cost.iterations} branches, {self.cost.seconds:.1f} s"]
        return "\n".join(lines)

    def _events(self, best: Candidate) -> list[str]:
        rows = ["kind             label    printed        found           units   others say  status"]
        for i, event in enumerate(self.events):
            status = "matched" if i in best.matched else "unmatched"
            status += ", outlier" if i in best.outliers else ""
            status += "" if event.fitted else ", not fitted"
            rows.append(
                f"{event.kind:16s} {event.label:8s} {event.value:<14.{event.digits}f} {best.found[i]:<14.9f} "
                f"{best.off[i]:>8.3g}  {best.left_out[i]:>10.3g}  {status}"
            )
        return rows

    def _parameters(self, best: Candidate, refined: Candidate) -> list[str]:
        rows = ["parameter                 refined         left open  taken       digits   cost   worth"]
        rounding = {r.parameter: r for r in self.roundings}
        for name, value in best.values.items():
            row = f"{name:25s} {refined.values[name]:<14.9g}  {refined.spread[name]:<9.1e}  {value:<10.8g}"
            if name in rounding:
                r = rounding[name]
                row += f"  {r.digits:>6d} {r.cost:6.1f} {r.worth:7.1f}"
            rows.append(row)
        return rows
