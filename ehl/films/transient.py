"""A film under a load that changes with time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from base import Array, Cost, Stopwatch, unclocked
from base.results import WORST
from ehl.discrete.contact import LineContact
from ehl.discrete.method import METHOD
from ehl.discrete.supply import Meniscus
from ehl.films.film import Film
from ehl.films.solver import solve
from ehl.films.transient_film import TransientFilm
from ehl.solving.refinement import refine
from ehl.solving.stepping import Laying
from ehl.solving.time_inputs import OverTime, at_time, checked, jump_fault
from ehl.solving.time_march import JumpError, Shot, TimeMarch

_ROUNDS = 6
_TIME_SHARE = 0.4  # of the tolerance, for the steps of time
_STEPS = 25.0  # of time in one transit, at first
_FIRST_ALLOWED = 2e-5  # local error of a step at first, whatever the tolerance


def solve_transient(
    contact: LineContact,
    load: OverTime,
    time: ArrayLike,
    *,
    entrainment: OverTime | None = None,
    radius: OverTime | None = None,
    tolerance: float = 0.01,
    nodes: int | None = None,
    step: float | None = None,
    supply: Meniscus | None = None,
) -> TransientFilm:
    """Solve the isothermal line contact under a load, speed and radius that change with time.

    Reynolds' equation ``d/dx[rho h^3/(12 eta) dp/dx] = u d(rho h)/dx + d(rho h)/dt`` with the gap and the load of every
    moment, from the steady film at the first time on; backwards in time with second order, by steps of an estimated
    error, on nodes that follow the contact.

    Parameters
    ----------
    contact : LineContact
        Oil, modulus, and whatever does not change; its load is not used.
    load : callable or array_like
        w over time [N/m]: a function of seconds, or values at the times, linear between them.
    time : array_like (n,)
        Times [s], increasing, at which the film is given.
    entrainment, radius : callable or array_like, optional
        u [m/s] and R [m] over time; the contact's unless given.
    tolerance : float
        Wanted relative error of central and minimum film at every time.
    nodes : int, optional
        Solve on this many nodes instead and report the error that this leaves.
    step : float, optional
        Longest step of time [s], all of one length between two of the times; by the tolerance unless given.
    supply : Meniscus, optional
        Place from which the gap is full; flooded unless given.

    Returns
    -------
    TransientFilm
        With ``converged=False``, NaN figures and a remedy in ``message`` if no film was found at some time. A film
        whose error is above the tolerance on 513 nodes keeps its figures; ``error`` and ``message`` say so.

    Raises
    ------
    InputError
        With every fault of the arguments. For a load that jumps: in no time no oil leaves the gap, which would carry
        the jump as a flat punch as wide as the oil reaches; ramp it over the time in which load sharing shifts it. For
        an entrainment that turns round: inlet and outlet would change places.

    Notes
    -----
    Method and limits: docs/theory/ehl.md, "Time".

    Examples
    --------
    A load that rises by a fifth within the time b/u:

    >>> from ehl import Lubricant
    >>> oil = Lubricant(viscosity=0.06, pressure_viscosity=22.6e-9, density=910.0)
    >>> contact = LineContact(load=1e5, entrainment=1.0, radius=0.015, reduced_modulus=2.2e11, lubricant=oil)
    >>> unit = contact.half_width / contact.entrainment
    >>> film = solve_transient(contact, lambda t: 1e5 * (1 + 0.2 * min(t / unit, 1)), [0, unit, 4 * unit], nodes=65)
    >>> film.converged, [f"{1e6 * h:.2f}" for h in film.least]
    (True, ['0.45', '0.44', '0.44'])
    """
    functions, times = checked(contact, load, time, entrainment, radius, tolerance, nodes, step, supply)
    with unclocked():
        import ehl.kernels.film_kernels  # noqa: F401  numba
    watch = Stopwatch()

    def contact_at(at: float) -> LineContact:
        return at_time(contact, functions, at)

    run = _Run(contact_at, times, tolerance, step, supply, watch)
    try:
        return run.solved(nodes)
    except JumpError as jump:
        raise jump_fault(contact_at, float(jump.args[0])) from None


_SLOWER = "allow a larger tolerance, or let load and speed change more slowly"


@dataclass(frozen=True)
class _Marched:
    """A film over time on two grids through the same instants."""

    pair: tuple[TimeMarch, TimeMarch]
    grid: float  # error by the grid
    steps: float  # and by the steps of time
    enough: bool

    @property
    def error(self) -> float:
        """Of both together."""
        return self.grid + self.steps


class _Run:
    """Solves on two grids, finer ones and shorter steps until the tolerance is met."""

    def __init__(
        self,
        contact_at: Callable[[float], LineContact],
        times: Array,
        tolerance: float,
        step: float | None,
        supply: Meniscus | None,
        watch: Stopwatch,
    ) -> None:
        self.contact_at, self.times, self.tolerance = contact_at, times, tolerance
        self.step, self.supply, self.watch = step, supply, watch
        self.allowed = max(_TIME_SHARE * tolerance / _STEPS, _FIRST_ALLOWED)
        self.iterations = self.nodes = self.rejected = 0
        self.first: Film  # steady, at the first time
        self.reason = ""

    def solved(self, nodes: int | None) -> TransientFilm:
        """Return the film, or the reason why there is none."""
        nearest = refine(self.pairs(nodes))
        if nearest is None or not self.first.converged or nearest.error >= WORST:
            return self.failed()
        film = self.film(nearest)
        if nearest.enough:
            return film
        message = (
            f"converged; the error of {nearest.error:.2g} is above the tolerance of {self.tolerance:.2g}"
        )
        return replace(film, message=message)

    def pairs(self, nodes: int | None) -> Iterator[_Marched]:
        """Follow the film on two grids, then with whatever of nodes and steps was too coarse made finer."""
        n, prescribed = nodes or METHOD.first_nodes_in_time, nodes is not None or self.step is not None
        for _ in range(_ROUNDS):
            first = self.first = solve(self.contact_at(float(self.times[0])), nodes=n, supply=self.supply)
            if not first.converged:
                self.reason = f"the steady film of the first time: {first.message}"
                return
            pair = self.pair(first)
            if isinstance(pair, str):
                self.allowed *= 0.25
                self.reason = f"{pair}: {_SLOWER}"
                continue
            grid, steps = _grid_error(*pair) + first.errors.inlet, pair[0].error
            march = _Marched(pair, grid, steps, prescribed or grid + steps <= self.tolerance)
            shots = len(pair[0].shots) - 1
            self.reason = f"error {march.error:.2g} left on {n} nodes with {shots} steps of time: {_SLOWER}"
            yield march
            if steps > _TIME_SHARE * self.tolerance:
                self.allowed *= 0.7 * (_TIME_SHARE * self.tolerance / steps) ** 1.5
            while grid > (1.0 - _TIME_SHARE) * self.tolerance and n <= METHOD.most_nodes_in_time:
                n, grid = 2 * n - 1, 0.3 * grid  # of second order, with a margin
            if n > METHOD.most_nodes_in_time:
                return

    def pair(self, first: Film) -> tuple[TimeMarch, TimeMarch] | str:
        """Follow the film on the coarser grid, and on the finer one through the same instants."""
        assert first.state is not None
        coarse, fine = (
            TimeMarch.begin(
                float(self.times[0]),
                level,
                self.contact_at,
                Laying(level.contact, level.plan, level.grid.nodes.size, self.supply),
            )
            for level in (first.state.coarse, first.state.fine)
        )
        self.nodes = max(self.nodes, fine.laying.nodes)
        if self.step is None:
            done = coarse.to(self.times[1:], self.allowed) and fine.through(coarse.times[1:])
        else:
            pieces = [
                np.linspace(a, b, max(1, math.ceil((b - a) / self.step - 1e-9)) + 1)[1:]
                for a, b in zip(self.times[:-1], self.times[1:], strict=True)
            ]
            instants = np.concatenate([*pieces, np.zeros(0)])
            done = coarse.through(instants) and fine.through(instants)
        for march in (coarse, fine):
            self.iterations += march.iterations
            self.rejected += march.rejected
        return (coarse, fine) if done else coarse.message or fine.message

    def cost(self, steps: int) -> Cost:
        """Return what was spent."""
        counts = {"steps": steps, "rejected": self.rejected}
        return Cost(self.watch.seconds, unknowns=self.nodes - 1, iterations=self.iterations, counts=counts)

    def film(self, march: _Marched) -> TransientFilm:
        """Return the film in SI."""
        pair = march.pair
        fine = pair[1]
        shown = [_shot(fine, at) for at in self.times.tolist()]
        lowest = min(fine.shots, key=lambda shot: shot.figures.minimum_thickness)
        tops = [np.array([shot.pressure.max() for shot in march.shots]) for march in pair]
        # a spike narrower than its cells grows by about as much with every halving of them
        growth = np.abs(tops[0] / tops[1] - 1.0) * (1.0 + np.array([shot.halvings for shot in fine.shots]))
        return TransientFilm(
            contact=fine.shots[0].contact,
            time=self.times,
            load=np.array([instant.contact.load for instant in shown]),
            least=np.array([instant.figures.minimum_thickness for instant in shown]),
            central=np.array([instant.figures.central_thickness for instant in shown]),
            separation=np.array([instant.figures.separation for instant in shown]),
            greatest_pressure=np.array([instant.pressure.max() for instant in shown]),
            x=np.array([instant.x for instant in shown]),
            pressure=np.array([instant.pressure for instant in shown]),
            thickness=np.array([instant.thickness for instant in shown]),
            cost=self.cost(len(fine.shots) - 1),
            converged=True,
            message="converged",
            lowest=lowest.figures.minimum_thickness,
            lowest_time=lowest.time,
            grid_error=march.grid,
            time_error=march.steps,
            pressure_error=float(np.max(growth)),
            balance=max(instant.balance for instant in fine.shots),
        )

    def failed(self) -> TransientFilm:
        """Return no figures."""
        first = self.first
        blank = np.full(self.times.size, math.nan)
        curves = np.full((self.times.size, first.x.size), math.nan)
        load = np.array([self.contact_at(at).load for at in self.times.tolist()])
        return TransientFilm(
            contact=first.contact,
            time=self.times,
            load=load,
            least=blank,
            central=blank,
            separation=blank,
            greatest_pressure=blank,
            x=curves,
            pressure=curves,
            thickness=curves,
            cost=self.cost(0),
            converged=False,
            message=self.reason,
        )


def _grid_error(coarse: TimeMarch, fine: TimeMarch) -> float:
    """Largest estimated error of the finer of two grids, of all moments."""
    names = ("central_thickness", "minimum_thickness", "separation")
    worst = 0.0
    for before, after in zip(coarse.shots, fine.shots, strict=True):
        changes = [getattr(before.figures, name) / getattr(after.figures, name) - 1.0 for name in names]
        worst = max(worst, METHOD.grid_factor * math.fsum(abs(float(change)) for change in changes))
    return worst


def _shot(course: TimeMarch, time: float) -> Shot:
    """Shot of one of the times."""
    return course.shots[int(np.argmin(np.abs(course.times - time)))]
