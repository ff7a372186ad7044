r"""Lines of contact on a helical gear without ends: what cells of a line yield by loads on cells of any line.

A line of contact is straight and crosses the flank: along it rho = rho(0) + r_b tau z on the left flank of a right
hand. Cells of equal length h divide it. Loads are line loads per length of the axis, displacements means over cells
along the normal. With all waves c(a, b; k) of ``fem.influence.helix_waves`` together, cells of the loaded line yield

.. math:: \frac{\cos\beta_b}{\pi E^*} \overline{\frac{1}{|\zeta|}}
   - \frac{1}{\pi E^* \ell} \overline{\frac{1 - e^{-\kappa |\zeta|}}{|\zeta|}} + \delta_{ij} \left[ u_r
   + \frac{2}{\pi E^* \ell} \left( \ln\frac{\kappa}{2} + \gamma - \frac{1 + \nu^*}{2} \right) \right] + \ldots

with means over both cells, and a smooth rest. A load at itself has 1/R at a distance of e^(-(1 + nu*)/2) across the
line, in modules, where the plane's singular solution is nil (``fem.elasticity.flamant``): the local law of the contact
says what its pressure adds to that.
"""

from __future__ import annotations

import numpy as np

from base import Array, record, unclocked
from fem.influence.gear_face import BEND, SHORTEST, between_waves
from fem.influence.helix_waves import HelixHarmonics

__all__ = ["ContactLine", "along_line", "between_lines"]

POINTS = 512
"""Of the quadrature over waves: distances of some 40 modules."""


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
        On different teeth, of cells as long as each other.
    """
    tooth = point.tooth - load.tooth
    first, second = np.broadcast_arrays(load.rho[:, None], point.rho)
    even = waves.even_cross[abs(tooth)].at(*((second, first) if tooth < 0 else (first, second)))
    return _of_waves(waves, load, point) + _overlap(load, point) * even


def along_line(waves: HelixHarmonics, poisson: float, line: ContactLine) -> Array:
    """Mean displacements of the cells of a line by unit line loads on its cells (loads, points), but for the local law.

    Parameters
    ----------
    waves : HelixHarmonics
    poisson : float
        nu*
    line : ContactLine
    """
    helix, cells = waves.helix(line.rho[:, None], line.rho), np.arange(len(line.z))
    bent = _without_logarithm(line)
    even = waves.even_own.at(line.rho)
    even = even + 2.0 / (np.pi * waves.helix(line.rho, line.rho)) * (
        np.log(0.5 * BEND) + np.euler_gamma - 0.5 * (1.0 + poisson)
    )
    distant = waves.cos_base * _distant(len(cells))
    itself = 2.0 * (np.log(2.0 * line.length / waves.cos_base) - 1.0) + 1.0 + poisson
    distant[cells, cells] = waves.cos_base * itself
    return np.asarray(_of_waves(waves, line, line) + np.diag(even) + (distant - bent / helix) / np.pi)


def _distant(cells: int) -> Array:
    """Means of 1/|zeta| over two cells of a line, times a cell (cells, cells): 0 for a cell with itself."""
    steps = np.arange(cells + 1.0)
    second = steps * np.log(np.maximum(steps, 1.0))
    means = np.concatenate([[0.0], second[:-2] - 2.0 * second[1:-1] + second[2:]])
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
    """Share of a cell over which two cells are beside each other (loads, points)."""
    return np.maximum(0.0, 1.0 - np.abs(point.z - load.z[:, None]) / load.length)


def _of_waves(waves: HelixHarmonics, load: ContactLine, point: ContactLine) -> Array:
    """What the smooth part of the waves adds (loads, points).

    Weights of the solved waves are transformed for the distances that there are; beyond the shortest solved wave the
    smooth part is constant, so that it stays where the load is.
    """
    smooth = waves.smooth(point.tooth - load.tooth, load.rho[:, None], point.rho)
    zeta, length = point.z - load.z[:, None], load.length
    s, share = np.polynomial.legendre.leggauss(POINTS)
    wavenumber = 0.5 * SHORTEST * (s + 1.0)
    last = between_waves(np.array([SHORTEST]))[0]
    share = 0.5 * SHORTEST * share * np.sinc(0.5 * wavenumber * length / np.pi) ** 2 * length / np.pi
    rest = (between_waves(wavenumber) - last) * share[:, None]
    distances, which = np.unique(np.round(zeta, 12), return_inverse=True)
    turns = np.outer(distances, wavenumber)
    cosine, sine = (np.reshape((f(turns) @ rest)[which], smooth.shape) for f in (np.cos, np.sin))
    moved = np.sum(smooth.real * cosine - smooth.imag * sine, axis=-1)
    return np.asarray(moved + _overlap(load, point) * (smooth.real @ last))
