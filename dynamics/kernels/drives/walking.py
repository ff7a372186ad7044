"""The motion in several freedoms followed closely: samples, extrema of y and impacts."""

import math

import numpy as np

from dynamics.kernels.compiling import (
    CROWDED,
    DIVERGED,
    FINE,
    FREQUENCY,
    HALF_BACKLASH,
    MAX_EVENTS,
    ZERO,
    FloatArray,
    kernel,
)
from dynamics.kernels.drives.expanding import evaluate
from dynamics.kernels.drives.propagating import Drive, aim, enter_cells, leave_cells, room_for
from dynamics.kernels.regions import enter, leave
from dynamics.kernels.roots import copy
from dynamics.kernels.walking import note_impact, note_turns


@kernel
def walk(
    table: Drive, state: FloatArray, periods: int, points: int, samples: FloatArray, turns: FloatArray,
    events: FloatArray,
) -> tuple[int, int, int]:  # fmt: skip
    """Follow the motion closely; arguments and what is returned as for one freedom, samples (any, 2 m)."""
    par, systems, load, series, _, _, _ = table
    m, cells, n = load.shape[1], len(series), series.shape[2]
    d, h = par[HALF_BACKLASH], 2.0 * math.pi / par[FREQUENCY] / cells
    room = room_for(m, n, series.shape[1])
    a, _, lines, end, choose, _, _, _ = room
    z = np.empty(2 * m)
    g, b, rest, spare = lines[2], lines[3], lines[4], lines[5]
    region = enter_cells(par, h, state, z)
    filled = turned = happened = 0
    way = ZERO
    for global_cell in range(periods * cells):
        s, fresh = 0.0, ZERO
        for event in range(MAX_EVENTS + 1):
            if event == MAX_EVENTS:
                return CROWDED, turned, happened
            now = global_cell + s
            aim(systems, load, series, global_cell % cells, s, region, d, z, room)
            t, hit = leave(region, par, a[0], g, b, 1.0 - s, fresh)
            while points > 0 and filled < len(samples):
                at = filled * (cells / points) - now
                if at > t:
                    break
                evaluate(a, max(at, 0.0), end)
                leave_cells(par, h, region, end, samples[filled])
                filled += 1
            copy(a[0], rest)
            way, turned = note_turns(rest, spare, g, b, choose, t, way, now, region, par, h, turns, turned)
            evaluate(a, t, z)
            s = 1.0 if hit == 0 else s + t
            if hit == 0:
                break
            region, z[0] = enter(region, hit, par)
            fresh = hit
            happened = note_impact(events, happened, (global_cell + s) * h, hit * d, z[m] / h, region)
            if s >= 1.0:
                break
        size = 0.0
        for i in range(2 * m):
            size += abs(z[i])
        if not size < 1e150:
            return DIVERGED, turned, happened
    while filled < len(samples):
        leave_cells(par, h, region, z, samples[filled])
        filled += 1
    return FINE, turned, happened
