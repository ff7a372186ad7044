"""Damping matrices of drive trains: of mass and stiffness after Rayleigh, or by modes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from base import Array, Faults, InputError
from dynamics.model.limits import OSCILLATOR

NO_NEGATIVE = OSCILLATOR["damping_ratio"]
RIGID = 1e-6  # of the highest frequency: what is less is the root of rounding, of a free motion


def rayleigh_damping(
    mass: npt.ArrayLike, stiffness: npt.ArrayLike, of_mass: float = 0.0, of_stiffness: float = 0.0
) -> Array:
    r"""Damping :math:`C = \alpha M + \beta K`: a mode has the ratio :math:`\alpha / (2 \omega) + \beta \omega / 2`.

    Parameters
    ----------
    mass, stiffness : array_like, shape (n, n)
        M and K.
    of_mass, of_stiffness : float
        alpha and beta, at least 0. A train with a free rotation allows no alpha: it would brake the rotation.

    Raises
    ------
    InputError
        If a factor is negative.

    Examples
    --------
    >>> rayleigh_damping([[2.0]], [[3.0]], of_mass=0.1, of_stiffness=0.2)
    array([[0.8]])
    """
    with Faults() as faults:
        alpha = faults.number("of_mass", of_mass, NO_NEGATIVE)
        beta = faults.number("of_stiffness", of_stiffness, NO_NEGATIVE)
    return alpha * np.asarray(mass, dtype=np.float64) + beta * np.asarray(stiffness, dtype=np.float64)


def modal_damping(mass: npt.ArrayLike, stiffness: npt.ArrayLike, ratios: npt.ArrayLike) -> Array:
    r"""Damping that gives each mode of M and K its ratio.

    :math:`C = M \Phi \, \mathrm{diag}(2 \zeta_i \omega_i) \, \Phi^T M` with :math:`\Phi^T M \Phi = 1`; free
    motions have none.

    Parameters
    ----------
    mass, stiffness : array_like, shape (n, n)
        M and K, symmetric.
    ratios : float or array_like
        :math:`\zeta_i` at least 0, from the lowest frequency above 0 on; one number for all modes, else one for each.

    Raises
    ------
    InputError
        If a ratio is negative, their number is another one, or a matrix is not symmetric.

    Examples
    --------
    >>> modal_damping([[2.0]], [[8.0]], 0.05)  # 2 zeta sqrt(k m)
    array([[0.4]])
    """
    m, k = (np.asarray(matrix, dtype=np.float64) for matrix in (mass, stiffness))
    for name, matrix in (("mass", m), ("stiffness", k)):
        if not np.allclose(
            matrix, matrix.T, rtol=0.0, atol=1e-12 * float(np.max(np.abs(matrix), initial=0.0))
        ):
            raise InputError.at(name, matrix.tolist(), "must be symmetric", "modes need it")
    factor = np.linalg.inv(np.linalg.cholesky(m))
    squares, vectors = np.linalg.eigh(factor @ k @ factor.T)
    frequencies = np.sqrt(np.maximum(squares, 0.0))
    moving = np.flatnonzero(frequencies > RIGID * frequencies[-1])
    modal_ratios = np.atleast_1d(np.asarray(ratios, dtype=np.float64))
    with Faults() as faults:
        for i, ratio in enumerate(modal_ratios.tolist()):
            faults.number(f"ratios[{i}]", ratio, NO_NEGATIVE)
        if len(modal_ratios) not in (1, len(moving)):
            allowed = f"must be one, or {len(moving)}: one for each mode with a frequency"
            faults.add("ratios", f"{len(modal_ratios)} ratios", allowed, "the lowest mode first")
    rates = np.zeros(len(m))
    rates[moving] = 2.0 * modal_ratios * frequencies[moving]
    shapes = np.linalg.inv(factor) @ vectors  # M Phi
    return np.asarray(shapes @ np.diag(rates) @ shapes.T)
