"""Taylor polynomials of a motion in several freedoms, and the tables made of them."""

import math

import numpy as np

from dynamics.kernels.compiling import ONE, ZERO, FloatArray, helper, kernel
from dynamics.kernels.tables import add_harmonic, fill_roots


@helper
def excite(systems: FloatArray, load: FloatArray, error: FloatArray, push: FloatArray) -> None:
    """Taylor coefficients `push`, (m, degree + 1), of all forces that do not depend on the state.

    `error` are those of e: y is the first coordinate less e, which is left behind as a force.
    """
    m, n = push.shape
    for i in range(m):
        for k in range(n - 2):
            push[i, k] = -systems[0, i, 0] * error[k] - load[1, i] * (k + 1) * error[k + 1]
        push[i, 0] += load[0, i]
    for k in range(n - 2):
        push[0, k] -= (k + 1) * (k + 2) * error[k + 2]


@helper
def expand(
    systems: FloatArray, mesh: FloatArray, push: FloatArray, offset: float, kind: int, a: FloatArray
) -> None:  # fmt: skip
    """Taylor coefficients `a`, (m, degree + 1), of the motion whose first two columns are given.

    `kind` 0: in contact, 1: in the dead zone. `offset` is region D.
    """
    m, n = a.shape
    for k in range(n - 2):
        share, rate, pull = 1.0 / ((k + 1) * (k + 2)), k + 1.0, 0.0
        if kind == 0:
            for i in range(k + 1):
                pull += mesh[i] * a[0, k - i]
        for i in range(m):
            total = push[i, k]
            for j in range(m):
                total -= systems[0, i, j] * a[j, k] + rate * systems[1 + kind, i, j] * a[j, k + 1]
            a[i, k + 2] = total * share
        a[0, k + 2] -= pull * share
        if k == 0:
            for i in range(m):
                a[i, 2] -= 0.5 * offset * systems[0, i, 0]


@helper
def expand_many(systems: FloatArray, mesh: FloatArray, kind: int, begin: FloatArray, a: FloatArray) -> None:
    """Taylor coefficients `a`, (degree + 1, m, c), of many free motions from the first rows of `begin`, (2 m, c).

    A motion is a column, next to its neighbours in memory: the inner loops take several at once.
    """
    n, m, columns = a.shape
    for i in range(m):
        for c in range(columns):
            a[0, i, c] = begin[i, c]
            a[1, i, c] = begin[m + i, c]
    for k in range(n - 2):
        add_many(systems, mesh, kind, k, a)


@helper
def add_many(systems: FloatArray, mesh: FloatArray, kind: int, k: int, a: FloatArray) -> None:
    """The coefficients k + 2 of many free motions."""
    _, m, columns = a.shape
    share = 1.0 / ((k + 1) * (k + 2))
    for i in range(m):
        for c in range(columns):
            a[k + 2, i, c] = 0.0
        for j in range(m):
            p, q = -share * systems[0, i, j], -share * (k + 1) * systems[1 + kind, i, j]
            for c in range(columns):
                a[k + 2, i, c] += p * a[k, j, c] + q * a[k + 1, j, c]
    if kind == 0:
        for i in range(k + 1):
            p = -share * mesh[i]
            for c in range(columns):
                a[k + 2, 0, c] += p * a[k - i, 0, c]


@helper
def evaluate(a: FloatArray, t: float, out: FloatArray) -> None:
    """State, (2 m,), of polynomials at t."""
    m, n = a.shape
    for i in range(m):
        f = df = 0.0
        for k in range(n - 1, -1, -1):
            df = df * t + f
            f = f * t + a[i, k]
        out[i] = f
        out[m + i] = df


@helper
def evaluate_many(a: FloatArray, t: float, out: FloatArray) -> None:
    """States, (2 m, c), of many motions at t."""
    n, m, columns = a.shape
    for i in range(m):
        for c in range(columns):
            out[i, c] = out[m + i, c] = 0.0
        for k in range(n - 1, -1, -1):
            for c in range(columns):
                out[m + i, c] = out[m + i, c] * t + out[i, c]
                out[i, c] = out[i, c] * t + a[k, i, c]


@helper
def fill_maps(
    systems: FloatArray, load: FloatArray, series: FloatArray, maps: FloatArray, reach: FloatArray, a: FloatArray,
    push: FloatArray, begin: FloatArray,
) -> None:  # fmt: skip
    """Maps over the whole cells and the bounds of the departure from the chord; a, push and begin are room."""
    n, m, columns = a.shape
    cells, force = len(series), columns - 2
    for row in range(2 * cells):
        kind, cell = (0, row) if row < cells else (1, row - cells)
        excite(systems, load, series[cell, 1], push)
        for j in range(columns):
            for i in range(2 * m):
                begin[i, j] = 1.0 if i == j else 0.0
            for i in range(m):
                a[0, i, j] = begin[i, j]
                a[1, i, j] = begin[m + i, j]
        for k in range(n - 2):
            add_many(systems, series[cell, 0], kind, k, a)
            for i in range(m):
                a[k + 2, i, force] += push[i, k] / ((k + 1) * (k + 2))
                if k == 0 and kind == 0:
                    a[2, i, force + 1] -= 0.5 * systems[0, i, 0]
        evaluate_many(a, 1.0, begin)
        for j in range(columns):
            bend = 0.0
            for k in range(2, n):
                bend += k * (k - 1) * abs(a[k, 0, j])
            reach[row, j] = 0.12501 * bend
            for i in range(2 * m):
                maps[row, j, i] = begin[i, j]


@kernel
def tabulate(
    mesh: FloatArray, errors: FloatArray, cells: int, degree: int, systems: FloatArray, load: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Tables `series`, `maps` and `reach` of one period.

    `mesh`, (2, 1 + J): mean and amplitudes of the mesh stiffness as in `series`, and their phases (the first unused);
    `errors`, (2, M): amplitudes and phases of the error.
    """
    m, n = load.shape[1], degree + 1
    series, maps, reach = (
        np.zeros((cells, 2, n)),
        np.zeros((2 * cells, 2 * m + 2, 2 * m)),
        np.zeros((2 * cells, 2 * m + 2)),
    )
    sums, roots, waves = np.zeros((2, n, cells)), np.empty((2, 2 * cells)), np.empty((2, cells))
    fill_roots(roots)
    for cell in range(cells):
        sums[0, 0, cell] = mesh[0, 0]
    for which in range(2):
        table, first = (mesh, ONE) if which == 0 else (errors, ZERO)
        for j in range(first, table.shape[1]):
            harmonic = j + 1 - first
            # half a cell back, from its middle to its start
            at = table[1, j] - math.pi * harmonic / cells
            p, q = table[0, j] * math.cos(at), table[0, j] * math.sin(at)
            add_harmonic(sums[which], harmonic, p, q, roots, waves)
        for k in range(n):
            for cell in range(cells):
                series[cell, which, k] = sums[which, k, cell]
    a, begin = np.empty((n, m, 2 * m + 2)), np.empty((2 * m, 2 * m + 2))
    fill_maps(systems, load, series, maps, reach, a, np.zeros((m, n)), begin)
    return series, maps, reach
