"""The scans of the article's section 6 for tests: parameters and printed values are those of examples/motion."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from dynamics import FourierStiffness, GearOscillator
from dynamics.inverse import Event
from examples.motion.events import EVENTS
from examples.motion.scans import SCANS


def _changed(section: str, kappa: float | None, phase: float, changes: dict[str, Any]) -> GearOscillator:
    here = SCANS[section].oscillator
    amplitudes = here.stiffness.amplitudes if kappa is None else (kappa,)
    return dataclasses.replace(here, stiffness=FourierStiffness(1.0, amplitudes, (phase,)), **changes)


def lubricated(
    frequency: float = 0.6, phase: float = 0.0, kappa: float | None = None, **changes: Any
) -> GearOscillator:
    """Oscillator of the lubricated frequency scan, 6.1."""
    return _changed("6.1", kappa, phase, {"frequency": frequency, **changes})


def starved(frequency: float = 0.6, **changes: Any) -> GearOscillator:
    """Oscillator of the starved frequency scan, 6.2."""
    return _changed("6.2", None, 0.0, {"frequency": frequency, **changes})


def lubricated_error(error_amplitude: float = 0.4, **changes: Any) -> GearOscillator:
    """Oscillator of the lubricated scan of the error amplitude, 6.3."""
    return _changed("6.3", None, 0.0, {"error_amplitude": error_amplitude, **changes})


def printed(section: str, kind: str, label: str, near: float = math.nan) -> float:
    """Value that the article prints for a special point; the nearest to one given if there are several."""
    values = [e.value for e in EVENTS if (e.section, e.kind) == (section, kind) and label in e.labels]
    return values[0] if len(values) == 1 else min(values, key=lambda value: abs(value - near))


def event(section: str, name: str, fitted: bool = True) -> Event:
    """A printed special point as `identify` takes it."""
    (found,) = (e for e in EVENTS if (e.section, e.name) == (section, name))
    return Event(found.kind, found.labels[0], found.value, found.digits, fitted=fitted)
