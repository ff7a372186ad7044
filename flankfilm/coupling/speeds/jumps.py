"""Bifurcation diagram of a pair over its speed: ranges, jumps with their error budgets, dynamic factors."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

import dynamics
from base import Array, Cost, Stopwatch, described, part, quantity, record, unclocked
from flankfilm.coupling.drive.pair_drive import PairDrive
from flankfilm.coupling.speeds.both_ways import frequencies_of
from flankfilm.coupling.speeds.jump_errors import Jump, alike, rises, stiffness_errors, train_jump
from flankfilm.coupling.speeds.truncation import (
    Longer,
    MissedJump,
    longer_branches,
    longer_motion,
    missed_jumps,
)
from flankfilm.coupling.vibration.harmonics import harmonics_of
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.series import OTHER
from flankfilm.coupling.vibration.speed_ranges import (
    back_contact_ranges,
    changes,
    force_factors,
    separated_ranges,
    standard_factors,
)
from gears.closed_form.record import STANDARD

if TYPE_CHECKING:
    from dynamics.branches.branch import Stretch


@record
class SpeedDiagram:
    """Branches of periodic motions over the mesh frequency, and what follows from them."""

    no_error = "rounding of the exact flow; errors of the stiffness stand with the jumps"

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
    force_factor: Array = quantity("1", "maximum force of a stable motion over the mean force", "force")
    force_factor_iso6336: Array = quantity(
        "1", "K_v after ISO 6336-1, method B; nan without a pair", "force", no_error=STANDARD
    )
    half_backlash: float = quantity("1", "half the backlash D")
    longer_order: int | None = quantity(
        "1", "harmonics of the longer series that truncations are measured with; None for a given series"
    )
    with_longer: dynamics.Diagram | None = part("branches of period 1 with the longer series")
    missed: tuple[MissedJump, ...] = part("jumps of period 1 that only the longer series has")
    truncation: Mapping[str, float] = part(
        "relative change of ranges and maximum force by the longer series, motions of period 1; infinite where unknown"
    )
    error: float
    cost: Cost
    converged: bool
    message: str

    @described("1", "jump", error="jump_error")
    def jump_frequency(self) -> Array:
        """Frequencies at which a stable motion ends in a saddle node."""
        return np.array([jump.frequency for jump in self.jumps])

    @described("1", "jump")
    def jump_error(self) -> Array:
        """Relative errors of the jump speeds; infinite where unknown, nan for a given series."""
        return np.array([jump.error if jump.budget else np.nan for jump in self.jumps])

    @described("rad/s", "jump", shown="rpm", error="jump_error")
    def jump_speed(self) -> Array | None:
        """Pinion speeds at which a stable motion ends; None for an oscillator in its own units."""
        return None if self.speed_of_one is None else self.speed_of_one * self.jump_frequency

    @described("1", error="truncation")
    def greatest_force(self) -> float:
        """Maximum force of a stable motion over the mean force; nan without a mean force."""
        return float(np.max(self.force_factor)) if self.force_factor.size else math.nan

    @property
    def branches(self) -> int:
        """Number of branches."""
        return len(self.diagram.branches)

    @property
    def jump_count(self) -> int:
        """Number of jumps."""
        return len(self.jumps)


def jump_speeds(
    motion: PairOscillator | PairDrive,
    speed: tuple[float, float] | None = None,
    *,
    frequency: tuple[float, float] | None = None,
    searches: int = 9,
    max_period: int = 8,
) -> SpeedDiagram:
    """Every branch of periodic motions over a range of speed, with the jumps and what their speeds err by.

    Parameters
    ----------
    motion : PairOscillator or PairDrive
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
    low, high = frequencies_of(motion.rigid, speed, frequency)[0].tolist()
    oscillator, scales, longer = motion.oscillator, motion.scales, longer_motion(motion, (low, high))
    branches = diagram(oscillator, "frequency", (low, high), searches=searches, max_period=max_period)
    stable = tuple(branches.stretches(stable=True))
    forces = force_factors(oscillator, branches, motion.mean_force)
    ends = jump_points(branches)
    whole = None
    if isinstance(motion, PairDrive):
        whole = None if longer is None else longer_branches(longer, branches, ())
        there = alike(ends, [] if whole is None else jump_points(whole))
        jumps = tuple(
            train_jump(motion, longer, *end, counterpart)
            for end, counterpart in zip(ends, there, strict=True)
        )
    else:
        there = [None if longer is None else longer.carried(motion.oscillator, point) for _, point in ends]
        jumps = tuple(
            _jump(motion, longer, *end, counterpart) for end, counterpart in zip(ends, there, strict=True)
        )
        if longer is not None:
            whole = longer_branches(
                longer,
                branches,
                [(point, counterpart) for (_, point), counterpart in zip(ends, there, strict=True)],
            )
    missed, changed = _with_longer(
        branches,
        forces,
        longer,
        whole,
        [counterpart for counterpart in there if counterpart is not None],
        motion.mean_force,
    )
    return SpeedDiagram(
        diagram=branches,
        speed_of_one=None if scales is None else scales.speed(1.0),
        stable=stable,
        separated=separated_ranges(stable),
        back_contact=back_contact_ranges(stable),
        jumps=jumps,
        variants={} if isinstance(motion, PairDrive) else _variants(motion, branches, whole),
        force_frequency=forces[:, 0],
        force_factor=forces[:, 1],
        force_factor_iso6336=standard_factors(motion.rigid, forces[:, 0]),
        half_backlash=oscillator.half_backlash,
        longer_order=None if longer is None else longer.order,
        with_longer=whole,
        missed=missed,
        truncation=changed,
        error=branches.error,
        cost=Cost(watch.seconds),
        converged=branches.converged,
        message=branches.message,
    )


def jump_points(diagram: dynamics.Diagram) -> list[tuple[Stretch, dynamics.SpecialPoint]]:
    """Saddle nodes at which a stable stretch ends, by frequency."""
    ends = ((stretch, point) for stretch in diagram.stretches(stable=True) for point in stretch.limits)
    return sorted((e for e in ends if e[1].kind == "saddle-node"), key=lambda end: end[1].parameter)


def _jump(
    motion: PairOscillator,
    longer: Longer | None,
    stretch: Stretch,
    point: dynamics.SpecialPoint,
    carried: dynamics.SpecialPoint | None,
) -> Jump:
    """Carry the stiffness' errors through the exact derivatives of a jump's speed, and the jump to more harmonics.

    The speed is the frequency times sqrt(k_m): half the relative error of the mean stiffness, less what the mean
    force, which is over k_m, changes of the frequency. The amplitudes over the mean have separate errors.
    """
    rising, here = rises(stretch, point), point.parameter
    series, oscillator = motion.series, motion.oscillator
    if longer is None:
        return Jump(here, rising, stretch.label, {}, None)
    names = [f"stiffness.amplitudes[{j}]" for j in range(series.order)]
    slopes = dynamics.special_sensitivities(oscillator, "frequency", point, ["mean_force", *names])
    force = abs(0.5 - slopes["mean_force"] * oscillator.mean_force / here)
    steep = np.array([slopes[name] / here for name in names])
    mean, off = stiffness_errors(series)
    budget = {
        "stiffness": mean * force + float(np.abs(steep) @ off),
        "truncation": longer.truncation(point, carried),
        "flow": point.error,
    }
    return Jump(here, rising, stretch.label, budget, math.nan if carried is None else carried.parameter)


def _with_longer(
    diagram: dynamics.Diagram,
    forces: Array,
    longer: Longer | None,
    whole: dynamics.Diagram | None,
    known: Sequence[dynamics.SpecialPoint],
    load: float,
) -> tuple[tuple[MissedJump, ...], Mapping[str, float]]:
    """Jumps that the longer series has alone, and what it changes of other figures."""
    if longer is None or whole is None:
        return (), {}
    own = ((point, stretch.label, rises(stretch, point)) for stretch, point in jump_points(whole))
    missed = missed_jumps(whole, own, [there.parameter for there in known])
    others = force_factors(longer.oscillator, whole, load, longest=1)
    return missed, changes((diagram, whole), (forces, others))


def _variants(
    motion: PairOscillator, diagram: dynamics.Diagram, whole: dynamics.Diagram | None
) -> dict[str, tuple[float, ...]]:
    """Jump frequencies of period 1 with the longer series and with the other law, in this motion's frequency."""
    series, scales = motion.series, motion.scales
    if series.cycle is None or scales is None or whole is None:
        return {}
    other, k_m = (
        harmonics_of(series.cycle, OTHER[series.kind]).fit(series.order).stiffness,
        scales.mean_stiffness,
    )
    stiffness = dynamics.FourierStiffness(
        other.mean / k_m, tuple(a / k_m for a in other.amplitudes), other.phases
    )
    changed = replace(motion.oscillator, stiffness=stiffness)
    alike = dynamics.diagram(changed, "frequency", diagram.bounds, periods=(1,), searches=5, max_period=1)
    laws = ((series.kind, diagram), (series.kind, whole), (OTHER[series.kind], alike))
    return {
        f"{law}, order {fitted.order}, mean {fitted.mean:.4f}": tuple(
            point.parameter for stretch, point in jump_points(branches) if stretch.periods == 1
        )
        for law, branches, fitted in ((*each, each[1].oscillator.contact_stiffness) for each in laws)
    }
