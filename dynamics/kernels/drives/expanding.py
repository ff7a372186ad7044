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
    systems: FloatArray, mesh: FloatArray, push: FloatArray, forced: float, offset: float, kind: int, a: FloatArray
) -> None:  # fmt: skip
    """Taylor coefficients `a`, (m, degree + 1), of the motion whose first two columns are given.

    `kind` 0: in contact, 1: in the dead zone. `forced` is the factor on `push`, `offset` is region D.
    """
    m, n = a.shape
    for k in range(n - 2):
        share, rate, pull = 1.0 / ((k + 1) * (k + 2)), k + 1.0, 0.0
        if kind == 0:
            for i in range(k + 1):
                pull += mesh[i] * a[0, k - i]
        for i in range(m):
            total = forced * push[i, k]
            for j in range(m):
                total -= systems[0, i, j] * a[j, k] + rate * systems[1 + kind, i, j] * a[j, k + 1]
            a[i, k + 2] = total * share
        a[0, k + 2] -= pull * share
        if k == 0:
            for i in range(m):
                a[i, 2] -= 0.5 * offset * systems[0, i, 0]


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
def fill_maps(
    systems: FloatArray, load: FloatArray, series: FloatArray, maps: FloatArray, reach: FloatArray, a: FloatArray,
    push: FloatArray, end: FloatArray,
) -> None:  # fmt: skip
    """Maps over the whole cells and the bounds of the departure from the chord; a, push and end are room."""
    m, n = a.shape
    cells = len(series)
    for row in range(2 * cells):
        kind, cell = (0, row) if row < cells else (1, row - cells)
        excite(systems, load, series[cell, 1], push)
        for j in range(2 * m + 2):
            if row > cells and j != 2 * m:  # nothing but the force depends on time
                for i in range(2 * m):
                    maps[row, i, j] = maps[cells, i, j]
                reach[row, j] = reach[cells, j]
                continue
            for i in range(m):
                a[i, 0] = 1.0 if i == j else 0.0
                a[i, 1] = 1.0 if m + i == j else 0.0
            forced, offset = 1.0 if j == 2 * m else 0.0, 1.0 if j > 2 * m and kind == 0 else 0.0
            expand(systems, series[cell, 0], push, forced, offset, kind, a)
            evaluate(a, 1.0, end)
            for i in range(2 * m):
                maps[row, i, j] = end[i]
            bend = 0.0
            for k in range(2, n):
                bend += k * (k - 1) * abs(a[0, k])
            reach[row, j] = 0.12501 * bend


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
        np.zeros((2 * cells, 2 * m, 2 * m + 2)),
        np.zeros((2 * cells, 2 * m + 2)),
    )
    roots, weights = np.empty((2, 2 * cells)), np.empty(n)
    fill_roots(roots)
    for cell in range(cells):
        series[cell, 0, 0] = mesh[0, 0]
    for which in range(2):
        table, first = (mesh, ONE) if which == 0 else (errors, ZERO)
        for j in range(first, table.shape[1]):
            harmonic = j + 1 - first
            # half a cell back, from its middle to its start
            at = table[1, j] - math.pi * harmonic / cells
            p, q = table[0, j] * math.cos(at), table[0, j] * math.sin(at)
            add_harmonic(series, which, harmonic, p, q, roots, weights)
    fill_maps(systems, load, series, maps, reach, np.empty((m, n)), np.empty((m, n)), np.empty(2 * m))
    return series, maps, reach
