"""Oscillators whose restoring force is any smooth or piecewise smooth function of angle, deflection and speed.

The functions have the names and arguments of those of the exact flow, and results of the same kind:
``smooth.find_orbit(oscillator, guess)`` instead of ``find_orbit(oscillator, guess)``. Steps are of order 8 with a
stated tolerance; switchings are met exactly. Names are loaded when first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dynamics.smooth.compiled import CompiledLaw as CompiledLaw
    from dynamics.smooth.compiled import Surface as Surface
    from dynamics.smooth.continuation import continue_branch as continue_branch
    from dynamics.smooth.continuation import follow_branch as follow_branch
    from dynamics.smooth.flow import FlowMap as FlowMap
    from dynamics.smooth.flow import period_map as period_map
    from dynamics.smooth.flow import trajectory as trajectory
    from dynamics.smooth.laws import Law as Law
    from dynamics.smooth.laws import PowerContact as PowerContact
    from dynamics.smooth.laws import SmoothedBacklash as SmoothedBacklash
    from dynamics.smooth.laws import SqueezeFilm as SqueezeFilm
    from dynamics.smooth.oscillator import SmoothOscillator as SmoothOscillator
    from dynamics.smooth.problem import MapPoint as MapPoint
    from dynamics.smooth.problem import PeriodMap as PeriodMap
    from dynamics.smooth.shooting import SmoothOrbit as SmoothOrbit
    from dynamics.smooth.shooting import find_orbit as find_orbit
    from dynamics.smooth.sweeps import force as force
    from dynamics.smooth.sweeps import lyapunov_exponents as lyapunov_exponents
    from dynamics.smooth.sweeps import rest_state as rest_state
    from dynamics.smooth.sweeps import sweep as sweep
    from dynamics.smooth.switching import doubled_orbit as doubled_orbit
    from dynamics.smooth.tabulated import TabulatedContact as TabulatedContact

_HOMES = {
    "CompiledLaw": "compiled",
    "FlowMap": "flow",
    "Law": "laws",
    "MapPoint": "problem",
    "PeriodMap": "problem",
    "PowerContact": "laws",
    "SmoothOrbit": "shooting",
    "SmoothOscillator": "oscillator",
    "SmoothedBacklash": "laws",
    "SqueezeFilm": "laws",
    "Surface": "compiled",
    "TabulatedContact": "tabulated",
    "continue_branch": "continuation",
    "doubled_orbit": "switching",
    "find_orbit": "shooting",
    "follow_branch": "continuation",
    "force": "sweeps",
    "lyapunov_exponents": "sweeps",
    "period_map": "flow",
    "rest_state": "sweeps",
    "sweep": "sweeps",
    "trajectory": "flow",
}

__all__ = sorted(_HOMES)


def __getattr__(name: str) -> object:
    """Load a public name from its module."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    """Public names, loaded or not."""
    return list(__all__)
