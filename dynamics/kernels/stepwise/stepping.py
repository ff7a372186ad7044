"""One step of order 8: the equation with its derivatives, the stages, the error, the dense output as polynomials.

The independent variable is the angle theta = omega tau, so that the period is 2 pi whatever the frequency. A vector y
holds X and V alone, or X, V, the logarithm of the determinant of the flow, and pairs of derivatives of X and V.
"""

import math

from dynamics.kernels.compiling import FloatArray, IntArray
from dynamics.kernels.stepwise.compiling import ERROR, FORCE, FREQUENCY, MORE, PHASE, ZETA, Model, helper
from dynamics.kernels.stepwise.tableau import DENSE, E3, E5, STAGES, A, B, C

COLUMNS = 3  # where the pairs of derivatives begin
FLOOR = 1e-3  # a derivative smaller than this is computed to an absolute tolerance


@helper
def pushed(par: FloatArray, theta: float) -> float:
    """Force of the error over w^2."""
    total = par[ERROR] * math.cos(theta + par[PHASE])
    more = (len(par) - MORE) // 2
    for j in range(more):
        n = j + 2
        total += n * n * par[MORE + j] * math.cos(n * theta + par[MORE + more + j])
    return float(total)


@helper
def pushed_by(par: FloatArray, theta: float, way: int) -> float:
    """Derivative of `pushed` by an amplitude or a phase."""
    more = (len(par) - MORE) // 2
    if way == ERROR:
        return math.cos(theta + par[PHASE])
    if way == PHASE:
        return -float(par[ERROR]) * math.sin(theta + par[PHASE])
    j = (way - MORE) % more
    n = j + 2
    angle = n * theta + par[MORE + more + j]
    return n * n * math.cos(angle) if way - MORE < more else -n * n * float(par[MORE + j]) * math.sin(angle)


@helper
def slope(
    model: Model, theta: float, y: FloatArray, region: int, out: FloatArray, k: FloatArray, s: int
) -> None:
    """dy/dtheta into k[s]; `out` (1 or 3 + parameters of the law) is room for the law's answer."""
    par, law, q, data, ways = model
    w, x, v = par[FREQUENCY], y[0], y[1]
    law(theta, x, v, region, q, data, out)
    push = pushed(par, theta)
    damping = 2.0 * par[ZETA]
    a = par[FORCE] + w * w * push - damping * v - out[0]
    k[s, 0] = v / w
    k[s, 1] = a / w
    if len(y) == 2:
        return
    damping += out[2]
    k[s, 2] = -damping / w
    for j in range((len(y) - COLUMNS) // 2):
        at = COLUMNS + 2 * j
        g = y[at + 1]
        b = -out[1] * y[at] - damping * y[at + 1]
        if j >= 2:
            way = ways[j - 2]
            if way == ZETA:
                b -= 2.0 * v
            elif way == FORCE:
                b += 1.0
            elif way == FREQUENCY:
                g -= v / w
                b += 2.0 * w * push - a / w
            elif way < len(par):
                b += w * w * pushed_by(par, theta, way)
            else:
                b -= out[3 + way - len(par)]
        k[s, at] = g / w
        k[s, at + 1] = b / w


@helper
def attempt_state(
    model: Model, theta: float, h: float, y: FloatArray, region: int, few: FloatArray, k: FloatArray, path: FloatArray,
    new: FloatArray,
) -> None:  # fmt: skip
    """The same as `attempt` for X and V alone, three times as fast."""
    par, law, q, data, _ = model
    per, damping = 1.0 / par[FREQUENCY], 2.0 * par[ZETA]
    force, square = par[FORCE], par[FREQUENCY] * par[FREQUENCY]
    x, v = y[0], y[1]
    for s in range(1, STAGES + 1):
        dx = dv = 0.0
        for j in range(s):
            weight = A[s, j] if s < STAGES else B[j]
            dx += weight * k[j, 0]
            dv += weight * k[j, 1]
        x, v, angle = y[0] + h * dx, y[1] + h * dv, theta + C[s] * h
        path[s, 0], path[s, 1] = x, v
        law(angle, x, v, region, q, data, few)
        k[s, 0] = v * per
        k[s, 1] = (force + square * pushed(par, angle) - damping * v - few[0]) * per
    new[0], new[1] = x, v


@helper
def attempt(
    model: Model, theta: float, h: float, y: FloatArray, region: int, out: FloatArray, k: FloatArray, stage: FloatArray,
    path: FloatArray, new: FloatArray,
) -> None:  # fmt: skip
    """A step from known k[0]: stages in `k`, k[12] at its end, X and V of the stages in `path`, the end in `new`."""
    n = len(y)
    if n == 2:
        attempt_state(model, theta, h, y, region, out, k, path, new)
        return
    for s in range(1, STAGES + 1):
        for i in range(n):
            stage[i] = 0.0
        for j in range(s):
            weight = A[s, j] if s < STAGES else B[j]
            if weight != 0.0:
                for i in range(n):
                    stage[i] += weight * k[j, i]
        for i in range(n):
            stage[i] = y[i] + h * stage[i]
        path[s, 0], path[s, 1] = stage[0], stage[1]
        slope(model, theta + C[s] * h, stage, region, out, k, s)
    for i in range(n):
        new[i] = stage[i]


@helper
def discrepancy(h: float, y: FloatArray, new: FloatArray, k: FloatArray, tol: float, size: float) -> float:
    """Estimated error of a step over what is allowed, the worst of the state and of each derivative."""
    worst = 0.0
    at = 0
    while at < len(y):
        floor = size if at == 0 else FLOOR
        scale = tol * max(abs(y[at]), abs(y[at + 1]), abs(new[at]), abs(new[at + 1]), floor)
        high = low = 0.0
        for i in range(at, at + 2):
            e5 = e3 = 0.0
            for s in range(STAGES):
                e5 += E5[s] * k[s, i]
                e3 += E3[s] * k[s, i]
            high += (e5 / scale) ** 2
            low += (e3 / scale) ** 2
        if not high < math.inf:
            return math.inf
        if high > 0.0:
            worst = max(worst, h * high / math.sqrt(2.0 * (high + 0.01 * low)))
        at += 2 if at > 0 else COLUMNS
    return worst


@helper
def polynomials(
    model: Model, theta: float, h: float, y: FloatArray, new: FloatArray, region: int, few: FloatArray, k: FloatArray,
    f: FloatArray, dense: FloatArray,
) -> None:  # fmt: skip
    """Dense output: coefficients of X and V in powers of the fraction of the step, dense[0:2, 0:8]; f (7) is room."""
    par, law, q, data, _ = model
    w = par[FREQUENCY]
    for s in range(STAGES + 1, STAGES + 4):
        dx = dv = 0.0
        for j in range(s):
            dx += A[s, j] * k[j, 0]
            dv += A[s, j] * k[j, 1]
        x, v, angle = y[0] + h * dx, y[1] + h * dv, theta + C[s] * h
        law(angle, x, v, region, q, data, few)
        drive = par[FORCE] + w * w * pushed(par, angle)
        k[s, 0] = v / w
        k[s, 1] = (drive - 2.0 * par[ZETA] * v - few[0]) / w
    for i in range(2):
        rise = new[i] - y[i]
        f[0] = rise
        f[1] = h * k[0, i] - rise
        f[2] = 2.0 * rise - h * (k[STAGES, i] + k[0, i])
        for r in range(4):
            total = 0.0
            for s in range(STAGES + 4):
                total += DENSE[r, s] * k[s, i]
            f[3 + r] = h * total
        for j in range(8):
            dense[i, j] = 0.0
        dense[i, 0] = f[6]
        for r in range(5, -1, -1):
            if r % 2 == 1:  # times s
                for j in range(7, 0, -1):
                    dense[i, j] = dense[i, j - 1]
                dense[i, 0] = 0.0
            else:  # times 1 - s
                for j in range(7, 0, -1):
                    dense[i, j] -= dense[i, j - 1]
            dense[i, 0] += f[r]
        for j in range(7, 0, -1):
            dense[i, j] = dense[i, j - 1]
        dense[i, 0] = y[i]


@helper
def next_step(h: float, error: float, rejected: bool) -> float:
    """Length for the next step, or for another try."""
    if not error < math.inf:
        return 0.1 * h
    factor: float = 0.9 * max(error, 1e-30) ** -0.125
    factor = min(max(factor, 0.2), 6.0)
    return h * (min(factor, 1.0) if rejected else factor)


@helper
def level(surfaces: FloatArray, i: int, q: FloatArray) -> float:
    """Value at which n . (X, V) lies on surface i; a row of `surfaces` holds n_X, n_V, sign, place in q or -1."""
    place = int(surfaces[i, 3])
    return float(surfaces[i, 2] * q[place]) if place >= 0 else 0.0


@helper
def height(surfaces: FloatArray, i: int, q: FloatArray, x: float, v: float) -> float:
    """Positive on one side of surface i, negative on the other."""
    return float(surfaces[i, 0] * x + surfaces[i, 1] * v - level(surfaces, i, q))


@helper
def clear(surfaces: FloatArray, i: int, q: FloatArray, y: FloatArray, path: FloatArray) -> bool:
    """Return whether a step stays far from surface i: over twice its whole excursion at the twelve stages."""
    here = height(surfaces, i, q, y[0], y[1])
    farthest = 0.0
    for s in range(1, STAGES + 1):
        farthest = max(farthest, abs(height(surfaces, i, q, path[s, 0], path[s, 1]) - here))
    return abs(here) > 2.0 * farthest


@helper
def way_of(region: int, i: int) -> int:
    """1 on the positive side of surface i, -1 on the other."""
    return 1 if (region >> i) & 1 else -1


@helper
def regions_of(
    model: Model,
    surfaces: FloatArray,
    theta: float,
    y: FloatArray,
    out: FloatArray,
    k: FloatArray,
    on: IntArray,
) -> int:
    """Region of a state; on a surface, the one it moves to, and `on` is set. Overwrites k[0]."""
    q = model[2]
    region = 0
    for sweep in range(2):  # what lies on a surface goes by its speed, which may need the region
        for i in range(len(surfaces)):
            off = height(surfaces, i, q, y[0], y[1])
            size = abs(level(surfaces, i, q)) + abs(surfaces[i, 0] * y[0]) + abs(surfaces[i, 1] * y[1])
            if abs(off) <= 8.9e-16 * size and sweep == 1:
                slope(model, theta, y, region, out, k, 0)
                off = surfaces[i, 0] * k[0, 0] + surfaces[i, 1] * k[0, 1]
                on[i] = 1
            bit = 1 << i
            region = region | bit if off > 0.0 else region & ~bit
    return region
