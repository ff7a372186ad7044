"""The motion followed closely: samples, extrema and impacts."""

import math

from dynamics.kernels.compiling import (
    CROWDED,
    DIVERGED,
    FINE,
    FREQUENCY,
    HALF_BACKLASH,
    MAX_EVENTS,
    ZERO,
    FloatArray,
    Space,
    Table,
    plain_kernel,
)
from dynamics.kernels.flow import expand
from dynamics.kernels.regions import enter, leave, note_extremum, start
from dynamics.kernels.roots import copy, find_turn, poly


@plain_kernel
def walk(
    table: Table, space: Space, state: FloatArray, periods: int, points: int,
    samples: FloatArray, turns: FloatArray, events: FloatArray,
) -> tuple[int, int, int]:  # fmt: skip
    """Follow the motion closely; returns flag, number of turns and number of events.

    `samples`, (periods points + 1, 2): states at equal times. `turns`, (any, 5): time, X, X'', region and
    region's coordinate, at every extremum of X. `events`, (any, 4): time, X, X', region entered. What does
    not fit in `turns` or `events` is counted, not stored.
    """
    par, coef, edge = table
    cells = len(edge) // 2
    d, h = par[HALF_BACKLASH], 2.0 * math.pi / par[FREQUENCY] / cells
    work, choose, _, _ = space
    a, b, g, rest, spare = work[0], work[1], work[2], work[3], work[4]
    region, y = start(state[0], state[1], par)
    w = state[1] * h
    filled = turned = happened = 0
    way = ZERO
    for global_cell in range(periods * cells):
        cell = global_cell % cells
        s = -0.5
        fresh = ZERO
        for event in range(MAX_EVENTS + 1):
            if event == MAX_EVENTS:
                return CROWDED, turned, happened
            now = global_cell + s + 0.5
            expand(coef, edge, cell if region != 0 else cell + cells, s, y, w, a, b, choose)
            t, hit = leave(region, par, a, g, b, 0.5 - s, fresh)
            while points > 0 and filled < len(samples):
                at = filled * (cells / points) - now
                if at > t:
                    break
                f, df, _ = poly(a, ZERO, max(at, 0.0))
                samples[filled, 0] = f + region * d
                samples[filled, 1] = df / h
                filled += 1
            done = 0.0
            copy(a, rest)
            while len(turns) > 0:
                way, step = find_turn(rest, spare, g, b, choose, t - done, way if done == 0.0 else ZERO)
                if step < 0.0:
                    break
                done += step
                if turned < len(turns):
                    note_extremum(turns[turned], (now + done) * h, rest, region, par, h)
                turned += 1
                if step == 0.0:
                    way, done = ZERO, 0.0
            y, w, _ = poly(a, ZERO, t)
            s = 0.5 if hit == 0 else s + t
            if hit == 0:
                break
            region, y = enter(region, hit, par)
            fresh = hit
            if happened < len(events):
                events[happened, 0] = (global_cell + s + 0.5) * h
                events[happened, 1] = hit * d
                events[happened, 2] = w / h
                events[happened, 3] = region
            happened += 1
            if s >= 0.5:
                break
        if not (abs(y) < 1e150 and abs(w) < 1e150):
            return DIVERGED, turned, happened
    while filled < len(samples):
        samples[filled, 0] = y + region * d
        samples[filled, 1] = w / h
        filled += 1
    return FINE, turned, happened
