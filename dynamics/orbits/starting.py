"""Where searches for orbits start: boxes around long motions, and states in them."""

from __future__ import annotations

import numpy as np

from base import Array
from dynamics.flow.flows import flow_of
from dynamics.flow.motions import period_map
from dynamics.flow.protocol import Flow
from dynamics.model.protocol import PeriodicOscillator, settling_periods
from dynamics.model.states import Region


def reach(oscillator: PeriodicOscillator) -> Region:
    """Box of X and V, from the middle of basins, somewhat larger than what long motions from three starts cover."""
    centre = oscillator.start_plane()[1]
    states = np.vstack([centre, long_motions(oscillator, flow_of(oscillator))[0]])
    plane = oscillator.in_plane(states)
    return around(np.max(np.abs(plane[1:] - plane[0]), axis=0, initial=1e-9))


def long_motions(oscillator: PeriodicOscillator, flow: Flow) -> tuple[Array, int]:
    """States of motions from three starts, the later ones at the end, and the periods that they took.

    What diverges is left out.
    """
    rest, (across, along) = oscillator.rest_state(), oscillator.start_plane()[0]
    x = float(oscillator.contact_motion(np.zeros(1), rest[None])[0][0])
    push = (1.0 + abs(x)) * along
    wait = min(settling_periods(oscillator, low=50), 400)
    parts, used = [], 0
    for start in (rest, rest + push, rest - 2.0 * x * across - push):
        image = period_map(flow, start, 80, skip=wait)
        used += wait + 80
        if not image.message and float(np.max(np.abs(image.states))) < 1e6:
            parts.append(image.states)
    return (np.stack(parts, axis=1).reshape(-1, len(rest)) if parts else np.array([rest])), used


def grid_of(region: Region, side: int) -> Array:
    """States at equal distances, so many along each side."""
    x, v = (np.linspace(*ends, side) for ends in region)
    return np.stack(np.meshgrid(x, v), axis=-1).reshape(-1, 2)


def around(size: Array) -> Region:
    """Box somewhat larger than a motion."""
    x, v = (float(1.3 * s + 0.1 * np.max(size)) for s in size)
    return (-x, x), (-v, v)
