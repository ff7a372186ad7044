"""Taylor tables of the linear motions in each cell of the excitation period."""

import math

import numpy as np

from dynamics.kernels.compiling import (
    ERROR,
    FORCE,
    FREQUENCY,
    MEAN,
    ONE,
    ORDER,
    PHASE,
    SERIES,
    TWO,
    ZERO,
    ZETA,
    FloatArray,
    helper,
    kernel,
)


@helper
def fill_roots(roots: FloatArray) -> None:
    """Cosines and sines of all multiples of half a cell's turn, (2, 2 cells): harmonics have no other angles."""
    count = roots.shape[1]
    for m in range(count):
        roots[0, m], roots[1, m] = math.cos(2.0 * math.pi * m / count), math.sin(2.0 * math.pi * m / count)


@helper
def add_harmonic(
    series: FloatArray, place: int, n: int, p: float, q: float, roots: FloatArray, weights: FloatArray
) -> None:
    """Add to series[cell, place] the Taylor coefficients of p cos(n theta) - q sin(n theta) about each cell's middle.

    `weights`, one for each coefficient, is room.
    """
    count = roots.shape[1]
    rate, factor = 4.0 * math.pi * n / count, 1.0
    for k in range(len(weights)):
        weights[k] = factor if k % 4 == 0 or k % 4 == 3 else -factor
        factor *= rate / (k + 1)
    m = n % count
    for cell in range(count // 2):
        even, odd = p * roots[0, m] - q * roots[1, m], p * roots[1, m] + q * roots[0, m]
        for k in range(0, len(weights) - 1, 2):
            series[cell, place, k] += weights[k] * even
            series[cell, place, k + 1] += weights[k + 1] * odd
        if len(weights) % 2 == 1:
            series[cell, place, len(weights) - 1] += weights[-1] * even
        m = (m + 2 * n) % count


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
def ends(coef: FloatArray, row: int, which: int) -> tuple[float, float, float, float]:
    """Value and speed of a polynomial at the start and at the end of the cell."""
    even = odd = even_slope = odd_slope = 0.0
    power = 1.0
    for k in range(0, coef.shape[2] - 1, 2):
        even += coef[row, which, k] * power
        odd_slope += k * coef[row, which, k] * power
        power *= 0.5
        odd += coef[row, which, k + 1] * power
        even_slope += (k + 1) * coef[row, which, k + 1] * power
        power *= 0.5
    if coef.shape[2] % 2 == 1:
        k = coef.shape[2] - 1
        even += coef[row, which, k] * power
        odd_slope += k * coef[row, which, k] * power
    return even - odd, even + odd, 2.0 * (even_slope - odd_slope), 2.0 * (even_slope + odd_slope)


@helper
def bounds(coef: FloatArray, row: int, which: int) -> tuple[float, float]:
    """Bounds of |d2y/ds2|/8 and |d3y/ds3|/8 over the cell, with a last digit for rounding."""
    bend = jerk = 0.0
    power = 0.12501
    for k in range(2, coef.shape[2]):
        size = k * (k - 1) * abs(coef[row, which, k]) * power
        bend += size
        jerk += 2.0 * (k - 2) * size
        power *= 0.5
    return bend, jerk


@helper
def fill_edge(coef: FloatArray, edge: FloatArray, row: int) -> None:
    """Map over the whole cell, to its middle, and the bounds, from the polynomials of a row."""
    f0, p0, g0, q0 = ends(coef, row, ZERO)
    f1, p1, g1, q1 = ends(coef, row, ONE)
    f2, p2, g2, q2 = ends(coef, row, TWO)
    w = f0 * g1 - f1 * g0
    c00, c01, c10, c11 = g1 / w, -f1 / w, -g0 / w, f0 / w
    c0, c1 = -c00 * f2 - c01 * g2, -c10 * f2 - c11 * g2
    edge[row, 0], edge[row, 1] = p0 * c00 + p1 * c10, p0 * c01 + p1 * c11
    edge[row, 2], edge[row, 3] = q0 * c00 + q1 * c10, q0 * c01 + q1 * c11
    edge[row, 4], edge[row, 5] = p0 * c0 + p1 * c1 + p2, q0 * c0 + q1 * c1 + q2
    edge[row, 9], edge[row, 10], edge[row, 11], edge[row, 12] = c00, c01, c10, c11
    edge[row, 13], edge[row, 14] = c0, c1
    b0, j0 = bounds(coef, row, ZERO)
    b1, j1 = bounds(coef, row, ONE)
    b2, j2 = bounds(coef, row, TWO)
    edge[row, 18], edge[row, 19], edge[row, 20] = b0, b1, b2
    edge[row, 27], edge[row, 28], edge[row, 29] = j0, j1, j2
    edge[row, 21], edge[row, 22], edge[row, 23] = p0, p1, p2
    edge[row, 24], edge[row, 25], edge[row, 26] = q0, q1, q2
    edge[row, 6], edge[row, 15] = abs(c00) * b0 + abs(c10) * b1, abs(c00) * j0 + abs(c10) * j1
    edge[row, 7], edge[row, 16] = abs(c01) * b0 + abs(c11) * b1, abs(c01) * j0 + abs(c11) * j1
    edge[row, 8], edge[row, 17] = abs(c0) * b0 + abs(c1) * b1 + b2, abs(c0) * j0 + abs(c1) * j1 + j2


@helper
def fill_excitation(
    par: FloatArray, coef: FloatArray, push: FloatArray, roots: FloatArray, weights: FloatArray
) -> None:
    """Stiffness and force, both times h^2, about the middles of all cells: coef[:, 3] and push[:, 0]."""
    cells = len(push)
    turn = 2.0 * math.pi / cells
    h = turn / par[FREQUENCY]
    order, more = harmonics(par)
    for cell in range(cells):
        coef[cell, 3, 0], push[cell, 0, 0] = par[MEAN] * h * h, par[FORCE] * h * h
    for j in range(order):
        a, at = par[SERIES + j] * h * h, par[SERIES + order + j]
        add_harmonic(coef, 3, j + 1, a * math.cos(at), a * math.sin(at), roots, weights)
    for n in range(1, more + 2):
        size, phase = error_places(par, n)
        a, at = par[size] * (n * turn) ** 2, par[phase]
        add_harmonic(push, 0, n, a * math.cos(at), a * math.sin(at), roots, weights)


@kernel
def tabulate(par: FloatArray, cells: int, degree: int) -> tuple[FloatArray, FloatArray]:
    """Taylor tables `coef` and cell maps `edge` of one period."""
    coef, edge = np.zeros((2 * cells, 4, degree + 1)), np.zeros((2 * cells, 30))
    push, roots, weights = np.zeros((cells, 1, degree + 1)), np.empty((2, 2 * cells)), np.empty(degree + 1)
    fill_roots(roots)
    fill_excitation(par, coef, push, roots, weights)
    drag = 4.0 * math.pi / cells * par[ZETA] / par[FREQUENCY]
    for cell in range(cells):
        for kind in range(2):
            row = cell + kind * cells
            coef[row, 0, 0] = coef[row, 1, 1] = 1.0
            for k in range(degree - 1):
                t0, t1 = -drag * (k + 1) * coef[row, 0, k + 1], -drag * (k + 1) * coef[row, 1, k + 1]
                t2 = push[cell, 0, k] - drag * (k + 1) * coef[row, 2, k + 1]
                if kind == 0:
                    for i in range(k + 1):
                        t0 -= coef[cell, 3, i] * coef[row, 0, k - i]
                        t1 -= coef[cell, 3, i] * coef[row, 1, k - i]
                        t2 -= coef[cell, 3, i] * coef[row, 2, k - i]
                share = 1.0 / ((k + 2) * (k + 1))
                coef[row, 0, k + 2], coef[row, 1, k + 2], coef[row, 2, k + 2] = (
                    t0 * share,
                    t1 * share,
                    t2 * share,
                )
            fill_edge(coef, edge, row)
    return coef, edge


@helper
def edge_derivative(
    coef: FloatArray, edge: FloatArray, dcoef: FloatArray, dedge: FloatArray, p: int, row: int
) -> None:
    """Derivative of the map over the whole cell: d(F C) = dF C - F C dF(start) C, column by column."""
    _, f0, _, g0 = ends(coef, row, ZERO)
    _, f1, _, g1 = ends(coef, row, ONE)
    part = dcoef[p]
    s0, e0, t0, h0 = ends(part, row, ZERO)
    s1, e1, t1, h1 = ends(part, row, ONE)
    s2, e2, t2, h2 = ends(part, row, TWO)
    for j in range(3):  # columns of A, then b
        a, b = (edge[row, 9 + j], edge[row, 11 + j]) if j < 2 else (edge[row, 13], edge[row, 14])
        forced = 1.0 if j == 2 else 0.0
        top, low = s0 * a + s1 * b + forced * s2, t0 * a + t1 * b + forced * t2
        da = -edge[row, 9] * top - edge[row, 10] * low
        db = -edge[row, 11] * top - edge[row, 12] * low
        upper = e0 * a + e1 * b + forced * e2 + f0 * da + f1 * db
        lower = h0 * a + h1 * b + forced * h2 + g0 * da + g1 * db
        dedge[p, row, j if j < 2 else 4] = upper
        dedge[p, row, 2 + j if j < 2 else 5] = lower


@helper
def fill_excitation_derivative(
    par: FloatArray,
    way: FloatArray,
    part: FloatArray,
    push: FloatArray,
    roots: FloatArray,
    weights: FloatArray,
) -> None:
    """Derivatives of stiffness and force, both times h^2, when `par` changes by `way`: part[:, 3] and push[:, 0]."""
    cells = len(push)
    turn = 2.0 * math.pi / cells
    h, stretch = turn / par[FREQUENCY], -way[FREQUENCY] / par[FREQUENCY]
    order, more = harmonics(par)
    for cell in range(cells):
        part[cell, 3, 0] = (way[MEAN] + 2.0 * stretch * par[MEAN]) * h * h
        push[cell, 0, :] = 0.0
        push[cell, 0, 0] = (way[FORCE] + 2.0 * stretch * par[FORCE]) * h * h
    for j in range(order):
        size, phase = SERIES + j, SERIES + order + j
        a = (way[size] + 2.0 * stretch * par[size]) * h * h
        b = par[size] * way[phase] * h * h
        c, s = math.cos(par[phase]), math.sin(par[phase])
        add_harmonic(part, 3, j + 1, a * c - b * s, a * s + b * c, roots, weights)
    for n in range(1, more + 2):
        size, phase = error_places(par, n)
        a, b = way[size] * (n * turn) ** 2, par[size] * way[phase] * (n * turn) ** 2
        c, s = math.cos(par[phase]), math.sin(par[phase])
        add_harmonic(push, 0, n, a * c - b * s, a * s + b * c, roots, weights)


@kernel
def differentiate(
    par: FloatArray, ways: FloatArray, coef: FloatArray, edge: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Derivatives of the tables in given directions of the parameters.

    `ways`, (m, length of `par`): changes of `par`, of all but the number of sides and J. Returns `dcoef`,
    (m, 2 cells, 4, degree + 1), and `dedge`, (m, 2 cells, 6), derivatives of the map over each cell.
    """
    cells, degree = len(edge) // 2, coef.shape[2] - 1
    m = len(ways)
    dcoef, dedge = np.zeros((m, 2 * cells, 4, degree + 1)), np.zeros((m, 2 * cells, 6))
    push, roots, weights = np.zeros((cells, 1, degree + 1)), np.empty((2, 2 * cells)), np.empty(degree + 1)
    fill_roots(roots)
    h = 2.0 * math.pi / cells / par[FREQUENCY]
    drag = 2.0 * par[ZETA] * h
    for p in range(m):
        fill_excitation_derivative(par, ways[p], dcoef[p], push, roots, weights)
        stretch = -ways[p, FREQUENCY] / par[FREQUENCY]  # dh/h
        ddrag = 2.0 * ways[p, ZETA] * h + drag * stretch
        for cell in range(cells):
            for kind in range(2):
                row = cell + kind * cells
                for k in range(degree - 1):
                    t0 = drag * dcoef[p, row, 0, k + 1] + ddrag * coef[row, 0, k + 1]
                    t1 = drag * dcoef[p, row, 1, k + 1] + ddrag * coef[row, 1, k + 1]
                    t2 = drag * dcoef[p, row, 2, k + 1] + ddrag * coef[row, 2, k + 1]
                    t0, t1, t2 = (k + 1) * t0, (k + 1) * t1, (k + 1) * t2 - push[cell, 0, k]
                    if kind == 0:
                        for i in range(k + 1):
                            old, new = coef[cell, 3, i], dcoef[p, cell, 3, i]
                            t0 += old * dcoef[p, row, 0, k - i] + new * coef[row, 0, k - i]
                            t1 += old * dcoef[p, row, 1, k - i] + new * coef[row, 1, k - i]
                            t2 += old * dcoef[p, row, 2, k - i] + new * coef[row, 2, k - i]
                    share = -1.0 / ((k + 2) * (k + 1))
                    dcoef[p, row, 0, k + 2], dcoef[p, row, 1, k + 2] = t0 * share, t1 * share
                    dcoef[p, row, 2, k + 2] = t2 * share
                edge_derivative(coef, edge, dcoef, dedge, p, row)
    return dcoef, dedge
