r"""Enumeration by two events of one branch: grazing and period doubling whose ratio needs neither force nor backlash.

In a scan of the error's amplitude the orbit in contact touches at :math:`\varepsilon_{gr}` and the motion that leaves
contact doubles at :math:`\varepsilon_{pd}`. As long as the back flank is not touched only X - D counts, and the
equation is homogeneous in (X - D, F_m, :math:`\varepsilon`): the ratio of the two depends on frequency, damping and
stiffness alone. For every combination of trial values the frequencies are found at which the ratio is that reported;
the force follows. Two events meet two unknowns exactly, so that a solution proves nothing; what counts is whether
frequency and force come out round more often than chance has it.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from itertools import pairwise, product

import numpy as np

from base import Array, Cost, Faults, Stopwatch, quantity, record
from base.results import EXACT
from dynamics.branches.continuation import orbits_over
from dynamics.branches.grazing import ResonanceError, contact_orbit
from dynamics.branches.roots import bracketed
from dynamics.flow.motions import period_map
from dynamics.inverse.events import Event, OneOf
from dynamics.model.oscillator import GearOscillator
from dynamics.orbits.shooting import find_orbit

BEFORE, SETTLE = 0.97, 300
"""Of the doubling's amplitude, where the motion settles, and periods that it takes."""

ONE_SIDED = ("1-1-0", "1-2-0")
"""Motions that do not depend on the backlash."""

ROUND = 0.01
"""Step of the values that count as round."""


@record
class PairScan:
    """Solutions of two events of one branch, and how round they are."""

    headline = ("solutions", "hits", "by_chance")

    names: tuple[str, ...] = quantity("", "unknowns; the last two are solved for", "unknown")
    values: Array = quantity("1", "values of each solution", "solution unknown", error="error")
    rounded: Array = quantity(
        "1", "whether frequency and force are round within their tolerances", "solution", no_error=EXACT
    )
    trials: int = quantity("1", "combinations at which the motion was computed", no_error=EXACT)
    by_chance: float = quantity(
        "1", "solutions that are round by chance, for frequencies and forces spread evenly", no_error=EXACT
    )
    error: float = quantity("1", "relative tolerance of the frequencies solved for")
    cost: Cost
    converged: bool = quantity("1", "whether more than thrice as many solutions are round as chance has it")
    message: str

    @property
    def solutions(self) -> int:
        """How many there are."""
        return len(self.values)

    @property
    def hits(self) -> int:
        """How many are round."""
        return int(np.sum(self.rounded))


def by_two_events(
    oscillator: GearOscillator,
    events: tuple[Event, Event],
    frequencies: OneOf,
    unknowns: Mapping[str, OneOf],
    *,
    near: float = 1e-3,
    progress: Callable[[int, int], None] | None = None,
) -> PairScan:
    """Enumerate what meets a grazing of the orbit in contact and a period doubling over the error's amplitude.

    Parameters
    ----------
    oscillator : GearOscillator
        What is not among the unknowns.
    events : (Event, Event)
        The grazing of 1-0-0 and the period doubling of 1-1-0 or 1-2-0, values of the error's amplitude.
    frequencies : OneOf
        Between which the ratio of both is looked for, rising.
    unknowns : mapping
        Other parameters to values; all combinations are tried.
    near : float
        How near to a multiple of 0.01 a frequency or a force must be to count as round, relative.
    progress : callable, optional
        Called with combinations done and all.

    Raises
    ------
    InputError
        For other events, or no such parameters.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> from dynamics.inverse import Event, OneOf, by_two_events
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.4, 0.4, half_backlash=0.8)
    >>> events = Event("grazing", "1-0-0", 0.55869, 5), Event("period-doubling", "1-2-0", 0.63434, 5)
    >>> pairs = by_two_events(osc, events, OneOf((0.39, 0.41)), {"damping_ratio": OneOf((0.06,))})
    >>> pairs.names, pairs.values.round(3).tolist()
    (('damping_ratio', 'frequency', 'mean_force'), [[0.06, 0.4, 0.1]])
    """
    watch = Stopwatch()
    with Faults() as faults:
        kinds = [(event.kind, event.label) for event in events]
        label = events[1].label
        if kinds[0] != ("grazing", "1-0-0") or kinds[1][0] != "period-doubling" or label not in ONE_SIDED:
            allowed = f"must be a grazing of 1-0-0 and a period-doubling of {' or '.join(ONE_SIDED)}"
            faults.add("events", ", ".join(f"{k} {motion}" for k, motion in kinds), allowed, "name these two")
        for name in unknowns:
            faults.choice("unknowns", name, oscillator.parameters, "name parameters of the oscillator")
    grazing, doubling = events
    ratio = doubling.value / grazing.value
    grid = list(product(*(choice.values for choice in unknowns.values())))
    rows: list[tuple[float, ...]] = []
    trials = 0
    for done, values in enumerate(grid, start=1):
        here = dataclasses.replace(oscillator, mean_force=1.0, half_backlash=1.0, one_sided=True)
        for name, value in zip(unknowns, values, strict=True):
            here = here.with_parameter(name, float(value))
        seen: dict[float, float] = {}

        def flip(frequency: float, here: GearOscillator = here, seen: dict[float, float] = seen) -> float:
            if frequency not in seen:
                seen[frequency] = _flip(here.with_parameter("frequency", frequency), ratio, label)
            return seen[frequency]

        for low, high in pairwise(frequencies.values):
            if flip(low) * flip(high) < 0.0 and (root := bracketed(flip, low, high, xtol=1e-9)) is not None:
                touch = _touch(here.with_parameter("frequency", root))
                rows.append((*values, root, grazing.value / touch))
        trials += len(seen)
        if progress is not None:
            progress(done, len(grid))
    solutions = np.array(rows, dtype=np.float64).reshape(-1, len(unknowns) + 2)
    off = np.abs(solutions[:, -2:] / ROUND - np.round(solutions[:, -2:] / ROUND)) * ROUND
    rounded = np.all(off <= near * solutions[:, -2:], axis=1)
    chance = np.clip(2.0 * near * solutions[:, -2:] / ROUND, 0.0, 1.0)
    expected = float(np.sum(np.prod(chance, axis=1)))
    hits = int(rounded.sum())
    good = hits > 3.0 * expected and hits > 0
    verdict = "more than chance gives" if good else "no better than chance"
    said = f"{len(solutions)} solutions of {trials} trials; {hits} are round, {expected:.2g} by chance: {verdict}"
    names = (*unknowns, "frequency", "mean_force")
    return PairScan(
        names, solutions, rounded, trials, expected, 1e-9, Cost(watch.seconds, 2, trials), good, said
    )


def _touch(here: GearOscillator) -> float:
    """Amplitude of the error at which the orbit in contact touches; nan without one."""

    def clearance(amplitude: float) -> float:
        try:
            return contact_orbit(here.with_parameter("error_amplitude", amplitude)).clearance
        except ResonanceError:
            return math.nan

    high = 0.1
    while not clearance(high) < 0.0:
        high *= 3.0
        if high > 1e5:
            return math.nan
    root = bracketed(clearance, 0.0, high, xtol=1e-12) if clearance(0.0) > 0.0 else None
    return math.nan if root is None else root


def _flip(here: GearOscillator, ratio: float, label: str) -> float:
    """Product of (1 + multiplier) of a motion at a multiple of the touch's amplitude; nan where there is none."""
    touch = _touch(here)
    if not math.isfinite(touch):
        return math.nan
    before = here.with_parameter("error_amplitude", BEFORE * ratio * touch)
    start = contact_orbit(here.with_parameter("error_amplitude", 0.999 * touch)).state
    settled = period_map(before, start, 1, SETTLE)
    orbit = None if settled.message else find_orbit(before, settled.state)
    if orbit is None or not orbit.converged or orbit.label.removeprefix("U") != label:
        return math.nan
    value = ratio * touch
    size = float(np.max(np.abs(orbit.state)))
    problem = orbits_over(here, "error_amplitude", 1, (0.9 * value, 1.1 * value), size)
    point = problem.correct(problem.unknowns(orbit.state, value), problem.flat)
    return math.nan if point is None or point.counts[1] != 0 else float(point.flip)
