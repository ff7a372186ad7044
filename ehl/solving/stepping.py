"""A film from one moment to the next: a formula of second order backwards in time, on nodes that follow the load."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from base import Array
from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Grid, Groups, centre_gap, fluxes
from ehl.discrete.newton import Iteration, newton
from ehl.discrete.squeeze import Content, Squeeze
from ehl.discrete.supply import Meniscus
from ehl.solving.levels import Figures, Level, figures, open_gap
from ehl.solving.plan import Plan, expected_film

_MOST_ITERATIONS = 25
_DONE = 1e-7  # last step of Newton's method: films of one step must differ by more than they are off


@dataclass(frozen=True)
class Moment:
    """A film at one time."""

    time: float  # [s]
    level: Level
    content: Array  # of each node's volume, cavities filled in part (n,) [m2]
    middles: Array  # of the cells (n-1,) [m]

    @property
    def figures(self) -> Figures:
        """Headline figures [m]."""
        return figures(self.level)

    @property
    def unit(self) -> float:
        """Time in which oil goes once the film's scale [s]."""
        return self.level.groups.length / self.level.contact.entrainment

    @property
    def film(self) -> Array:
        """Gap at the nodes [m]."""
        return self.level.solution.H * self.level.groups.gap

    @property
    def pressure(self) -> Array:
        """Pressure at the nodes [Pa]."""
        return self.level.solution.P * self.level.groups.pressure

    @property
    def centre(self) -> float:
        """Gap at x = 0 [m]."""
        level = self.level
        return centre_gap(level.grid, level.groups, level.solution.P, level.solution.H0) * level.groups.gap


def steady(time: float, level: Level) -> Moment:
    """Begin with a steady film: behind its end oil fills the gap in part, so that the flow is the same."""
    content = Content.of(level.grid, level.groups, level.solution.P, level.solution.H0)
    end = int(np.flatnonzero(level.solution.P > 0.0)[-1])
    oil = content.oil.copy()
    lengths = level.grid.weights * level.groups.length
    oil[end + 1 :] = np.minimum(oil[end + 1 :], level.flow * lengths[end + 1 :])
    return Moment(time, level, oil, content.middles)


@dataclass(frozen=True)
class Laying:
    """How nodes follow the contact: as the plan of the first film would have them for each moment's film."""

    contact: LineContact  # that the plan was laid for
    plan: Plan
    nodes: int
    supply: Meniscus | None

    def grid(self, contact: LineContact) -> tuple[Plan, Grid]:
        """Return the plan and the grid for a contact."""
        moved = self.plan.moved(expected_film(contact) / expected_film(self.contact))
        if self.supply is not None:
            moved = moved.with_inlet(self.supply.position / contact.half_width)
        return moved, moved.grid(self.nodes)


def extrapolated(moments: list[Moment], time: float, values: list[Array]) -> Array:
    """Values at a later time by the parabola through the last three moments', or what fewer give."""
    times = [moment.time for moment in moments[-3:]]
    out = np.zeros_like(values[-1])
    for i, (at, value) in enumerate(zip(times, values[-3:], strict=True)):
        weight = 1.0
        for j, other in enumerate(times):
            if j != i:
                weight *= (time - other) / (at - other)
        out += weight * value
    return out


def backwards(moments: list[Moment], time: float) -> tuple[float, float, float]:
    """Factors of the value now, one and two moments ago in the derivative now [1/s]; of first order at the first step.

    A load that begins to change at the first moment has a kink there, which a formula over three would smear.
    """
    step = time - moments[-1].time
    if len(moments) == 1:
        return 1.0 / step, -1.0 / step, 0.0
    ratio = step / (moments[-1].time - moments[-2].time)
    return (
        (1.0 + 2.0 * ratio) / (1.0 + ratio) / step,
        -(1.0 + ratio) / step,
        ratio**2 / (1.0 + ratio) / step,
    )


def advance(moments: list[Moment], time: float, contact: LineContact, laying: Laying) -> Moment | None:
    """Solve the film at a later time; None where Newton's method finds none, or where it breaks ahead of its end."""
    plan, grid = laying.grid(contact)
    groups = Groups.on(contact, grid)
    now, by_last, by_before = backwards(moments, time)
    last = moments[-1]
    before = moments[-2] if len(moments) > 1 else last
    middles = 0.5 * groups.length * (grid.nodes[1:] + grid.nodes[:-1])
    squeeze = Squeeze(
        grid=grid,
        groups=groups,
        rate=now,
        past=-by_last * last.content - by_before * before.content,
        velocity=(now * middles + by_last * last.middles + by_before * before.middles) / contact.entrainment,
        speed=contact.entrainment,
    )
    P, H0 = _start(moments, time, grid, groups)
    solution = newton(grid, groups, P, H0, squeeze=squeeze, max_iterations=_MOST_ITERATIONS, done=_DONE)
    if not solution.converged:
        return None
    level = Level(contact, plan, grid, replace(solution, factors=None))
    content = _contents(level, squeeze)
    return None if content is None else Moment(time, level, content, middles)


def _start(moments: list[Moment], time: float, grid: Grid, groups: Groups) -> tuple[Array, float]:
    """Pressures and separation to start from, extrapolated from former moments."""
    pressure = extrapolated(moments, time, [moment.pressure for moment in moments[-3:]])
    last = moments[-1].pressure
    P = np.where(last > 0.0, np.clip(pressure, 0.2 * last, 5.0 * last), 0.0) / groups.pressure
    centre = float(extrapolated(moments, time, [np.array(moment.centre) for moment in moments[-3:]]))
    centre = max(centre, 0.5 * moments[-1].centre)
    return P, open_gap(grid, groups, P, centre / groups.gap)


def _contents(level: Level, squeeze: Squeeze) -> Array | None:
    """Contents at the end of a step: full in the film; behind it what the flow brings less what it takes along.

    In the cavity oil goes with u, from the node upstream of a middle that is slower, downstream of one that is faster.
    Where bodies part so fast that pressure ahead of the film falls to ambient, the bath keeps the gap full.
    """
    solution: Iteration = level.solution
    grid, groups = level.grid, level.groups
    end = int(np.flatnonzero(solution.P > 0.0)[-1])
    if not (solution.P[int(np.argmax(solution.P)) : end] > 0.0).all():
        return None  # the film breaks behind its maximum pressure
    full = Content.under(grid, groups, solution.P, solution.H).oil
    flux = (
        fluxes(grid, groups, solution.P, solution.H, grid.quick)[0] + squeeze.swept(solution.P, solution.H)[0]
    )
    scale = groups.gap * squeeze.speed
    lengths = grid.weights * groups.length
    past = squeeze.past  # (n,) so that rate C - past is the change
    filled = full.copy()
    inflow = -float(flux[end]) * scale
    n = full.size
    former = np.maximum(past / squeeze.rate, 0.0) / lengths
    for i in range(end + 1, n):
        away = squeeze.speed * (1.0 - float(squeeze.velocity[min(i, n - 2)]))
        taken = max(away, 0.0)
        back = max(-away, 0.0) * former[min(i + 1, n - 1)]
        content = (inflow + back + past[i]) / (squeeze.rate + taken / lengths[i])
        filled[i] = min(max(content, 0.0), full[i])
        inflow = taken * filled[i] / lengths[i] - back
    return filled
