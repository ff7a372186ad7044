r"""What a series leaves out of the motion: figures of the motion once more with many more harmonics.

A jump is carried from the series of order n to one of order N, by Newton's method on the fold itself
(`dynamics.carried_point`); N is at least twice n, and so large that what lies beyond answers with at most a twentieth
of what lies beyond n (`flankfilm.coupling.vibration.series`). The next four harmonics count by the exact derivatives of
the fold at N. Jumps that only the longer series has follow from its own branches of period 1.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import dynamics
from base import Array
from flankfilm.coupling.drive.pair_drive import PairDrive
from flankfilm.coupling.vibration.harmonics import harmonics_of
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.series import MOST_HARMONICS, MeshSeries, left_out

BEYOND = 4
"""Harmonics beyond the longer series that count by derivatives."""

LEAST_ORDER = 8
"""Lowest order of the longer series."""

FADED = 0.05
"""What the longer series may leave out of the motion, over what the series leaves out."""

SAME = 1e-7
"""Relative difference of two frequencies below which they are one jump's."""

SEARCHES = 5
"""Frequencies at which orbits of the longer series are searched for."""

ASIDE = 3
"""Points along a branch from a fold to where the branch of the longer series is looked for."""


@dataclass(frozen=True, eq=False)
class Longer:
    """Oscillator of a pair or of its drive train with the longer series.

    Attributes
    ----------
    oscillator : GearOscillator or DriveOscillator
    extended : GearOscillator or DriveOscillator
        With room for further harmonics, of amplitude zero at their phases.
    beyond : tuple of float
        Amplitudes that these have.
    """

    oscillator: Any
    extended: Any
    beyond: tuple[float, ...]

    @property
    def order(self) -> int:
        """Highest harmonic."""
        return int(self.oscillator.contact_stiffness.order)

    def carried(
        self, oscillator: dynamics.GearOscillator, point: dynamics.SpecialPoint
    ) -> dynamics.SpecialPoint | None:
        """A jump over the frequency with the longer series; None where there is no such jump."""
        return dynamics.carried_point(oscillator, "frequency", point, self.oscillator.contact_stiffness)

    def truncation(self, point: dynamics.SpecialPoint, carried: dynamics.SpecialPoint | None) -> float:
        """Relative error of a jump's frequency from the truncated series; infinite where there is no such jump."""
        if carried is None:
            return math.inf
        names = [f"stiffness.amplitudes[{self.order + j}]" for j in range(len(self.beyond))]
        slopes = dynamics.special_sensitivities(self.extended, "frequency", carried, names)
        rest = math.fsum(abs(slopes[name] * a) for name, a in zip(names, self.beyond, strict=True))
        off = abs(carried.parameter - point.parameter) + rest
        return off / carried.parameter if math.isfinite(off) else math.inf


@dataclass(frozen=True)
class MissedJump:
    """A jump that the longer series has alone.

    Attributes
    ----------
    frequency : float
        Mesh frequency over the natural one.
    rising : bool
        Whether the motion ends as the speed rises.
    label : str
        The motion that ends.
    width : float
        Relative distance to the next fold of the same branch: over so much speed the motion that is missed exists
        beside others; infinite where there is no other fold.
    """

    frequency: float
    rising: bool
    label: str
    width: float


def longer_motion(
    motion: PairOscillator | PairDrive, bounds: tuple[float, float], least: int = LEAST_ORDER
) -> Longer | None:
    """Oscillator with the longer series for a range of the mesh frequency; None where the series was given."""
    series, oscillator = motion.series, motion.oscillator
    if series.fit is None:
        return None
    order = max(least, longer_order(series, bounds, motion.rigid.oscillator.damping_ratio))
    whole = with_order(motion, order + BEYOND).contact_stiffness
    first, beyond = whole.amplitudes[:order], whole.amplitudes[order:]
    shorter = replace(whole, amplitudes=first, phases=whole.phases[:order])
    extended = replace(whole, amplitudes=first + (0.0,) * BEYOND)
    return Longer(
        oscillator.with_contact_stiffness(shorter), oscillator.with_contact_stiffness(extended), beyond
    )


def longer_order(series: MeshSeries, bounds: tuple[float, float], damping_ratio: float) -> int:
    """Order of the longer series."""
    assert series.fit is not None
    order = series.order
    with np.errstate(divide="ignore"):
        motion = left_out(np.array(series.fit.harmonics), bounds, damping_ratio).motion
    assert motion is not None
    faded = int(np.argmax(motion <= FADED * motion[min(order, motion.size - 1)]))
    return max(2 * order, LEAST_ORDER, min(faded, MOST_HARMONICS))


def with_order(motion: PairOscillator | PairDrive, order: int) -> Any:
    """Oscillator of a pair or of its drive train with the series of another order."""
    series, oscillator = motion.series, motion.oscillator
    own = oscillator.contact_stiffness
    assert series.cycle is not None
    fitted = harmonics_of(series.cycle, series.kind).fit(order).stiffness
    amplitudes = tuple(a / fitted.mean * own.mean for a in fitted.amplitudes)
    return oscillator.with_contact_stiffness(dynamics.FourierStiffness(own.mean, amplitudes, fitted.phases))


def longer_branches(
    longer: Longer,
    diagram: dynamics.Diagram,
    carried: Iterable[tuple[dynamics.SpecialPoint, dynamics.SpecialPoint | None]],
) -> dynamics.Diagram:
    """Branches of period 1 with the longer series: by searches, and from beside the jumps and the stable motions known.

    Parameters
    ----------
    longer : Longer
    diagram : Diagram
        With the series itself.
    carried : iterable
        Its jumps, each with that of the longer series.
    """
    starts = [(s.value, s.state, 1) for s in diagram.stretches(stable=True) if s.periods == 1]
    for point, there in carried:
        if there is not None and point.periods == 1:
            starts += _beside(diagram, point, there)
    return dynamics.diagram(
        longer.oscillator,
        "frequency",
        diagram.bounds,
        periods=(1,),
        searches=SEARCHES,
        swept=0,
        max_period=1,
        starts=starts,
    )


def _beside(
    diagram: dynamics.Diagram, point: dynamics.SpecialPoint, there: dynamics.SpecialPoint
) -> list[tuple[float, Array, int]]:
    """Points of a fold's branch on both sides of it, moved with it."""
    starts = []
    for branch in diagram.branches:
        if not any(point is fold for fold in branch.points):
            continue
        size = float(np.max(np.abs(branch.states)))
        off = np.max(np.abs(branch.states - point.state), axis=1) / size
        nearest = int(np.argmin(off + np.abs(branch.values / point.parameter - 1.0)))
        for at in (nearest - ASIDE, nearest + ASIDE):
            if 0 <= at < len(branch.values):
                value = float(branch.values[at]) + there.parameter - point.parameter
                starts.append((value, branch.states[at] + there.state - point.state, 1))
    return starts


def missed_jumps(
    diagram: dynamics.Diagram,
    jumps: Iterable[tuple[dynamics.SpecialPoint, str, bool]],
    carried: Iterable[float],
) -> tuple[MissedJump, ...]:
    """Jumps of the longer series that no jump was carried to.

    Parameters
    ----------
    diagram : Diagram
        Branches with the longer series.
    jumps : iterable
        Their jumps: fold, motion that ends, and whether it ends as the speed rises.
    carried : iterable of float
        Frequencies that the jumps of the series were carried to.
    """
    known = list(carried)
    return tuple(
        MissedJump(point.parameter, rising, label, _width(diagram, point))
        for point, label, rising in jumps
        if not any(abs(point.parameter / frequency - 1.0) < SAME for frequency in known)
    )


def _width(diagram: dynamics.Diagram, point: dynamics.SpecialPoint) -> float:
    """Relative distance of a fold to the next one along its branch."""
    for branch in diagram.branches:
        folds = branch.special("saddle-node")
        places = [fold.parameter for fold in folds]
        at = next((k for k, fold in enumerate(folds) if fold is point), None)
        if at is not None:
            beside = [places[k] for k in (at - 1, at + 1) if 0 <= k < len(places)]
            return min((abs(place / point.parameter - 1.0) for place in beside), default=math.inf)
    return math.inf
