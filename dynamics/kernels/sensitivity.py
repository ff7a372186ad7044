"""The period map with first and second derivatives and with every extremum.

Directions: 0 and 1 are X and V at tau = 0, then come the given directions of the parameters. With W = V + g(X), g the
integral of the damping c over X, it is X' = W - g(X), W' = push - K f(X), continuous at an impact, so that first
derivatives of X and W pass it unchanged; that of V jumps by (c - c') (dX - dD). The slopes of g and f jump there, so
that the derivative of the Jacobian M of X and W jumps by (A - A') M dt, with A = (-c, 1; -K, 0) and dt the shift of the
instant of the impact.
"""

import math

from dynamics.kernels.compiling import (
    CROWDED,
    DIVERGED,
    FINE,
    FREE,
    FREQUENCY,
    HALF_BACKLASH,
    MAX_EVENTS,
    ZERO,
    ZETA,
    FloatArray,
    IntArray,
    Table,
    helper,
)
from dynamics.kernels.flow import basis, expand
from dynamics.kernels.regions import clear, drag_jump, enter, leave, note_extremum, start
from dynamics.kernels.roots import copy, find_turn, poly


@helper
def flow_derivatives(
    coef: FloatArray, dcoef: FloatArray, row: int, s: float, later: float, y: float, w: float,
    lin: FloatArray, bend: FloatArray,
) -> None:  # fmt: skip
    """Carry first (`lin`) and, if there is room for them, second derivatives between two instants of a cell."""
    f0, f1, f2, g0, g1, g2 = basis(coef, row, s)
    p0, p1, _, q0, q1, _ = basis(coef, row, later)
    wronskian = f0 * g1 - f1 * g0
    i00, i01, i10, i11 = g1 / wronskian, -f1 / wronskian, -g0 / wronskian, f0 / wronskian
    c0, c1 = i00 * (y - f2) + i01 * (w - g2), i10 * (y - f2) + i11 * (w - g2)
    second = len(bend) > 0
    for way in range(lin.shape[1] - 1, -1, -1):
        a0 = a1 = a2 = b0 = b1 = b2 = u0 = u1 = u2 = v0 = v1 = v2 = 0.0
        if way >= 2:
            part = dcoef[way - 2]
            a0, a1, a2, b0, b1, b2 = basis(part, row, s)
            u0, u1, u2, v0, v1, v2 = basis(part, row, later)
        for j in range(2 if second else 0):
            m0 = i00 * lin[0, j] + i01 * lin[1, j]
            m1 = i10 * lin[0, j] + i11 * lin[1, j]
            r0 = bend[way, 0, j] - a0 * m0 - a1 * m1
            r1 = bend[way, 1, j] - b0 * m0 - b1 * m1
            e0, e1 = i00 * r0 + i01 * r1, i10 * r0 + i11 * r1
            bend[way, 0, j] = e0 * p0 + e1 * p1 + m0 * u0 + m1 * u1
            bend[way, 1, j] = e0 * q0 + e1 * q1 + m0 * v0 + m1 * v1
    for way in range(lin.shape[1]):
        r0, r1 = lin[0, way], lin[1, way]
        u0 = u1 = u2 = v0 = v1 = v2 = 0.0
        if way >= 2:
            part = dcoef[way - 2]
            a0, a1, a2, b0, b1, b2 = basis(part, row, s)
            u0, u1, u2, v0, v1, v2 = basis(part, row, later)
            r0 -= a0 * c0 + a1 * c1 + a2
            r1 -= b0 * c0 + b1 * c1 + b2
        e0, e1 = i00 * r0 + i01 * r1, i10 * r0 + i11 * r1
        lin[0, way] = e0 * p0 + e1 * p1 + u0 * c0 + u1 * c1 + u2
        lin[1, way] = e0 * q0 + e1 * q1 + v0 * c0 + v1 * c1 + v2


@helper
def cell_derivatives(
    edge: FloatArray, dedge: FloatArray, row: int, y: float, w: float, lin: FloatArray, bend: FloatArray
) -> None:
    """Carry first and second derivatives over a whole cell."""
    a00, a01, a10, a11 = edge[row, 0], edge[row, 1], edge[row, 2], edge[row, 3]
    for way in range(len(bend)):
        for j in range(2):
            top = a00 * bend[way, 0, j] + a01 * bend[way, 1, j]
            low = a10 * bend[way, 0, j] + a11 * bend[way, 1, j]
            if way >= 2:
                p = way - 2
                top += dedge[p, row, 0] * lin[0, j] + dedge[p, row, 1] * lin[1, j]
                low += dedge[p, row, 2] * lin[0, j] + dedge[p, row, 3] * lin[1, j]
            bend[way, 0, j], bend[way, 1, j] = top, low
    for way in range(lin.shape[1]):
        top = a00 * lin[0, way] + a01 * lin[1, way]
        low = a10 * lin[0, way] + a11 * lin[1, way]
        if way >= 2:
            p = way - 2
            top += dedge[p, row, 0] * y + dedge[p, row, 1] * w + dedge[p, row, 4]
            low += dedge[p, row, 2] * y + dedge[p, row, 3] * w + dedge[p, row, 5]
        lin[0, way], lin[1, way] = top, low


@helper
def play(ways: FloatArray, way: int) -> float:
    """Change of D in a direction."""
    return float(ways[way - 2, HALF_BACKLASH]) if way >= 2 else 0.0


@helper
def stretch(par: FloatArray, ways: FloatArray, way: int) -> float:
    """Relative change of the cell's length in a direction."""
    return float(-ways[way - 2, FREQUENCY] / par[FREQUENCY]) if way >= 2 else 0.0


@helper
def note_slope(
    table: Table, dcoef: FloatArray, ways: FloatArray, region: int, row: int, s: float, done: float, y: float,
    w: float, lin: FloatArray, there: FloatArray, none: FloatArray, note: FloatArray,
) -> None:  # fmt: skip
    """Add the derivatives of X to the note of the extremum at s + done of a stretch that begins at s."""
    for k in range(lin.shape[1]):
        there[0, k], there[1, k] = lin[0, k], lin[1, k]
    flow_derivatives(table[1], dcoef, row, s, s + done, y, w, there, none)
    for k in range(lin.shape[1]):
        note[5 + k] = there[0, k] + region * play(ways, k)


@helper
def begin(
    par: FloatArray, ways: FloatArray, region: int, w: float, h: float, lin: FloatArray, bend: FloatArray
) -> None:
    """Derivatives of the state at the start, measured in cells."""
    for k in range(lin.shape[1]):
        lin[0, k], lin[1, k] = -region * play(ways, k), w * stretch(par, ways, k)
    lin[0, 0] = 1.0
    lin[1, 1] = h
    for k in range(len(bend)):
        bend[k, 0, 0] = bend[k, 0, 1] = bend[k, 1, 0] = 0.0
        bend[k, 1, 1] = h * stretch(par, ways, k)


@helper
def finish(
    par: FloatArray, ways: FloatArray, region: int, w: float, h: float, lin: FloatArray, bend: FloatArray
) -> None:
    """Derivatives of X and V from those measured in cells."""
    for k in range(lin.shape[1]):
        lin[0, k] += region * play(ways, k)
        for j in range(2 if len(bend) > 0 else 0):
            bend[k, 1, j] = (bend[k, 1, j] - stretch(par, ways, k) * lin[1, j]) / h
    for k in range(lin.shape[1]):
        lin[1, k] = (lin[1, k] - stretch(par, ways, k) * w) / h


@helper
def pass_boundary(
    par: FloatArray, ways: FloatArray, old: int, region: int, hit: int, k_old: float, h: float, w: float,
    lin: FloatArray, bend: FloatArray,
) -> None:  # fmt: skip
    """Jumps of the derivatives at an impact; `k_old` is the stiffness there in contact."""
    fall = -h * drag_jump(par, old, region)  # of the damping, in cells
    if len(bend) > 0 and (old == 0 or region == 0):
        k_jump = k_old if old != 0 else -k_old
        for k in range(lin.shape[1]):
            shifted = lin[0, k] + (old - hit) * play(ways, k)
            for j in range(2):
                bend[k, 1, j] += k_jump * lin[0, j] * shifted / w
    if fall != 0.0:
        past = 2.0 * par[ZETA if region != 0 else FREE] * h
        sign = 2.0 * h if old != 0 else -2.0 * h
        for k in range(len(bend)):
            shifted = lin[0, k] + (old - hit) * play(ways, k)
            more = fall * stretch(par, ways, k)
            if k >= 2:
                more += sign * (ways[k - 2, ZETA] - ways[k - 2, FREE])
            for j in range(2):
                turn = fall * lin[0, j] * shifted / w
                bend[k, 1, j] += fall * bend[k, 0, j] + more * lin[0, j] - past * turn
                bend[k, 0, j] += turn
        for k in range(lin.shape[1]):
            lin[1, k] += fall * (lin[0, k] + (old - hit) * play(ways, k))
    for k in range(2, lin.shape[1]):
        lin[0, k] += (old - region) * play(ways, k)


@helper
def probe(
    table: Table, slopes: tuple[FloatArray, FloatArray], ways: FloatArray, state: FloatArray, periods: int,
    lin: FloatArray, bend: FloatArray, counts: IntArray, turns: FloatArray, clock: FloatArray,
    work: FloatArray, choose: FloatArray, there: FloatArray, none: FloatArray,
) -> tuple[int, int]:  # fmt: skip
    """Carry `state` over whole periods with its derivatives; returns flag and number of extrema.

    `lin`, (2, m): derivatives of the image in m directions, two of the state and those of `ways`. `bend`, (m, 2, 2) or
    empty: derivatives of the Jacobian lin[:, :2]. `counts`, (2): exits and entries. `turns`, (any, 5 + m): time, X,
    X'', region and its coordinate at every extremum of X, and the derivatives of X there; none wanted if empty.
    `clock`, (1,): time in contact. The rest is room: five rows, `binomials`, (2, m), and no second derivatives.
    """
    par, coef, edge = table
    dcoef, dedge = slopes
    cells = len(edge) // 2
    d, h = par[HALF_BACKLASH], 2.0 * math.pi / par[FREQUENCY] / cells
    a, b, g, rest, spare = work[0], work[1], work[2], work[3], work[4]
    region, y = start(state[0], state[1], par)
    w = state[1] * h
    begin(par, ways, region, w, h, lin, bend)
    counts[0] = counts[1] = 0
    clock[0] = 0.0
    turned = 0
    way = ZERO
    wanted = len(turns) > 0
    for global_cell in range(periods * cells):
        cell = global_cell % cells
        row = cell if region != 0 else cell + cells
        y_new = edge[row, 0] * y + edge[row, 1] * w + edge[row, 4]
        w_new = edge[row, 2] * y + edge[row, 3] * w + edge[row, 5]
        size, speed = abs(y), abs(w)
        quiet = clear(region, par, y, y_new, edge[row, 6] * size + edge[row, 7] * speed + edge[row, 8])
        if quiet and wanted:
            reach = edge[row, 15] * size + edge[row, 16] * speed + edge[row, 17]
            quiet = w * w_new > 0.0 and min(speed, abs(w_new)) > reach and w * way >= 0.0
        if quiet:
            cell_derivatives(edge, dedge, row, y, w, lin, bend)
            way = 1 if w_new > 0.0 else -1
            y, w = y_new, w_new
            continue
        s = -0.5
        fresh = ZERO
        for event in range(MAX_EVENTS + 1):
            if event == MAX_EVENTS:
                return CROWDED, turned
            row = cell if region != 0 else cell + cells
            expand(coef, edge, row, s, y, w, a, b, choose)
            t, hit = leave(region, par, a, g, b, 0.5 - s, fresh)
            done = 0.0
            copy(a, rest)
            while wanted:
                way, step = find_turn(rest, spare, g, b, choose, t - done, way if done == 0.0 else ZERO)
                if step < 0.0:
                    break
                done += step
                if turned < len(turns):
                    note_extremum(turns[turned], (global_cell + s + 0.5 + done) * h, rest, region, par, h)
                    note_slope(
                        table, dcoef, ways, region, row, s, done, y, w, lin, there, none, turns[turned]
                    )
                turned += 1
                if step == 0.0:
                    way, done = ZERO, 0.0
            if hit == 0 and s == -0.5:
                cell_derivatives(edge, dedge, row, y, w, lin, bend)
                y = edge[row, 0] * y + edge[row, 1] * w + edge[row, 4]
                w = w_new
                break
            later = 0.5 if hit == 0 else s + t
            flow_derivatives(coef, dcoef, row, s, later, y, w, lin, bend)
            y, w, _ = poly(a, ZERO, t)
            s = later
            if hit == 0:
                break
            old = region
            region, y = enter(region, hit, par)
            fresh = hit
            counts[0] += old == 1
            counts[1] += region == -1
            pass_boundary(par, ways, old, region, hit, poly(coef[cell, 3], ZERO, s)[0], h, w, lin, bend)
            if old == 0:
                clock[0] -= (global_cell + s + 0.5) * h
            if region == 0:
                clock[0] += (global_cell + s + 0.5) * h
            if s >= 0.5:
                break
        if not (abs(y) < 1e150 and abs(w) < 1e150):
            return DIVERGED, turned
    if region != 0:
        clock[0] += periods * cells * h
    state[0] = y + region * d
    state[1] = w / h
    finish(par, ways, region, w, h, lin, bend)
    return FINE, turned
