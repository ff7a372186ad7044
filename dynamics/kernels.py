"""Compiled exact flow of the oscillator with backlash; plain arrays in and out.

Within a region the motion is linear with periodic coefficients, so the flow over a cell of the period is an
affine map that is known beforehand; only the instants at which a boundary is crossed are searched for.

Arrays that travel together:

- `par`, (7,): mean stiffness, zeta, F_m, eps, omega, error phase, D.
- `coef`, (2, cells, 3, degree + 1): Taylor coefficients, in time from the start of the cell and measured in
  cells, of the solutions started with (1, 0) and (0, 1) and of the forced one started with (0, 0). First
  index: 0 with the stiffness (in contact, y = X -+ D), 1 without (in the dead zone, y = X).
- `edge`, (2, cells, 9): the map over the whole cell, A (4, row by row) and b (2), then three factors which
  bound how far y departs from the chord of the cell: factor . (|y|, |v|, 1).

The region is +1 above D, 0 in the dead zone, -1 below -D; the coordinate y belongs to it. With D = 0 there
is no region 0. One file, because a change in a helper elsewhere would leave stale compiled callers.
"""

import math
from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt
from numba import njit

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Table = tuple[FloatArray, FloatArray, FloatArray]  # par, coef, edge

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile when first called, keep the result on disk, keep the type signature."""
    return cast(F, njit(cache=True, error_model="numpy", nogil=True)(function))


MEAN, ZETA, FORCE, ERROR, FREQUENCY, PHASE, HALF_BACKLASH = range(7)
FINE, DIVERGED, CROWDED = range(3)  # what a kernel returns: all well, not finite, too many events in a cell
MAX_EVENTS = 10_000  # in one cell, which holds a fraction of an oscillation: never met in earnest
ZERO, ONE = cast(int, np.int64(0)), cast(int, np.int64(1))  # a literal would have numba compile callees twice


@kernel
def poly(c: FloatArray, first: int, t: float) -> tuple[float, float, float]:
    """Value, first and second derivative of sum c[first + k] t^k."""
    f = 0.0
    df = 0.0
    ddf = 0.0
    for k in range(len(c) - 1, first - 1, -1):
        ddf = ddf * t + df
        df = df * t + f
        f = f * t + c[k]
    return f, df, 2.0 * ddf


@kernel
def find_root(c: FloatArray, first: int, low: float, high: float, f_low: float, f_high: float) -> float:
    """Root of the polynomial c[first + k] t^k between two points of opposite sign ."""
    rising = f_low < 0.0
    t = low + (high - low) * f_low / (f_low - f_high)
    before = high - low
    for _ in range(200):
        f, df, ddf = poly(c, first, t)
        if f == 0.0:
            return t
        if (f < 0.0) == rising:
            low = t
        else:
            high = t
        square = df * df - 2.0 * f * ddf
        slope = df + (math.sqrt(square) if rising else -math.sqrt(square)) if square > 0.0 else 2.0 * df
        new = (
            t - 2.0 * f / slope if slope != 0.0 else low
        )  # root of the parabola: good next to a double root too
        step = abs(new - t)
        if step <= 4.5e-16 * abs(t) or (step >= 0.5 * before and step < 1e-12 * abs(t)):
            return t  # rounding; never the middle of a bracket that rounding has closed on one side only
        if not (low < new < high):
            new = 0.5 * (low + high)
            step = abs(new - t)
        before = step
        t = new
    return t


@kernel
def first_exit(c: FloatArray, slope: FloatArray, end: float, fresh: int) -> float:
    """Smallest t in [0, end] at which the polynomial turns negative, -1 if it does not.

    A root at t = 0 is divided out. `fresh` = 1: the motion has just come in through this boundary, so that a
    leading coefficient of the wrong sign is rounding. Every part of [0, end] is either proved free of roots
    by a bound on a derivative, or proved to hold at most one extremum, or halved.
    """
    degree = len(c) - 1
    m = 0
    while m <= degree and (c[m] == 0.0 or (m == 0 and c[0] < 0.0)):
        m += 1
    if m <= degree and c[m] < 0.0:
        if fresh != 1:
            return 0.0
        while m <= degree and c[m] <= 0.0:
            m += 1
    if m > degree or end <= 0.0:
        return -1.0
    s2 = s3 = s4 = 0.0
    power = end
    for k in range(2, degree - m + 1):
        power *= end
        size = abs(c[m + k]) * power * k * (k - 1) * 0.12501
        s2 += size
        s3 += size * (k - 2)
        s4 += size * (k - 2) * (k - 3)
    left = 0.0
    width = 1.0
    f_l, g_l, h_l = poly(c, m, 0.0)
    while left < 1.0:
        right = min(left + width, 1.0)
        f_r, g_r, h_r = poly(c, m, right * end)
        square = (right - left) ** 2
        low, high = left * end, right * end
        tilt, bend = min(abs(g_l), abs(g_r)) * end, min(abs(h_l), abs(h_r)) * end * end
        tiny = width < 1e-9
        if f_r > 0.0 and f_l > 0.0 and min(f_l, f_r) > s2 * square:
            pass
        elif (
            tiny
            or (g_l * g_r > 0.0 and tilt > s3 * square)
            or (h_l * h_r > 0.0 and bend > s4 * square and g_l * g_r >= 0.0)
        ):
            if f_r < 0.0:
                return find_root(c, m, low, high, f_l, f_r) if f_l > 0.0 else low
        elif h_l * h_r > 0.0 and bend > s4 * square:
            for k in range(m + 1, degree + 1):
                slope[k - 1] = (k - m) * c[k]
            slope[degree] = 0.0
            turn = find_root(slope, m, low, high, g_l, g_r)
            f_t, _, _ = poly(c, m, turn)
            if f_t < 0.0:
                return find_root(c, m, low, turn, f_l, f_t) if f_l > 0.0 else low
            if f_r < 0.0:
                return find_root(c, m, turn, high, f_t, f_r) if f_t > 0.0 else turn
        else:
            width *= 0.5
            continue
        left, f_l, g_l, h_l = right, f_r, g_r, h_r
        width *= 2.0
    return -1.0


@kernel
def basis(u: FloatArray, s: float, h: float, phi: FloatArray) -> None:
    """Values and speeds of the three tabulated solutions at s: phi = y1, y2, yp, v1, v2, vp."""
    for which in range(3):
        f, df, _ = poly(u[which], 0, s)
        phi[which] = f
        phi[3 + which] = df / h


@kernel
def expand(u: FloatArray, phi: FloatArray, s: float, y: float, v: float, h: float, a: FloatArray) -> None:
    """Taylor coefficients `a` about s of the solution through (y, v) at s."""
    basis(u, s, h, phi)
    wronskian = phi[0] * phi[4] - phi[1] * phi[3]
    r, w = y - phi[2], v - phi[5]
    c1 = (r * phi[4] - w * phi[1]) / wronskian
    c2 = (w * phi[0] - r * phi[3]) / wronskian
    n = len(a)
    for k in range(n):
        a[k] = c1 * u[0, k] + c2 * u[1, k] + u[2, k]
    for i in range(n - 1):
        for k in range(n - 2, i - 1, -1):
            a[k] += s * a[k + 1]
    a[0] = y
    a[1] = v * h


@kernel
def leave(
    region: int, d: float, a: FloatArray, b: FloatArray, slope: FloatArray, end: float, fresh: int
) -> tuple[float, int]:
    """When, within `end`, and through which boundary (1: D, -1: -D, 0: none) the motion leaves."""
    f_end = a[0] + a[1] * end
    power = end
    bend = 0.0
    for k in range(2, len(a)):
        power *= end
        f_end += a[k] * power
        bend += k * (k - 1) * abs(a[k]) * power
    bend *= 0.12501
    hit = 0
    for side in (1, -1):
        if region == -side:
            continue
        if region == 0:
            offset, sign = d, -side
        else:
            offset, sign = 0.0, side
        if min(offset + sign * a[0], offset + sign * f_end) > bend:
            continue
        for k in range(len(a)):
            b[k] = sign * a[k]
        b[0] += offset
        t = first_exit(b, slope, end, fresh * side)
        if t >= 0.0 and (t < end or hit == 0):
            end = t
            hit = side
    return end, hit


@kernel
def enter(region: int, hit: int, d: float) -> tuple[int, float]:
    """Region and coordinate just past the boundary `hit`."""
    if d == 0.0:
        return -region, 0.0
    if region == 0:
        return hit, 0.0
    return 0, hit * d


@kernel
def start(x: float, v: float, d: float, push: float) -> tuple[int, float]:
    """Region and coordinate of a state; on a boundary the motion (speed, else push) decides."""
    way = v if v != 0.0 else push
    if x > d or (x == d and (way > 0.0 or (d == 0.0 and way == 0.0))):
        return 1, x - d
    if x < -d or (x == -d and way < 0.0):
        return -1, x + d
    return 0, x


@kernel
def carry(phi: FloatArray, later: FloatArray, jac: FloatArray) -> None:
    """Multiply the sensitivities by the flow between two instants of a cell."""
    wronskian = phi[0] * phi[4] - phi[1] * phi[3]
    for j in range(2):
        c1 = (jac[0, j] * phi[4] - jac[1, j] * phi[1]) / wronskian
        c2 = (jac[1, j] * phi[0] - jac[0, j] * phi[3]) / wronskian
        jac[0, j] = c1 * later[0] + c2 * later[1]
        jac[1, j] = c1 * later[3] + c2 * later[4]


@kernel
def apply(e: FloatArray, jac: FloatArray) -> None:
    """Multiply the sensitivities by the map of a whole cell."""
    for j in range(2):
        top = e[0] * jac[0, j] + e[1] * jac[1, j]
        jac[1, j] = e[2] * jac[0, j] + e[3] * jac[1, j]
        jac[0, j] = top


@kernel
def straighten(jac: FloatArray) -> None:
    """Make the columns of rows 0 and 1 orthonormal and add the logarithms of their lengths to row 2."""
    area = jac[0, 0] * jac[1, 1] - jac[0, 1] * jac[1, 0]
    length = math.hypot(jac[0, 0], jac[1, 0])
    jac[2, 0] += math.log(length)
    jac[2, 1] += math.log(abs(area) / length)
    c, s = jac[0, 0] / length, jac[1, 0] / length
    jac[0, 0], jac[1, 0] = c, s
    jac[0, 1], jac[1, 1] = (-s, c) if area > 0.0 else (s, -c)


@kernel
def cell_step(
    coef: FloatArray, edge: FloatArray, cell: int, d: float, h: float, region: int, y: float, v: float,
    want: int, jac: FloatArray, work: FloatArray, count: IntArray,
) -> tuple[int, float, float, int]:  # fmt: skip
    """State at the end of a cell, crossing every boundary on the way; counts exits and entries."""
    e = edge[0 if region != 0 else 1, cell]
    y_new = e[0] * y + e[1] * v + e[4]
    v_new = e[2] * y + e[3] * v + e[5]
    reach = e[6] * abs(y) + e[7] * abs(v) + e[8]
    if (region == 0 and d - max(abs(y), abs(y_new)) > reach) or min(region * y, region * y_new) > reach:
        if want > 0:
            apply(e, jac)
        return region, y_new, v_new, FINE
    a, b, phi, later, slope = work[0], work[1], work[2], work[3], work[4]
    s = 0.0
    fresh = ZERO
    for _ in range(MAX_EVENTS):
        u = coef[0 if region != 0 else 1, cell]
        if s == 0.0:
            for k in range(len(a)):
                a[k] = y * u[0, k] + v * u[1, k] + u[2, k]
        else:
            expand(u, phi, s, y, v, h, a)
        t, hit = leave(region, d, a, b, slope, 1.0 - s, fresh)
        if hit == 0 and fresh == 0:  # nothing happened: the map of the whole cell holds
            if want > 0:
                apply(e, jac)
            return region, y_new, v_new, FINE
        y, v, _ = poly(a, ZERO, t)
        v /= h
        s = 1.0 if hit == 0 else s + t
        if want > 0:
            basis(u, s - t, h, phi)
            basis(u, s, h, later)
            carry(phi, later, jac)
        if hit == 0:
            return region, y, v, FINE
        old = region
        region, y = enter(region, hit, d)
        fresh = hit
        count[0] += old == 1
        count[1] += region == -1
        if s >= 1.0:
            return region, y, v, FINE
    return region, y, v, CROWDED


@kernel
def iterate(
    table: Table,
    state: FloatArray,
    skip: int,
    want: int,
    jac: FloatArray,
    states: FloatArray,
    counts: IntArray,
) -> int:
    """Carry `state` over `skip` periods, then fill `states` (periods, 2) and `counts` (periods, 2).

    Row i is the state after i + 1 further periods and the exits and entries during the last of them. `state`
    ends at the last period. `want` 1: the rows 0 and 1 of `jac` are multiplied by the derivative of the map;
    2: its columns are made orthonormal on the way, and the logarithms of their stretch added to row 2.
    """
    par, coef, edge = table
    cells = edge.shape[1]
    d = par[HALF_BACKLASH]
    h = 2.0 * math.pi / par[FREQUENCY] / cells
    work = np.zeros((5, coef.shape[3]))
    count = np.zeros(2, dtype=np.int64)
    push = par[FORCE] + par[ERROR] * par[FREQUENCY] ** 2 * math.cos(par[PHASE])
    v = state[1]
    region, y = start(state[0], v, d, push)
    for period in range(skip + len(states)):
        count[0] = count[1] = 0
        for cell in range(cells):
            region, y, v, flag = cell_step(coef, edge, cell, d, h, region, y, v, want, jac, work, count)
            if flag != FINE:
                return flag
            if want == 2 and (cell % 8 == 7 or cell == cells - 1):
                straighten(jac)
        if not (abs(y) < 1e150 and abs(v) < 1e150):
            return DIVERGED
        if period >= skip:
            states[period - skip, 0] = y + region * d
            states[period - skip, 1] = v
            counts[period - skip, 0] = count[0]
            counts[period - skip, 1] = count[1]
    state[0] = y + region * d
    state[1] = v
    return FINE


@kernel
def direction(a: FloatArray) -> int:
    """Sign of the slope of the polynomial just after t = 0."""
    for k in range(1, len(a)):
        if a[k] != 0.0:
            return 1 if a[k] > 0.0 else -1
    return 0


@kernel
def next_turn(a: FloatArray, b: FloatArray, slope: FloatArray, end: float) -> float:
    """Smallest t in (0, end] at which the slope of the polynomial changes sign, -1 if it does not."""
    for k in range(len(a) - 1):
        b[k] = (k + 1) * a[k + 1]
    b[len(a) - 1] = 0.0
    if direction(a) < 0:
        for i in range(len(b)):
            b[i] = -b[i]
    return first_exit(b, slope, end, ONE)


@kernel
def walk(
    table: Table, state: FloatArray, periods: int, points: int,
    samples: FloatArray, turns: FloatArray, events: FloatArray,
) -> tuple[int, int, int]:  # fmt: skip
    """Follow the motion closely; returns flag, number of turns and number of events.

    `samples`, (periods points + 1, 2): states at equal times. `turns`, (any, 5): time, X, X'', region and
    region just before, at every extremum of X. `events`, (any, 4): time, X, X', region entered. What does
    not fit in `turns` or `events` is counted, not stored.
    """
    par, coef, edge = table
    cells = edge.shape[1]
    d = par[HALF_BACKLASH]
    h = 2.0 * math.pi / par[FREQUENCY] / cells
    work = np.zeros((5, coef.shape[3]))
    a, b, phi, rest, slope = work[0], work[1], work[2], work[3], work[4]
    push = par[FORCE] + par[ERROR] * par[FREQUENCY] ** 2 * math.cos(par[PHASE])
    v = state[1]
    region, y = start(state[0], v, d, push)
    filled = turned = happened = way = 0
    for global_cell in range(periods * cells):
        cell = global_cell % cells
        s = 0.0
        fresh = ZERO
        for event in range(MAX_EVENTS + 1):
            if event == MAX_EVENTS:
                return CROWDED, turned, happened
            u = coef[0 if region != 0 else 1, cell]
            expand(u, phi, s, y, v, h, a)
            t, hit = leave(region, d, a, b, slope, 1.0 - s, fresh)
            while points > 0 and filled < len(samples):
                at = filled * (cells / points) - global_cell - s
                if at > t:
                    break
                f, df, _ = poly(a, ZERO, max(at, 0.0))
                samples[filled, 0] = f + region * d
                samples[filled, 1] = df / h
                filled += 1
            done = 0.0
            for k in range(len(a)):
                rest[k] = a[k]
            while len(turns) > 0:
                heading = direction(rest)
                step = 0.0  # an extremum on the joint of two stretches belongs to neither
                if heading * way != -1 or done > 0.0:
                    way = heading if heading != 0 else way
                    step = next_turn(rest, b, slope, t - done)
                    if step <= 0.0:
                        break
                way = -way
                for i in range(len(rest) - 1):
                    for k in range(len(rest) - 2, i - 1, -1):
                        rest[k] += step * rest[k + 1]
                rest[1] = 0.0
                done += step
                if turned < len(turns):
                    turns[turned, 0] = (global_cell + s + done) * h
                    turns[turned, 1] = rest[0] + region * d
                    turns[turned, 2] = 2.0 * rest[2] / (h * h)
                    turns[turned, 3] = region
                    turns[turned, 4] = rest[0]
                turned += 1
            y, v, _ = poly(a, ZERO, t)
            v /= h
            s = 1.0 if hit == 0 else s + t
            if hit == 0:
                break
            region, y = enter(region, hit, d)
            fresh = hit
            if happened < len(events):
                events[happened, 0] = (global_cell + s) * h
                events[happened, 1] = hit * d
                events[happened, 2] = v
                events[happened, 3] = region
            happened += 1
            if s >= 1.0:
                break
        if not (abs(y) < 1e150 and abs(v) < 1e150):
            return DIVERGED, turned, happened
    while filled < len(samples):
        samples[filled, 0] = y + region * d
        samples[filled, 1] = v
        filled += 1
    return FINE, turned, happened


@kernel
def settle(
    table: Table, starts: FloatArray, homes: FloatArray, radius: float, limit: int, labels: IntArray
) -> int:
    """Follow every start with label -1 until it stays near a known attractor; `starts` become the last states.

    `homes`, (any, 4): X, V, attractor and its period for every point of every attractor. A motion has arrived
    when it is within `radius` of a point, in the largest norm, and no farther after one more round. Labels:
    attractor, -1 not arrived within `limit` periods, -2 grown without bound. Returns periods used.
    """
    one, counts, jac = np.zeros((1, 2)), np.zeros((1, 2), dtype=np.int64), np.zeros((3, 2))
    used = 0
    for i in range(len(starts)):
        state = starts[i]
        home = wait = period = 0
        distance = 0.0
        while labels[i] == -1 and period < limit:
            period += 1
            if iterate(table, state, ZERO, ZERO, jac, one, counts) != FINE:
                labels[i] = -2
            wait -= 1
            for k in range(
                home if wait == 0 else 0, home + 1 if wait == 0 else len(homes) if wait < 0 else 0
            ):
                gap = max(abs(state[0] - homes[k, 0]), abs(state[1] - homes[k, 1]))
                if wait == 0 and gap <= distance:
                    labels[i] = int(homes[k, 2])
                elif wait < 0 and gap < radius:
                    home, distance, wait = k, gap, int(homes[k, 3])
        used += period
    return used
