"""The motion swept up and down, portraits of what the sweeps met, and where contact is first lost."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from base import SolverError

if TYPE_CHECKING:
    from dynamics import SweepResult
    from flankfilm.stages.engine import Engine
    from flankfilm.stages.motion import ScalingStage

Array = NDArray[np.float64]

MOST_PORTRAITS = 6


@dataclass(frozen=True)
class Portrait:
    """A settled motion at one parameter value.

    Attributes
    ----------
    frequency : float
        Mesh frequency over the natural frequency.
    direction : str
        Sweep that met it, ``"up"`` or ``"down"``.
    label : str
        Motion n-p-q.
    displacement, velocity : ndarray
        Trajectory, dimensionless.
    section : ndarray, shape (points, 2)
        States at tau = 0.
    """

    frequency: float
    direction: str
    label: str
    displacement: Array
    velocity: Array
    section: Array


@dataclass(frozen=True)
class SweepStage:
    """Motion swept up and down.

    Attributes
    ----------
    frequency : ndarray, shape (values,)
        Mesh frequency over the natural frequency, rising.
    speed_rpm : ndarray, shape (values,), or None
        Pinion speed [rpm]; None for a scene in the oscillator's own units.
    states : mapping
        ``"up"`` and ``"down"`` to states at tau = 0, shape (values, kept, 2).
    labels : mapping
        The same to labels n-p-q, one a value.
    portraits : tuple of Portrait
        Settled motions at chosen values.
    grazings : ndarray
        Frequencies at which the orbit that never leaves contact touches the edge of the backlash.
    half_backlash : float
        D.
    error : float
        Largest estimated relative error of a period map.
    periods : int
        Excitation periods integrated.
    seconds : float
        Cost [s].
    messages : tuple of str
        What the solvers have to say.
    """

    frequency: Array
    speed_rpm: Array | None
    states: Mapping[str, Array]
    labels: Mapping[str, Sequence[str]]
    portraits: tuple[Portrait, ...]
    grazings: Array
    half_backlash: float
    error: float
    periods: int
    seconds: float
    messages: tuple[str, ...]


def sweep(engine: Engine) -> SweepStage:
    """Sweep the frequency up and down over the scene's range."""
    from dynamics import contact_grazing
    from dynamics import sweep as sweep_parameter

    start = time.perf_counter()
    scaled: ScalingStage = engine["scaling"]
    section = engine.scene.dynamics
    if section is None or section.sweep is None:
        raise SolverError("the sweep needs dynamics.sweep")
    if section.sweep.speed_rpm is not None and scaled.scales is not None:
        speed = np.linspace(*section.sweep.speed_rpm, section.sweep.points)
        frequency = np.array([scaled.scales.frequency_from_rpm(rpm) for rpm in speed.tolist()])
    else:
        assert section.sweep.frequency is not None
        frequency = np.linspace(*section.sweep.frequency, section.sweep.points)
        speed = None
    oscillator = scaled.oscillator
    found = {
        direction: sweep_parameter(oscillator, parameter="frequency", values=frequency, direction=direction)
        for direction in ("up", "down")
    }
    grazing = contact_grazing(oscillator, "frequency", (float(frequency[0]), float(frequency[-1])))
    told = [(result.message, result.converged) for result in found.values()]
    told.append((grazing.message, grazing.converged))
    return SweepStage(
        frequency=frequency,
        speed_rpm=speed,
        states={direction: result.states for direction, result in found.items()},
        labels={direction: result.labels for direction, result in found.items()},
        portraits=tuple(_portrait(scaled, found, *choice) for choice in _choices(engine, frequency, found)),
        grazings=np.asarray(grazing),
        half_backlash=oscillator.half_backlash,
        error=max(result.error for result in found.values()),
        periods=sum(result.cost.periods for result in found.values()),
        seconds=time.perf_counter() - start,
        messages=tuple(message for message, converged in told if not converged),
    )


def _choices(engine: Engine, frequency: Array, found: Mapping[str, SweepResult]) -> list[tuple[str, int]]:
    """Choose direction and index of each portrait: those of the scene, else one for each kind of motion."""
    section = engine.scene.dynamics
    assert section is not None
    wanted = list(section.portraits_frequency)
    if scales := engine["scaling"].scales:
        wanted += [scales.frequency_from_rpm(rpm) for rpm in section.portraits_rpm]
    if wanted:
        nearest = [int(np.argmin(np.abs(frequency - w))) for w in wanted]
        return [(d, i) for i in nearest for d in _different(found, i)]
    longest: dict[str, tuple[int, str, int]] = {}
    for direction, result in found.items():
        at = 0
        for label, run in groupby(result.labels):
            length = len(list(run))
            if length > longest.get(label, (0, "", 0))[0]:
                longest[label] = (length, direction, at + length // 2)
            at += length
    kept = sorted(longest.values(), reverse=True)[:MOST_PORTRAITS]
    return sorted(((d, i) for _, d, i in kept), key=lambda choice: choice[1])


def _different(found: Mapping[str, SweepResult], index: int) -> tuple[str, ...]:
    """Directions whose motions differ at a value: one where both sweeps met the same."""
    labels = {result.labels[index] for result in found.values()}
    return ("up",) if len(labels) == 1 else ("up", "down")


def _portrait(scaled: ScalingStage, found: Mapping[str, SweepResult], direction: str, index: int) -> Portrait:
    from dynamics import trajectory

    result = found[direction]
    frequency = float(result.values[index])
    states = result.states[index]
    periods = int(result.periods[index]) or 60
    oscillator = scaled.oscillator.with_parameter("frequency", frequency)
    motion = trajectory(oscillator, states[-1], periods=periods)
    return Portrait(frequency, direction, result.labels[index], motion.x, motion.v, motion.poincare)
