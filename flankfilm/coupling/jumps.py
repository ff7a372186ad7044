"""Bifurcation diagram of a pair over its speed: ranges, jumps with their error budgets, dynamic factors."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

import dynamics
import gears
from base import Array, Cost, Stopwatch, described, part, quantity, record, unclocked
from flankfilm.coupling.motion import frequencies_of
from flankfilm.coupling.oscillator import PairOscillator
from flankfilm.coupling.series import OTHER, MeshSeries, arc_fit

if TYPE_CHECKING:
    from dynamics.branch import Stretch

MEANS = {"secant": "mean_secant_stiffness", "tangent": "mean_stiffness"}
"""Figure of a mesh cycle that is the mean of a kind of stiffness."""

DROPPED = 4
"""Harmonics beyond the series that the error budget looks at."""


@dataclass(frozen=True)
class Jump:
    """End of a stable motion at a saddle node, where the motion jumps.

    Attributes
    ----------
    frequency : float
        Mesh frequency over the natural frequency.
    rising : bool
        Whether the motion ends as the speed rises.
    label : str
        The motion that ends.
    budget : mapping
        Source of error to relative error of the speed: ``"stiffness"`` of meshes, arcs and films, ``"series"`` of what
        its order leaves out, ``"flow"``; empty for an oscillator in its own units.
    second : float
        Relative change of the speed by the first harmonic that the series leaves out, to first order; 0 if none.
    """

    frequency: float
    rising: bool
    label: str
    budget: Mapping[str, float]
    second: float

    @property
    def error(self) -> float:
        """Sum of the budget."""
        return math.fsum(self.budget.values())


@record
class SpeedDiagram:
    """Branches of periodic motions over the mesh frequency, and what follows from them."""

    headline = ("branches", "jump_count")

    diagram: dynamics.Diagram = part("branches over the frequency")
    speed_of_one: float | None = quantity("rad/s", "pinion speed of frequency 1", shown="rpm")
    stable: tuple[Stretch, ...] = part("stable motions with their ranges")
    separated: tuple[tuple[float, float], ...] = part(
        "ranges of frequency in which some stable motion loses contact"
    )
    back_contact: tuple[tuple[float, float], ...] = part(
        "ranges of frequency in which some stable motion touches the back flank"
    )
    jumps: tuple[Jump, ...] = part("where a stable motion ends")
    variants: Mapping[str, tuple[float, ...]] = part(
        "jump frequencies with another law of stiffness or a longer series, by name"
    )
    force_frequency: Array = quantity("1", "mesh over natural frequency", "force")
    force_factor: Array = quantity("1", "greatest force of a stable motion over the mean force", "force")
    force_factor_iso6336: Array = quantity("1", "K_v after ISO 6336-1, method B; nan without a pair", "force")
    half_backlash: float = quantity("1", "half the backlash D")
    error: float
    cost: Cost
    converged: bool
    message: str

    @described("1", "jump")
    def jump_frequency(self) -> Array:
        """Frequencies at which a stable motion ends in a saddle node."""
        return np.array([jump.frequency for jump in self.jumps])

    @described("1", "jump")
    def jump_error(self) -> Array:
        """Relative errors of the jump speeds; nan for an oscillator in its own units."""
        return np.array([jump.error if jump.budget else np.nan for jump in self.jumps])

    @described("rad/s", "jump", shown="rpm", error="jump_error")
    def jump_speed(self) -> Array | None:
        """Pinion speeds at which a stable motion ends; None for an oscillator in its own units."""
        return None if self.speed_of_one is None else self.speed_of_one * self.jump_frequency

    @property
    def branches(self) -> int:
        """Number of branches."""
        return len(self.diagram.branches)

    @property
    def jump_count(self) -> int:
        """Number of jumps."""
        return len(self.jumps)


def jump_speeds(
    motion: PairOscillator,
    speed: tuple[float, float] | None = None,
    *,
    frequency: tuple[float, float] | None = None,
    searches: int = 9,
    max_period: int = 8,
) -> SpeedDiagram:
    """Every branch of periodic motions over a range of speed, with the jumps and what their speeds err by.

    Parameters
    ----------
    motion : PairOscillator
        With the mesh cycle that its series is of, the errors of the jump speeds follow; with the pair K_v.
    speed : (float, float)
        Range of the pinion speed [rad/s].
    frequency : (float, float)
        Instead of it: of the mesh frequency over the natural one.
    searches, max_period : int
        As of `dynamics.diagram`.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> from flankfilm.coupling import PairOscillator, given_series
    >>> series = given_series(1.0, [0.18], [0.0])
    >>> oscillator = GearOscillator(series.stiffness, 0.05, 0.1, 0.2, 0.5, 0.2)
    >>> found = jump_speeds(
    ...     PairOscillator(oscillator, None, series), frequency=(0.5, 0.7), searches=3, max_period=1
    ... )
    >>> [round(float(jump), 4) for jump in found.jump_frequency]
    [0.5694, 0.6556]
    """
    with unclocked():
        from dynamics import diagram
    watch = Stopwatch()
    low, high = frequencies_of(motion, speed, frequency)[0].tolist()
    oscillator, scales = motion.oscillator, motion.scales
    found = diagram(oscillator, "frequency", (low, high), searches=searches, max_period=max_period)
    stable = tuple(found.stretches(stable=True))
    value, force, standard = _factors(motion, found)
    return SpeedDiagram(
        diagram=found,
        speed_of_one=None if scales is None else scales.speed(1.0),
        stable=stable,
        separated=_union([s for s in stable if _counts(s.label)[0] > 0]),
        back_contact=_union([s for s in stable if _counts(s.label)[1] > 0]),
        jumps=tuple(_jump(motion, stretch, point) for stretch, point in jump_points(found)),
        variants=_variants(motion, (low, high)),
        force_frequency=value,
        force_factor=force,
        force_factor_iso6336=standard,
        half_backlash=oscillator.half_backlash,
        error=found.error,
        cost=Cost(watch.seconds),
        converged=found.converged,
        message=found.message,
    )


def jump_points(found: dynamics.Diagram) -> list[tuple[Stretch, dynamics.SpecialPoint]]:
    """Saddle nodes at which a stable stretch ends, by frequency."""
    ends = ((stretch, point) for stretch in found.stretches(stable=True) for point in stretch.limits)
    return sorted((e for e in ends if e[1].kind == "saddle-node"), key=lambda end: end[1].parameter)


def _jump(motion: PairOscillator, stretch: Stretch, point: dynamics.SpecialPoint) -> Jump:
    """Carry the errors of the stiffness through the exact derivatives of a jump's speed.

    The speed is the frequency times sqrt(k_m): half the relative error of the mean stiffness, less what the mean
    force, which is over k_m, changes of the frequency. The amplitudes over the mean err by errors of their own.
    """
    rising = stretch.high - point.parameter < point.parameter - stretch.low
    series, oscillator = motion.series, motion.oscillator
    if series.fit is None:
        return Jump(point.parameter, rising, stretch.label, {}, 0.0)
    order = series.order
    extended, dropped = _longer(motion, order + DROPPED)
    slopes = dynamics.special_sensitivities(extended, "frequency", point)
    here = point.parameter
    force = abs(0.5 - slopes["mean_force"] * oscillator.mean_force / here)
    amplitudes = (*oscillator.stiffness.amplitudes, *dropped)
    steep = [slopes[f"stiffness.amplitudes[{j}]"] / here for j in range(len(amplitudes))]
    left = [rate * a for rate, a in zip(steep[order:], dropped, strict=True)]
    mean, off = _stiffness_errors(series)
    budget = {
        "stiffness": mean * force + float(np.abs(steep[:order]) @ off),
        "series": math.fsum(map(abs, left)),
        "flow": point.error,
    }
    return Jump(here, rising, stretch.label, budget, left[0] if left else 0.0)


def _stiffness_errors(series: MeshSeries) -> tuple[float, Array]:
    """Relative error of the mean, and errors of the amplitudes over the mean, by meshes, arcs and films.

    Zero where a model's are unknown.
    """
    assert series.cycle is not None
    mean = series.cycle.errors[MEANS[series.kind]]
    amplitudes = np.zeros(series.order) if series.harmonic_error is None else series.harmonic_error
    return mean or 0.0, amplitudes


def _longer(motion: PairOscillator, order: int) -> tuple[dynamics.GearOscillator, tuple[float, ...]]:
    """Oscillator with room for further harmonics, of amplitude zero at their phases, and the amplitudes they have."""
    assert motion.series.cycle is not None
    own = motion.oscillator.stiffness
    whole = arc_fit(motion.series.cycle, motion.series.kind, order).stiffness
    further = tuple(a / whole.mean for a in whole.amplitudes[own.order :])
    series = dynamics.FourierStiffness(
        own.mean, own.amplitudes + (0.0,) * len(further), own.phases + whole.phases[own.order :]
    )
    return replace(motion.oscillator, stiffness=series), further


def _variants(motion: PairOscillator, bounds: tuple[float, float]) -> dict[str, tuple[float, ...]]:
    """Jump frequencies with the other law of stiffness and with one more harmonic, in this motion's frequency."""
    series, scales = motion.series, motion.scales
    if series.cycle is None or scales is None:
        return {}
    kind, order, found, k_m = series.kind, series.order, {}, scales.mean_stiffness
    for law, number in ((kind, order), (kind, order + 1), (OTHER[kind], order)):
        fitted = arc_fit(series.cycle, law, number).stiffness
        over = dynamics.FourierStiffness(
            fitted.mean / k_m, tuple(a / k_m for a in fitted.amplitudes), fitted.phases
        )
        changed = replace(motion.oscillator, stiffness=over)
        ends = jump_points(
            dynamics.diagram(changed, "frequency", bounds, periods=(1,), searches=5, max_period=1)
        )
        found[f"{law}, order {number}, mean {over.mean:.4f}"] = tuple(point.parameter for _, point in ends)
    return found


def _factors(motion: PairOscillator, found: dynamics.Diagram) -> tuple[Array, Array, Array]:
    """Frequency, greatest force over the mean force along stable branches of period 1 and 2, ISO 6336-1's K_v."""
    from dynamics.motions import force_range

    rows = []
    for branch in found.branches:
        for value, state, stable in zip(branch.values, branch.states, branch.stable, strict=True):
            if stable and branch.periods <= 2 and motion.oscillator.mean_force != 0.0:
                here = motion.oscillator.with_parameter("frequency", float(value))
                rows.append((float(value), force_range(here, state, branch.periods).greatest))
    curve = np.array(sorted(rows)).reshape(-1, 2)
    return curve[:, 0], curve[:, 1], _standard(motion, curve[:, 0])


def _standard(motion: PairOscillator, frequency: Array) -> Array:
    """K_v after ISO 6336-1, method B; the pitch deviation is the peak-to-peak value of the unloaded error."""
    scales, pair = motion.scales, motion.pair
    if scales is None or pair is None:
        return np.full(len(frequency), np.nan)
    reliefs = [gear.tip_relief.amount for gear in (pair.pinion, pair.wheel) if gear.tip_relief is not None]
    factor = gears.closed_form.iso6336_dynamic(
        pair,
        motion.force,
        scales.equivalent_mass,
        scales.speed(1.0) * frequency,
        pitch_deviation=2.0 * motion.error_amplitude,
        relief=max(reliefs, default=0.0),
    )
    return np.asarray(factor.K_v)


def _counts(label: str) -> tuple[int, int]:
    """Losses of contact and contacts of the back flank in a label."""
    _, p, q = label.removeprefix("U").split("-")
    return int(p), int(q)


def _union(parts: list[Stretch]) -> tuple[tuple[float, float], ...]:
    """Ranges covered by stretches, joined where they touch or overlap."""
    joined: list[tuple[float, float]] = []
    for low, high in sorted((s.low, s.high) for s in parts):
        if joined and low <= joined[-1][1] * (1.0 + 1e-9):
            joined[-1] = (joined[-1][0], max(high, joined[-1][1]))
        else:
            joined.append((low, high))
    return tuple(joined)
