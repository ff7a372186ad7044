"""The tables of the exact flow in several freedoms, at a cost of m^2 numbers a cell.

All cells share the motions without the stiffness of the mesh: from unit states, and under forces t^i along a few
directions. The mesh is one of these forces, -mu(t) y(t) along y, so that a cell of contact needs y alone,

    y_k = c_k - sum_i u_ik (mu y)_i,

with u_ik the coefficients of y under t^i, and its end is that of the free motion less the ends under t^i times
(mu y)_i. Forces of the error and periodic ones go the same way. The force t^i gives the term S^J / J! of the free
motion from a unit speed the factor B(i, J) = i! J! / (i + J + 1)!. These are the polynomials of `expanding`, to
rounding.
"""

import math

import numpy as np

from dynamics.kernels.compiling import ONE, ZERO, FloatArray, helper, kernel, maker
from dynamics.kernels.drives.expanding import evaluate_many, expand_many
from dynamics.kernels.tables import add_harmonic, fill_roots

Basis = tuple[FloatArray, FloatArray, FloatArray, FloatArray]
"""Without the mesh: coefficients of y from unit states (degree + 1, 2 m), their ends (2 m, 2 m); coefficients of y
under forces (sources, degree + 1, degree + 1) and their ends (sources, degree + 1, 2 m), by t^i."""
SOURCES = 4
"""Forces of fixed direction: along y, along its stiffness and damping, and the mean one; periodic ones follow."""


@maker
def basis_of(systems: FloatArray, load: FloatArray, kind: int, n: int) -> Basis:
    """Motions without the mesh, in contact (its damping with it) or in the dead zone."""
    m = load.shape[1]
    size, more = 2 * m, len(load) - 2
    a, begin, none = np.empty((n, m, size + 3 + more)), np.zeros((size, size + 3 + more)), np.zeros(n)
    for i in range(size):
        begin[i, i] = 1.0
    for i in range(m):
        begin[m + i, size] = systems[0, i, 0]
        begin[m + i, size + 1] = load[1, i]
        begin[m + i, size + 2] = load[0, i]
        for j in range(more):
            begin[m + i, size + 3 + j] = load[2 + j, i]
    expand_many(systems, none, kind, begin, a)
    evaluate_many(a, 1.0, begin)
    lines, ends = np.empty((n, size)), np.empty((size, size))
    for i in range(size):
        for k in range(n):
            lines[k, i] = a[k, 0, i]
        for j in range(size):
            ends[i, j] = begin[j, i]
    pushed, answers = np.zeros((SOURCES + more, n, n)), np.zeros((SOURCES + more, n, size))
    for which in range(SOURCES + more):
        column = m if which == 0 else size - 1 + which
        for i in range(n - 2):
            beta = 1.0 / (i + 1)  # B(i, 0)
            for j in range(1, n - 1 - i):
                speed, beta = j * beta, beta * j / (i + j + 1)
                pushed[which, i, i + j + 1] = beta * a[j, 0, column]
                for k in range(m):
                    answers[which, i, k] += beta * a[j, k, column]
                    answers[which, i, m + k] += speed * a[j, k, column]
    return lines, ends, pushed, answers


@helper
def known_forces(series: FloatArray, forces: FloatArray) -> None:
    """Taylor coefficients of a cell's forces that do not depend on the state, (sources, degree + 1)."""
    error, n = series[1], series.shape[1]
    for k in range(n - 2):
        forces[0, k] = -(k + 1) * (k + 2) * error[k + 2]
        forces[1, k] = -error[k]
        forces[2, k] = -(k + 1) * error[k + 1]
        forces[3, k] = 1.0 if k == 0 else 0.0
    for j in range(SOURCES, len(forces)):
        for k in range(n - 2):
            forces[j, k] = series[j - 2, k]


@helper
def y_of_cell(
    basis: Basis, series: FloatArray, kind: int, forces: FloatArray, y: FloatArray, pull: FloatArray
) -> None:
    """Coefficients of y over a cell, (degree + 1, 2 m + 2), and of mu y; `forces` become those of the cell."""
    lines, _, pushed, _ = basis
    n, size = lines.shape
    known_forces(series, forces)
    for k in range(n):
        for c in range(size):
            y[k, c] = lines[k, c]
        y[k, size] = 0.0
        y[k, size + 1] = -pushed[1, 0, k] if kind == 0 else 0.0
        for which in range(len(forces)):
            for i in range(k - 1):
                y[k, size] += pushed[which, i, k] * forces[which, i]
        if kind == 0:
            for i in range(k - 1):
                for c in range(size + 2):
                    y[k, c] -= pushed[0, i, k] * pull[i, c]
            for c in range(size + 2):
                pull[k, c] = 0.0
            for i in range(k + 1):
                for c in range(size + 2):
                    pull[k, c] += series[0, i] * y[k - i, c]


@maker
def ends_of_cell(
    basis: Basis, kind: int, forces: FloatArray, pull: FloatArray, ends: FloatArray, spare: FloatArray
) -> None:
    """Ends of a cell, (2 m + 2, 2 m), after `y_of_cell`."""
    _, free, _, answers = basis
    _, n, size = answers.shape
    for c in range(size):
        for i in range(size):
            ends[c, i] = free[c, i]
    for i in range(size):
        ends[size, i] = 0.0
        ends[size + 1, i] = -answers[1, 0, i] if kind == 0 else 0.0
    for which in range(len(forces)):
        for k in range(n - 2):
            for i in range(size):
                ends[size, i] += forces[which, k] * answers[which, k, i]
    if kind == 0:
        np.dot(pull.T, answers[0], spare)
        for c in range(size + 2):
            for i in range(size):
                ends[c, i] -= spare[c, i]


@kernel
def tabulate(
    mesh: FloatArray, errors: FloatArray, pushes: FloatArray, cells: int, degree: int, systems: FloatArray,
    load: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:  # fmt: skip
    """Tables `series`, `maps` and `reach` of one period.

    `mesh`, (2, 1 + J): mean and amplitudes of the mesh stiffness as in `series`, and their phases (the first unused);
    `errors`, (2, M): amplitudes and phases of the error; `pushes`, (2 p, H): of each periodic force.
    """
    rows, m, n = len(load), load.shape[1], degree + 1
    series, maps, reach = (
        np.zeros((cells, rows, n)),
        np.zeros((2 * cells, 2 * m + 2, 2 * m)),
        np.zeros((2 * cells, 2 * m + 2)),
    )
    sums, roots, waves = np.zeros((rows, n, cells)), np.empty((2, 2 * cells)), np.empty((2, cells))
    fill_roots(roots)
    for cell in range(cells):
        sums[0, 0, cell] = mesh[0, 0]
    for which in range(rows):
        table, first = (mesh, ONE) if which == 0 else (errors, ZERO)
        if which > 1:
            table = pushes[2 * which - 4 : 2 * which - 2]
        for j in range(first, table.shape[1]):
            harmonic = j + 1 - first
            # half a cell back, from its middle to its start
            at = table[1, j] - math.pi * harmonic / cells
            p, q = table[0, j] * math.cos(at), table[0, j] * math.sin(at)
            add_harmonic(sums[which], harmonic, p, q, roots, waves)
        for k in range(n):
            for cell in range(cells):
                series[cell, which, k] = sums[which, k, cell]
    y, pull, forces = np.empty((n, 2 * m + 2)), np.empty((n, 2 * m + 2)), np.zeros((SOURCES + rows - 2, n))
    spare = np.empty((2 * m + 2, 2 * m))
    for kind in range(2):
        basis = basis_of(systems, load, kind, n)
        for cell in range(cells):
            row = cell + kind * cells
            y_of_cell(basis, series[cell], kind, forces, y, pull)
            ends_of_cell(basis, kind, forces, pull, maps[row], spare)
            for c in range(2 * m + 2):
                for k in range(2, n):
                    reach[row, c] += 0.12501 * k * (k - 1) * abs(y[k, c])
    return series, maps, reach


@kernel
def gather(
    systems: FloatArray, load: FloatArray, series: FloatArray, maps: FloatArray, stride: int
) -> FloatArray:
    """Maps over strides of so many cells in contact, (strides, 2 m + 2, 2 m + 2 stride), transposed like `maps`.

    As functions of the start of a stride: its end, then y at the end of each of its cells, then bounds of how far y
    departs from its chord in each, to be multiplied by moduli.
    """
    m, n, count = load.shape[1], series.shape[2], len(series) // stride
    size, columns = 2 * m, 2 * m + 2
    y, pull, forces = np.empty((n, columns)), np.empty((n, columns)), np.zeros((SOURCES + len(load) - 2, n))
    states, now, after = np.empty((n, size)), np.empty((size, columns)), np.empty((size, columns))
    lines, stride_maps = np.empty((n, columns)), np.zeros((count, columns, size + 2 * stride))
    basis = basis_of(systems, load, ZERO, n)
    for which in range(count):
        for i in range(size):
            for c in range(columns):
                now[i, c] = 1.0 if i == c else 0.0
        for step in range(stride):
            cell = which * stride + step
            y_of_cell(basis, series[cell], ZERO, forces, y, pull)
            for k in range(n):
                for i in range(size):
                    states[k, i] = y[k, i]
            np.dot(states, now, lines)
            np.dot(maps[cell, :size].T, now, after)
            for k in range(2, n):
                lines[k, size] += y[k, size]
                lines[k, size + 1] += y[k, size + 1]
                for c in range(columns):
                    stride_maps[which, c, size + stride + step] += 0.12501 * k * (k - 1) * abs(lines[k, c])
            for i in range(size):
                after[i, size] += maps[cell, size, i]
                after[i, size + 1] += maps[cell, size + 1, i]
            now, after = after, now
            for c in range(columns):
                stride_maps[which, c, size + step] = now[0, c]
        for i in range(size):
            for c in range(columns):
                stride_maps[which, c, i] = now[i, c]
    return stride_maps
