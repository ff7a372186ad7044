"""Records of what was found, and their table."""

from __future__ import annotations

import math

from base import Cost, quantity, record
from dynamics.inverse.events import Event
from dynamics.inverse.rounding import Rounding
from dynamics.inverse.scoring import Direction
from dynamics.model.oscillator import GearOscillator
from dynamics.model.reasons import FITTED


@record
class Candidate:
    """Parameters that explain events."""

    no_error = FITTED

    headline = ("misfit", "by_chance")

    oscillator: GearOscillator = quantity(
        "", "the parameters found; one-sided if no event shows where the back flank is"
    )
    values: dict[str, float] = quantity("1", "value of each unknown by name")
    spread: dict[str, float] = quantity(
        "1",
        "what one unit of the last decimal of each event that agrees leaves open of each unknown, to first order",
    )
    found: tuple[float, ...] = quantity(
        "1", "where each event lies with these parameters; nan if it has no partner", "event"
    )
    off: tuple[float, ...] = quantity("1", "difference to the printed value in its last decimals", "event")
    weights: tuple[float, ...] = quantity(
        "1", "weight of each event in the last fit, over its trust; 0 if it was not fitted", "event"
    )
    left_out: tuple[float, ...] = quantity(
        "1",
        "difference of each event from what the others say of it, in units; nan where they are too few to say",
        "event",
    )
    matched: tuple[int, ...] = quantity(
        "1",
        "events that have a partner so near that chance would bring one there in less than 1 of 100 cases",
        "matched",
    )
    outliers: tuple[int, ...] = quantity(
        "1",
        "fitted events that the fit disregarded: no partner, or beyond three times the scale of the differences",
        "outlier",
    )
    misfit: float = quantity("1", "sum over the fitted events of trust times ln(1 + difference in units)")
    by_chance: float = quantity("1", "trials expected to match as well if the events lay at random")


@record
class Identification:
    """What the events say about the parameters; the iterations of its cost are branches followed."""

    headline = ("trials", "by_chance")

    events: tuple[Event, ...] = quantity("", "the events as given")
    trials: int = quantity("1", "trials scanned")
    reduction: str = quantity("", "what was left out at first, and why")
    cost: Cost
    message: str
    converged: bool = quantity(
        "1",
        "whether more events agree than there are unknowns, those not fitted included, and by_chance is below 0.01",
        default=False,
    )
    best: Candidate | None = quantity(
        "",
        "refined, with round values; None if no trial has any of the events that were tried as the exact one",
        default=None,
    )
    refined: Candidate | None = quantity("", "the same before rounding", default=None)
    roundings: tuple[Rounding, ...] = quantity("", "what rounding cost and is worth", default=())
    competitors: tuple[Candidate, ...] = quantity(
        "", "other refined trials, the better first, that are not the same parameters", default=()
    )
    by_chance: float = quantity(
        "1",
        "trials expected to match as well as the refined one if the events lay at random",
        default=math.nan,
    )
    directions: tuple[Direction, ...] = quantity(
        "", "singular directions of the unknowns, the best seen first", default=()
    )
    unseen: tuple[str, ...] = quantity(
        "",
        "unknowns, or unknowns together, that the matched events cannot see, and known parameters that none depends on",
        default=(),
    )
    error: float = quantity(
        "1",
        "median difference of the fitted events that agree, in units of their last decimals",
        default=math.nan,
    )

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
