r"""What gyroscopic moments would change of natural frequencies."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import sparse

from base import Array
from flankfilm.coupling.drive.train import Train, lowest_modes


def gyroscopic_change(
    train: Train, modes: Array, squares: Array, speeds: Sequence[float], count: int, about: float
) -> float:
    r"""Largest relative change of the train's frequencies by gyroscopic moments.

    The plane across the line of action meets no mesh of spur gears: each shaft bends there by itself, and gyroscopic
    moments are all that joins it to the motion along that line. With modes Q of the train and P of that plane

    .. math:: \ddot a + \Gamma \dot b + \Lambda_a a = 0, \quad \ddot b - \Gamma^T \dot a + \Lambda_b b = 0, \quad
       \Gamma = Q^T \Omega G P,

    G of the polar inertias. A mode that two frequencies share counts by its parts in these. The train of a helical pair
    has both planes: :math:`\ddot a + Q^T \Omega G Q\, \dot a + \Lambda_a a = 0` with a skew G.

    Parameters
    ----------
    train : Train
    modes, squares : ndarray, shapes (n, m), (m,)
        Of the train in contact, of a mass of one.
    speeds : (float, float)
        Of pinion and wheel [rad/s].
    count, about
        As of `lowest_modes`.
    """
    turns = [np.flatnonzero(np.any(side.spin != 0.0, axis=1)) for side in train.sides]
    if not any(at.size for at in turns):
        return 0.0
    firsts = (0, len(train.sides[0].free))
    spin = np.zeros((len(train.rotation), len(train.rotation)))
    for first, side, speed in zip(firsts, train.sides, speeds, strict=True):
        at = slice(first, first + len(side.free))
        spin[at, at] = speed * side.spin
    n, root = len(squares), np.sqrt(squares)
    if np.array_equal(spin, -spin.T):  # both planes are in the train
        frequencies, _ = _turning(modes.T @ spin @ modes, root)
        return float(np.max(np.abs(frequencies / root - 1.0), initial=0.0))
    other_squares, other = _across(train, count, about)
    joined, m = modes.T @ spin @ other, len(other_squares)
    gyro = np.block([[np.zeros((n, n)), joined], [-joined.T, np.zeros((m, m))]])
    frequencies, vectors = _turning(gyro, np.sqrt(np.concatenate([squares, other_squares])))
    share = np.abs(vectors[:n]) ** 2 + np.abs(vectors[n + m : 2 * n + m]) ** 2
    share /= share.sum(axis=1, keepdims=True)
    off = np.abs(frequencies / root[:, None] - 1.0)
    return float(np.max(np.sum(share * off, axis=1), initial=0.0))


def _turning(gyro: Array, root: Array) -> tuple[Array, Array]:
    """Frequencies with gyroscopic moments between modes of frequencies `root`, and speeds, then root times motion."""
    # of speeds and frequency times displacement: i times this matrix is Hermitian
    whole = np.block([[-gyro, -np.diag(root)], [np.diag(root), np.zeros_like(gyro)]])
    frequencies, vectors = np.linalg.eigh(1j * whole)
    forward = frequencies > 0.0
    return frequencies[forward], vectors[:, forward]


def _across(train: Train, count: int, about: float) -> tuple[Array, Array]:
    """Squares of frequencies and modes of shafts in the plane across the line of action, where no mesh acts."""
    second = len(train.sides[0].free)
    bends = np.concatenate(
        [
            first + np.flatnonzero(side.free == 0.0)
            for first, side in zip((0, second), train.sides, strict=True)
        ]
    )
    firm, mass = (
        sparse.csc_array(matrix.tocsr()[bends][:, bends]) for matrix in (train.out_of_mesh, train.mass)
    )
    squares, own = lowest_modes(firm, mass, min(count, len(bends)), about)
    modes = np.zeros((len(train.rotation), own.shape[1]))
    modes[bends] = own
    return squares, modes
