"""What is given to the inverse problem: printed special points, and what may be assumed of each parameter."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from base import Array, Faults, Limit
from dynamics.branches.branch import KINDS, SpecialPoint
from dynamics.model.limits import NUMBER, ordered
from dynamics.model.oscillator import GearOscillator

MAX_TRIALS = 100_000  # combinations of trial values


@dataclass(frozen=True)
class Event:
    """A special point that somebody reports.

    Parameters
    ----------
    kind : str
        "saddle-node", "period-doubling" or "grazing".
    label : str
        Motion n-p-q at the point; a star for what is not said, as in "2-*-*".
    value : float
        Parameter value as printed.
    digits : int
        Decimals printed.
    fitted : bool
        Whether it may be used to find parameters; the others are only scored.
    trust : float
        Weight, above 0 and up to 1.
    branch : str
        Events that name the same branch lie on one branch, in the order in which they are given, or all in the
        opposite one. Empty: nothing is said.
    """

    kind: str
    label: str
    value: float
    digits: int
    fitted: bool = True
    trust: float = 1.0
    branch: str = ""

    @property
    def unit(self) -> float:
        """One unit of the last decimal."""
        return float(10.0**-self.digits)

    @property
    def fields(self) -> tuple[str, ...]:
        """Periods, exits from X > D, entries into X < -D, as written."""
        return tuple(self.label.split("-"))

    @property
    def periods(self) -> int | None:
        """Period of the orbit; None if it is not said."""
        return None if self.fields[0] == "*" else int(self.fields[0])

    @property
    def one_sided(self) -> bool:
        """Whether the motion is said not to touch the back flank."""
        return self.fields[2] == "0"

    def fits(self, point: SpecialPoint) -> bool:
        """Whether a special point is of this kind and label."""
        return point.kind == self.kind and self.names(point.label)

    def names(self, label: str) -> bool:
        """Whether a label, stable or not, is the one meant."""
        parts = label.removeprefix("U").split("-")
        return all(mine in ("*", theirs) for mine, theirs in zip(self.fields, parts, strict=True))

    def loss(self, computed: float, width: float) -> float:
        r"""What a difference costs: :math:`t \ln(1 + |\mu - \mu_e| / u)`, no partner as much as the whole width.

        The logarithm is, but for a constant, minus that of a density :math:`1 / (u + |\mu - \mu_e|)`: small errors are
        likely, errors of any order of magnitude are possible. So one misprint costs a bounded amount.

        Parameters
        ----------
        computed : float
            Computed value; nan if there is none.
        width : float
            Range of the parameter.
        """
        off = width if math.isnan(computed) else min(abs(computed - self.value), width)
        return self.trust * math.log1p(off / self.unit)


@dataclass(frozen=True)
class Ranged:
    """A parameter that lies in a range.

    Parameters
    ----------
    low, high : float
        The range.
    trials : int
        Values that are tried first: the middles of equal intervals, in equal ratios if both ends are positive.
    """

    continuous: ClassVar = True

    low: float
    high: float
    trials: int = 4

    def check(self, faults: Faults, path: str) -> None:
        """Note what is not allowed."""
        ordered(faults, path, (self.low, self.high), "give Ranged(low, high)")
        faults.whole(f"{path}.trials", self.trials, 1, 10_000, "4 is usual")

    @property
    def middle(self) -> float:
        """Middle of the range, in equal ratios if both ends are positive."""
        return math.sqrt(self.low * self.high) if self.low > 0.0 else 0.5 * (self.low + self.high)

    @property
    def values(self) -> tuple[float, ...]:
        """Values that are tried first."""
        share = (np.arange(self.trials) + 0.5) / self.trials
        if self.low > 0.0:
            return tuple(float(x) for x in self.low * (self.high / self.low) ** share)
        return tuple(float(x) for x in self.low + share * (self.high - self.low))


@dataclass(frozen=True)
class OneOf:
    """A parameter that has one of several values, round ones for instance.

    Parameters
    ----------
    values : sequence of float
        All are tried, and the result is one of them.
    """

    continuous: ClassVar = False

    values: Sequence[float]

    def check(self, faults: Faults, path: str) -> None:
        """Note what is not allowed."""
        if len(self.values) == 0:
            faults.add(f"{path}.values", (), "must hold at least one value", "give the values to try")
        for i, value in enumerate(self.values):
            faults.number(f"{path}.values[{i}]", value, NUMBER)

    @property
    def middle(self) -> float:
        """The middle value."""
        return float(sorted(self.values)[len(self.values) // 2])

    @property
    def low(self) -> float:
        """Minimum value."""
        return float(min(self.values))

    @property
    def high(self) -> float:
        """Maximum value."""
        return float(max(self.values))


Unknown = Ranged | OneOf


@dataclass(frozen=True, eq=False)
class Problem:
    """Events in one parameter, the unknowns among the others, and the oscillator that holds the rest.

    Parameters
    ----------
    oscillator : GearOscillator
        Its values of `parameter` and of the unknowns are not used.
    parameter : str
        Parameter in which the events are given.
    events : tuple of Event
        The events.
    unknowns : dict
        Name to range or choice.
    bounds : tuple of float
        Range of the parameter.
    """

    oscillator: GearOscillator
    parameter: str
    events: tuple[Event, ...]
    unknowns: dict[str, Unknown]
    bounds: tuple[float, float]

    @property
    def width(self) -> float:
        """Of the bounds."""
        return self.bounds[1] - self.bounds[0]

    @property
    def fitted(self) -> tuple[int, ...]:
        """Indices of the events that may be used."""
        return tuple(i for i, event in enumerate(self.events) if event.fitted)

    @cached_property
    def printed(self) -> Array:
        """Value of each event."""
        return np.array([event.value for event in self.events])

    @cached_property
    def units(self) -> Array:
        """Unit of the last decimal of each event."""
        return np.array([event.unit for event in self.events])

    @cached_property
    def trust(self) -> Array:
        """Weight of each event."""
        return np.array([event.trust for event in self.events])

    def misfit(self, computed: Sequence[float] | Array, rows: Iterable[int] | None = None) -> float:
        """Sum of the losses of events (the fitted ones if none are named) with computed values, nan for none."""
        wanted = self.fitted if rows is None else rows
        return math.fsum(self.events[i].loss(float(computed[i]), self.width) for i in wanted)


def checked(
    oscillator: GearOscillator, parameter: str, events: Sequence[Event], unknowns: Mapping[str, Unknown],
    bounds: tuple[float, float],
) -> Problem:  # fmt: skip
    """Problem of the arguments.

    Raises
    ------
    InputError
        With every fault found.
    """
    faults = Faults()
    oscillator.get(parameter)
    low, high = ordered(faults, "bounds", bounds)
    for i, event in enumerate(events):
        _check_event(faults, f"events[{i}]", event, (low, high))
    for name, unknown in unknowns.items():
        oscillator.get(name)
        if name == parameter:
            faults.add(f"unknowns[{name!r}]", name, "must not be the parameter of the events", "leave it out")
        unknown.check(faults, f"unknowns[{name!r}]")
    if not unknowns:
        faults.add("unknowns", {}, "must hold at least one", "name a parameter and its range")
    faults.raise_if_any()
    if math.prod(len(u.values) for u in unknowns.values()) > MAX_TRIALS:
        allowed = f"must have at most {MAX_TRIALS} combinations"
        faults.add("unknowns", "", allowed, "give fewer trial values")
    fitted = sum(e.fitted for e in events)
    blind = "half_backlash" in unknowns and all(e.one_sided for e in events)
    seen = len(unknowns) - blind
    if fitted < seen or len(events) < seen + 1:
        allowed = f"must hold {seen} fitted ones or more, {seen + 1} in all"
        faults.add("events", f"{fitted} fitted of {len(events)}", allowed, "give one more than unknowns")
    faults.raise_if_any()
    return Problem(oscillator, parameter, tuple(events), dict(unknowns), (low, high))


def _check_event(faults: Faults, path: str, event: Event, bounds: tuple[float, float]) -> None:
    faults.choice(f"{path}.kind", event.kind, KINDS)
    parts = event.label.split("-")
    if len(parts) != 3 or not all(p == "*" or p.isdecimal() for p in parts) or parts[0] == "0":
        allowed = "must be n-p-q, with a star for what is not known"
        faults.add(f"{path}.label", event.label, allowed, 'write "1-1-0" or "2-*-*"')
    faults.number(f"{path}.trust", event.trust, Limit(0.0, 1.0, low_open=True, remedy="1 is full trust"))
    faults.whole(f"{path}.digits", event.digits, 0, 15, "give the decimals printed")
    value = faults.number(f"{path}.value", event.value, NUMBER)
    if not math.isnan(value) and not bounds[0] < value < bounds[1]:
        faults.add(f"{path}.value", event.value, "must be within bounds", "widen the bounds")
