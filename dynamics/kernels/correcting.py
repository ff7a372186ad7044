"""The corrector: Newton's method on the period map with its derivatives."""

import math

import numpy as np

from dynamics.kernels.compiling import (
    FINE,
    FREQUENCY,
    HALF_BACKLASH,
    LOST,
    ZETA,
    FloatArray,
    IntArray,
    helper,
    kernel,
    maker,
)
from dynamics.kernels.roots import largest
from dynamics.kernels.sensitivity import probe
from dynamics.kernels.tables import differentiate, tabulate

NEARLY = 1e-6  # Newton's step, over the scale, after which an orbit is likely to be good to rounding


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
    origin: FloatArray, ways: FloatArray, cells: int, degree: int, u: FloatArray, scale: float,
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
    coef, edge = tabulate(q, cells, degree)
    slopes = differentiate(q, ways, coef, edge)
    state[0], state[1] = u[0] * scale, u[1] * scale
    flag, turned = probe((q, coef, edge), slopes, ways, state, periods, lin, bend, counts, turns)
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
    origin: FloatArray, ways: FloatArray, cells: int, degree: int, u: FloatArray, across: FloatArray,
    scale: float, periods: int, limit: int,
    state: FloatArray, lin: FloatArray, bend: FloatArray, counts: IntArray, turns: FloatArray,
) -> tuple[int, int, int, float]:  # fmt: skip
    """Newton's method for a periodic orbit in the plane across . (u - guess) = 0, `u` being the guess.

    With a limit of 0 it is the state of the guess that is looked at, with any number of parameters.

    Returns flag, number of extrema, iterations and residual over the scale; `u` becomes the orbit, and the rest is
    filled as by `probe`, for the image of the orbit, but with derivatives with respect to the unknowns, over the scale,
    and with phases in [0, 1) of the orbit's period for times.
    """
    guess, last = u.copy(), u.copy()
    matrix, right = np.empty((3, 3)), np.empty(3)
    best, step, done = math.inf, math.inf, 0
    while True:
        # the error falls with the square of the step: this is likely to be the last time
        whole = limit == 0 or step < NEARLY
        flag, turned, size = look(
            origin, ways, cells, degree, u, scale, periods, state, lin,
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
        if limit == 0:
            break
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
            origin, ways, cells, degree, u, scale, periods, state, lin, bend, counts, turns
        )
    rounding = 1.5e-14 * periods * max(1.0, abs(u[0]), abs(u[1]))  # as in dynamics.corrector
    if limit > 0 and not best <= rounding * max(1.0, largest(lin, 2)):
        flag = LOST
    scaled(frequency(origin, ways, u), scale, periods, lin, bend, turns[: min(turned, len(turns))])
    return flag, turned, done, best
