"""The period map: whole cells by their tabulated maps, and the cells that hold an impact in stretches."""

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
    SIDES,
    ZERO,
    FloatArray,
    IntArray,
    Table,
    helper,
    kernel,
)
from dynamics.kernels.regions import clear, enter, leave, start
from dynamics.kernels.roots import binomials, poly, shift


@helper
def basis(coef: FloatArray, row: int, s: float) -> tuple[float, float, float, float, float, float]:
    """Values y1, y2, yp and speeds of the three tabulated solutions at s."""
    f0 = f1 = f2 = g0 = g1 = g2 = 0.0
    for k in range(coef.shape[2] - 1, -1, -1):
        g0 = g0 * s + f0
        f0 = f0 * s + coef[row, 0, k]
        g1 = g1 * s + f1
        f1 = f1 * s + coef[row, 1, k]
        g2 = g2 * s + f2
        f2 = f2 * s + coef[row, 2, k]
    return f0, f1, f2, g0, g1, g2


@helper
def middle(coef: FloatArray, edge: FloatArray, row: int, s: float, y: float, w: float) -> tuple[float, float]:
    """State at the middle of the cell of the solution through (y, w) at s."""
    if s == -0.5:
        c0 = edge[row, 9] * y + edge[row, 10] * w + edge[row, 13]
        return c0, edge[row, 11] * y + edge[row, 12] * w + edge[row, 14]
    f0, f1, f2, g0, g1, g2 = basis(coef, row, s)
    wronskian = f0 * g1 - f1 * g0
    p, q = y - f2, w - g2
    return (p * g1 - q * f1) / wronskian, (q * f0 - p * g0) / wronskian


@helper
def expand(
    coef: FloatArray, edge: FloatArray, row: int, s: float, y: float, w: float, a: FloatArray, b: FloatArray,
    choose: FloatArray,
) -> None:  # fmt: skip
    """Taylor coefficients `a` about s of the solution through (y, w) at s; `b` is work space."""
    c0, c1 = middle(coef, edge, row, s, y, w)
    expand_from(coef, row, s, y, w, c0, c1, a, b, choose)


@helper
def expand_from(
    coef: FloatArray, row: int, s: float, y: float, w: float, c0: float, c1: float, a: FloatArray, b: FloatArray,
    choose: FloatArray,
) -> None:  # fmt: skip
    """Do the same from the state at the middle."""
    for k in range(len(a)):
        b[k] = c0 * coef[row, 0, k] + c1 * coef[row, 1, k] + coef[row, 2, k]
    shift(b, s, choose, a)
    a[0] = y
    a[1] = w


@helper
def stays(
    par: FloatArray, region: int, fresh: int, y: float, y_end: float, w: float, bend: float, rest: float
) -> bool:
    """Tell whether a motion that has just come in with speed w is proved to stay for the rest of the cell.

    `bend` bounds |d2y/ds2|/8: it cannot turn back to the boundary it came through if |w| > 4 bend rest, and it stays
    clear of the other one if both its ends do by bend rest^2.
    """
    if region != 0:
        return region * w > 4.0 * bend * rest
    if not -fresh * w > 4.0 * bend * rest:
        return False
    if fresh == 1 and par[SIDES] < 1.5:
        return True
    return bool(par[HALF_BACKLASH] - max(-fresh * y, -fresh * y_end) > bend * rest * rest)


@helper
def carry(coef: FloatArray, row: int, s: float, later: float, jac: FloatArray) -> None:
    """Multiply the sensitivities by the flow between two instants of a cell."""
    f0, f1, _, g0, g1, _ = basis(coef, row, s)
    p0, p1, _, q0, q1, _ = basis(coef, row, later)
    wronskian = f0 * g1 - f1 * g0
    for j in range(2):
        c0 = (jac[0, j] * g1 - jac[1, j] * f1) / wronskian
        c1 = (jac[1, j] * f0 - jac[0, j] * g0) / wronskian
        jac[0, j] = c0 * p0 + c1 * p1
        jac[1, j] = c0 * q0 + c1 * q1


@helper
def apply(edge: FloatArray, row: int, jac: FloatArray) -> None:
    """Multiply the sensitivities by the map of a whole cell."""
    for j in range(2):
        top = edge[row, 0] * jac[0, j] + edge[row, 1] * jac[1, j]
        jac[1, j] = edge[row, 2] * jac[0, j] + edge[row, 3] * jac[1, j]
        jac[0, j] = top


@helper
def cross_cell(
    par: FloatArray, coef: FloatArray, edge: FloatArray, cell: int, region: int, y: float, w: float, want: int,
    jac: FloatArray, a: FloatArray, b: FloatArray, g: FloatArray, choose: FloatArray, count: IntArray,
) -> tuple[int, float, float, int]:  # fmt: skip
    """State at the end of a cell that may hold impacts; counts exits and entries."""
    cells = len(edge) // 2
    s = -0.5
    fresh = ZERO
    for _ in range(MAX_EVENTS):
        row = cell if region != 0 else cell + cells
        c0, c1 = middle(coef, edge, row, s, y, w)
        if fresh != 0:
            y_end = c0 * edge[row, 21] + c1 * edge[row, 22] + edge[row, 23]
            bend = abs(c0) * edge[row, 18] + abs(c1) * edge[row, 19] + edge[row, 20]
            if stays(par, region, fresh, y, y_end, w, bend, 0.5 - s):
                if want > 0:
                    carry(coef, row, s, 0.5, jac)
                return region, y_end, c0 * edge[row, 24] + c1 * edge[row, 25] + edge[row, 26], FINE
        expand_from(coef, row, s, y, w, c0, c1, a, b, choose)
        t, hit = leave(region, par, a, g, b, 0.5 - s, fresh)
        if hit == 0 and s == -0.5:  # nothing happened: the map of the whole cell holds
            if want > 0:
                apply(edge, row, jac)
            y_new = edge[row, 0] * y + edge[row, 1] * w + edge[row, 4]
            return region, y_new, edge[row, 2] * y + edge[row, 3] * w + edge[row, 5], FINE
        y, w, _ = poly(a, ZERO, t)
        later = 0.5 if hit == 0 else s + t
        if want > 0 and t > 0.0:
            carry(coef, row, s, later, jac)
        s = later
        if hit == 0:
            return region, y, w, FINE
        old = region
        region, y = enter(region, hit, par)
        fresh = hit
        count[0] += old == 1
        count[1] += region == -1
        if s >= 0.5:
            return region, y, w, FINE
    return region, y, w, CROWDED


@helper
def straighten(jac: FloatArray, h: float) -> None:
    """Make the columns of rows 0 and 1 orthonormal in (X, V) and add the logarithms of their lengths to row 2."""
    v0, v1 = jac[1, 0] / h, jac[1, 1] / h
    area = jac[0, 0] * v1 - jac[0, 1] * v0
    length = math.hypot(jac[0, 0], v0)
    jac[2, 0] += math.log(length)
    jac[2, 1] += math.log(abs(area) / length)
    c, s = jac[0, 0] / length, v0 / length
    turned = 1.0 if area > 0.0 else -1.0
    jac[0, 0], jac[1, 0] = c, s * h
    jac[0, 1], jac[1, 1] = -s * turned, c * turned * h


@kernel
def iterate(
    table: Table,
    state: FloatArray,
    skip: int,
    want: int,
    jac: FloatArray,
    states: FloatArray,
    counts: IntArray,
) -> int:
    """Carry `state` over `skip` periods, then fill `states` (periods, 2) and `counts` (periods, 2).

    Row i is the state after i + 1 further periods and the exits and entries during the last of them. `state`
    ends at the last period. `want` 1: the rows 0 and 1 of `jac` are multiplied by the derivative of the map;
    2: its columns are made orthonormal on the way, and the logarithms of their stretch added to row 2.
    """
    par, coef, edge = table
    cells = len(edge) // 2
    h = 2.0 * math.pi / par[FREQUENCY] / cells
    n = coef.shape[2]
    a, b, g, choose = np.empty(n), np.empty(n), np.empty(n), binomials(n - 1)
    count = np.zeros(2, dtype=np.int64)
    region, y = start(state[0], state[1], par)
    w = state[1] * h
    if want > 0:
        jac[1, 0] *= h
        jac[1, 1] *= h
    for period in range(skip + len(states)):
        count[0] = count[1] = 0
        for cell in range(cells):
            row = cell if region != 0 else cell + cells
            y_new = edge[row, 0] * y + edge[row, 1] * w + edge[row, 4]
            reach = edge[row, 6] * abs(y) + edge[row, 7] * abs(w) + edge[row, 8]
            if clear(region, par, y, y_new, reach):
                w = edge[row, 2] * y + edge[row, 3] * w + edge[row, 5]
                y = y_new
                if want > 0:
                    apply(edge, row, jac)
            else:
                region, y, w, flag = cross_cell(
                    par, coef, edge, cell, region, y, w, want, jac, a, b, g, choose, count
                )
                if flag != FINE:
                    return flag
            if want == 2 and (cell % 8 == 7 or cell == cells - 1):
                straighten(jac, h)
        if not (abs(y) < 1e150 and abs(w) < 1e150):
            return DIVERGED
        if period >= skip:
            states[period - skip, 0] = y + region * par[HALF_BACKLASH]
            states[period - skip, 1] = w / h
            counts[period - skip, 0] = count[0]
            counts[period - skip, 1] = count[1]
    state[0] = y + region * par[HALF_BACKLASH]
    state[1] = w / h
    if want > 0:
        jac[1, 0] /= h
        jac[1, 1] /= h
    return FINE


@kernel
def partial(
    table: Table, first: int, number: int, state: FloatArray, jac: FloatArray, counts: IntArray
) -> int:
    """Carry `state` and the columns of `jac` over some cells from cell `first`; adds to `counts` (2).

    The state is taken in (X, V) at the start of the first cell. The region of a state on a boundary is decided by
    its speed.
    """
    par, coef, edge = table
    cells = len(edge) // 2
    h = 2.0 * math.pi / par[FREQUENCY] / cells
    n = coef.shape[2]
    a, b, g, choose = np.empty(n), np.empty(n), np.empty(n), binomials(n - 1)
    region, y = start(state[0], state[1], par)
    w = state[1] * h
    jac[1, 0] *= h
    jac[1, 1] *= h
    for at in range(first, first + number):
        region, y, w, flag = cross_cell(
            par, coef, edge, at % cells, region, y, w, ONE, jac, a, b, g, choose, counts
        )
        if flag != FINE:
            return flag
    state[0] = y + region * par[HALF_BACKLASH]
    state[1] = w / h
    jac[1, 0] /= h
    jac[1, 1] /= h
    return FINE if abs(y) < 1e150 and abs(w) < 1e150 else DIVERGED
