"""Many starts: those that settle on known attractors, and Newton's method from all over the plane."""

import math

from dynamics.kernels.compiling import (
    FINE,
    FREQUENCY,
    HALF_BACKLASH,
    ONE,
    ZERO,
    FloatArray,
    IntArray,
    Space,
    Table,
    plain_kernel,
)
from dynamics.kernels.flow import iterate, some_cells
from dynamics.kernels.regions import start
from dynamics.kernels.roots import largest


@plain_kernel
def settle(
    table: Table,
    space: Space,
    starts: FloatArray,
    homes: FloatArray,
    radius: float,
    limit: int,
    labels: IntArray,
) -> int:
    """Follow every start with label -1 until it stays near a known attractor; `starts` become the last states.

    `homes`, (any, 4): X, V, attractor and its period for every point of every attractor. A motion has arrived
    when it is within `radius` of a point, in the largest norm, and no farther after one more round. Labels:
    attractor, -1 not arrived within `limit` periods, -2 grown without bound. Returns periods used.
    """
    par, coef, edge = table
    cells = len(edge) // 2
    h, d = 2.0 * math.pi / par[FREQUENCY] / cells, par[HALF_BACKLASH]
    work, choose, jac, tally = space
    count = tally[0]
    used = 0
    for i in range(len(starts)):
        region, y = start(starts[i, 0], starts[i, 1], par)
        x, v = starts[i, 0], starts[i, 1]
        w = v * h
        home = wait = period = 0
        distance = 0.0
        while labels[i] == -1 and period < limit:
            period += 1
            region, y, w, flag = some_cells(
                par, coef, edge, ZERO, cells, region, y, w, ZERO, jac, work, choose, count
            )
            if flag != FINE:
                labels[i] = -2
            x, v = y + region * d, w / h
            wait -= 1
            for k in range(
                home if wait == 0 else 0, home + 1 if wait == 0 else len(homes) if wait < 0 else 0
            ):
                gap = max(abs(x - homes[k, 0]), abs(v - homes[k, 1]))
                if wait == 0 and gap <= distance:
                    labels[i] = int(homes[k, 2])
                elif wait < 0 and gap < radius:
                    home, distance, wait = k, gap, int(homes[k, 3])
        starts[i, 0], starts[i, 1] = x, v
        used += period
    return used


@plain_kernel
def repeats(states: FloatArray, tolerance: float) -> bool:
    """Whether a motion repeats, within `tolerance` of its size, after half as many periods as its states or fewer."""
    size = 1e-300
    for k in range(len(states)):
        size = max(size, abs(states[k, 0]), abs(states[k, 1]))
    for n in range(1, len(states) // 2 + 1):
        off = 0.0
        for k in range(len(states) - n):
            off = max(off, abs(states[k + n, 0] - states[k, 0]), abs(states[k + n, 1] - states[k, 1]))
            if off > tolerance * size:
                break
        if off <= tolerance * size:
            return True
    return False


@plain_kernel
def hunt(
    table: Table,
    space: Space,
    starts: FloatArray,
    periods: int,
    limit: int,
    scale: float,
    points: FloatArray,
    known: int,
) -> tuple[int, int]:
    """Fixed points of the map over `periods` from many starts by deflated Newton's method.

    `points`, (any, 2), holds `known` points already; new ones are added, all points of an orbit at once. A point found
    pushes later searches away: the residual is multiplied by 1 + (scale/distance)^2 of each, which scales Newton's
    step by 1/(1 - step . grad log of that factor). Returns the number of points and of periods used.
    """
    work, _, room, tally = space
    cells = len(table[2]) // 2
    x, image, jac, counts = work[3], room[4:5], room, tally[1:]  # the other rows are what following takes
    used = 0
    for i in range(len(starts)):
        at0, at1 = starts[i, 0], starts[i, 1]
        near = math.inf
        for _ in range(limit):
            x[0], x[1] = at0, at1
            jac[0, 0] = jac[1, 1] = 1.0
            jac[0, 1] = jac[1, 0] = 0.0
            used += periods
            if iterate(table, space, ZERO, cells, x, periods - 1, ONE, jac, image, counts) != FINE:
                break
            r0, r1 = x[0] - at0, x[1] - at1
            near = max(abs(r0), abs(r1))
            stretch = max(1.0, largest(jac[:2], 2))
            if near <= 1e-13 * scale * stretch:
                break
            a, b, c, e = 1.0 - jac[0, 0], -jac[0, 1], -jac[1, 0], 1.0 - jac[1, 1]
            area = a * e - b * c
            if area == 0.0:
                break
            s0, s1 = (r0 * e - r1 * b) / area, (r1 * a - r0 * c) / area
            pull = 0.0
            if max(abs(s0), abs(s1)) > 1e-6 * scale:
                for k in range(known):
                    d0, d1 = at0 - points[k, 0], at1 - points[k, 1]
                    square = (d0 * d0 + d1 * d1) / (scale * scale) + 1e-300
                    pull -= 2.0 * (d0 * s0 + d1 * s1) / (scale * scale * square * (1.0 + square))
            factor = 1.0 / (1.0 - pull) if abs(1.0 - pull) > 1e-3 else 1.0
            factor *= min(1.0, 0.5 * scale / max(abs(factor * s0), abs(factor * s1), 1e-300))
            at0 += factor * s0
            at1 += factor * s1
            if not (abs(at0) < 1e3 * scale and abs(at1) < 1e3 * scale):
                near = math.inf
                break
        if not near <= 1e-12 * scale * max(1.0, largest(jac[:2], 2)):
            continue
        new = True
        for k in range(known):
            if max(abs(points[k, 0] - at0), abs(points[k, 1] - at1)) < 1e-7 * scale:
                new = False
        x[0], x[1] = at0, at1
        for _ in range(periods if new else 0):
            if known == len(points):
                return known, used
            old = False
            for k in range(known):
                old = old or max(abs(points[k, 0] - x[0]), abs(points[k, 1] - x[1])) < 1e-7 * scale
            if not old:
                points[known, 0], points[known, 1] = x[0], x[1]
                known += 1
            iterate(table, space, ZERO, cells, x, ZERO, ZERO, jac, image, counts)
            used += 1
    return known, used
