"""First instant at which a polynomial turns negative, certified by sign variations of Bernstein coefficients."""

import math
from functools import cache
from typing import cast

import numpy as np

from dynamics.kernels.compiling import NO, ONE, YES, ZERO, FloatArray, helper, maker


@helper
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


@helper
def sole_root(
    b: FloatArray, limit: float, low: float, y_low: float, w_low: float, y_high: float, w_high: float
) -> tuple[float, float]:
    """Instant in (low, 1/2) at which a monotone polynomial meets `limit`, and its slope there.

    Values and slopes at both ends are given; the cubic through them, as time over value, is the first guess. Steps are
    of the fourth order; the last one is judged by the error it leaves, against rounding and the last term of the
    polynomial, and takes the slope along.
    """
    high, rising = 0.5, y_high > y_low
    width, rise = high - low, y_high - y_low
    share = (limit - y_low) / rise
    other = 1.0 - share
    t = rise * other * share * (other / w_low - share / w_high) + width * share * share * (1.0 + 2.0 * other)
    t = low + t if 0.0 < t < width else low + share * width
    slope = w_low
    crude = 1e-17 * abs(rise) + math.ldexp(0.01 * abs(b[-1]), -len(b))
    for _ in range(200):
        f = f1 = f2 = f3 = f4 = 0.0
        for k in range(len(b) - 1, -1, -1):
            f4 = f4 * t + f3
            f3 = f3 * t + f2
            f2 = f2 * t + f1
            f1 = f1 * t + f
            f = f * t + b[k]
        f -= limit
        if (f < 0.0) == rising:
            low = t
        else:
            high = t
        square = f1 * f1
        step = f * (f * f2 - square) / (f1 * (square - 2.0 * f * f2) + f * f * f3)
        new = t + step
        if not (low <= new <= high):
            new = 0.5 * (low + high)
            step = new - t
            if step == 0.0:
                return t, f1
        slope = f1 + step * (2.0 * f2 + step * (3.0 * f3 + 4.0 * step * f4))
        size = step * step
        remainder = size * size * (abs(f2) * (f2 * f2 + abs(f1 * f3)) + square * abs(f4))
        if remainder <= crude * square or size <= 2e-31 * t * t:
            return new, slope
        t = new
    return t, slope


@helper
def copy(source: FloatArray, target: FloatArray) -> None:
    """Copy a vector (a slice assignment takes much longer to compile)."""
    for k in range(len(source)):
        target[k] = source[k]


@helper
def largest(matrix: FloatArray, columns: int) -> float:
    """Largest modulus in the first columns."""
    size = 0.0
    for i in range(matrix.shape[0]):
        for j in range(columns):
            size = max(size, abs(matrix[i, j]))
    return size


@cache
def choices(n: int) -> FloatArray:
    """What `binomials` gives, for rooms made in Python; not to be written to."""
    return cast(FloatArray, getattr(binomials, "py_func", binomials)(n))


@maker
def binomials(n: int) -> FloatArray:
    """Table [j, i] of (i + j over j) for `shift`."""
    table = np.ones((n + 1, n + 1))
    for j in range(1, n + 1):
        for i in range(1, n + 1):
            table[j, i] = table[j - 1, i] + table[j, i - 1]
    return table


@helper
def shift(a: FloatArray, s: float, choose: FloatArray, out: FloatArray) -> None:
    """Taylor coefficients about s instead of 0."""
    n = len(a)
    for i in range(n):
        out[i] = a[i]
    power = 1.0
    for j in range(1, n):
        power *= s
        for i in range(n - j):
            out[i] += power * choose[j, i] * a[i + j]


@helper
def find_root(c: FloatArray, first: int, low: float, high: float, t: float, rising: bool) -> float:
    """Root of the polynomial c[first + k] t^k between two points of opposite sign, from a guess between them."""
    if not (low < t < high):
        t = 0.5 * (low + high)
    before = width = high - low
    for _ in range(200):
        f, df, ddf = poly(c, first, t)
        if f == 0.0:
            return t
        if (f < 0.0) == rising:
            low = t
        else:
            high = t
        new = t + parabola(f, df, ddf, rising)
        step = abs(new - t)
        if step <= 4.5e-16 * abs(t) or (step >= 0.5 * before and step < 1e-12 * abs(t)):
            return t  # rounding; never the middle of a bracket that rounding has closed on one side only
        if not (low < new < high):
            new = 0.5 * (low + high)
            step = abs(new - t)
        elif step < 1e-6 * width and step * abs(ddf) < 1e-8 * abs(df):
            return new  # the error falls with the third power of the step
        before = step
        t = new
    return t


@helper
def parabola(f: float, df: float, ddf: float, rising: bool) -> float:
    """Distance to the root of the osculating parabola: good next to a double root too."""
    square = df * df - 2.0 * f * ddf
    slope = df + (math.sqrt(square) if rising else -math.sqrt(square)) if square > 0.0 else 2.0 * df
    return -2.0 * f / slope if slope != 0.0 else math.inf


@helper
def bernstein(c: FloatArray, first: int, low: float, width: float, b: FloatArray) -> int:
    """Bernstein coefficients b[0..n] of sum c[first + k] t^k on [low, low + width]; returns n."""
    n = len(c) - 1 - first
    for k in range(n + 1):
        b[k] = c[first + k]
    if low != 0.0:
        for i in range(n):
            for k in range(n - 1, i - 1, -1):
                b[k] += low * b[k + 1]
    factor = 1.0
    for k in range(1, n + 1):
        factor *= width * k / (n - k + 1)
        b[k] *= factor
    for j in range(1, n + 1):
        for i in range(n, j - 1, -1):
            b[i] += b[i - 1]
    return n


@helper
def variations(b: FloatArray, n: int) -> int:
    """Sign changes in b[0..n]: at least the number of roots inside, and equal to it if 0 or 1."""
    changes = 0
    sign = 0
    for i in range(n + 1):
        if b[i] != 0.0:
            now = 1 if b[i] > 0.0 else -1
            changes += now * sign < 0
            sign = now
    return changes


@helper
def monotone(c: FloatArray, first: int, end: float) -> bool:
    """Return whether the polynomial is proved to fall throughout [0, end]."""
    rest = 0.0
    power = 1.0
    for k in range(2, len(c) - first):
        power *= end
        rest += k * abs(c[first + k]) * power
    return bool(-c[first + 1] > 1.0001 * rest)


@helper
def first_exit(c: FloatArray, b: FloatArray, end: float, fresh: int) -> float:
    """Smallest t in [0, end] at which the polynomial turns negative, -1 if it does not.

    A root at t = 0 is divided out. `fresh` = 1: the motion has just come in through this boundary, so that a
    leading coefficient of the wrong sign is rounding. By Descartes' rule for Bernstein coefficients a part without
    sign variation holds no root and a part with one variation exactly one; with more, a part whose derivative has
    one variation holds exactly one minimum, whose sign decides; any other part is halved. `b` is work space.
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
    if m >= degree or end <= 0.0:
        return -1.0
    left, right, guess, isolated = 0.0, end, -1.0, False
    if monotone(c, m, end):
        if poly(c, m, end)[0] >= 0.0:
            return -1.0
        isolated = True
    width = end
    while not isolated and left < end:
        right = end if left + width >= end else left + width
        n = bernstein(c, m, left, right - left, b)
        f_l = b[0]
        if f_l < 0.0:
            return left  # the last root lies on the joint of two parts, to rounding
        count = variations(b, n)
        if count == 1 and b[n] < 0.0:
            isolated = True
        elif count > 0 and right - left > 1e-13 * end:
            for k in range(n):
                b[k] = b[k + 1] - b[k]
            if variations(b, n - 1) > 1 or not (b[0] < 0.0 < b[n - 1]):
                width = 0.5 * (right - left)
                continue
            guess = left + (right - left) * b[0] / (b[0] - b[n - 1])
            for k in range(n):
                b[k] = (k + 1) * c[m + k + 1]
            for k in range(n, len(b)):
                b[k] = 0.0
            turn = find_root(b, ZERO, left, right, guess, YES)
            f_t, _, ddf = poly(c, m, turn)
            guess = -1.0
            if f_t < 0.0:
                isolated, right = True, turn
                if ddf > 0.0:
                    guess = turn - math.sqrt(-2.0 * f_t / ddf)
        if isolated and f_l == 0.0:
            return left
        if not isolated:
            left = right
            width *= 2.0
    if not isolated:
        return -1.0
    if guess < 0.0:
        f_l, slope, curve = poly(c, m, left)
        guess = left + parabola(f_l, slope, curve, NO)
    return find_root(c, m, left, right, guess, NO)


@helper
def direction(a: FloatArray) -> int:
    """Sign of the slope of the polynomial just after t = 0."""
    for k in range(1, len(a)):
        if a[k] != 0.0:
            return 1 if a[k] > 0.0 else -1
    return 0


@helper
def find_turn(
    rest: FloatArray, spare: FloatArray, slope: FloatArray, b: FloatArray, choose: FloatArray, end: float, way: int
) -> tuple[int, float]:  # fmt: skip
    """Expand `rest` about its next extremum: way of X after it and time to it, -1 if there is none up to `end`.

    `way` is the way just before t = 0, 0 if unknown: an extremum on the joint of two stretches is at t = 0.
    """
    heading, step = direction(rest), 0.0
    if heading * way != -1:
        way = heading if heading != 0 else way
        sign = -1.0 if heading < 0 else 1.0
        for k in range(len(rest) - 1):
            slope[k] = sign * (k + 1) * rest[k + 1]
        slope[len(rest) - 1] = 0.0
        step = first_exit(slope, b, end, ONE)
        if not step > 0.0:
            return way, -1.0
    shift(rest, step, choose, spare)
    copy(spare, rest)
    rest[1] = 0.0
    return -way, step
