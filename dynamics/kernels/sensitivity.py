"""The period map with first and second derivatives and with every extremum; and the corrector built on it.

Directions: 0 and 1 are X and V at tau = 0, then come the given directions of the parameters. The force is continuous
at an impact, so that first derivatives pass it unchanged; the restoring force has a corner there, so that the
derivative of the Jacobian jumps by (K - K') M dt, with dt the shift of the instant of the impact.
"""

import math

import numpy as np

from dynamics.kernels.compiling import (
    CROWDED,
    DIVERGED,
    FINE,
    FREQUENCY,
    HALF_BACKLASH,
    LOST,
    MAX_EVENTS,
    ZERO,
    ZETA,
    FloatArray,
    IntArray,
    Table,
    helper,
    kernel,
    maker,
)
from dynamics.kernels.flow import basis, expand
from dynamics.kernels.regions import clear, enter, leave, start
from dynamics.kernels.roots import binomials, copy, find_turn, largest, poly, shift
from dynamics.kernels.tables import differentiate, tabulate

NEARLY = 1e-6  # Newton's step, over the scale, after which an orbit is likely to be good to rounding


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
def note_turn(
    table: Table, dcoef: FloatArray, ways: FloatArray, region: int, row: int, s: float, done: float, now: float,
    y: float, w: float, rest: FloatArray, lin: FloatArray, there: FloatArray, none: FloatArray, note: FloatArray,
) -> None:  # fmt: skip
    """Fill one row of `turns`: the extremum at s + done of a stretch that begins at s."""
    par, coef, edge = table
    h = 2.0 * math.pi / par[FREQUENCY] / (len(edge) // 2)
    note[0] = now * h
    note[1] = rest[0] + region * par[HALF_BACKLASH]
    note[2] = 2.0 * rest[2] / (h * h)
    note[3] = region
    note[4] = rest[0]
    for k in range(lin.shape[1]):
        there[0, k], there[1, k] = lin[0, k], lin[1, k]
    flow_derivatives(coef, dcoef, row, s, s + done, y, w, there, none)
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
    ways: FloatArray,
    old: int,
    region: int,
    hit: int,
    k_old: float,
    w: float,
    lin: FloatArray,
    bend: FloatArray,
) -> None:
    """Jumps of the derivatives at an impact; `k_old` is the stiffness there in contact."""
    if len(bend) > 0 and (old == 0 or region == 0):
        k_jump = k_old if old != 0 else -k_old
        for k in range(lin.shape[1]):
            shifted = lin[0, k] + (old - hit) * play(ways, k)
            for j in range(2):
                bend[k, 1, j] += k_jump * lin[0, j] * shifted / w
    for k in range(2, lin.shape[1]):
        lin[0, k] += (old - region) * play(ways, k)


@kernel
def probe(
    table: Table, slopes: tuple[FloatArray, FloatArray], ways: FloatArray, state: FloatArray, periods: int,
    lin: FloatArray, bend: FloatArray, counts: IntArray, turns: FloatArray,
) -> tuple[int, int]:  # fmt: skip
    """Carry `state` over whole periods with its derivatives; returns flag and number of extrema.

    `lin`, (2, m): derivatives of the image in m directions, two of the state and those of `ways`. `bend`, (m, 2, 2) or
    empty: derivatives of the Jacobian lin[:, :2]. `counts`, (2): exits and entries. `turns`, (any, 5 + m): time, X,
    X'', region and its coordinate at every extremum of X, and the derivatives of X there; none wanted if empty.
    """
    par, coef, edge = table
    dcoef, dedge = slopes
    cells, n, m = len(edge) // 2, coef.shape[2], lin.shape[1]
    d, h = par[HALF_BACKLASH], 2.0 * math.pi / par[FREQUENCY] / cells
    work, choose, there, none = np.empty((5, n)), binomials(n - 1), np.empty((2, m)), np.empty((0, 2, 2))
    a, b, g, rest, spare = work[0], work[1], work[2], work[3], work[4]
    region, y = start(state[0], state[1], par)
    w = state[1] * h
    begin(par, ways, region, w, h, lin, bend)
    counts[0] = counts[1] = 0
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
                way, step = find_turn(rest, g, b, t - done, way if done == 0.0 else ZERO)
                if step < 0.0:
                    break
                way = -way
                shift(rest, step, choose, spare)
                copy(spare, rest)
                rest[1] = 0.0
                done += step
                if turned < len(turns):
                    now = global_cell + s + 0.5 + done
                    note_turn(
                        table,
                        dcoef,
                        ways,
                        region,
                        row,
                        s,
                        done,
                        now,
                        y,
                        w,
                        rest,
                        lin,
                        there,
                        none,
                        turns[turned],
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
            pass_boundary(ways, old, region, hit, poly(coef[cell, 3], ZERO, s)[0], w, lin, bend)
            if s >= 0.5:
                break
        if not (abs(y) < 1e150 and abs(w) < 1e150):
            return DIVERGED, turned
    state[0] = y + region * d
    state[1] = w / h
    finish(par, ways, region, w, h, lin, bend)
    return FINE, turned


@helper
def solve_three(matrix: FloatArray, right: FloatArray) -> bool:
    """Gaussian elimination with row exchange, in place; False if the matrix is singular to rounding."""
    size = largest(matrix, 3)
    for k in range(3):
        best = k
        for i in range(k + 1, 3):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if not abs(matrix[best, k]) > 1e-15 * size:
            return False
        if best != k:
            for j in range(3):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
            right[k], right[best] = right[best], right[k]
        for i in range(k + 1, 3):
            share = matrix[i, k] / matrix[k, k]
            for j in range(k, 3):
                matrix[i, j] -= share * matrix[k, j]
            right[i] -= share * right[k]
    for k in range(2, -1, -1):
        for j in range(k + 1, 3):
            right[k] -= matrix[k, j] * right[j]
        right[k] /= matrix[k, k]
    return True


@maker
def look(
    origin: FloatArray, ways: FloatArray, order: int, cells: int, degree: int, u: FloatArray, scale: float,
    periods: int, state: FloatArray, lin: FloatArray, bend: FloatArray, counts: IntArray, turns: FloatArray,
) -> tuple[int, int, float]:  # fmt: skip
    """Probe the orbit of the unknowns u: X and V over the scale, then amounts of the directions `ways`.

    Returns flag, number of extrema and the residual over the scale. `origin` and the rows of `ways` hold `par`,
    amplitudes and phases.
    """
    q = origin.copy()
    for k in range(len(ways)):
        for i in range(len(q)):
            q[i] += u[2 + k] * ways[k, i]
    if not (q[FREQUENCY] > 0.0 and q[HALF_BACKLASH] >= 0.0 and q[ZETA] >= 0.0):
        return LOST, 0, math.inf
    par, amplitudes, phases = q[:8], q[8 : 8 + order], q[8 + order :]
    coef, edge = tabulate(par, amplitudes, phases, cells, degree)
    slopes = differentiate(par, amplitudes, phases, ways, coef, edge)
    state[0], state[1] = u[0] * scale, u[1] * scale
    flag, turned = probe((par, coef, edge), slopes, ways, state, periods, lin, bend, counts, turns)
    off = max(abs(state[0] / scale - u[0]), abs(state[1] / scale - u[1]))
    return flag, turned, off if flag == FINE and off < math.inf else math.inf


@helper
def scaled(
    q_frequency: float, scale: float, periods: int, lin: FloatArray, bend: FloatArray, turns: FloatArray
) -> None:  # fmt: skip
    """Derivatives with respect to the unknowns, over the scale; times of the extrema as phases of the orbit."""
    length = periods * 2.0 * math.pi / q_frequency
    for k in range(lin.shape[1]):
        for j in range(2):
            if k >= 2:
                lin[j, k] /= scale
            else:
                bend[k, 0, j] *= scale
                bend[k, 1, j] *= scale
    for i in range(len(turns)):
        turns[i, 0] = turns[i, 0] / length % 1.0
        for k in range(7, turns.shape[1]):
            turns[i, k] /= scale


@helper
def frequency(origin: FloatArray, ways: FloatArray, u: FloatArray) -> float:
    """The frequency of the unknowns."""
    value = origin[FREQUENCY]
    for k in range(len(ways)):
        value += u[2 + k] * ways[k, FREQUENCY]
    return float(value)


@kernel
def evaluate(
    origin: FloatArray, ways: FloatArray, order: int, cells: int, degree: int, u: FloatArray, scale: float,
    periods: int, state: FloatArray, lin: FloatArray, bend: FloatArray, counts: IntArray, turns: FloatArray,
) -> tuple[int, int, float]:  # fmt: skip
    """Do as `look`, and give everything with respect to the unknowns and as phases, as `correct` does."""
    flag, turned, residual = look(
        origin, ways, order, cells, degree, u, scale, periods, state, lin, bend, counts, turns
    )
    scaled(frequency(origin, ways, u), scale, periods, lin, bend, turns[: min(turned, len(turns))])
    return flag, turned, residual


@helper
def newton_step(
    u: FloatArray, guess: FloatArray, across: FloatArray, scale: float, state: FloatArray, lin: FloatArray,
    matrix: FloatArray, right: FloatArray,
) -> float:  # fmt: skip
    """Fill `right` with Newton's step; returns its size, infinite if there is none."""
    right[2] = 0.0
    for i in range(2):
        right[i] = u[i] - state[i] / scale
        for j in range(2):
            matrix[i, j] = lin[i, j] - (1.0 if i == j else 0.0)
        matrix[i, 2] = lin[i, 2] / scale
    for j in range(3):
        matrix[2, j] = across[j]
        right[2] += across[j] * (guess[j] - u[j])
    if not solve_three(matrix, right):
        return math.inf
    return float(max(abs(right[0]), abs(right[1]), abs(right[2])))


@kernel
def correct(
    origin: FloatArray, ways: FloatArray, order: int, cells: int, degree: int, u: FloatArray, across: FloatArray,
    scale: float, periods: int, limit: int,
    state: FloatArray, lin: FloatArray, bend: FloatArray, counts: IntArray, turns: FloatArray,
) -> tuple[int, int, int, float]:  # fmt: skip
    """Newton's method for a periodic orbit in the plane across . (u - guess) = 0, `u` being the guess.

    Returns flag, number of extrema, iterations and residual over the scale; `u` becomes the orbit, and the rest is
    filled as by `probe`, for the image of the orbit, but with derivatives with respect to the unknowns, over the scale,
    and with phases in [0, 1) of the orbit's period for times.
    """
    guess, last = u.copy(), u.copy()
    matrix, right = np.empty((3, 3)), np.empty(3)
    best, step, done = math.inf, math.inf, 0
    while True:
        whole = (
            step < NEARLY
        )  # the error falls with the square of the step: this is likely to be the last time
        flag, turned, size = look(
            origin, ways, order, cells, degree, u, scale, periods, state, lin,
            bend if whole else bend[:0], counts, turns if whole else turns[:0],
        )  # fmt: skip
        if flag != FINE:
            return flag, 0, done, best
        if not size < best and done > 3:  # rounding: the one before was as good
            for k in range(3):
                u[k] = last[k]
            whole = False
            break
        best = size
        rest = newton_step(u, guess, across, scale, state, lin, matrix, right) if size > 0.0 else 0.0
        if whole and (size <= 4e-15 * max(1.0, largest(lin, 2)) or step < 1e-11):
            break
        if rest == 0.0 or done >= limit:
            whole = False
            break
        if not rest < 0.5:
            return LOST, 0, done, best
        step = rest
        done += 1
        for k in range(3):
            last[k] = u[k]
            u[k] += right[k]
    if not whole:
        flag, turned, best = look(
            origin, ways, order, cells, degree, u, scale, periods, state, lin, bend, counts, turns
        )
    rounding = 1.5e-14 * periods * max(1.0, abs(u[0]), abs(u[1]))  # as in dynamics.corrector
    if not best <= rounding * max(1.0, largest(lin, 2)):
        flag = LOST
    scaled(frequency(origin, ways, u), scale, periods, lin, bend, turns[: min(turned, len(turns))])
    return flag, turned, done, best
