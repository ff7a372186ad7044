"""Order of a series by its jumps: the smallest whose jump speeds err by no more than a tolerance.

It begins with the order that leaves out no more than a share of the curve and of the motion. Where a jump of that
series errs by more than the tolerance, or the longer series has none there, or has further jumps that more than
the tolerance parts from the next fold, the lowest order is taken with which all jumps of the longer series lie within
the tolerance of theirs, and the diagram is built again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

import dynamics
from base import Cost, Stopwatch, part, quantity, record
from base.results import EXACT
from flankfilm.coupling.speeds.jump_errors import Jump
from flankfilm.coupling.speeds.jumps import SpeedDiagram, jump_points, jump_speeds
from flankfilm.coupling.speeds.truncation import SAME, Longer, longer_motion, with_order
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.series import MOST_HARMONICS, MeshSeries, mesh_series

MOST_DIAGRAMS = 4
"""Diagrams that are built at most."""


@record
class OrderedJumps:
    """Diagram with as many harmonics as its jumps need."""

    no_error = EXACT

    headline = ("order", "worst")

    order: int = quantity("1", "highest harmonic of the series")
    tolerance: float = quantity("1", "relative error that jump speeds may have")
    tried: tuple[tuple[int, float], ...] = part("lower orders, with what their jump speeds err by")
    diagram: SpeedDiagram = part("of the series of this order")
    cost: Cost
    converged: bool
    message: str

    @property
    def worst(self) -> float:
        """Largest error of a jump's speed, or of what is missed of one; infinite where unknown."""
        return worst_jump(self.diagram)

    @property
    def error(self) -> float:
        """As `worst`."""
        return self.worst


def worst_jump(speed_diagram: SpeedDiagram) -> float:
    """Largest relative error of a diagram's jump speeds and width of a missed jump; 0 without jumps."""
    return max(
        (*(jump.error for jump in speed_diagram.jumps), *(jump.width for jump in speed_diagram.missed)),
        default=0.0,
    )


def jumps_to_tolerance(
    motion_of: Callable[[MeshSeries], PairOscillator],
    series: MeshSeries,
    tolerance: float,
    speed: tuple[float, float] | None = None,
    *,
    frequency: tuple[float, float] | None = None,
    searches: int = 9,
    max_period: int = 8,
) -> OrderedJumps:
    """Diagram of a pair with the lowest order that its jump speeds allow, from that of a series on.

    Parameters
    ----------
    motion_of : callable
        Gives the oscillator of a series.
    series : MeshSeries
        Of a mesh cycle, with the lowest order that is tried.
    tolerance : float
        Relative error that the jump speeds may have.
    speed, frequency, searches, max_period
        As of `jump_speeds`.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import mesh_cycle, pair_oscillator
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> cycle, played = mesh_cycle(pair, 600.0, model="potential-energy"), pair.with_backlash(50e-6)
    >>> found = jumps_to_tolerance(
    ...     lambda series: pair_oscillator(played, series, 600.0, 800.0, error_amplitude=5e-6),
    ...     mesh_series(cycle, order=2),
    ...     0.015,
    ...     frequency=(0.84, 0.92),
    ...     searches=1,
    ...     max_period=1,
    ... )
    >>> found.order, found.worst < 0.015, found.tried[0][0]
    (3, True, 2)
    """
    watch, tried = Stopwatch(), list[tuple[int, float]]()
    while True:
        motion = motion_of(series)
        speed_diagram = jump_speeds(
            motion, speed, frequency=frequency, searches=searches, max_period=max_period
        )
        met = all(_within(jump, tolerance) for jump in speed_diagram.jumps) and all(
            jump.width <= tolerance for jump in speed_diagram.missed
        )
        if met or series.order >= MOST_HARMONICS or len(tried) + 1 == MOST_DIAGRAMS:
            break
        tried.append((series.order, worst_jump(speed_diagram)))
        assert series.cycle is not None
        order = _next_order(motion, speed_diagram, tolerance)
        series = replace(mesh_series(series.cycle, series.kind, order), left_out=series.left_out)
    worst = worst_jump(speed_diagram)
    message = (
        "" if met else f"jump speeds err by {worst:.2g} with {series.order} harmonics, above {tolerance:g}"
    )
    return OrderedJumps(
        series.order,
        tolerance,
        tuple(tried),
        speed_diagram,
        Cost(watch.seconds),
        speed_diagram.converged and met,
        message,
    )


def _within(jump: Jump, tolerance: float) -> bool:
    """Whether a jump's speed is as exact as asked, or its truncation no longer counts beside its other errors."""
    others = jump.error - jump.budget["truncation"] if math.isfinite(jump.error) else 0.0
    return jump.error <= tolerance or jump.budget["truncation"] <= 0.1 * others


def _next_order(motion: PairOscillator, speed_diagram: SpeedDiagram, tolerance: float) -> int:
    """Lowest higher order with which all jumps of the longer series lie within the tolerance; at most its own."""
    longer = longer_motion(motion, speed_diagram.diagram.bounds)
    assert longer is not None
    others = max(
        (jump.error - jump.budget["truncation"] for jump in speed_diagram.jumps if math.isfinite(jump.error)),
        default=0.0,
    )
    allowed = max(tolerance - others, 0.1 * others)
    points = list(_points(motion, speed_diagram, longer, tolerance))
    for order in range(motion.series.order + 1, longer.order):
        if all(_near(longer, with_order(motion, order), point, allowed) for point in points):
            return order
    return min(longer.order, MOST_HARMONICS)


def _points(
    motion: PairOscillator, speed_diagram: SpeedDiagram, longer: Longer, tolerance: float
) -> Iterator[dynamics.SpecialPoint]:
    """Jumps with the longer series: those that jumps are carried to, and wide ones that it has alone."""
    for _, point in jump_points(speed_diagram.diagram):
        if (carried := longer.carried(motion.oscillator, point)) is not None:
            yield carried
    assert speed_diagram.with_longer is not None
    missed = np.array([jump.frequency for jump in speed_diagram.missed if jump.width > tolerance])
    for _, point in jump_points(speed_diagram.with_longer):
        if np.any(np.abs(missed / point.parameter - 1.0) < SAME):
            yield point


def _near(
    longer: Longer, there: dynamics.GearOscillator, point: dynamics.SpecialPoint, allowed: float
) -> bool:
    """Whether a jump of the longer series has one within a relative distance with another series."""
    carried = dynamics.carried_point(longer.oscillator, "frequency", point, there.stiffness)
    return carried is not None and longer.truncation(carried, point) <= allowed
