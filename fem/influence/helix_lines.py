r"""Lines of contact on a helical gear without ends: what cells of a line yield by loads on cells of any line.

A line of contact is straight and crosses the flank: along it rho = rho(0) + r_b tau z on the left flank of a right
hand. Cells of equal length h divide it. Loads are line loads per length of the axis, displacements means over cells
along the normal. With all waves c(a, b; k) of ``fem.influence.helix_waves`` together, cells of the loaded line yield

.. math:: \frac{\cos\beta_b}{\pi E^*} \overline{\frac{1}{|\zeta|}}
   - \frac{1}{\pi E^* \ell} \overline{\frac{1 - e^{-\kappa |\zeta|}}{|\zeta|}} + \delta_{ij} \frac{1}{\ell} \left[ u_r
   + \frac{2}{\pi E^*} \left( \ln\frac{\kappa}{2} + \gamma - \frac{1 + \nu^*}{2} \right) \right] + \ldots

with means over both cells, u_r that of an even load in the plane (``fem.influence.gear_compliance``), and a smooth
rest. A load at itself has 1/R at a distance of e^(-(1 + nu*)/2) across the line, in modules, where the plane's singular
solution is nil (``fem.elasticity.flamant``): the local law of the contact says what its pressure adds to that. The
pressure spreads over a strip of half-width a: 1/R is taken at the distance (zeta^2/cos^2 beta_b + a^2/4)^(1/2), a/2
the distance whose logarithm is the mean one in Hertz's pressure, which counts where cells are about as short as that.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from base import Array, record, unclocked
from fem.influence.gear_face import BEND, SHORTEST, between_waves
from fem.influence.helix_waves import HelixHarmonics

__all__ = ["ContactLine", "along_line", "between_lines"]

POINTS = 13.0
"""Of the quadrature over waves, for every module of the longest distance."""

STEP = 0.0125
"""Of distances [modules] at which the waves' sums are known; cubics join them."""


RUNGS = 8
"""Lengths of cells for every doubling of them for which the waves' sums are known."""


@record
class ContactLine:
    """Cells of a line of contact on one gear, in modules.

    Attributes
    ----------
    tooth : int
        Counted to the side of growing rho.
    z : (cells,) array
        Middles of the cells along the axis.
    rho : (cells,) array
        Curvature radii there.
    length : float
        Of each cell along the axis.
    """

    tooth: int
    z: Array
    rho: Array
    length: float


def between_lines(waves: HelixHarmonics, load: ContactLine, point: ContactLine) -> Array:
    """Mean displacements of the cells of another tooth's line by unit line loads on cells (loads, points).

    Parameters
    ----------
    waves : HelixHarmonics
    load, point : ContactLine
        On different teeth.
    """
    tooth = point.tooth - load.tooth
    series = waves.even_cross[abs(tooth)]
    if tooth < 0:
        even = _products(*series.bases(point.rho, load.rho), series.coefficients).T
    else:
        even = _products(*series.bases(load.rho, point.rho), series.coefficients)
    return _of_waves(waves, load, point) + _overlap(load, point) * even


def along_line(
    waves: HelixHarmonics, poisson: float, line: ContactLine, in_plane: Array, half_width: float = 0.0
) -> Array:
    """Mean displacements of the cells of a line by unit line loads on its cells (loads, points), but for the local law.

    Parameters
    ----------
    waves : HelixHarmonics
    poisson : float
        nu*
    line : ContactLine
    in_plane : (cells,) array
        u_r of an even load at the cells' places, on the spur gear of this section.
    half_width : float
        Of the pressure, in modules; 0 is a line.
    """
    helix, cells = waves.helix(line.rho[:, None], line.rho), np.arange(len(line.z))
    bent = _without_logarithm(line)
    constant = 2.0 / np.pi * (np.log(0.5 * BEND) + np.euler_gamma - 0.5 * (1.0 + poisson))
    even = waves.even_own.at(line.rho) + (in_plane + constant) / waves.helix(line.rho, line.rho)
    strip = 0.5 * half_width
    distant = waves.cos_base * _distant(len(cells), strip * waves.cos_base / line.length)
    # without a strip the cell's own mean lacks the logarithm that a strip takes from it
    within = np.log(strip) if strip else np.log(2.0 * line.length / waves.cos_base) - 1.0
    distant[cells, cells] += waves.cos_base * (2.0 * within + 1.0 + poisson)
    return np.asarray(_of_waves(waves, line, line) + np.diag(even) + (distant - bent / helix) / np.pi)


def _products(loads: Array, points: Array, coefficients: Array) -> Array:
    """Sum of polynomials (loads, n), (points, n) with coefficients (n, n)."""
    return np.asarray(loads @ coefficients @ points.T)


def _distant(cells: int, strip: float) -> Array:
    """Means of 1/(zeta^2 + strip^2)^(1/2) over two cells of a line, lengths in cells (cells, cells).

    Without a strip that of a cell with itself is infinite, and 0 is given.
    """
    steps = np.abs(np.arange(-1.0, cells + 1.0))
    if strip:
        second = steps * np.arcsinh(steps / strip) - np.hypot(steps, strip)
    else:
        second = steps * np.log(np.maximum(steps, 1.0))
    means = second[:-2] - 2.0 * second[1:-1] + second[2:]
    means[0] = means[0] if strip else 0.0
    return np.asarray(means[np.abs(np.subtract.outer(np.arange(cells), np.arange(cells)))])


def _without_logarithm(line: ContactLine) -> Array:
    """Means of (1 - exp(-kappa |zeta|))/|zeta| over two cells, times a cell (cells, cells)."""
    with unclocked():
        from scipy.special import exp1

    cells = np.arange(len(line.z))
    turns = BEND * line.length * np.arange(-1.0, len(cells) + 1.0)
    turns = np.abs(turns)
    ein = np.euler_gamma + np.log(np.maximum(turns, 1e-300)) + exp1(np.maximum(turns, 1e-300))
    second = turns * ein - turns + 1.0 - np.exp(-turns)
    means = (second[:-2] - 2.0 * second[1:-1] + second[2:]) / (BEND * line.length)
    return np.asarray(means[np.abs(np.subtract.outer(cells, cells))])


def _overlap(load: ContactLine, point: ContactLine) -> Array:
    """Part of the observed cells that is beside the loaded ones (loads, points)."""
    start = np.maximum(*np.broadcast_arrays(_edge(load, -0.5)[:, None], _edge(point, -0.5)))
    stop = np.minimum(*np.broadcast_arrays(_edge(load, 0.5)[:, None], _edge(point, 0.5)))
    return np.asarray(np.maximum(0.0, stop - start) / point.length)


def _edge(line: ContactLine, side: float) -> Array:
    return np.asarray(line.z + side * line.length)


def _of_waves(waves: HelixHarmonics, load: ContactLine, point: ContactLine) -> Array:
    """What the smooth part of the waves adds (loads, points).

    Beyond the shortest solved wave the smooth part is constant, so that it stays where the load is.
    """
    tooth = point.tooth - load.tooth
    first, second = (point, load) if tooth < 0 else (load, point)
    series = waves.cross[abs(tooth)] if tooth else waves.own
    loads, points = series.bases(first.rho, second.rho)
    count = loads.shape[1]
    by_load = (loads @ series.coefficients.reshape(count, -1)).reshape(len(loads), count, -1)
    smooth = np.einsum("iaw,ja->ijw", by_load, points, optimize=True)
    zeta = second.z - first.z[:, None]
    size = np.sqrt(0.5 * (load.length**2 + point.length**2))
    longest = 2.0 ** np.ceil(np.log2(np.abs(zeta).max() + 1.0))
    sums = _sums_between(zeta, size, longest)
    last = smooth[..., ::2] @ between_waves(np.array([SHORTEST]))[0]
    moved = np.sum(smooth * sums, axis=-1) * load.length
    moved = moved.T if tooth < 0 else moved
    return np.asarray(moved + _overlap(load, point) * (last.T if tooth < 0 else last))


def _sums_between(zeta: Array, size: float, longest: float) -> Array:
    """Sums over waves at distances (...) for cells of a mean square length (..., 2 waves): cosine, minus sine.

    Means over cells are those over cells of the lengths of a ladder next to it, in proportion to the square.
    """
    rung = np.floor(RUNGS * np.log2(size))
    lower, upper = (float(2.0 ** ((rung + k) / RUNGS)) for k in (0, 1))
    of_lower, of_upper = (_sums(length, float(longest)) for length in (lower, upper))
    part = (size**2 - lower**2) / (upper**2 - lower**2)
    place = np.abs(zeta) / STEP
    at = np.minimum(place.astype(int), len(of_lower) - 4)
    t = (place - at)[..., None]
    table = (1.0 - part) * of_lower + part * of_upper
    before, here, after, beyond = (table[at + k] for k in range(4))
    bend = 2.0 * before - 5.0 * here + 4.0 * after - beyond
    sums = here + 0.5 * t * (after - before + t * (bend + t * (3.0 * (here - after) + beyond - before)))
    sums[..., 1::2] *= np.where(zeta < 0.0, 1.0, -1.0)[..., None]
    return np.asarray(sums)


@lru_cache(maxsize=64)
def _sums(length: float, longest: float) -> Array:
    """Sums over waves at distances from one step below 0 on, for cells of a length (distances, 2 waves)."""
    s, share = np.polynomial.legendre.leggauss(int(np.ceil(POINTS * max(longest, 8.0))))
    wavenumber = 0.5 * SHORTEST * (s + 1.0)
    last = between_waves(np.array([SHORTEST]))[0]
    share = 0.5 * SHORTEST * share * np.sinc(0.5 * wavenumber * length / np.pi) ** 2 / np.pi
    rest = (between_waves(wavenumber) - last) * share[:, None]
    turns = np.outer(STEP * np.arange(-1.0, longest / STEP + 4.0), wavenumber)
    return np.stack([np.cos(turns) @ rest, np.sin(turns) @ rest], axis=-1).reshape(len(turns), -1)
