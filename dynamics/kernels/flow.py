"""The period map: whole cells by their tabulated maps, and the cells that hold an impact in stretches."""

import math

import numpy as np

from dynamics.kernels.compiling import (
    CROWDED,
    DIVERGED,
    FINE,
    FREE,
    FREQUENCY,
    HALF_BACKLASH,
    MAX_EVENTS,
    SIDES,
    ZERO,
    ZETA,
    FloatArray,
    IntArray,
    Space,
    Table,
    helper,
    plain_kernel,
)
from dynamics.kernels.regions import clear, drag_jump, enter, leave, start
from dynamics.kernels.roots import choices, poly, shift, sole_root


def space_of(degree: int) -> Space:
    """Work space of a motion: five rows, `binomials`, zeros for a derivative and an image, two rows of counts.

    Made here because what allocates takes long to compile. Motions at the same time need one each.
    """
    return np.empty((5, degree + 1)), choices(degree), np.zeros((5, 2)), np.zeros((2, 2), dtype=np.int64)


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
    """Return whether a motion that has just come in with speed w is proved to stay for the rest of the cell.

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
def advance(p0: float, p1: float, q0: float, q1: float, jac: FloatArray) -> None:
    """Multiply the sensitivities by a matrix with the rows p and q."""
    for j in range(2):
        top = p0 * jac[0, j] + p1 * jac[1, j]
        jac[1, j] = q0 * jac[0, j] + q1 * jac[1, j]
        jac[0, j] = top


@helper
def sole_exit(
    region: int, par: FloatArray, y: float, w: float, y_end: float, w_end: float, jerk: float
) -> int:
    """Boundary (1, -1) that a motion leaves through exactly once, 0 if it leaves through none, 2 if that is open.

    The speed departs from its chord by less than `jerk`: if it is proved to keep its sign, the ends decide.
    """
    if not (w * w_end > 0.0 and min(abs(w), abs(w_end)) > jerk):
        return 2
    if region != 0:
        if region * w > 0.0 or region * y_end >= 0.0:
            return 0
        return region if region * y > 0.0 else 2
    side = 1 if w > 0.0 else -1
    d = par[HALF_BACKLASH]
    if (side == -1 and par[SIDES] < 1.5) or d - side * y_end >= 0.0:
        return 0
    return side if d - side * y > 0.0 else 2


@helper
def cross_cell(
    par: FloatArray, coef: FloatArray, edge: FloatArray, cell: int, region: int, y: float, w: float, want: int,
    jac: FloatArray, work: FloatArray, choose: FloatArray, count: IntArray,
) -> tuple[int, float, float, int]:  # fmt: skip
    """State at the end of a cell that may hold impacts; counts exits and entries.

    Between impacts the motion, and its sensitivities, are those of its state at the middle of the cell.
    """
    cells = len(edge) // 2
    a, b, g = work[0], work[1], work[2]
    s = -0.5
    fresh = ZERO
    row = cell if region != 0 else cell + cells
    c0 = edge[row, 9] * y + edge[row, 10] * w + edge[row, 13]
    c1 = edge[row, 11] * y + edge[row, 12] * w + edge[row, 14]
    if want > 0:
        advance(edge[row, 9], edge[row, 10], edge[row, 11], edge[row, 12], jac)
    for _ in range(MAX_EVENTS):
        y_end = c0 * edge[row, 21] + c1 * edge[row, 22] + edge[row, 23]
        w_end = c0 * edge[row, 24] + c1 * edge[row, 25] + edge[row, 26]
        rest = 0.5 - s
        jerk = (abs(c0) * edge[row, 27] + abs(c1) * edge[row, 28] + edge[row, 29]) * rest * rest
        hit = sole_exit(region, par, y, w, y_end, w_end, jerk)
        if hit == 2 and fresh != 0:
            bend = abs(c0) * edge[row, 18] + abs(c1) * edge[row, 19] + edge[row, 20]
            if stays(par, region, fresh, y, y_end, w, bend, rest):
                hit = ZERO
        if hit == 2:
            expand_from(coef, row, s, y, w, c0, c1, a, b, choose)
            t, hit = leave(region, par, a, g, b, rest, fresh)
            if hit != 0:
                _, w, _ = poly(a, ZERO, t)
                s += t
        elif hit != 0:
            for k in range(len(b)):
                b[k] = c0 * coef[row, 0, k] + c1 * coef[row, 1, k] + coef[row, 2, k]
            limit = 0.0 if region != 0 else hit * par[HALF_BACKLASH]
            s, w = sole_root(b, limit, s, y, w, y_end, w_end)
        if hit == 0:
            if want > 0:
                advance(edge[row, 21], edge[row, 22], edge[row, 24], edge[row, 25], jac)
            return region, y_end, w_end, FINE
        if want > 0:
            f0, f1, _, g0, g1, _ = basis(coef, row, s)
            if par[ZETA] != par[FREE]:  # the acceleration jumps
                new = enter(region, hit, par)[0]
                jump = drag_jump(par, region, new) * (2.0 * math.pi / par[FREQUENCY] / cells)
                g0 -= jump * f0
                g1 -= jump * f1
                jac[3, 0] += (cell + s + 0.5) * ((new == 0) - (region == 0))
            advance(f0, f1, g0, g1, jac)
        old = region
        region, y = enter(region, hit, par)
        fresh = hit
        count[0] += old == 1
        count[1] += region == -1
        if s >= 0.5:
            return region, y, w, FINE
        row = cell if region != 0 else cell + cells
        f0, f1, f2, g0, g1, g2 = basis(coef, row, s)
        wronskian = f0 * g1 - f1 * g0
        p, q = y - f2, w - g2
        c0, c1 = (p * g1 - q * f1) / wronskian, (q * f0 - p * g0) / wronskian
        if want > 0:
            advance(g1 / wronskian, -f1 / wronskian, -g0 / wronskian, f0 / wronskian, jac)
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


@helper
def some_cells(
    par: FloatArray, coef: FloatArray, edge: FloatArray, first: int, last: int, region: int, y: float, w: float,
    want: int, jac: FloatArray, work: FloatArray, choose: FloatArray, count: IntArray,
) -> tuple[int, float, float, int]:  # fmt: skip
    """Carry a state, in its region's coordinates, over the cells before `last`; `want` and `jac` as in `iterate`."""
    cells = len(edge) // 2
    for cell in range(first, last):
        row = cell if region != 0 else cell + cells
        y_new = edge[row, 0] * y + edge[row, 1] * w + edge[row, 4]
        reach = edge[row, 6] * abs(y) + edge[row, 7] * abs(w) + edge[row, 8]
        if clear(region, par, y, y_new, reach):
            w = edge[row, 2] * y + edge[row, 3] * w + edge[row, 5]
            y = y_new
            if want > 0:
                advance(edge[row, 0], edge[row, 1], edge[row, 2], edge[row, 3], jac)
        else:
            region, y, w, flag = cross_cell(
                par, coef, edge, cell, region, y, w, want, jac, work, choose, count
            )
            if flag != FINE:
                return region, y, w, flag
        if want == 2 and (cell % 8 == 7 or cell == cells - 1):
            straighten(jac, 2.0 * math.pi / par[FREQUENCY] / cells)
    return region, y, w, FINE if abs(y) < 1e150 and abs(w) < 1e150 else DIVERGED


@plain_kernel
def iterate(
    table: Table, space: Space, first: int, number: int, state: FloatArray, skip: int, want: int, jac: FloatArray,
    states: FloatArray, counts: IntArray,
) -> int:  # fmt: skip
    """Carry `state` over `skip` rounds, then fill `states` (rounds, 2) and `counts` (rounds, 2).

    A round is `number` cells from cell `first`, a period if these are 0 and all. Row i is the state after i + 1 further
    rounds and the exits and entries during the last of them. `state` ends at the last round; the region of a state on a
    boundary is decided by its speed. `want` 1: the rows 0 and 1 of `jac`, (4, 2), are multiplied by the derivative of
    the map; 2: its columns are made orthonormal on the way, and the logarithms of their stretch added to row 2. In both
    cases jac[3, 0] takes the time in contact, in cells, where damping is another one out of it.
    """
    par, coef, edge = table
    cells = len(edge) // 2
    h = 2.0 * math.pi / par[FREQUENCY] / cells
    work, choose, _, tally = space
    count = tally[0]
    region, y = start(state[0], state[1], par)
    w = state[1] * h
    if want > 0:
        jac[1, 0] *= h
        jac[1, 1] *= h
    for period in range(skip + len(states)):
        count[0] = count[1] = 0
        at, rest = first, number
        while rest > 0:
            last = min(cells, at + rest)
            if want > 0 and region != 0:
                jac[3, 0] -= at
            region, y, w, flag = some_cells(
                par, coef, edge, at, last, region, y, w, want, jac, work, choose, count
            )
            if flag != FINE:
                return flag
            if want > 0 and region != 0:
                jac[3, 0] += last
            rest -= last - at
            at = ZERO
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
