"""Where a state is, and when it leaves: the geometry of the backlash."""

import math

from dynamics.kernels.compiling import (
    FORCE,
    FREE,
    FREQUENCY,
    HALF_BACKLASH,
    SIDES,
    ZETA,
    FloatArray,
    helper,
)
from dynamics.kernels.roots import first_exit
from dynamics.kernels.tables import error_places, harmonics


@helper
def push_at_start(par: FloatArray) -> float:
    """External force at tau = 0."""
    push = 0.0
    for n in range(1, harmonics(par)[1] + 2):
        size, phase = error_places(par, n)
        push += n * n * par[size] * math.cos(par[phase])
    return float(par[FORCE] + push * par[FREQUENCY] * par[FREQUENCY])


@helper
def start(x: float, v: float, par: FloatArray) -> tuple[int, float]:
    """Region and coordinate of a state; on a boundary the motion (speed, else push) decides."""
    d = par[HALF_BACKLASH]
    two_sided = par[SIDES] > 1.5
    way = v if v != 0.0 else push_at_start(par)
    joined = two_sided and d == 0.0
    if x > d or (x == d and (way > 0.0 or (joined and way == 0.0))):
        return 1, x - d
    if two_sided and (x < -d or (x == -d and way < 0.0)):
        return -1, x + d
    return 0, x


@helper
def enter(region: int, hit: int, par: FloatArray) -> tuple[int, float]:
    """Region and coordinate just past the boundary `hit`."""
    d = par[HALF_BACKLASH]
    if d == 0.0 and par[SIDES] > 1.5:
        return -region, 0.0
    if region == 0:
        return hit, 0.0
    return 0, hit * d


@helper
def drag_jump(par: FloatArray, old: int, region: int) -> float:
    """Damping, 2 zeta, past a boundary less that before it."""
    jump = 2.0 * (par[ZETA] - par[FREE])
    return float(0.0 if (old == 0) == (region == 0) else jump if old == 0 else -jump)


@helper
def clear(region: int, par: FloatArray, y: float, y_new: float, reach: float) -> bool:
    """Return whether a stretch that departs from its chord by less than `reach` stays in its region."""
    if region != 0:
        return min(region * y, region * y_new) > reach
    d = par[HALF_BACKLASH]
    if par[SIDES] > 1.5:
        return bool(d - max(abs(y), abs(y_new)) > reach)
    return bool(d - max(y, y_new) > reach)


@helper
def leave(
    region: int, par: FloatArray, a: FloatArray, g: FloatArray, b: FloatArray, end: float, fresh: int
) -> tuple[float, int]:
    """When, within `end`, and through which boundary (1: D, -1: -D, 0: none) the motion `a` leaves."""
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
        if region == -side or (side == -1 and par[SIDES] < 1.5):
            continue
        offset, sign = (par[HALF_BACKLASH], -side) if region == 0 else (0.0, side)
        if min(offset + sign * a[0], offset + sign * f_end) > bend:
            continue
        for k in range(len(a)):
            g[k] = sign * a[k]
        g[0] += offset
        t = first_exit(g, b, end, fresh * side)
        if t >= 0.0 and (t < end or hit == 0):
            end = t
            hit = side
    return end, hit


@helper
def note_extremum(
    note: FloatArray, tau: float, rest: FloatArray, region: int, par: FloatArray, h: float
) -> None:
    """Time, X, X'', region and its coordinate of the extremum about which `rest` is expanded."""
    note[0] = tau
    note[1] = rest[0] + region * par[HALF_BACKLASH]
    note[2] = 2.0 * rest[2] / (h * h)
    note[3] = region
    note[4] = rest[0]
