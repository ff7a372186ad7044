"""The tables of the exact flow in several freedoms, at a cost of m^2 numbers a cell.

All cells share one motion without the stiffness of the mesh, from unit states and from unit speeds along the fixed
forces: S^k x / k! of these. The mesh is a force of rank one, -mu(s) y(s) on the speed of y, so that a cell of contact
needs y alone,

    y_k = C_k - sum_{i + J = k - 1} u_J B(i, J) (mu y)_i,    B(i, J) = i! J! / (i + J + 1)!,

with u_J the first row of S^J / J! from a unit speed of y, and its end adds to that of the free motion as many fixed
vectors, S^J / J! from that speed, as there are terms. Forces of the error go the same way. These are the polynomials of
`expanding`, to rounding.
"""

import math

import numpy as np

from dynamics.kernels.compiling import ONE, ZERO, FloatArray, helper, kernel
from dynamics.kernels.drives.expanding import evaluate_many, expand_many
from dynamics.kernels.tables import add_harmonic, fill_roots

SOURCES = 4
"""Forces of fixed direction: on y alone, by e and by its rate, and the mean one."""


@helper
def fill_betas(betas: FloatArray) -> None:
    """B(i, J) = i! J! / (i + J + 1)!, which t^i (1 - t)^J has over a cell."""
    n = len(betas)
    for j in range(n):
        betas[0, j] = 1.0 / (j + 1)
        for i in range(1, n):
            betas[i, j] = betas[i - 1, j] * i / (i + j + 1)


@helper
def free_motions(
    systems: FloatArray, load: FloatArray, kind: int, none: FloatArray, a: FloatArray, begin: FloatArray
) -> None:
    """Coefficients `a` without mesh from unit states, then from speeds along the stiffness and damping of y and the load.

    `begin`, (2 m, 2 m + 3), becomes their ends; `none` is the mesh stiffness, zeros.
    """
    n, m, columns = a.shape
    for i in range(2 * m):
        for j in range(columns):
            begin[i, j] = 1.0 if i == j else 0.0
    for i in range(m):
        begin[m + i, 2 * m] = systems[0, i, 0]
        begin[m + i, 2 * m + 1] = load[1, i]
        begin[m + i, 2 * m + 2] = load[0, i]
    expand_many(systems, none, kind, begin, a)
    evaluate_many(a, 1.0, begin)


@helper
def error_forces(error: FloatArray, forces: FloatArray) -> None:
    """Taylor coefficients of the forces along y, stiffness and damping of y, and load, (4, degree + 1)."""
    n = len(error)
    for k in range(n - 2):
        forces[0, k] = -(k + 1) * (k + 2) * error[k + 2]
        forces[1, k] = -error[k]
        forces[2, k] = -(k + 1) * error[k + 1]
        forces[3, k] = 1.0 if k == 0 else 0.0


@helper
def add_force(
    a: FloatArray, betas: FloatArray, column: int, force: FloatArray, y: FloatArray, at: int, row: FloatArray
) -> None:
    """Add what a force along the speed that begins column `column` of `a` does: to y[:, at], and to the end `row`."""
    n, m, _ = a.shape
    for j in range(1, n - 1):
        p = q = 0.0
        for i in range(n - 1 - j):
            y[i + j + 1, at] += a[j, 0, column] * betas[i, j] * force[i]
            p += betas[i, j] * force[i]
            q += betas[i, j - 1] * force[i]
        q *= j
        for i in range(m):
            row[i] += p * a[j, i, column]
            row[m + i] += q * a[j, i, column]


@helper
def meet_mesh(
    a: FloatArray, betas: FloatArray, mesh: FloatArray, y: FloatArray, pull: FloatArray, ends: FloatArray,
    lines: FloatArray,
) -> None:  # fmt: skip
    """Turn free motions into those in contact: y, (degree + 1, c), and their ends, (c, 2 m); pull and lines are room."""
    n, m, _ = a.shape
    columns = y.shape[1]
    for k in range(n):
        for i in range(k - 1):
            factor = a[k - 1 - i, 0, m] * betas[i, k - 1 - i]
            for c in range(columns):
                y[k, c] -= factor * pull[i, c]
        for c in range(columns):
            pull[k, c] = 0.0
        for i in range(k + 1):
            for c in range(columns):
                pull[k, c] += mesh[i] * y[k - i, c]
    for j in range(1, n - 1):
        for c in range(columns):
            lines[0, c] = lines[1, c] = 0.0
        for i in range(n - 1 - j):
            p, q = betas[i, j], j * betas[i, j - 1]
            for c in range(columns):
                lines[0, c] -= p * pull[i, c]
                lines[1, c] -= q * pull[i, c]
        for i in range(m):  # what y begins with, next to each other in memory
            lines[2, i] = a[j, i, m]
        for c in range(columns):
            p, q = lines[0, c], lines[1, c]
            for i in range(m):
                ends[c, i] += p * lines[2, i]
                ends[c, m + i] += q * lines[2, i]


@helper
def fill_maps(
    systems: FloatArray, load: FloatArray, series: FloatArray, maps: FloatArray, reach: FloatArray, a: FloatArray,
    begin: FloatArray, y: FloatArray, pull: FloatArray, lines: FloatArray, betas: FloatArray, forces: FloatArray,
) -> None:  # fmt: skip
    """Maps over the whole cells and the bounds of the departure from the chord; `a` and what follows is room."""
    n, m, _ = a.shape
    cells, size = len(series), 2 * m
    fill_betas(betas)
    for kind in range(2):
        for k in range(n):
            forces[0, k] = 0.0
        free_motions(systems, load, kind, forces[0], a, begin)
        for cell in range(cells):
            row = cell + kind * cells
            for c in range(size):
                for k in range(n):
                    y[k, c] = a[k, 0, c]
                for i in range(size):
                    maps[row, c, i] = begin[i, c]
            for c in range(size, size + 2):
                for k in range(n):
                    y[k, c] = 0.0
            error_forces(series[cell, 1], forces)
            for which in range(SOURCES):
                column = m if which == 0 else size - 1 + which
                add_force(a, betas, column, forces[which], y, size, maps[row, size])
            if kind == 0:
                for k in range(n):
                    forces[0, k] = 0.0
                forces[0, 0] = -1.0
                add_force(a, betas, size, forces[0], y, size + 1, maps[row, size + 1])
                meet_mesh(a, betas, series[cell, 0], y, pull, maps[row], lines)
            for c in range(size + 2):
                bend = 0.0
                for k in range(2, n):
                    bend += k * (k - 1) * abs(y[k, c])
                reach[row, c] = 0.12501 * bend


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
    a, begin = np.empty((n, m, 2 * m + 3)), np.empty((2 * m, 2 * m + 3))
    y, pull, lines = np.empty((n, 2 * m + 2)), np.empty((n, 2 * m + 2)), np.empty((3, 2 * m + 2))
    room = np.empty((n, n)), np.zeros((SOURCES, n))
    fill_maps(systems, load, series, maps, reach, a, begin, y, pull, lines, *room)
    return series, maps, reach
