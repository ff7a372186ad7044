"""Compiled kernels of the heat along and across the film."""

from __future__ import annotations

import numpy as np
from numba import njit

from base import Array, hide_compilation

hide_compilation("ehl")

_STEP = 3.0  # largest change of ln(eta) by heat in one sweep


@njit(cache=True, error_model="numpy")
def solve_small(system: Array, right: Array) -> None:
    """Solve a small dense system in place for several right sides (m, k), by elimination with row exchanges."""
    m, count = right.shape
    for c in range(m):
        best = c
        for r in range(c + 1, m):
            if abs(system[r, c]) > abs(system[best, c]):
                best = r
        if best != c:
            for k in range(c, m):
                system[c, k], system[best, k] = system[best, k], system[c, k]
            for k in range(count):
                right[c, k], right[best, k] = right[best, k], right[c, k]
        inverse = 1.0 / system[c, c]
        for r in range(c + 1, m):
            factor = system[r, c] * inverse
            for k in range(c + 1, m):
                system[r, k] -= factor * system[c, k]
            for k in range(count):
                right[r, k] -= factor * right[c, k]
    for c in range(m - 1, -1, -1):
        for k in range(count):
            total = right[c, k]
            for r in range(c + 1, m):
                total -= system[c, r] * right[r, k]
            right[c, k] = total / system[c, c]


@njit(cache=True, error_model="numpy")
def heat_across(
    x: Array,
    gap: Array,
    flow: Array,
    viscosity: Array,
    stress: Array,
    rate: Array,
    thinning: Array,
    yielding: Array,
    speed: Array,
    gradient: Array,
    bodies: Array,
    ambient: Array,
    stores: Array,
    added: Array,
    about: Array,
    temperature: Array,
    into: Array,
    response: Array,
    expansion: float,
    conductivity: float,
    zeta: Array,
    weights: Array,
    derive: Array,
    stiffness: Array,
    sum_up: Array,
    first: int,
    last: int,
    backward: bool,
) -> None:
    """Sweep once along the film for the temperature across every cell and in both surfaces.

    In every cell and at every place across, c d(g T)/dx + c d(V T)/dzeta is (k/h) d2T/dzeta2 + h (heat +
    expansion u p' T), g = rho u h and V from its continuity. What flows between cells carries one temperature out
    of the one and into the other, the upstream cell's, carried on to the face by its slope where it flows
    downstream; across in the weak form with the weights of integration, so that the sums over the film balance to
    rounding. The heat that shear makes changes with the temperature, at a given speed of sliding and pressure flow:
    Newton's method about ``about``. At the surfaces T = ambient + bodies @ flux.

    Parameters
    ----------
    x, gap : ndarray (n+1,), (n,)
        Faces of the cells and h [m].
    flow : ndarray (n+1, m)
        c g through every face [W/(m K)] per zeta; the same in all.
    viscosity, stress, rate : ndarray (n, m)
        eta [Pa s], tau [Pa] and du/dz [1/s].
    thinning, yielding : ndarray (n, m)
        -d ln(eta)/dT [1/K] and d(du/dz)/dtau [1/(Pa s)]; 0 where the stress does not yield.
    speed, gradient : ndarray (n, m), (n,)
        u [m/s] and p' [Pa/m].
    bodies : ndarray (2, n, n)
        Temperature of either surface per heat flux into it [K m2/W].
    ambient : ndarray (2, n)
        Temperatures of either surface without the film's heat, those of the bulk in steady films [K].
    stores, added : ndarray (n,), (n, m)
        Heat that the oil takes up per temperature [W/(m2 K)], and that further sources make, over the film's
        thickness [W/m2]; 0 in steady films.
    about : ndarray (n, m)
        Temperatures for which stress and rate stand [K].
    temperature, into : ndarray (n, m), (2, n)
        T [K] and the heat flux into either body [W/m2]; changed in place.
    response : ndarray (n, 2)
        Filled with the change of every cell's mean temperature by that of the cell upstream, and by the pressure's
        rise through the cell [K/Pa].
    expansion, conductivity : float
        The oil's thermal expansion [1/K] and k [W/(m K)].
    zeta, weights, derive, stiffness, sum_up : ndarray
        Places and weights (m,); matrices (m, m) of the derivative, of the integral of products of derivatives, and of
        the integral from -1/2.
    first, last : int
        First and last cell that are solved.
    backward : bool
        From the outlet to the inlet.

    Notes
    -----
    Complex arrays are steady films with a small complex change: real parts decide which way heat flows.
    """
    m = weights.size
    system = np.empty((m, m), temperature.dtype)
    right = np.empty((m, 3), temperature.dtype)
    wall = np.empty((2, m), temperature.dtype)
    wall_right = np.empty(2, temperature.dtype)
    down_flow = np.empty(m, temperature.dtype)
    eased = np.empty(m, temperature.dtype)
    turned = np.empty(m, temperature.dtype)
    nothing = 0.0 * temperature[0, 0]
    for step in range(first, last + 1):
        i = last + first - step if backward else step
        h = gap[i]
        dx = x[i + 1] - x[i]
        near = dx / (x[i + 1] - x[i - 1]) if i > 0 else 0.0
        far = (x[i] - x[i - 1]) / (x[i] - x[i - 2]) if i > 1 else 0.0
        y0 = nothing
        y1 = nothing
        y2 = nothing
        fluid = nothing
        lean = nothing
        for j in range(m):
            part = weights[j] * yielding[i, j]
            y0 += part
            y1 += part * zeta[j]
            y2 += part * zeta[j] * zeta[j]
            fluid += weights[j] / viscosity[i, j]
            lean += weights[j] * zeta[j] / viscosity[i, j]
        lean /= fluid
        yields = y0 * y2 - y1 * y1
        cooled = nothing
        tilted = nothing
        slid = nothing
        for j in range(m):
            # hotter oil shears more at the same stress; mean stress and slope of the pressure give way, since the
            # sliding and what the pressure moves are given
            slid += weights[j] * rate[i, j]
        for j in range(m):
            eased[j] = nothing
            turned[j] = nothing
            if y0.real > 0.0:
                sheared = weights[j] * rate[i, j] * thinning[i, j]
                moved = zeta[j] * sheared
                moved -= slid * weights[j] / viscosity[i, j] * (zeta[j] - lean) * thinning[i, j] / fluid
                eased[j] = (y2 * sheared - y1 * moved) / yields
                turned[j] = (y0 * moved - y1 * sheared) / yields
            cooled += eased[j] * about[i, j]
            tilted += turned[j] * about[i, j]
            total = nothing
            for k in range(m):
                total += sum_up[j, k] * (flow[i + 1, k] - flow[i, k])
            down_flow[j] = -total / dx
        for j in range(m):
            gives = weights[j] * h * (rate[i, j] + stress[i, j] * yielding[i, j])
            for k in range(m):
                system[j, k] = (
                    weights[j] * down_flow[j] * derive[j, k]
                    + conductivity / h * stiffness[j, k]
                    + gives * (eased[k] + zeta[j] * turned[k])
                )
            source = h * stress[i, j] * rate[i, j]
            squeezed = h * expansion * speed[i, j]
            diagonal = stores[i] - squeezed * gradient[i]
            if y0.real > 0.0:
                hotter = source * thinning[i, j]
                diagonal -= hotter
                source -= hotter * about[i, j]
            source += added[i, j]
            out = flow[i + 1, j] / dx
            if out.real >= 0.0 and i > 0:
                diagonal += out * near
                source += out * near * temperature[i - 1, j]
            elif out.real < 0.0 and i < last:
                diagonal -= out
                source -= out * temperature[i + 1, j]
            enters = flow[i, j] / dx
            if enters.real > 0.0 and i > 0:
                carried = temperature[i - 1, j]
                if i > 1:
                    carried += far * (temperature[i - 1, j] - temperature[i - 2, j])
                diagonal += enters
                source += enters * carried
            system[j, j] += weights[j] * diagonal
            right[j, 0] = weights[j] * source + gives * (cooled + zeta[j] * tilted)
            comes = enters if enters.real > 0.0 else nothing
            goes = out if out.real > 0.0 else nothing
            right[j, 1] = weights[j] * (comes + goes * near)
            right[j, 2] = weights[j] * squeezed * temperature[i, j] / dx
        for side in range(2):
            row = 0 if side == 0 else m - 1
            warmed = ambient[side, i]
            own = bodies[side, i, i]
            for k in range(last + 1):
                if k != i:
                    warmed += bodies[side, i, k] * into[side, k]
                if k > i:  # not yet swept: their fluxes change as this one's
                    own += bodies[side, i, k]
                    warmed -= bodies[side, i, k] * into[side, i]
            wall_right[side] = right[row, 0]
            for k in range(m):
                wall[side, k] = system[row, k]
                system[row, k] *= own
            system[row, row] += 1.0
            right[row, 0] = warmed + own * wall_right[side]
            right[row, 1] *= own
            right[row, 2] *= own
        solve_small(system, right)
        steepest = 0.0
        for j in range(m):
            steepest = max(steepest, abs(right[j, 0] - temperature[i, j]) * thinning[i, j].real)
        taken = min(1.0, _STEP / steepest) if steepest > 0.0 else 1.0
        for j in range(m):
            right[j, 0] = temperature[i, j] + taken * (right[j, 0] - temperature[i, j])
            temperature[i, j] = right[j, 0]
        for k in range(2):
            total = nothing
            for j in range(m):
                total += weights[j] * right[j, 1 + k]
            response[i, k] = total
        for side in range(2):
            total = wall_right[side]
            for k in range(m):
                total -= wall[side, k] * right[k, 0]
            into[side, i] += taken * (total - into[side, i])


@njit(cache=True, error_model="numpy")
def compression_response(nodes: Array, response: Array) -> Array:
    """Change of the mean temperature at every node, by heat of compression, by every node's pressure [K/Pa], (n, n).

    Parameters
    ----------
    nodes : ndarray (n,)
        X.
    response : ndarray (n-1, 2)
        From :func:`heat_across`.
    """
    n = nodes.size
    out = np.zeros((n, n))
    row = np.zeros(n)
    for f in range(n - 1):
        for k in range(f + 1):
            row[k] *= response[f, 0]
        row[f] -= response[f, 1]
        row[f + 1] = response[f, 1]
        left = nodes[f] - nodes[f - 1] if f > 0 else 0.0
        right = nodes[f + 2] - nodes[f + 1] if f < n - 2 else 0.0
        h = nodes[f + 1] - nodes[f]
        for k in range(f + 2):
            out[f, k] += row[k] * left / (left + h)
            out[f + 1, k] += row[k] * right / (right + h)
    return out


@njit(cache=True, error_model="numpy")
def _source(s: float, table: Array, ln_least: float, ln_step: float) -> float:
    """Integral of exp(y) K0(|y|) from 0 to s, by cubics through a table of it and its derivative over ln|s|."""
    if s == 0.0:
        return 0.0
    row = 0 if s > 0.0 else 2
    place = max((np.log(abs(s)) - ln_least) / ln_step, 0.0)
    k = min(int(place), table.shape[1] - 2)
    a = place - k
    b = 1.0 - a
    ends = b * b * (1.0 + 2.0 * a) * table[row, k] + a * a * (1.0 + 2.0 * b) * table[row, k + 1]
    integral: float = ends + ln_step * a * b * (b * table[row + 1, k] - a * table[row + 1, k + 1])
    return integral


@njit(cache=True, error_model="numpy")
def source_differences(points: Array, edges: Array, table: Array, ln_least: float, ln_step: float) -> Array:
    """Integrals of exp(y) K0(|y|) over y = point - edge from one edge to the next, (points, edges - 1).

    Parameters
    ----------
    points, edges : ndarray
        Both times u/2 kappa.
    table : ndarray (4, places)
        The integral from 0 behind a source, its derivative by ln y, and both ahead of it.
    ln_least, ln_step : float
        First place of the table and its step, ln y.
    """
    out = np.empty((points.size, edges.size - 1))
    for i in range(points.size):
        before = _source(points[i] - edges[0], table, ln_least, ln_step)
        for k in range(edges.size - 1):
            after = _source(points[i] - edges[k + 1], table, ln_least, ln_step)
            out[i, k] = before - after
            before = after
    return out
