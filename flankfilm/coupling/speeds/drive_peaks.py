"""Peaks of what a drive train carries, between the speeds of a sweep too, and what damping makes of them.

Places are the maximum values of both sweeps and the highest peaks of the linear response, which is cheap everywhere.
About the highest of them periodic motions are followed to the maximum force: to the top of a parabola, or to where the
motion ends, beyond which the train jumps to another one. Motions that do not repeat count with what the sweeps saw of
them; how far their maximum is off is unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import dynamics
from base import Array
from dynamics.flow.drive_flow import drive_flow
from dynamics.model.protocol import settling_periods
from flankfilm.coupling.vibration.part_loads import output_rows
from flankfilm.coupling.vibration.resonance import Vibrations, vibration

if TYPE_CHECKING:
    from flankfilm.coupling.drive.pair_drive import PairDrive

GRID = 400
"""Frequencies of the linear response, besides those about its modes."""

HIGHEST = 3
"""Peaks of the linear response at which the motion is computed, of each part."""

NEARLY = 0.9
"""Places are searched whose force is at least this part of the largest known."""

STEPS, SETTLED = 10, 1e-3
"""Most motions of one search, and relative difference of a parabola from the motion at its top at which it ends."""

HALVINGS = 20
"""Most motions of the search for the place where a motion ends."""


class Peaks(NamedTuple):
    """Maximum forces over a range of speed: of the mesh over the mean force, then of each part.

    Attributes
    ----------
    frequency : ndarray, shape (1 + parts,)
        Mesh frequency over the natural one of the pair on rigid shafts.
    height : ndarray, shape (1 + parts,)
    band : ndarray, shape (2, 1 + parts)
        Heights there with the minimum and the maximum damping that is likely; nan without a motion that repeats.
    settled : ndarray, shape (1 + parts,)
        Relative difference to the neighbours of the search, and of samples of a period; infinite of a motion that does
        not repeat.
    """

    frequency: Array
    height: Array
    band: Array
    settled: Array

    @property
    def error(self) -> Array:
        """Relative error by search, samples and band of the damping; infinite where that is not known."""
        off = np.max(np.abs(self.band / self.height - 1.0), axis=0, initial=0.0)
        return np.asarray(self.settled + np.where(np.isfinite(off), off, np.inf))


def drive_peaks(
    drive: PairDrive,
    sweeps: Mapping[str, dynamics.SweepResult],
    shaken: Mapping[str, Vibrations],
    progress: Callable[[int, int], None] = lambda done, every: None,
) -> Peaks:
    """Find the maximum force of the mesh and of every part over the range of a sweep.

    Parameters
    ----------
    drive : PairDrive
    sweeps : mapping
        Sweeps by direction.
    shaken : mapping
        Their forces.
    progress : callable
        Called with the number of parts done, and of all.
    """
    values = next(iter(sweeps.values())).values
    heights = {
        way: np.column_stack([response.force, np.abs(response.parts[:, 2])])
        for way, response in shaken.items()
    }
    search = _Search(drive, sweeps, heights)
    best = [search.sampled(part) for part in range(1 + len(drive.outputs))]
    if search.known and values.min() < values.max():
        fine, estimate = linear_heights(drive, float(values.min()), float(values.max()))
        for part in range(len(best)):
            places = _maxima(fine, estimate[:, part])
            known = [search.at(part, middle).height for _, middle, _ in places]
            least = NEARLY * max([best[part].height, *known])
            for height, (low, _, high) in zip(known, places, strict=True):
                if height >= least:
                    search.at(part, low)
                    search.at(part, high)
            best[part] = max(search.greatest(part), best[part], key=lambda peak: peak.height)
            progress(part + 1, len(best))
        for part, peak in enumerate(best):
            if _peak(part, search.known).height > peak.height:  # of a motion that was met for another part
                best[part] = search.greatest(part)
    band = np.array([search.damped(peak) for peak in best]).T
    return Peaks(
        np.array([peak.frequency for peak in best]),
        np.array([peak.height for peak in best]),
        band,
        np.array([peak.settled for peak in best]),
    )


class _Motion(NamedTuple):
    """Motion at a frequency: state, periods of the excitation (0 where it does not repeat), maximum forces, change.

    The change is relative, with half as many samples.
    """

    frequency: float
    state: Array
    periods: int
    heights: Array
    change: float


class _Peak(NamedTuple):
    """Maximum force of a part: where, how high, how far settled, and the motion there."""

    part: int
    frequency: float
    height: float
    settled: float
    state: Array
    periods: int


def _peak(part: int, motions: Sequence[_Motion]) -> _Peak:
    """Give the motion with the maximum force of a part."""
    most = max(motions, key=lambda motion: float(motion.heights[part]))
    return _Peak(part, most.frequency, float(most.heights[part]), most.change, most.state, most.periods)


class _Search:
    """Periodic motions at any frequency of a sweep's range, by Newton's method from the nearest one known."""

    def __init__(
        self, drive: PairDrive, sweeps: Mapping[str, dynamics.SweepResult], heights: Mapping[str, Array]
    ) -> None:
        self.drive = drive
        self.known: list[_Motion] = []
        self.wandering: list[_Motion] = []
        for way, swept in sweeps.items():
            for row, (value, states, periods) in enumerate(
                zip(swept.values.tolist(), swept.states, swept.periods.tolist(), strict=True)
            ):
                if np.all(np.isfinite(heights[way][row])):
                    change, among = (0.0, self.known) if periods else (np.inf, self.wandering)
                    among.append(_Motion(value, states[-1], periods, heights[way][row], change))

    def sampled(self, part: int) -> _Peak:
        """Largest of all motions that the sweeps met; nan without any."""
        if not (motions := [*self.known, *self.wandering]):
            return _Peak(part, np.nan, np.nan, np.inf, np.empty(0), 0)
        return _peak(part, motions)

    def greatest(self, part: int) -> _Peak:
        """Maximum force of all motions known, and of those at the tops of parabolas through it and its neighbours."""
        off = np.inf
        for _ in range(STEPS):
            best = _peak(part, self.known)
            beside = self._beside(best)
            place, top = _top([*beside, best.frequency], [*beside.values(), best.height])
            here = self.at(part, place)
            if np.isfinite(here.height):
                off = abs(here.height / top - 1.0)
                if off < SETTLED:
                    break
            elif (ends := self._end(best, place, beside)) is not None:
                return ends
        peak = _peak(part, self.known)
        return peak._replace(settled=off + peak.settled)

    def _beside(self, best: _Peak) -> dict[float, float]:
        """Frequencies on both sides of a motion at which others are known, and their maximum force."""
        points = {
            motion.frequency: float(motion.heights[best.part])
            for motion in sorted(self.known, key=lambda motion: float(motion.heights[best.part]))
        }
        order = sorted(points)
        at = order.index(best.frequency)
        return {order[k]: points[order[k]] for k in (at - 1, at + 1) if 0 <= k < len(order)}

    def _end(self, best: _Peak, beyond: float, beside: Mapping[float, float]) -> _Peak | None:
        """Follow a motion, whose force rises, up to where it ends; None where the force falls before.

        Forces change by the root of the distance to a fold at most, F = F_end - c |nu - nu_end|^(1/2), so that two
        motions bound what is left, wherever in the interval that remains the end is.

        Parameters
        ----------
        best : _Peak
        beyond : float
            Frequency at which the motion has ended.
        beside : mapping
            Maximum force at the neighbours of `best`.
        """
        back = [place for place in beside if (place - best.frequency) * (beyond - best.frequency) < 0.0]
        before, left = (back[0], beside[back[0]]) if back else None, np.inf
        for _ in range(HALVINGS):
            here = self.at(best.part, 0.5 * (best.frequency + beyond), best)
            if here.height == -np.inf:
                beyond = here.frequency
            elif here.height < best.height:
                return None
            else:
                before, best = (best.frequency, best.height), here
            if before is not None:
                gone = abs((best.frequency - beyond) / (before[0] - beyond)) ** 0.5
                left = abs(before[1] / best.height - 1.0) * gone / (1.0 - gone)
            if left < SETTLED:
                break
        return best._replace(settled=left + best.settled)

    def at(self, part: int, frequency: float, near: _Peak | None = None) -> _Peak:
        """Stable motion at a frequency and its force; minus infinity where none is found.

        It is sought from `near`, or from the nearest one known; of several there, from that with the maximum force.
        """
        value, state, periods, heights, change = min(
            self.known,
            key=lambda motion: (abs(motion.frequency - frequency), -float(motion.heights[part])),
        )
        if value != frequency:
            if near is not None:
                state, periods = near.state, near.periods
            here = self.drive.oscillator.with_parameter("frequency", frequency)
            orbit = dynamics.find_orbit(here, state, periods=periods)
            if not (orbit.converged and orbit.stable):
                return _Peak(part, frequency, -np.inf, np.inf, state, periods)
            state, periods = orbit.state, orbit.periods
            heights, change = _heights(self.drive, here, state, periods)
            self.known.append(_Motion(frequency, state, periods, heights, change))
        return _Peak(part, frequency, float(heights[part]), change, state, periods)

    def damped(self, peak: _Peak) -> list[float]:
        """Heights of a peak with the minimum and the maximum damping that is likely, at its frequency."""
        heights: list[float] = []
        for factor in self.drive.damping_band:
            if not peak.periods:
                heights.append(np.nan)
                continue
            here = self.drive.damped(factor).with_parameter("frequency", peak.frequency)
            orbit = dynamics.find_orbit(here, peak.state, periods=peak.periods)
            state, periods = orbit.state, orbit.periods
            if not (orbit.converged and orbit.stable):  # another motion: the one that it settles to
                image = drive_flow(here).follow(peak.state, 1, settling_periods(here), derivatives=False)
                state, periods = image.state, 0
            heights.append(float(_heights(self.drive, here, state, periods)[0][peak.part]))
        return heights


def _heights(
    drive: PairDrive, oscillator: dynamics.DriveOscillator, state: Array, periods: int
) -> tuple[Array, float]:
    """Maximum forces of a motion, of the mesh and of all parts, and how they change with half as many samples."""
    response = vibration(oscillator, state, periods, load=drive.mean_force, outputs=drive.outputs)
    return np.append(response.force, np.abs(response.parts[2])), response.change


def _top(places: list[float], heights: list[float]) -> tuple[float, float]:
    """Place and height of the top of a parabola through three points, the largest last; halfway between two."""
    best, height = places[-1], heights[-1]
    if len(places) == 3:
        near, far = sorted(places[:2], key=lambda place: abs(place - best))
        square, slope, _ = np.polyfit(np.array(places) - best, heights, 2)
        step = -0.5 * slope / square if square < 0.0 else 0.0
        if abs(step) > 0.02 * abs(near - best):
            return best + float(step), height + 0.5 * float(slope * step)
        return best + 0.25 * (far - best), height + float(square * (0.25 * (far - best)) ** 2)
    return 0.5 * (places[0] + best), 0.5 * (heights[0] + height)


def _maxima(at: Array, heights: Array) -> list[tuple[float, float, float]]:
    """Highest peaks of a curve within its range, each with its neighbours."""
    inner = np.flatnonzero((heights[1:-1] >= heights[:-2]) & (heights[1:-1] > heights[2:])) + 1
    highest = inner[np.argsort(-heights[inner])][:HIGHEST]
    return [(float(at[max(k - 3, 0)]), float(at[k]), float(at[min(k + 3, len(at) - 1)])) for k in highest]


def linear_heights(drive: PairDrive, low: float, high: float) -> tuple[Array, Array]:
    """Maximum forces of the linear response in contact: mean and amplitudes of all harmonics added up.

    Parameters
    ----------
    drive : PairDrive
    low, high : float
        Mesh frequencies over the natural one of the pair on rigid shafts.

    Returns
    -------
    frequencies : ndarray, shape (n,)
    heights : ndarray, shape (n, 1 + parts)
        Of the mesh over the mean force, and of all parts.
    """
    osc, size = drive.oscillator, drive.oscillator.dimension
    mass, damping, stiffness, g = map(np.asarray, (osc.mass, osc.damping, osc.stiffness, osc.direction))
    swing = np.abs(osc.mesh_stiffness.amplitudes) / osc.mesh_stiffness.mean * abs(drive.mean_force)
    error = osc.error_series[0]
    pushed = osc.force_series[0]
    moved = [] if osc.force_direction is None else [np.asarray(osc.force_direction)]
    count = max(len(swing), len(error), len(pushed))
    swing, error, pushed = (
        np.pad(np.abs(amplitudes), (0, count - len(amplitudes))) for amplitudes in (swing, error, pushed)
    )
    natural = drive.natural_frequencies / drive.scales.natural_frequency
    met = (natural[:, None] / np.arange(1, count + 1)).ravel()
    near = (met[:, None] * (1.0 + 0.01 * np.arange(-4, 5))).ravel()
    at = np.unique(np.concatenate([np.geomspace(low, high, GRID), near[(near > low) & (near < high)]]))
    rows = output_rows(drive.outputs, size)
    push, drag = rows[:, : size // 2], rows[:, size // 2 :]
    rest = np.linalg.lstsq(
        stiffness + osc.mesh_stiffness.mean * np.outer(g, g),
        np.asarray(osc.mean_force) + osc.mesh_stiffness.mean * osc.half_backlash * g,
        rcond=None,
    )[0]
    heights = np.tile(np.append(1.0, np.abs(push @ rest)), (len(at), 1))
    for j in range(1, count + 1):
        nu = j * at[:, None, None]
        mesh = osc.mesh_stiffness.mean + 1j * nu * osc.mesh_damping
        whole = stiffness + 1j * nu * damping - nu**2 * mass + mesh * np.outer(g, g)
        at_mesh = g, 1.0, swing[j - 1] + np.abs(mesh[:, 0, 0]) * error[j - 1]
        travelling = [(along, 0.0, np.full(len(at), pushed[j - 1])) for along in moved if pushed[j - 1]]
        for direction, direct, force in (at_mesh, *travelling):
            answer = np.linalg.solve(
                whole, np.broadcast_to(direction.astype(np.complex128), (len(at), len(g)))[..., None]
            )
            parts = np.abs((push + 1j * nu * drag) @ answer)[..., 0]
            own = np.abs(direct - mesh[:, 0, 0] * (answer[..., 0] @ g)) * force / abs(drive.mean_force or 1.0)
            heights += np.column_stack([own, parts * force[:, None]])
    return at, heights
