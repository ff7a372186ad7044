"""From angle to angle with every switching met: the extrema of each surface function decide, not its end values."""

import math

import numpy as np

from dynamics.kernels.compiling import ONE, ZERO, FloatArray, IntArray
from dynamics.kernels.roots import copy, first_exit
from dynamics.kernels.stepwise.compiling import (
    CROWDED,
    DIVERGED,
    FINE,
    FREQUENCY,
    MAX_EVENTS,
    MAX_STEPS,
    STUCK,
    TINY,
    Model,
    helper,
    kernel,
)
from dynamics.kernels.stepwise.stepping import (
    COLUMNS,
    attempt,
    attempt_state,
    clear,
    discrepancy,
    height,
    level,
    next_step,
    polynomials,
    regions_of,
    slope,
    way_of,
)

TURN = 2.0 * math.pi
EPS = 2.220446049250313e-16


@helper
def first_event(
    model: Model, surfaces: FloatArray, theta: float, h: float, y: FloatArray, new: FloatArray, region: int,
    on: IntArray, few: FloatArray, k: FloatArray, path: FloatArray, f: FloatArray, dense: FloatArray, c: FloatArray,
    b: FloatArray,
) -> tuple[int, float]:  # fmt: skip
    """First surface that the dense output crosses, -1 if none, and the fraction of the step at which it does.

    Each surface function is a polynomial of degree 7 on the step; its first change of sign is certified by sign
    variations, so that a double root is found however shallow it is.
    """
    q = model[2]
    crossed, when = -1, 2.0
    ready = False
    for i in range(len(surfaces)):
        if on[i] == 0 and clear(surfaces, i, q, y, path):
            continue
        if not ready:
            polynomials(model, theta, h, y, new, region, few, k, f, dense)
            ready = True
        side = way_of(region, i)
        for j in range(8):
            c[j] = side * (surfaces[i, 0] * dense[0, j] + surfaces[i, 1] * dense[1, j])
        c[0] = 0.0 if on[i] else side * height(surfaces, i, q, y[0], y[1])
        s = first_exit(c, b, 1.0, ONE if on[i] else ZERO)
        if 0.0 <= s < when:
            crossed, when = i, s
    return crossed, when


@helper
def land(
    model: Model, surfaces: FloatArray, i: int, theta: float, h: float, guess: float, y: FloatArray, region: int,
    few: FloatArray, out: FloatArray, k: FloatArray, stage: FloatArray, path: FloatArray, new: FloatArray,
) -> tuple[float, int]:  # fmt: skip
    """Shorten a step until its end lies on surface i, to the order of the step and not of its dense output.

    Newton's method on the length, with X and V alone; then the step with all derivatives.
    """
    q, side = model[2], way_of(region, i)
    length = guess
    tries = 0
    while True:
        attempt_state(model, theta, length, y, region, few, k, path, new)
        tries += 1
        rate = surfaces[i, 0] * k[12, 0] + surfaces[i, 1] * k[12, 1]
        if not rate * side < 0.0 or tries == 6:
            break  # next to a touch the dense output is all there is
        move = -height(surfaces, i, q, new[0], new[1]) / rate
        if abs(move) <= 4.0 * EPS * (length + 1e-2 * h) or abs(move) > 1e-2 * h:
            break
        if not 0.0 < length + move <= 1.01 * h:
            break
        length += move
    if len(y) > 2:
        attempt(model, theta, length, y, region, out, k, stage, path, new)
        tries += 1
    return length, tries


@helper
def cross(
    model: Model, surfaces: FloatArray, i: int, theta: float, y: FloatArray, region: int, on: IntArray,
    out: FloatArray, k: FloatArray,
) -> tuple[int, bool]:  # fmt: skip
    """Change sides, of all surfaces that are crossed here; the derivatives jump by the saltation matrix."""
    q, ways, own = model[2], model[4], len(model[0])
    before_x, before_v = k[12, 0], k[12, 1]
    rate = surfaces[i, 0] * before_x + surfaces[i, 1] * before_v
    new = region
    for j in range(len(surfaces)):
        speed = surfaces[j, 0] * before_x + surfaces[j, 1] * before_v
        size = abs(level(surfaces, j, q)) + abs(surfaces[j, 0] * y[0]) + abs(surfaces[j, 1] * y[1])
        here = j == i or abs(height(surfaces, j, q, y[0], y[1])) <= 8.9e-16 * size
        if (here and way_of(region, j) * speed < 0.0) or j == i:
            new = new ^ (1 << j)
            on[j] = 1
    slope(model, theta, y, new, out, k, 0)
    jump = k[0, 1] - before_v
    stuck = False
    if abs(jump) > 1e-12 * (abs(before_v) + abs(before_x)):  # less is the rounding of a continuous force
        after = rate + surfaces[i, 1] * jump
        stuck = after * rate <= 0.0
        if len(y) > 2 and not stuck:
            y[2] += math.log(after / rate)
            for j in range((len(y) - COLUMNS) // 2):
                at = COLUMNS + 2 * j
                off = surfaces[i, 0] * y[at] + surfaces[i, 1] * y[at + 1]
                if j >= 2 and ways[j - 2] >= own and ways[j - 2] - own == int(surfaces[i, 3]):
                    off -= surfaces[i, 2]
                y[at + 1] += jump * off / rate
            slope(model, theta, y, new, out, k, 0)
    return new, stuck


@helper
def release(on: IntArray) -> None:
    """No surface is being left any more."""
    for i in range(len(on)):
        on[i] = 0


@helper
def note(events: FloatArray, row: int, theta: float, i: int, side: int, y: FloatArray, a: float) -> None:
    """Record angle, surface, side entered, X, V, X'' and the derivatives of X."""
    if row < len(events):
        e = events[row]
        e[0], e[1], e[2], e[3], e[4], e[5] = theta, i, side, y[0], y[1], a
        for j in range(6, len(e)):
            e[j] = y[COLUMNS + 2 * (j - 6)]


@kernel
def propagate(
    model: Model, surfaces: FloatArray, tol: float, size: float, start: float, stop: float, y: FloatArray,
    going: FloatArray, on: IntArray, falls: IntArray, events: FloatArray, turns: int,
) -> int:  # fmt: skip
    """Carry y over an angle less than a few periods; 0 or why it could not be.

    `going` holds what passes from call to call: region, -1 to find it; length of the next step; events noted;
    evaluations of the law. `falls` counts changes from the positive to the negative side of the first two surfaces.
    Angles of events count from `turns` periods.
    """
    par, _, q, _, _ = model
    n = len(y)
    k, stage, new = np.empty((16, n)), np.empty(n), np.empty(n)
    path, f, dense, c, b = np.empty((13, 2)), np.empty(7), np.empty((2, 8)), np.empty(8), np.empty(8)
    few, out = np.empty(1), np.empty(1 if n == 2 else 3 + len(q))
    if going[0] < 0.0:
        going[0] = regions_of(model, surfaces, start, y, out, k, on)
    region = int(going[0])
    theta, met, tried, rejected = start, 0, 0, False
    slope(model, theta, y, region, out, k, 0)
    while theta < stop:
        rest = stop - theta
        h = min(going[1], rest)
        attempt(model, theta, h, y, region, out, k, stage, path, new)
        going[3] += 12.0
        tried += 1
        if tried > MAX_STEPS:
            return TINY
        error = discrepancy(h, y, new, k, tol, size)
        if not error <= 1.0:
            going[1] = next_step(h, error, True)
            rejected = True
            if going[1] < 1e-14:
                return DIVERGED if not abs(new[0]) < 1e150 else TINY
            continue
        if not abs(new[0]) + abs(new[1]) < 1e150:
            return DIVERGED
        i, s = first_event(
            model, surfaces, theta, h, y, new, region, on, few, k, path, f, dense, c, b
        )  # fmt: skip
        if i < 0:
            longer = next_step(h, error, rejected)
            going[1] = max(going[1], longer) if h == rest else longer
            theta = stop if h == rest else theta + h
            copy(new, y)
            for j in range(n):
                k[0, j] = k[12, j]
            release(on)
            rejected = False
            continue
        met += 1
        if met > MAX_EVENTS:
            return CROWDED
        length, tries = land(
            model, surfaces, i, theta, h, s * h, y, region, few, out, k, stage, path, new
        )  # fmt: skip
        going[3] += 12.0 * tries
        theta = min(theta + length, stop)
        copy(new, y)
        release(on)
        side, before = -way_of(region, i), region
        region, stuck = cross(model, surfaces, i, theta, y, region, on, out, k)
        if stuck:
            return STUCK
        for j in range(min(2, len(surfaces))):
            falls[j] += (before >> j) & 1 & ~(region >> j)
        note(events, int(going[2]), theta + turns * TURN, i, side, y, k[0, 1] * par[FREQUENCY])
        going[2] += 1.0
        going[0] = region
        rejected = False
    return FINE


@kernel
def iterate(
    model: Model, surfaces: FloatArray, tol: float, size: float, y: FloatArray, going: FloatArray, on: IntArray,
    skip: int, states: FloatArray, falls: IntArray, events: FloatArray,
) -> int:  # fmt: skip
    """Carry y over `skip` periods and then over len(states), keeping state and falls of each; 0 or why it failed."""
    unseen = np.zeros(2, dtype=np.int64)
    for p in range(skip):
        flag = propagate(model, surfaces, tol, size, 0.0, TURN, y, going, on, unseen, events, p)
        if flag != FINE:
            return flag
    for p in range(len(states)):
        flag = propagate(model, surfaces, tol, size, 0.0, TURN, y, going, on, falls[p], events, skip + p)
        if flag != FINE:
            return flag
        states[p, 0], states[p, 1] = y[0], y[1]
    return FINE


@kernel
def stretch(
    model: Model, surfaces: FloatArray, tol: float, size: float, y: FloatArray, going: FloatArray, on: IntArray,
    periods: int, pieces: int, logs: FloatArray,
) -> int:  # fmt: skip
    """Carry the state and two directions that are made orthonormal `pieces` times a period; sum their logarithms.

    logs[2] takes the logarithm of the determinant by its own equation.
    """
    events, unseen = np.empty((0, 6)), np.zeros(2, dtype=np.int64)
    for p in range(periods):
        for piece in range(pieces):
            y[2] = 0.0
            start, stop = TURN * piece / pieces, TURN * (piece + 1) / pieces
            flag = propagate(model, surfaces, tol, size, start, stop, y, going, on, unseen, events, p)
            if flag != FINE:
                return flag
            first = math.hypot(y[3], y[4])
            y[3] /= first
            y[4] /= first
            shared = y[3] * y[5] + y[4] * y[6]
            y[5] -= shared * y[3]
            y[6] -= shared * y[4]
            second = math.hypot(y[5], y[6])
            y[5] /= second
            y[6] /= second
            logs[0] += math.log(first)
            logs[1] += math.log(second)
            logs[2] += y[2]
    return FINE


@kernel
def probe(model: Model, surfaces: FloatArray, points: FloatArray, out: FloatArray) -> None:
    """What the law says at points (angle, X, V), each in the region where it lies."""
    _, law, q, data, _ = model
    for p in range(len(points)):
        region = 0
        for i in range(len(surfaces)):
            if height(surfaces, i, q, points[p, 1], points[p, 2]) > 0.0:
                region |= 1 << i
        law(points[p, 0], points[p, 1], points[p, 2], region, q, data, out[p])
