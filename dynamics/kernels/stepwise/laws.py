"""Restoring forces as function pointers; what a law takes and gives is described in `dynamics.kernels.stepwise`.

Parameters q of the laws with contacts begin with half the backlash, the film's damping and the film's thickness.
Helpers live here too, because compiled laws are kept on disk by the date of this file.
"""

import math

from dynamics.kernels.compiling import FloatArray
from dynamics.kernels.stepwise.compiling import helper, law_kernel


@helper
def stiffness(theta: float, q: FloatArray, first: int, order: int) -> float:
    """Fourier series whose mean, amplitudes and phases begin at q[first]."""
    k: float = q[first]
    for j in range(order):
        k += q[first + 1 + j] * math.cos((j + 1) * theta + q[first + 1 + order + j])
    return k


@helper
def stiffness_slopes(
    theta: float, q: FloatArray, first: int, order: int, force: float, out: FloatArray
) -> None:
    """Derivatives of stiffness times force with respect to the series, into `out` from 3 + first on."""
    out[3 + first] = force
    for j in range(order):
        angle = (j + 1) * theta + q[first + 1 + order + j]
        out[4 + first + j] = force * math.cos(angle)
        out[4 + first + order + j] = -force * q[first + 1 + j] * math.sin(angle)


@helper
def narrow(gap: float, thickness: float) -> tuple[float, float, float]:
    """(h / (h + gap))^1.5 and its derivatives with respect to gap and h; 1 in contact."""
    if gap <= 0.0 or thickness <= 0.0:
        return (1.0 if gap <= 0.0 else 0.0), 0.0, 0.0
    whole = thickness + gap
    share = thickness / whole
    value = share * math.sqrt(share)
    return value, -1.5 * value / whole, 1.5 * value * gap / (thickness * whole)


@helper
def squeeze(x: float, v: float, region: int, q: FloatArray, out: FloatArray) -> None:
    """Add the force of the film squeezed between both flanks, in proportion to V."""
    if q[1] == 0.0 and len(out) == 1:
        return
    front = 0.0 if region & 1 else q[0] - x
    back = 0.0 if region & 2 == 0 else x + q[0]
    a, a_gap, a_h = narrow(front, q[2])
    b, b_gap, b_h = narrow(back, q[2])
    out[0] += q[1] * v * (a + b)
    if len(out) > 1:
        out[1] += q[1] * v * (b_gap - a_gap)
        out[2] += q[1] * (a + b)
        out[3] += q[1] * v * (a_gap + b_gap)
        out[4] += v * (a + b)
        out[5] += q[1] * v * (a_h + b_h)


@helper
def depth(x: float, region: int, d: float, two_sided: bool) -> tuple[float, float]:
    """Depth of contact and the side of it: 1 in front, -1 at the back, 0 in the gap."""
    if region & 1:
        return x - d, 1.0
    if two_sided and region & 2 == 0:
        return -x - d, -1.0
    return 0.0, 0.0


@helper
def clean(out: FloatArray) -> None:
    """Begin with zeros."""
    for i in range(len(out)):
        out[i] = 0.0


@law_kernel
def smoothed_backlash(
    theta: float, x: float, v: float, region: int, q: FloatArray, data: FloatArray, out: FloatArray
) -> None:
    """K s [ln(1 + e^((x - d)/s)) - ln(1 + e^(-(x + d)/s))]; q: d, s, series of K."""
    clean(out)
    order = (len(q) - 3) // 2
    k, d, s = stiffness(theta, q, 2, order), q[0], q[1]
    up, down = (x - d) / s, -(x + d) / s
    e, g = math.exp(-abs(up)), math.exp(-abs(down))
    force = s * (max(up, 0.0) + math.log1p(e) - max(down, 0.0) - math.log1p(g))
    out[0] = k * force
    if len(out) > 1:
        a = (1.0 if up > 0.0 else e) / (1.0 + e)
        b = (1.0 if down > 0.0 else g) / (1.0 + g)
        out[1] = k * (a + b)
        out[3] = k * (b - a)
        out[4] = k * (force / s - a * up + b * down)
        stiffness_slopes(theta, q, 2, order, force, out)


@law_kernel
def power_contact(
    theta: float, x: float, v: float, region: int, q: FloatArray, data: FloatArray, out: FloatArray
) -> None:
    """K depth^n; q: d, film damping, film thickness, n, series of K; data: number of sides."""
    clean(out)
    order = (len(q) - 5) // 2
    deep, side = depth(x, region, q[0], data[0] > 1.5)
    if side != 0.0:
        k, n = stiffness(theta, q, 4, order), q[3]
        size = abs(deep)
        power = size if n == 1.0 else size**n
        force = side * math.copysign(power, deep)
        out[0] = k * force
        if len(out) > 1:
            steep = 1.0 if n == 1.0 else n * size ** (n - 1.0)
            out[1] = k * steep
            out[3] = -side * k * steep
            out[6] = k * force * math.log(size) if size > 0.0 else 0.0
            stiffness_slopes(theta, q, 4, order, force, out)
    squeeze(x, v, region, q, out)


@law_kernel
def tabulated_contact(
    theta: float, x: float, v: float, region: int, q: FloatArray, data: FloatArray, out: FloatArray
) -> None:
    """Fourier series in the angle of splines in the depth; q: d, film damping, film thickness, factor.

    data: sides, order J, intervals n, reach, then for each of 1 + 2 J series (mean, cosines, sines) n rows of six
    coefficients in powers of the distance from the knot reach (i/n)^2, and at last the end value and slope.
    """
    clean(out)
    deep, side = depth(x, region, q[0], data[0] > 1.5)
    if side != 0.0:
        order, n, reach = int(data[1]), int(data[2]), data[3]
        width = 6 * n + 2
        force = steep = 0.0
        at, t, beyond = 0, deep, False
        if deep >= reach:
            beyond, t = True, deep - reach
        elif deep > 0.0:
            at = min(int(n * math.sqrt(deep / reach)), n - 1)
            if reach * (at / n) ** 2 > deep:
                at -= 1
            t = deep - reach * (at / n) ** 2
        for j in range(1 + 2 * order):
            if j == 0:
                wave = 1.0
            elif j <= order:
                wave = math.cos(j * theta)
            else:
                wave = math.sin((j - order) * theta)
            base = 4 + j * width
            if beyond:
                value, tangent = data[base + 6 * n] + t * data[base + 6 * n + 1], data[base + 6 * n + 1]
            elif deep <= 0.0:
                value, tangent = t * data[base + 1], data[base + 1]
            else:
                base += 6 * at
                value = tangent = 0.0
                for m in range(5, -1, -1):
                    tangent = tangent * t + value
                    value = value * t + data[base + m]
            force += wave * value
            steep += wave * tangent
        out[0] = side * q[3] * force
        if len(out) > 1:
            out[1] = q[3] * steep
            out[3] = -side * q[3] * steep
            out[6] = side * force
    squeeze(x, v, region, q, out)
