"""Error of the speed at which contact is first lost, from those of the stiffness."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import dynamics
from flankfilm.coupling.vibration.series import MEANS

if TYPE_CHECKING:
    from flankfilm.coupling.vibration.oscillator import PairOscillator
    from flankfilm.coupling.vibration.series import MeshSeries

STEP = 1e-5
"""Relative change of the frequency by which the clearance's slope is taken."""


def grazing_budget(
    motion: PairOscillator, frequency: float, flow: float, truncation: float | None = None
) -> Mapping[str, float]:
    r"""Parts of the relative error of the speed at which the orbit in contact touches the edge of the backlash.

    The orbit's clearance :math:`c(\omega, p) = 0` decides, so that
    :math:`d\omega = -\delta c/(\partial c/\partial\omega)` for a change :math:`\delta c` by a parameter's error; the
    speed goes with the root of the mean stiffness besides.

    Parameters
    ----------
    motion : PairOscillator
    frequency : float
        At which the orbit touches.
    flow : float
        Relative error of the frequency itself.
    truncation : float, optional
        Relative change by the harmonics that the series leaves out; infinite where it is unknown.

    Returns
    -------
    mapping
        ``"stiffness"`` of meshes, arcs and films, missing for closed forms, of which it is not known; ``"truncation"``
        where it is given; ``"flow"``, alone for a given stiffness.

    Examples
    --------
    >>> from flankfilm.coupling import PairOscillator, given_series
    >>> series = given_series(1.0, [0.18], [0.0])
    >>> oscillator = dynamics.GearOscillator(series.stiffness, 0.05, 0.1, 0.2, 0.5, 0.2)
    >>> grazing_budget(PairOscillator(oscillator, None, series), 0.6335, 1e-12)
    {'flow': 1e-12}
    """
    series = motion.series
    if series.cycle is None:
        return {"flow": flow}
    oscillator = motion.oscillator.with_parameter("frequency", frequency)
    here = _clearance(oscillator)
    above = _clearance(oscillator.with_parameter("frequency", frequency * (1.0 + STEP)))
    slope = (above - here) / STEP  # by the relative frequency

    def shift(changed: dynamics.GearOscillator) -> float:
        return (here - _clearance(changed)) / slope

    known = {"flow": flow} if truncation is None else {"truncation": truncation, "flow": flow}
    if (mean := series.cycle.errors[MEANS[series.kind]]) is None:
        return known
    softer = oscillator.with_parameter("mean_force", oscillator.mean_force / (1.0 + mean))
    # the error's amplitude and the backlash keep their lengths: the scale of length follows the mean force alone
    stiffness = abs(0.5 * mean + shift(softer))
    stiffness += math.fsum(abs(shift(varied)) for varied in _off(oscillator, series))
    return {"stiffness": stiffness, **known}


def _clearance(oscillator: dynamics.GearOscillator) -> float:
    """Minimum clearance of the orbit that never leaves contact."""
    from dynamics.branches.grazing import contact_orbit

    return contact_orbit(oscillator).clearance


def _off(oscillator: dynamics.GearOscillator, series: MeshSeries) -> Iterator[dynamics.GearOscillator]:
    """Oscillators with one amplitude off by its error each."""
    own = oscillator.stiffness
    errors = () if series.harmonic_error is None else series.harmonic_error
    for j, error in enumerate(errors):
        amplitudes = list(own.amplitudes)
        amplitudes[j] += float(error)
        yield replace(oscillator, stiffness=replace(own, amplitudes=tuple(amplitudes)))
