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
    helper,
    plain_kernel,
)
from dynamics.kernels.flow import expand
from dynamics.kernels.regions import enter, leave, note_extremum, start
from dynamics.kernels.roots import copy, find_turn, poly


@helper
def note_turns(
    rest: FloatArray, spare: FloatArray, g: FloatArray, b: FloatArray, choose: FloatArray, t: float, way: int,
    now: float, region: int, par: FloatArray, h: float, turns: FloatArray, turned: int,
) -> tuple[int, int]:  # fmt: skip
    """Note the extrema within t of the motion `rest`, which is used up, `now` cells from the start.

    Returns which way the motion goes on and the number of extrema; what does not fit in `turns` is counted alone.
    """
    done = 0.0
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
    return way, turned


@helper
def note_impact(events: FloatArray, happened: int, tau: float, x: float, v: float, region: int) -> int:
    """Note a crossing of the backlash's limit and the region entered, if it fits; returns the number of crossings."""
    if happened < len(events):
        events[happened, 0] = tau
        events[happened, 1] = x
        events[happened, 2] = v
        events[happened, 3] = region
    return happened + 1


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
            copy(a, rest)
            way, turned = note_turns(rest, spare, g, b, choose, t, way, now, region, par, h, turns, turned)
            y, w, _ = poly(a, ZERO, t)
            s = 0.5 if hit == 0 else s + t
            if hit == 0:
                break
            region, y = enter(region, hit, par)
            fresh = hit
            happened = note_impact(events, happened, (global_cell + s + 0.5) * h, hit * d, w / h, region)
            if s >= 0.5:
                break
        if not (abs(y) < 1e150 and abs(w) < 1e150):
            return DIVERGED, turned, happened
    while filled < len(samples):
        samples[filled, 0] = y + region * d
        samples[filled, 1] = w / h
        filled += 1
    return FINE, turned, happened
