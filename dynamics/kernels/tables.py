"""Taylor tables of the linear motions in each cell of the excitation period.

All cells are worked on side by side, the cell being the last index, so that loops over the cells are vectorised.
"""

import math

import numpy as np

from dynamics.kernels.compiling import (
    ERROR,
    FORCE,
    FREE,
    FREQUENCY,
    HALF_BACKLASH,
    MEAN,
    NO,
    ORDER,
    PHASE,
    SERIES,
    TWO,
    YES,
    ZERO,
    ZETA,
    FloatArray,
    Room,
    helper,
    plain_kernel,
)

EDGE = 30  # numbers of a cell's map


def tables_of(cells: int, degree: int) -> tuple[FloatArray, FloatArray]:
    """Room for `coef` and `edge`."""
    return np.empty((2 * cells, 4, degree + 1)), np.empty((2 * cells, EDGE))


def slopes_of(ways: int, cells: int, degree: int) -> tuple[FloatArray, FloatArray]:
    """Zeros for the derivatives of `coef` and of the map over each cell."""
    return np.zeros((ways, 2 * cells, 4, degree + 1)), np.zeros((ways, 2 * cells, 6))


def room_of(cells: int, degree: int) -> Room:
    """Room for `fill`: stiffness and push, coefficients, values at the ends and bounds of the solutions, roots, waves.

    Stiffness and push, (2, degree + 1, cells), are times h^2; coefficients are (2, 3, degree + 1, cells) and values
    (2, 3, 6, cells), first in contact, then in the dead zone, of the solutions as in `coef`.
    """
    n, kinds = degree + 1, 2
    return (
        np.empty((kinds, n, cells)),
        np.zeros((kinds, 3, n, cells)),
        np.empty((kinds, 3, 6, cells)),
        np.zeros((kinds, 2 * cells)),
        np.empty((kinds, cells)),
    )


@helper
def fill_roots(roots: FloatArray) -> None:
    """Cosines and sines of all multiples of half a cell's turn, (2, 2 cells): harmonics have no other angles."""
    count = roots.shape[1]
    for m in range(count // 2):
        c, s = math.cos(2.0 * math.pi * m / count), math.sin(2.0 * math.pi * m / count)
        roots[0, m], roots[1, m] = c, s
        roots[0, m + count // 2], roots[1, m + count // 2] = -c, -s


@helper
def add_harmonic(
    series: FloatArray, n: int, p: float, q: float, roots: FloatArray, waves: FloatArray
) -> None:
    """Add to series[:, cell] the Taylor coefficients of p cos(n theta) - q sin(n theta) about each cell's middle.

    `waves`, (2, cells), is room.
    """
    count, cells = roots.shape[1], series.shape[1]
    rate, factor = 4.0 * math.pi * n / count, 1.0
    m, step = n % count, (2 * n) % count
    for cell in range(cells):
        waves[0, cell] = p * roots[0, m] - q * roots[1, m]
        waves[1, cell] = p * roots[1, m] + q * roots[0, m]
        m += step
        if m >= count:
            m -= count
    for k in range(series.shape[0]):
        weight = factor if k % 4 == 0 or k % 4 == 3 else -factor
        for cell in range(cells):
            series[k, cell] += weight * waves[k % 2, cell]
        factor *= rate / (k + 1)


@helper
def harmonics(par: FloatArray) -> tuple[int, int]:
    """Numbers of harmonics of the stiffness, and of the error after its first."""
    order = int(par[ORDER])
    return order, (len(par) - SERIES) // 2 - order


@helper
def error_places(par: FloatArray, n: int) -> tuple[int, int]:
    """Where amplitude and phase of the error's harmonic n stand in `par`."""
    order, more = harmonics(par)
    at = SERIES + 2 * order + n - 2
    return (ERROR, PHASE) if n == 1 else (at, at + more)


@helper
def first_touched(par: FloatArray, ways: FloatArray) -> int:
    """First of the solutions that changes of `par` touch: 0, all; 2, the forced one, linear in the forces; 3, none."""
    order = int(par[ORDER])
    touched = 3
    for p in range(len(ways)):
        for i in range(len(par)):
            if ways[p, i] != 0.0 and i != HALF_BACKLASH:
                forces = i in (FORCE, ERROR, PHASE) or i >= SERIES + 2 * order
                touched = min(touched, TWO if forces else ZERO)
    return touched


@helper
def excite(par: FloatArray, way: FloatArray, derived: bool, series: FloatArray, room: Room) -> None:
    """Stiffness series[0] and force series[1], both times h^2, about the middles of all cells.

    Or, if `derived`, what they change by when `par` changes by `way`.
    """
    _, _, _, roots, waves = room
    cells = series.shape[2]
    turn = 2.0 * math.pi / cells
    h = turn / par[FREQUENCY]
    order, more = harmonics(par)
    stretch = -way[FREQUENCY] / par[FREQUENCY] if derived else 0.0
    for kind in range(2):
        at = MEAN if kind == 0 else FORCE
        level = (way[at] + 2.0 * stretch * par[at] if derived else par[at]) * h * h
        for k in range(series.shape[1]):
            for cell in range(cells):
                series[kind, k, cell] = level if k == 0 else 0.0
    for j in range(order + more + 1):
        stiff = j < order
        n = j + 1 if stiff else j - order + 1
        size, phase = (SERIES + j, SERIES + order + j) if stiff else error_places(par, n)
        a, b = par[size], 0.0
        if derived:
            a, b = way[size] + (2.0 * stretch * par[size] if stiff else 0.0), par[size] * way[phase]
        scale = h * h if stiff else n * turn * n * turn
        c, s = math.cos(par[phase]) * scale, math.sin(par[phase]) * scale
        add_harmonic(series[0 if stiff else 1], n, a * c - b * s, a * s + b * c, roots, waves)


@helper
def solve(
    stiff: FloatArray, push: FloatArray, drag: float, y: FloatArray, first: int,
    more_stiff: FloatArray, more_drag: float, base: FloatArray,
) -> None:  # fmt: skip
    """Taylor coefficients of the solutions from `first` on, from those of the orders 0 and 1, in all cells.

    y'' + drag y' + stiff y = push, the push being that of the third solution alone. With `base`, whose coefficients
    are multiplied by `more_drag` and `more_stiff` on the left, it is the equation of a derivative.
    """
    cells = y.shape[2]
    for j in range(first, 3):
        for k in range(y.shape[1] - 2):
            new, old = y[j, k + 2], y[j, k + 1]
            rate, more = drag * (k + 1), more_drag * (k + 1)
            for cell in range(cells):
                new[cell] = rate * old[cell] - (push[k, cell] if j == 2 else 0.0)
            for i in range(k + 1 if len(stiff) > 0 else 0):
                for cell in range(cells):
                    new[cell] += stiff[i, cell] * y[j, k - i, cell]
            if len(base) > 0:
                for cell in range(cells):
                    new[cell] += more * base[j, k + 1, cell]
                for i in range(k + 1 if len(stiff) > 0 else 0):
                    for cell in range(cells):
                        new[cell] += more_stiff[i, cell] * base[j, k - i, cell]
            share = -1.0 / ((k + 2) * (k + 1))
            for cell in range(cells):
                new[cell] *= share


@helper
def survey(y: FloatArray, rim: FloatArray, first: int) -> None:
    """Values and speeds at both ends, and bounds of |d2y/ds2|/8 and |d3y/ds3|/8 with a last digit for rounding.

    rim[j]: values at the start and the end, speeds there, the bounds, in all cells, of the solutions from `first` on.
    """
    cells = y.shape[2]
    for j in range(first, 3):
        r = rim[j]
        for i in range(6):
            for cell in range(cells):
                r[i, cell] = 0.0
        power, size = 1.0, 0.50004
        for k in range(y.shape[1]):
            c = y[j, k]
            odd = k % 2
            slope, bend, jerk = 2.0 * k * power, k * (k - 1) * size, 2.0 * k * (k - 1) * (k - 2) * size
            for cell in range(cells):
                r[odd, cell] += c[cell] * power
                r[3 - odd, cell] += c[cell] * slope
                r[4, cell] += bend * abs(c[cell])
                r[5, cell] += jerk * abs(c[cell])
            power *= 0.5
            size *= 0.5
        for cell in range(cells):
            even, odd_part = r[0, cell], r[1, cell]
            r[0, cell], r[1, cell] = even - odd_part, even + odd_part
            even, odd_part = r[2, cell], r[3, cell]
            r[2, cell], r[3, cell] = even - odd_part, even + odd_part


@helper
def fill_edge(rim: FloatArray, edge: FloatArray, kind: int) -> None:
    """Map over each whole cell, to its middle, and the bounds."""
    cells = rim.shape[2]
    for cell in range(cells):
        row = cell + kind * cells
        f0, p0, g0, q0, b0, j0 = (
            rim[0, 0, cell], rim[0, 1, cell], rim[0, 2, cell], rim[0, 3, cell], rim[0, 4, cell], rim[0, 5, cell],
        )  # fmt: skip
        f1, p1, g1, q1, b1, j1 = (
            rim[1, 0, cell], rim[1, 1, cell], rim[1, 2, cell], rim[1, 3, cell], rim[1, 4, cell], rim[1, 5, cell],
        )  # fmt: skip
        f2, p2, g2, q2, b2, j2 = (
            rim[2, 0, cell], rim[2, 1, cell], rim[2, 2, cell], rim[2, 3, cell], rim[2, 4, cell], rim[2, 5, cell],
        )  # fmt: skip
        w = f0 * g1 - f1 * g0
        c00, c01, c10, c11 = g1 / w, -f1 / w, -g0 / w, f0 / w
        c0, c1 = -c00 * f2 - c01 * g2, -c10 * f2 - c11 * g2
        edge[row, 0], edge[row, 1] = p0 * c00 + p1 * c10, p0 * c01 + p1 * c11
        edge[row, 2], edge[row, 3] = q0 * c00 + q1 * c10, q0 * c01 + q1 * c11
        edge[row, 4], edge[row, 5] = p0 * c0 + p1 * c1 + p2, q0 * c0 + q1 * c1 + q2
        edge[row, 9], edge[row, 10], edge[row, 11], edge[row, 12] = c00, c01, c10, c11
        edge[row, 13], edge[row, 14] = c0, c1
        edge[row, 18], edge[row, 19], edge[row, 20] = b0, b1, b2
        edge[row, 27], edge[row, 28], edge[row, 29] = j0, j1, j2
        edge[row, 21], edge[row, 22], edge[row, 23] = p0, p1, p2
        edge[row, 24], edge[row, 25], edge[row, 26] = q0, q1, q2
        edge[row, 6], edge[row, 15] = abs(c00) * b0 + abs(c10) * b1, abs(c00) * j0 + abs(c10) * j1
        edge[row, 7], edge[row, 16] = abs(c01) * b0 + abs(c11) * b1, abs(c01) * j0 + abs(c11) * j1
        edge[row, 8], edge[row, 17] = abs(c0) * b0 + abs(c1) * b1 + b2, abs(c0) * j0 + abs(c1) * j1 + j2


@helper
def hand_over(y: FloatArray, coef: FloatArray, kind: int, first: int) -> None:
    """Coefficients of the solutions from `first` on by cell, as the motion needs them."""
    cells = y.shape[2]
    for cell in range(cells):
        for j in range(first, 3):
            for k in range(y.shape[1]):
                coef[cell + kind * cells, j, k] = y[j, k, cell]


@plain_kernel
def fill(par: FloatArray, coef: FloatArray, edge: FloatArray, room: Room, first: int) -> None:
    """Fill tables; with `first` above 0 again for a `par` that touches the solutions from there on alone."""
    series, y, rim, _, _ = room
    cells = series.shape[2]
    if first > 2:
        return
    if room[3][0, 0] == 0.0:
        fill_roots(room[3])
    excite(par, par, NO, series, room)
    for kind in range(2):
        drag = 4.0 * math.pi / cells * par[ZETA if kind == 0 else FREE] / par[FREQUENCY]
        for cell in range(cells):
            y[kind, 0, 0, cell] = y[kind, 1, 1, cell] = 1.0
        stiff = series[0][: series.shape[1] if kind == 0 else 0]
        solve(stiff, series[1], drag, y[kind], first, stiff, 0.0, y[kind][:0])
        survey(y[kind], rim[kind], first)
        fill_edge(rim[kind], edge, kind)
        hand_over(y[kind], coef, kind, first)
    for cell in range(cells if first == 0 else 0):
        for k in range(series.shape[1]):
            coef[cell, 3, k] = series[0, k, cell]
            coef[cell + cells, 3, k] = 0.0


@helper
def edge_derivative(edge: FloatArray, rim: FloatArray, dedge: FloatArray, kind: int, first: int) -> None:
    """Derivative of the map over each whole cell: d(F C) = dF C - F C dF(start) C, column by column."""
    cells = rim.shape[2]
    for cell in range(cells):
        row = cell + kind * cells
        f0, f1, g0, g1 = edge[row, 21], edge[row, 22], edge[row, 24], edge[row, 25]
        for j in range(first, 3):  # columns of A, then b
            a, b = (edge[row, 9 + j], edge[row, 11 + j]) if j < 2 else (edge[row, 13], edge[row, 14])
            forced = 1.0 if j == 2 else 0.0
            top = rim[0, 0, cell] * a + rim[1, 0, cell] * b + forced * rim[2, 0, cell]
            low = rim[0, 2, cell] * a + rim[1, 2, cell] * b + forced * rim[2, 2, cell]
            da = -edge[row, 9] * top - edge[row, 10] * low
            db = -edge[row, 11] * top - edge[row, 12] * low
            upper = rim[0, 1, cell] * a + rim[1, 1, cell] * b + forced * rim[2, 1, cell] + f0 * da + f1 * db
            lower = rim[0, 3, cell] * a + rim[1, 3, cell] * b + forced * rim[2, 3, cell] + g0 * da + g1 * db
            dedge[row, j if j < 2 else 4] = upper
            dedge[row, 2 + j if j < 2 else 5] = lower


@helper
def differentiate(
    par: FloatArray, ways: FloatArray, edge: FloatArray, room: Room, more: Room, dcoef: FloatArray, dedge: FloatArray
) -> None:  # fmt: skip
    """Derivatives of the tables that `fill` has made, in given directions of the parameters.

    `ways`, (m, length of `par`): changes of `par`, of all but the number of sides and J. Fills `dcoef`, zeros of
    (m, 2 cells, 4, degree + 1), and `dedge`, zeros of (m, 2 cells, 6), derivatives of the map over each cell; `more`
    is room.
    """
    series, y, _, _, _ = room
    dseries, dy, drim, _, _ = more
    h = 2.0 * math.pi / series.shape[2] / par[FREQUENCY]
    for p in range(len(ways)):
        first = first_touched(par, ways[p : p + 1])
        if first > 2:
            continue
        excite(par, ways[p], YES, dseries, room)
        for kind in range(2):
            ratio = ZETA if kind == 0 else FREE
            drag = 2.0 * par[ratio] * h
            ddrag = 2.0 * ways[p, ratio] * h - drag * ways[p, FREQUENCY] / par[FREQUENCY]
            terms = series.shape[1] if kind == 0 else 0
            stiff, dstiff = series[0][:terms], dseries[0][:terms]
            for cell in range(series.shape[2] if first == 2 else 0):
                for i in range(4):  # what was there before is of other ways
                    drim[kind, 0, i, cell] = drim[kind, 1, i, cell] = 0.0
            solve(stiff, dseries[1], drag, dy[kind], first, dstiff, ddrag, y[kind])
            survey(dy[kind], drim[kind], first)
            edge_derivative(edge, drim[kind], dedge[p], kind, first)
            hand_over(dy[kind], dcoef[p], kind, first)
