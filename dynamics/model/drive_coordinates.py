"""Coordinates of a drive train in which the mesh acts on the first one alone."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from base import Array, InputError

FREE = 1e-13  # of the largest: what is less is rounding of an assembled matrix


@dataclass(frozen=True, eq=False)
class Coordinates:
    r"""Displacements q as :math:`w = W q`, whose first one is :math:`g \cdot q`.

    With :math:`M = L L^T`, :math:`\hat g = L^{-1} g`, :math:`\gamma = |\hat g|` and an orthonormal basis B that
    begins with :math:`\hat g / \gamma`, :math:`W = \gamma B^T L^T` and the equation becomes

    .. math::

        \ddot w + \hat C \dot w + \hat K w + \gamma^2 e_1 [c \dot y + k(t) f(y)] = \hat F, \qquad y = w_1 - e(t).

    Rotations that meet neither stiffness nor damping nor mesh are left out of B; the other vectors make the rest of a
    symmetric stiffness diagonal.

    Attributes
    ----------
    down : ndarray, shape (m, n)
        W.
    up : ndarray, shape (n, m)
        q of w, without what is left out.
    stiffness, damping : ndarray, shape (m, m)
        :math:`\hat K` and :math:`\hat C`, without the mesh.
    push : ndarray, shape (m, n)
        :math:`\hat F` of F.
    drift : ndarray, shape (r, n)
        Load of each of r free rotations of F, which must be zero; its square is part of
        :math:`F^T M^{-1} F`, the rest of which is that of `push` over `gain`.
    gain : float
        :math:`\gamma^2`, one over the mass that the mesh feels.
    """

    down: Array
    up: Array
    stiffness: Array
    damping: Array
    push: Array
    drift: Array
    gain: float

    @cached_property
    def lowers(self) -> Array:
        """W for displacements and for speeds, shape (2 m, 2 n)."""
        return _twice(self.down)

    @cached_property
    def raises(self) -> Array:
        """`up` for displacements and for speeds, shape (2 n, 2 m)."""
        return _twice(self.up)

    def fastest(self, stiffness: float, damping: float) -> float:
        """Rate that no motion exceeds, with so much of the mesh's stiffness and damping."""
        return _fastest(self, stiffness, damping)


@lru_cache(maxsize=64)
def _fastest(at: Coordinates, stiffness: float, damping: float) -> float:
    """As `Coordinates.fastest`: oscillators that differ in frequency, force or backlash alone have the same."""
    stiff, drag = at.stiffness.copy(), at.damping.copy()
    stiff[0, 0] += at.gain * stiffness
    drag[0, 0] += at.gain * damping
    return max(math.sqrt(float(np.linalg.norm(stiff, 2))), float(np.linalg.norm(drag, 2)))


def _twice(matrix: Array) -> Array:
    """Two of a matrix along a diagonal, that nobody can change."""
    rows, columns = matrix.shape
    twice = np.zeros((2 * rows, 2 * columns))
    twice[:rows, :columns] = matrix
    twice[rows:, columns:] = matrix
    twice.flags.writeable = False
    return twice


def coordinates_of(mass: Array, damping: Array, stiffness: Array, direction: Array) -> Coordinates:
    """Coordinates of a drive train; those of the last few are kept.

    Parameters
    ----------
    mass, damping, stiffness : ndarray, shape (n, n)
        M, symmetric and positive definite, C and K.
    direction : ndarray, shape (n,)
        g.

    Raises
    ------
    InputError
        If the mass is not positive definite, the mesh touches nothing, or a motion that nothing holds is damped.
    """
    entries = b"".join(np.ascontiguousarray(part).tobytes() for part in (mass, damping, stiffness, direction))
    return _kept(len(direction), entries)


@lru_cache(maxsize=16)
def _kept(size: int, entries: bytes) -> Coordinates:
    """Coordinates of M, C, K and g, one after the other."""
    numbers = np.frombuffer(entries)
    mass, damping, stiffness = numbers[: 3 * size**2].reshape(3, size, size)
    direction = numbers[3 * size**2 :]
    try:
        factor = np.linalg.cholesky(mass)
    except np.linalg.LinAlgError:
        allowed, eigenvalues = "must be positive definite", np.linalg.eigvalsh(mass).tolist()
        raise InputError.at("mass", eigenvalues, allowed, "give every freedom a mass") from None
    inverse = np.linalg.inv(factor)
    k, c = (inverse @ matrix @ inverse.T for matrix in (stiffness, damping))
    g = inverse @ direction
    gain = float(g @ g)
    if gain == 0.0:
        raise InputError.at(
            "direction", direction.tolist(), "must not be zero", "say which freedoms the mesh joins"
        )
    free = _null_space([k, k.T, c, c.T, g[None] / np.sqrt(gain)])
    basis = _basis(g / np.sqrt(gain), free, k)
    if len(_null_space([basis.T @ k @ basis, np.eye(1, basis.shape[1])])) > 0:
        allowed = "must hold every freedom, or leave a rotation free of stiffness, damping and mesh alike"
        raise InputError.at(
            "stiffness", stiffness.tolist(), allowed, "add a soft spring, or take its damping away"
        )
    root = float(np.sqrt(gain))
    return Coordinates(
        root * basis.T @ factor.T,
        inverse.T @ basis / root,
        basis.T @ k @ basis,
        basis.T @ c @ basis,
        root * basis.T @ inverse,
        free @ inverse,
        gain,
    )


def _null_space(parts: list[Array]) -> Array:
    """Unit vectors, as rows, that all of some matrices take to nothing, each measured by its size."""
    scaled = [part / size for part in parts if (size := float(np.max(np.abs(part), initial=0.0))) > 0.0]
    _, sizes, vectors = np.linalg.svd(np.vstack(scaled))
    return np.asarray(vectors[np.count_nonzero(sizes > FREE * len(vectors)) :])


def _basis(first: Array, free: Array, stiffness: Array) -> Array:
    """Orthonormal columns: `first`, then what the free rotations leave, which make a symmetric stiffness diagonal."""
    taken = np.column_stack([first, free.T])
    rest = np.linalg.svd(taken)[0][:, taken.shape[1] :]
    inner = rest.T @ stiffness @ rest
    _, turn = np.linalg.eigh(0.5 * (inner + inner.T))
    return np.column_stack([first, rest @ turn])
