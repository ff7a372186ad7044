"""The unloaded transmission error as what drives the motion: one harmonic of the mesh, or any number of them."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Sequence
from typing import TypeAlias

import numpy as np

from base import Array, Faults
from dynamics.model.limits import NUMBER
from dynamics.model.stiffness import MAX_ORDER, numbers

Harmonics: TypeAlias = float | tuple[float, ...]
"""A number for the first harmonic alone, or one number for each of several."""

AMPLITUDE, PHASE = "error_amplitude", "error_phase"
ERROR, FORCE = (AMPLITUDE, PHASE), ("force_amplitude", "force_phase")
"""Names of amplitudes and phases of what drives the motion: an error, or a force."""


def checked_series(
    faults: Faults, amplitude: object, phase: object, names: tuple[str, str] = ERROR
) -> tuple[Harmonics, Harmonics]:
    """Amplitudes and phases of a series as numbers, or as tuples if there are two or more; faults are noted.

    Parameters
    ----------
    faults : Faults
        Notes what is no finite number, and phases that are not one for each amplitude.
    amplitude, phase : float or sequence of float
        One phase of 0 serves any number of amplitudes.
    names : (str, str)
        What they are called.
    """
    sizes, phases = (
        _numbers(faults, name, harmonics) for name, harmonics in zip(names, (amplitude, phase), strict=True)
    )
    if phases == (0.0,) and not _several(phase):
        phases = phases * len(sizes)
    if len(phases) != len(sizes):
        allowed = f"must be {len(sizes)} phases, one per amplitude"
        faults.add(names[1], f"{len(phases)} phases", allowed, "give amplitudes and phases of equal length")
    if not 1 <= len(sizes) <= MAX_ORDER:
        allowed = f"must be 1 to {MAX_ORDER} harmonics"
        remedy = f"give 0 for no {names[0].partition('_')[0]}, or leave out the highest"
        faults.add(names[0], f"{len(sizes)} harmonics", allowed, remedy)
    return (sizes[0], phases[0]) if len(sizes) == len(phases) == 1 else (sizes, phases)


def _several(harmonics: object) -> bool:
    return (
        isinstance(harmonics, Sequence | np.ndarray)
        and not isinstance(harmonics, str)
        and np.ndim(harmonics) == 1
    )


def _numbers(faults: Faults, name: str, harmonics: object) -> tuple[float, ...]:
    if not isinstance(harmonics, Sequence | np.ndarray) or not _several(harmonics):
        return (faults.number(name, harmonics, NUMBER),)
    return numbers(faults, name, harmonics)


def as_series(amplitude: Harmonics, phase: Harmonics) -> Array:
    """Amplitudes and phases [rad] of the harmonics 1, 2, ..., shape (2, harmonics)."""
    return np.array([amplitude, phase], dtype=np.float64).reshape(2, -1)


@functools.lru_cache(maxsize=64)
def harmonic_names(harmonics: int, names: tuple[str, str] = ERROR) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names of the amplitudes and of the phases: without a number where there is one harmonic."""
    if harmonics == 1:
        return (names[0],), (names[1],)
    amplitudes, phases = (tuple(f"{name}[{j}]" for j in range(harmonics)) for name in names)
    return amplitudes, phases


def push(series: Array, angle: Array) -> Array:
    r"""Force of the error over :math:`\omega^2`: :math:`\sum_j j^2 \varepsilon_j \cos(j \omega\tau + \varphi_j)`.

    Parameters
    ----------
    series : (2, harmonics) array
        Amplitudes and phases [rad].
    angle : array
        :math:`\omega\tau` [rad].
    """
    total = np.zeros(np.shape(angle))
    for n, (amplitude, phase) in enumerate(series.T.tolist(), start=1):
        total = total + n**2 * amplitude * np.cos(n * angle + phase)
    return total


def highest_harmonic(order: int, errors: Iterable[float]) -> int:
    """Highest harmonic of stiffness and error that is there, at least 1; `errors` are amplitudes from the second on."""
    return max(order, 1, *(i + 2 for i, size in enumerate(errors) if size != 0.0))


def largest(series: Array) -> float:
    """Most that an error of such amplitudes can be."""
    return float(math.fsum(np.abs(series[0])))
