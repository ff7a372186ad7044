"""The period map in several freedoms: whole cells by their maps, and cells that hold an impact by expansion."""

import math

import numpy as np

from dynamics.kernels.compiling import (
    CROWDED,
    DIVERGED,
    FINE,
    FREQUENCY,
    HALF_BACKLASH,
    MAX_EVENTS,
    ONE,
    ZERO,
    FloatArray,
    IntArray,
    helper,
    kernel,
    maker,
)
from dynamics.kernels.drives import STRIDE
from dynamics.kernels.drives.columns import multiply, scale_rows, straighten
from dynamics.kernels.drives.expanding import evaluate, evaluate_many, excite, expand, expand_many
from dynamics.kernels.regions import clear, enter, leave, start
from dynamics.kernels.roots import binomials, copy, shift

Drive = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]
"""par, systems, load, series, maps, reach, strides"""
Room = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]
"""A motion and its push (m, degree + 1), six rows of as many and one for each periodic force, a state (2 m,), what
`binomials` gives; motions of many columns (degree + 1, m, 2 m), as many states (2 m, 2 m), and the end of a stride."""
PUSHED = 6
"""First of the rows of periodic forces."""


@maker
def room_for(m: int, n: int, rows: int) -> Room:
    """Work space for m freedoms and n coefficients of so many rows of a cell's `series`."""
    many, square = np.empty((n, m, 2 * m)), np.empty((2 * m, 2 * m))
    return (
        np.empty((m, n)),
        np.zeros((m, n)),
        np.zeros((PUSHED + rows - 2, n)),
        np.empty(2 * m),
        binomials(n - 1),
        many,
        square,
        np.empty(2 * m + 2 * STRIDE),
    )


@helper
def aim(
    systems: FloatArray, load: FloatArray, series: FloatArray, cell: int, s: float, region: int, d: float,
    z: FloatArray, room: Room,
) -> None:  # fmt: skip
    """Expand the motion through z at s of a cell, which becomes room[0]; stiffness and push about s are kept, too."""
    a, push, lines, _, choose, _, _, _ = room
    m = len(a)
    if s == 0.0:
        copy(series[cell, 0], lines[0])
        copy(series[cell, 1], lines[1])
    else:
        shift(series[cell, 0], s, choose, lines[0])
        shift(series[cell, 1], s, choose, lines[1])
    for j in range(series.shape[1] - 2):
        shift(series[cell, 2 + j], s, choose, lines[PUSHED + j])
    excite(systems, load, lines[1], lines[PUSHED:], push)
    for i in range(m):
        a[i, 0] = z[i]
        a[i, 1] = z[m + i]
    expand(systems, lines[0], push, region * d, ZERO if region != 0 else ONE, a)


@helper
def carry_columns(systems: FloatArray, kind: int, t: float, jac: FloatArray, room: Room) -> None:
    """Sensitivities over a time t after what `aim` expanded."""
    _, _, lines, _, _, many, _, _ = room
    expand_many(systems, lines[0], kind, jac, many)
    evaluate_many(many, t, jac)


@helper
def cross_cell(
    table: Drive,
    cell: int,
    region: int,
    z: FloatArray,
    want: int,
    jac: FloatArray,
    room: Room,
    count: IntArray,
) -> tuple[int, int]:
    """Carry the state z through a cell that may hold impacts; counts exits and entries, and the time in contact."""
    par, systems, load, series, _, _, _ = table
    a, _, lines, _, _, _, _, _ = room
    m, s, fresh = len(a), 0.0, ZERO
    for _ in range(MAX_EVENTS):
        aim(systems, load, series, cell, s, region, par[HALF_BACKLASH], z, room)
        t, hit = leave(region, par, a[0], lines[2], lines[3], 1.0 - s, fresh)
        evaluate(a, t, z)
        kind = ZERO if region != 0 else ONE
        if want > 0:
            carry_columns(systems, kind, t, jac, room)
        if region != 0:
            lines[4, 0] += t
        if hit == 0:
            return region, FINE
        count[0] += region == 1
        region, z[0] = enter(region, hit, par)
        count[1] += region == -1
        jump = systems[1 if region != 0 else 2, 0, 0] - systems[1 + kind, 0, 0]
        if want > 0 and jump != 0.0:  # damping jumps, and with it the acceleration
            for j in range(2 * m):
                jac[m, j] -= jump * jac[0, j]
        fresh = hit
        s += t
        if s >= 1.0:
            return region, FINE
    return region, CROWDED


@helper
def take_stride(par: FloatArray, stride: FloatArray, region: int, z: FloatArray, wide: FloatArray) -> bool:
    """Carry a state in contact over a stride if it stays there for certain; say whether it was."""
    n, d = len(z), par[HALF_BACKLASH]
    reach = n + STRIDE
    for i in range(reach):
        wide[i] = stride[n, i] + region * d * stride[n + 1, i]
    for i in range(reach, reach + STRIDE):
        wide[i] = stride[n, i] + d * stride[n + 1, i]
    for j in range(n):
        size = abs(z[j])
        for i in range(reach):
            wide[i] += stride[j, i] * z[j]
        for i in range(reach, reach + STRIDE):
            wide[i] += stride[j, i] * size
    y = z[0]
    for k in range(STRIDE):
        if not clear(region, par, y, wide[n + k], wide[reach + k]):
            return False
        y = wide[n + k]
    for i in range(n):
        z[i] = wide[i]
    return True


@helper
def some_cells(
    table: Drive, first: int, number: int, region: int, z: FloatArray, want: int, jac: FloatArray, room: Room,
    count: IntArray,
) -> tuple[int, int]:  # fmt: skip
    """Carry a state over some cells; returns its region and a flag. `want` and `jac` as in `iterate`, in cells."""
    par, _, _, series, maps, reach, strides = table
    _, _, lines, end, _, _, square, wide = room
    cells, n, d = len(series), len(z), par[HALF_BACKLASH]
    at, last = first, first + number
    while at < last:
        cell = at % cells
        which = cell // STRIDE
        whole = which * STRIDE == cell and which < len(strides) and at + STRIDE <= last
        if whole and want < 2 and region != 0 and take_stride(par, strides[which], region, z, wide):
            if want > 0:
                multiply(strides[which], jac, square)
            lines[4, 0] += STRIDE
            at += STRIDE
            continue
        row = cell if region != 0 else cell + cells
        bound = reach[row, n] + d * reach[row, n + 1]
        for i in range(n):
            end[i] = maps[row, n, i] + region * d * maps[row, n + 1, i]
        for j in range(n):
            bound += reach[row, j] * abs(z[j])
            for i in range(n):
                end[i] += maps[row, j, i] * z[j]
        if clear(region, par, z[0], end[0], bound):
            copy(end, z)
            if want > 0:
                multiply(maps[row], jac, square)
            if region != 0:
                lines[4, 0] += 1.0
        else:
            region, flag = cross_cell(table, cell, region, z, want, jac, room, count)
            if flag != FINE:
                return region, flag
        if want == 2 and (cell % 8 == 7 or cell == cells - 1):
            straighten(jac, 2.0 * math.pi / par[FREQUENCY] / cells)
        at += 1
    size = 0.0
    for i in range(n):
        size += abs(z[i])
    return region, FINE if size < 1e150 else DIVERGED


@helper
def enter_cells(par: FloatArray, h: float, state: FloatArray, z: FloatArray) -> int:
    """State in cells, z, of one in time; returns its region."""
    m = len(z) // 2
    for i in range(m):
        z[i] = state[i]
        z[m + i] = state[m + i] * h
    region, y = start(state[0], state[m], par)
    z[0] = y
    return region


@helper
def leave_cells(par: FloatArray, h: float, region: int, z: FloatArray, state: FloatArray) -> None:
    """State in time of one in cells."""
    m = len(z) // 2
    for i in range(m):
        state[i] = z[i]
        state[m + i] = z[m + i] / h
    state[0] += region * par[HALF_BACKLASH]


@kernel
def iterate(
    table: Drive, first: int, number: int, state: FloatArray, skip: int, want: int, jac: FloatArray,
    states: FloatArray, counts: IntArray, clock: FloatArray,
) -> int:  # fmt: skip
    """Carry `state` over `skip` rounds, then fill `states` and `counts`, one row for each further round.

    A round is `number` cells from cell `first`, a period if these are 0 and all. `want`, `jac`: as for one freedom,
    2 m columns. `clock`, (1,): time in contact is added.
    """
    par, _, load, series, _, _, _ = table
    m, n = load.shape[1], series.shape[2]
    h = 2.0 * math.pi / par[FREQUENCY] / len(series)
    room = room_for(m, n, series.shape[1])
    z, count = np.empty(2 * m), np.zeros(2, dtype=np.int64)
    region = enter_cells(par, h, state, z)
    if want > 0:
        scale_rows(jac, h)
    for period in range(skip + len(states)):
        count[0] = count[1] = 0
        region, flag = some_cells(table, first, number, region, z, want, jac, room, count)
        if flag != FINE:
            return flag
        if period >= skip:
            leave_cells(par, h, region, z, states[period - skip])
            counts[period - skip, 0] = count[0]
            counts[period - skip, 1] = count[1]
    leave_cells(par, h, region, z, state)
    if want > 0:
        scale_rows(jac, 1.0 / h)
    clock[0] += room[2][4, 0] * h
    return FINE


@kernel
def settle(
    table: Drive, starts: FloatArray, homes: FloatArray, radius: float, limit: int, labels: IntArray
) -> int:
    """Follow every start with label -1 until it stays near a known attractor; as for one freedom.

    `homes`, (any, 2 m + 2): state, attractor and its period for every point of every attractor.
    """
    par, _, load, series, _, _, _ = table
    m, n = load.shape[1], series.shape[2]
    h = 2.0 * math.pi / par[FREQUENCY] / len(series)
    room = room_for(m, n, series.shape[1])
    z, count, jac = np.empty(2 * m), np.zeros(2, dtype=np.int64), np.zeros((2 * m + 1, 2 * m))
    used = 0
    for i in range(len(starts)):
        region = enter_cells(par, h, starts[i], z)
        home = wait = period = 0
        distance = 0.0
        while labels[i] == -1 and period < limit:
            period += 1
            region, flag = some_cells(table, ZERO, len(series), region, z, ZERO, jac, room, count)
            if flag != FINE:
                labels[i] = -2
            leave_cells(par, h, region, z, starts[i])
            wait -= 1
            for k in range(
                home if wait == 0 else 0, home + 1 if wait == 0 else len(homes) if wait < 0 else 0
            ):
                gap = 0.0
                for j in range(2 * m):
                    gap = max(gap, abs(starts[i, j] - homes[k, j]))
                if wait == 0 and gap <= distance:
                    labels[i] = int(homes[k, 2 * m])
                elif wait < 0 and gap < radius:
                    home, distance, wait = k, gap, int(homes[k, 2 * m + 1])
        used += period
    return used
