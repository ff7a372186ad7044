"""The corrector: Newton's method on the period map with its derivatives."""

import math
from typing import Any

import numpy as np

from dynamics.kernels.compiling import (
    FINE,
    FREE,
    FREQUENCY,
    HALF_BACKLASH,
    LOST,
    ZERO,
    ZETA,
    FloatArray,
    IntArray,
    Room,
    helper,
    plain_kernel,
)
from dynamics.kernels.roots import choices, copy, largest
from dynamics.kernels.sensitivity import probe
from dynamics.kernels.tables import differentiate, fill, first_touched, room_of, slopes_of, tables_of

NEARLY = 1e-6  # Newton's step, over the scale, after which an orbit is likely to be good to rounding
Rooms = tuple[Any, Any, Room, Room, Any, Any]


def rooms_of(ways: int, length: int, cells: int, degree: int) -> Rooms:
    """Tables, their derivatives, room for both, for `probe` and for `correct`, with so many packed parameters."""
    m = 2 + ways
    return (
        tables_of(cells, degree),
        slopes_of(ways, cells, degree),
        room_of(cells, degree),
        room_of(cells, degree),
        (
            np.empty((5, degree + 1)),
            choices(degree),
            np.empty((2, m)),
            np.empty((0, 2, 2)),
        ),
        (np.empty(m), np.empty(m), np.empty(length), np.empty((3, 3)), np.empty(3)),
    )


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


@helper
def move(origin: FloatArray, ways: FloatArray, u: FloatArray, q: FloatArray) -> bool:
    """Fill `q` with the parameters of the unknowns; False where they are not allowed."""
    for i in range(len(q)):
        q[i] = origin[i]
        for k in range(len(ways)):
            q[i] += u[2 + k] * ways[k, i]
    return bool(q[FREQUENCY] > 0.0 and q[HALF_BACKLASH] >= 0.0 and min(q[ZETA], q[FREE]) >= 0.0)


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


@plain_kernel
def correct(
    origin: FloatArray, ways: FloatArray, u: FloatArray, across: FloatArray, scale: float, periods: int, limit: int,
    state: FloatArray, lin: FloatArray, bend: FloatArray, counts: IntArray, turns: FloatArray, clock: FloatArray,
    rooms: Rooms,
) -> tuple[int, int, int, float]:  # fmt: skip
    """Newton's method for a periodic orbit in the plane across . (u - guess) = 0, `u` being the guess.

    With a limit of 0 it is the state of the guess that is looked at, with any number of parameters.

    Returns flag, number of extrema, iterations and residual over the scale; `u` becomes the orbit, and the rest is
    filled as by `probe`, for the image of the orbit, but with derivatives with respect to the unknowns, over the scale,
    and with phases in [0, 1) of the orbit's period for times. `rooms` as by `rooms_of`, the same again for another call
    with these `origin` and `ways`: what they do not touch is not tabulated again.
    """
    (coef, edge), (dcoef, dedge), room, more, (work, choose, there, none), (guess, last, q, matrix, right) = (
        rooms
    )
    copy(u, guess)
    copy(u, last)
    touched = first_touched(origin, ways)
    first = ZERO if room[3][0, 0] == 0.0 else touched
    best, step, done, turned, final = math.inf, math.inf, 0, 0, False
    while True:
        # the error falls with the square of the step: this is likely to be the last time
        whole = final or limit == 0 or step < NEARLY
        if not move(origin, ways, u, q):
            return LOST, 0, done, best
        fill(q, coef, edge, room, first)
        first = touched
        differentiate(q, ways, edge, room, more, dcoef, dedge)
        state[0], state[1] = u[0] * scale, u[1] * scale
        flag, turned = probe(
            (q, coef, edge), (dcoef, dedge), ways, state, periods, lin,
            bend if whole else bend[:0], counts, turns if whole else turns[:0], clock, work, choose, there, none,
        )  # fmt: skip
        if flag != FINE:
            return flag, 0, done, best
        size = max(abs(state[0] / scale - u[0]), abs(state[1] / scale - u[1]))
        if final:
            best = size
            break
        if not size < best and done > 3:  # rounding: the one before was as good
            for k in range(3):
                u[k] = last[k]
            final = True
            continue
        best = size
        if limit == 0:
            break
        rest = newton_step(u, guess, across, scale, state, lin, matrix, right) if size > 0.0 else 0.0
        if whole and (size <= 4e-15 * max(1.0, largest(lin, 2)) or step < 1e-11):
            break
        if rest == 0.0 or done >= limit:
            final = True
            continue
        if not rest < 0.5:
            return LOST, 0, done, best
        step = rest
        done += 1
        for k in range(3):
            last[k] = u[k]
            u[k] += right[k]
    rounding = 1.5e-14 * periods * max(1.0, abs(u[0]), abs(u[1]))  # as in dynamics.branches.corrector
    flag = FINE
    if limit > 0 and not best <= rounding * max(1.0, largest(lin, 2)):
        flag = LOST
    scaled(q[FREQUENCY], scale, periods, lin, bend, turns[: min(turned, len(turns))])
    return flag, turned, done, best
