"""One grid's film under a load that oscillates: linear about the steady film, with heat or without."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from base import Array, Integers
from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Grid, Residual, film_gap
from ehl.discrete.squeeze import Content, Storage, at_meniscus, by_parameter
from ehl.solving.levels import Level, figures
from ehl.solving.oil_following import Complex, FollowingOil, following_oil
from ehl.solving.response import explicit, step_of

_SLOWEST = 1e-4  # u/b: below it stiffness and damping are those of this frequency, to 1e-8


def not_slower(frequency: Array, contact: LineContact) -> Array:
    """Frequencies, those near 0 so far from it that damping can be distinguished from rounding."""
    least = _SLOWEST * contact.entrainment / contact.half_width
    frequencies: Array = np.where(np.abs(frequency) < least, least, frequency)
    return frequencies


class Way(NamedTuple):
    """What one parameter changes with P and H0 held, by its ln, on nodes that follow it; without heat in the oil."""

    contact: LineContact
    moved: Grid
    forced: Array  # net fluxes and load
    swept: Array  # oil that moves between the nodes' volumes [s]
    central: float  # figures [m]
    separation: float
    thinned: Array  # film at the nodes where they are [m]
    taken: float  # flow into the film [m], and what of it the first node's volume stores [m2]
    held: float

    @classmethod
    def of(
        cls, level: Level, before: Residual, scale: Array, free: Integers, way: tuple[LineContact, Grid]
    ) -> Way:
        """Differentiate towards another contact on another grid, a step away."""
        grid, groups, solution = level.grid, level.groups, level.solution
        other, moved = way
        after = groups.on(other, moved)
        own = explicit(level, before, other, moved)
        step = step_of(level)
        was, is_now = (
            Content.of(*there, solution.P, solution.H0) for there in ((grid, groups), (moved, after))
        )
        swept = by_parameter(was, is_now, step) / (groups.gap * level.contact.entrainment)
        places = float(grid.nodes[0]) * groups.length, float(moved.nodes[0]) * after.length
        return cls(
            contact=other,
            moved=moved,
            forced=np.append(-scale * own.net_flux[free - 1], own.short),
            swept=np.append(scale * swept[free - 1], 0.0),
            central=own.central,
            separation=own.separation,
            thinned=_thinned(level, other, moved),
            taken=-float(own.flow[0]),
            held=at_meniscus(was, is_now, places, level.flow, step),
        )


@dataclass(frozen=True)
class LinearFilm:
    """One grid's linear problem (matrix - i omega stored) change = forced + i omega swept, by ln of parameters."""

    level: Level
    before: Residual
    oil: FollowingOil | None  # of films with heat
    matrix: Array
    stored: Array  # [s]
    scale: Array  # of the rows
    at_first: float  # content of the first node's volume by its gap
    free: Integers
    ways: tuple[Way, ...]

    @classmethod
    def of(cls, level: Level, ways: list[tuple[LineContact, Grid]]) -> LinearFilm:
        """Linearise about the steady film, towards contacts a step away on nodes that follow them."""
        from ehl.kernels.film_kernels import newton_matrix

        grid, groups, solution = level.grid, level.groups, level.solution
        before = Residual.of(grid, groups, solution.P, solution.H0)
        influence = by_pressure = -groups.compliance * grid.potential
        free = np.flatnonzero(solution.P[1:-1] > 0.0) + 1
        slopes, following = before.slopes, following_oil(level)
        if following is not None:
            slopes = following.after(0).residual.slopes
            by_pressure = influence + following.swelling
        system = newton_matrix(slopes, by_pressure, grid.weights, free)
        scale = system[:-1, -1]
        storage = Storage.of(grid, groups, solution.P, solution.H)
        stored = np.zeros((free.size + 1, free.size + 1))
        seconds = groups.length / level.contact.entrainment
        stored[:-1] = seconds * scale[:, None] * storage.rows(influence, free)
        return cls(
            level=level,
            before=before,
            oil=following,
            scale=scale,
            matrix=np.ascontiguousarray(system[:, :-1]),
            stored=stored,
            at_first=float(storage.by_gap[0]) * groups.gap * groups.length,
            free=free,
            ways=tuple(Way.of(level, before, scale, free, way) for way in ways),
        )

    def answer(self, frequency: float) -> Complex:
        """Derivatives of separation, central and minimum film, and oil that the first node misses (ways, 4) [m]."""
        omega = float(not_slower(np.array(frequency), self.level.contact))
        system = self.matrix - 1j * omega * self.stored
        if self.oil is not None:
            return np.array([self._with_heat(way, omega, lu_factor(system)) for way in self.ways])
        right = np.stack([way.forced + 1j * omega * way.swept for way in self.ways], axis=1)
        changes = np.linalg.solve(system, right)
        return np.array(
            [
                self._figures(way, *self._at_nodes(change), omega)
                for way, change in zip(self.ways, changes.T, strict=True)
            ]
        )

    def _at_nodes(self, change: Complex) -> tuple[Complex, complex]:
        dP = np.zeros(self.level.grid.nodes.size, complex)
        dP[self.free] = change[:-1]
        return dP, complex(change[-1])

    def _with_heat(self, way: Way, omega: float, factors: Any) -> Complex:
        def solve(net_flux: Complex, short: complex) -> tuple[Complex, complex]:
            right = np.append(-self.scale * net_flux[self.free - 1], short)
            return self._at_nodes(lu_solve(factors, right))

        assert self.oil is not None
        oil = self.oil.level.oil.on(way.contact, way.moved)
        answer = self.oil.towards(oil, way.moved, solve, omega)
        return self._figures(way, answer.P, answer.H0, omega, answer.missing)

    def _figures(
        self, way: Way, dP: Complex, dH0: complex, omega: float, missing: complex | None = None
    ) -> Complex:
        level, grid, groups = self.level, self.level.grid, self.level.groups
        dH = dH0 - groups.compliance * (grid.potential @ dP)
        centre = dH0 - groups.compliance * (grid.centre @ dP)
        film = way.thinned + groups.gap * dH
        least = np.interp(figures(level).minimum_position / groups.length, grid.nodes, film)
        if missing is None:
            slopes = self.before.slopes[0]
            taken = way.taken - groups.gap * (slopes[1:3] @ dP[:2] + slopes[4:] @ dH[:2])
            held = way.held + self.at_first * dH[0]
            missing = -taken - 1j * omega / level.contact.entrainment * held
        derivatives: Complex = np.array(
            [way.separation + groups.gap * dH0, way.central + groups.gap * centre, least, missing]
        )
        return derivatives


def _thinned(level: Level, heavier: LineContact, moved: Grid) -> Array:
    """Differentiate the gap at fixed places by ln w, with P and H0 of the moving nodes held [m]."""
    grid, groups, solution = level.grid, level.groups, level.solution
    after = groups.on(heavier, moved)
    x, x_moved = grid.nodes * groups.length, moved.nodes * after.length
    film = solution.H * groups.gap
    carried = film_gap(moved, after, solution.P, solution.H0) * after.gap
    change: Array = (carried - film - np.gradient(film, x) * (x_moved - x)) / step_of(level)
    return change
