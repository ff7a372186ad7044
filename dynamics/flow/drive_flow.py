"""The exact flow in several freedoms: its tables and the motion that they carry."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from base import Array, Cost, Integers, Stopwatch
from dynamics.flow.exact_flow import REASONS
from dynamics.flow.protocol import MapResult, PartedFlow, Stretches, lost_motion
from dynamics.kernels.drives import STRIDE
from dynamics.model.drive_oscillator import DriveOscillator
from dynamics.model.protocol import EPS

# of motions expanded about the start of a cell, a radian of every time scale long: 1/17! is rounding
DEGREE = 16
WORTH = 32
"""Periods of a state alone that maps of many cells at once are worth; derivatives count twice a freedom."""

Arrays = tuple[Array, Array, Array, Array, Array, Array, Array]


@dataclass(frozen=True, eq=False)
class DriveFlow(PartedFlow):
    """The exact flow of a drive train, tabulated for the compiled kernels.

    Parameters
    ----------
    oscillator : DriveOscillator
        The oscillator.
    arrays : tuple of ndarray
        What the kernels take, see `dynamics.kernels.drives`.
    """

    tolerance = EPS
    noise = 64.0 * EPS

    oscillator: DriveOscillator
    arrays: Arrays

    @property
    def dimension(self) -> int:  # type: ignore[override]
        """Length of a state."""
        return self.oscillator.dimension

    @property
    def cells(self) -> int:
        """Cells per period."""
        return len(self.arrays[3])

    def finer(self) -> DriveFlow:
        """Tables with half the cell."""
        return tabulated(self.oscillator, 2 * self.cells, self.arrays[3].shape[2] - 1)

    @cached_property
    def in_strides(self) -> Arrays:
        """What the kernels take of a motion that is followed for long: maps of many cells at once, too."""
        from dynamics.kernels.drives.tabulating import gather

        _, systems, load, series, maps, _, _ = self.arrays
        return (*self.arrays[:-1], gather(systems, load, series, maps, STRIDE))

    def _arrays(self, periods: int, derivatives: bool) -> Arrays:
        """What the kernels take of a motion over so many periods."""
        worth = periods * (2 * len(self.oscillator.load) if derivatives else 1) >= WORTH
        return self.in_strides if worth or "in_strides" in self.__dict__ else self.arrays

    def follow(self, state: Array, periods: int = 1, skip: int = 0, derivatives: bool = True) -> MapResult:
        """Follow a state; the Jacobian covers the periods skipped, too."""
        from dynamics.kernels.drives.propagating import iterate

        watch = Stopwatch()
        at, start = self.oscillator.coordinates, np.zeros(1)
        moved = self.oscillator.lowered(np.asarray(state, dtype=np.float64)[None], start)[0]
        size = len(moved)
        states, counts = np.empty((periods, size)), np.zeros((periods, 2), dtype=np.int64)
        jacobian, clock = np.eye(size), np.zeros(1)
        flag = int(
            iterate(
                self._arrays(periods + skip, derivatives),
                0,
                self.cells,
                moved,
                skip,
                int(derivatives),
                jacobian,
                states,
                counts,
                clock,
            )
        )
        if flag:
            states[:], jacobian[:] = np.nan, np.nan
        return MapResult(
            self.oscillator.lifted(states, np.zeros(periods)),
            at.raises @ jacobian @ at.lowers,
            -self.damped(float(clock[0]), periods + skip),
            counts,
            REASONS.get(flag, ""),
            Cost(watch.seconds, periods=periods + skip),
            np.empty((self.oscillator.dimension, 0)),
        )

    def part(self, first: int, number: int, state: Array, counts: Integers) -> tuple[Array, Array, float]:
        """State after some cells, its derivative by the state before, time in contact; `counts` grow.

        All nan if the motion is lost.
        """
        from dynamics.kernels.drives.propagating import iterate

        osc, at = self.oscillator, self.oscillator.coordinates
        tau = np.array([first, first + number]) * (osc.period / self.cells)
        moved = osc.lowered(np.asarray(state, dtype=np.float64)[None], tau[:1])[0]
        jacobian, clock = np.eye(len(moved)), np.zeros(1)
        last, met = np.empty((1, len(moved))), np.zeros((1, 2), dtype=np.int64)
        if iterate(self.arrays, first, number, moved, 0, 1, jacobian, last, met, clock):
            last[:] = np.nan
        counts += met[0]
        factor = at.raises @ jacobian @ at.lowers
        return osc.lifted(last, tau[1:])[0], factor, float(clock[0])

    def damped(self, contact: float, periods: int) -> float:
        """Integral of the trace of all damping, by the time in contact."""
        at, (pressed, free) = self.oscillator.coordinates, self.oscillator.dampings
        whole = periods * self.oscillator.period
        return float(np.trace(at.damping)) * whole + at.gain * (pressed * contact + free * (whole - contact))

    def sampled(self, state: Array, periods: int, points: int) -> tuple[Array, Array, Array]:
        """Samples of the state, extrema of y and impacts; repeated with more room if the last two did not fit."""
        from dynamics.kernels.drives.walking import walk

        osc, room = self.oscillator, 64 * periods
        moved = osc.lowered(np.asarray(state, dtype=np.float64)[None], np.zeros(1))[0]
        while True:
            samples = np.empty((periods * points + 1 if points else 0, len(moved)))
            turns, events = np.empty((room, 5)), np.empty((room, 4))
            flag, turned, happened = walk(self.arrays, moved, periods, points, samples, turns, events)
            if flag:
                raise lost_motion(state, REASONS[int(flag)])
            if turned <= room and happened <= room:
                tau = np.arange(len(samples), dtype=np.float64) * (osc.period / max(points, 1))
                return osc.lifted(samples, tau), turns[:turned], events[:happened]
            room = max(turned, happened)

    def stretches(self, state: Array, sizes: Sequence[int], keep: bool = False) -> Stretches:
        """Growth of all directions, made orthonormal every eight cells."""
        from dynamics.kernels.drives.propagating import iterate

        moved = self.oscillator.lowered(np.asarray(state, dtype=np.float64)[None], np.zeros(1))[0]
        n, clock, damped = len(moved), np.zeros(1), np.zeros(len(sizes))
        frame = np.vstack([np.eye(n), np.zeros((1, n))])
        logs, kept, flag = np.zeros((len(sizes), n)), [moved[None, :][:0]], 0
        for k, (row, size) in enumerate(zip(logs, sizes, strict=True)):
            part = np.empty((size if keep else min(size, 1), n))
            frame[n] = clock[0] = 0.0
            if size:
                unseen = np.zeros((len(part), 2), dtype=np.int64)
                flag = flag or int(
                    iterate(
                        self.arrays, 0, self.cells, moved, size - len(part), 2, frame, part, unseen, clock
                    )
                )
            row[:], damped[k] = frame[n], self.damped(float(clock[0]), size)
            kept.append(part)
        states: Array = np.vstack(kept) if keep else moved[None]
        return Stretches(
            logs,
            self.oscillator.lifted(np.asarray(states), np.zeros(len(states))),
            damped,
            REASONS.get(flag, ""),
        )

    def settle(self, starts: Array, homes: Array, radius: float, limit: int, labels: Integers) -> int:
        """Follow starts until they stay near known attractors, in the coordinates of the flow."""
        osc, n = self.oscillator, self.oscillator.dimension
        moved = osc.lowered(starts, np.zeros(len(starts)))
        places = np.hstack([osc.lowered(homes[:, :n], np.zeros(len(homes))), homes[:, n:]])
        # so near in the coordinates of the flow that states are as near as asked
        near = radius / float(np.max(np.sum(np.abs(osc.coordinates.up), axis=1)))
        _ = self.in_strides  # made once, before several cores ask for it
        used = super().settle(moved, places, near, limit, labels)
        starts[:] = osc.lifted(moved, np.zeros(len(moved)))
        return used

    def settle_block(self, starts: Array, homes: Array, radius: float, limit: int, labels: Integers) -> int:
        """As of `settle`, on one core, of starts and attractors in the coordinates of the flow."""
        from dynamics.kernels.drives.propagating import settle

        return int(settle(self.in_strides, starts, homes, radius, limit, labels))


def drive_flow(oscillator: DriveOscillator) -> DriveFlow:
    """Tabulate a drive train."""
    return tabulated(oscillator, math.ceil(oscillator.cells))


def tabulated(oscillator: DriveOscillator, cells: int, degree: int = DEGREE) -> DriveFlow:
    """Tables of a drive train, with so many cells per period."""
    from dynamics.kernels.drives.tabulating import tabulate

    at, series = oscillator.coordinates, oscillator.mesh_stiffness
    h = oscillator.period / cells
    dampings = []
    for damping in oscillator.dampings:
        whole = at.damping * h
        whole[0, 0] += at.gain * damping * h
        dampings.append(whole)
    systems = np.stack([at.stiffness * h**2, *dampings])
    moving = oscillator.moving_loads
    load = np.vstack([oscillator.load * h**2, at.damping[:, 0] * h, moving * h**2])
    mesh = np.array([[series.mean, *series.amplitudes], [0.0, *series.phases]])
    mesh[0] *= at.gain * h**2
    own = np.zeros(10)
    own[2], own[4], own[6] = oscillator.load[0], oscillator.frequency, oscillator.half_backlash
    own[2] += oscillator.moving_force(np.zeros(1))[0] * np.sum(moving[:, 0])
    own[7] = 1.0 if oscillator.one_sided else 2.0
    pushes = oscillator.force_series if len(moving) else np.zeros((0, 1))
    tables = tabulate(mesh, oscillator.error_series, pushes, cells, degree, systems, load)
    size = systems.shape[1]
    none = np.zeros((0, 2 * size + 2, 2 * size + 2 * STRIDE))
    return DriveFlow(oscillator, (own, systems, load, *tables, none))
