"""Condensation of a sector onto its cuts by nested groups of elements, all in dense blocks.

Nodes that no other element has are eliminated in each group of few elements, then in each union of two groups
(``fem.elasticity.dissection``), up to the whole sector, where the cuts are left (fronts: I. S. Duff and J. K. Reid,
ACM Trans. Math. Softw. 9, 1983, doi:10.1145/356044.356047).
With d the nodes that a group eliminates and r those that it leaves,

    K_dd = L L^T,   W = L^-1 K_dr,   S = K_rr - W^T W.

Forces pass upwards, z = L^-1 f_d and f_r - W^T z, and leave on the cuts what these carry when they are held;
|z|^2 is twice the energy of the forces. Displacements pass downwards from any displacements of the cuts,
u_d = L^-T (z - W u_r).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from base import Array, Integers, record, unclocked
from fem.elasticity.dissection import Dissection, Group, Half

__all__ = ["Condensation", "condensation"]


@record
class _Front:
    """One group: unknowns that it eliminates and those that it leaves, L^-1 and W."""

    done: Integers
    shared: Integers
    inverse: Array
    coupling: Array


@record
class Condensation:
    """A sector's factors.

    Attributes
    ----------
    fronts : tuple of _Front
        From the smallest groups up.
    cut : (cut,) array of int
        Unknowns on the cuts.
    stiffness : (cut, cut) array
        Of the sector as seen from its cuts, Cartesian components.
    modulus : float
        Over that of what was factorised.
    """

    fronts: tuple[_Front, ...]
    cut: Integers
    stiffness: Array
    modulus: float = 1.0

    def stiffer(self, factor: float) -> Condensation:
        """Condensation of a sector that is stiffer by a factor."""
        return Condensation(self.fronts, self.cut, self.stiffness * factor, self.modulus * factor)

    def up(self, force: Array) -> tuple[Array, Array, Array]:
        """Pass forces up to the cuts, which are held.

        Parameters
        ----------
        force : (unknowns, loads) array
            On all unknowns of the sector; those on the hub are of no account.

        Returns
        -------
        reduced : (unknowns, loads) array
            What ``down`` needs of the forces.
        on_cuts : (cut, loads) array
            Forces on the cuts and those that are handed on to them.
        work : (loads,) array
            Forces inside the sector times the displacements that they cause.
        """
        reduced = force / self.modulus
        work = np.zeros(force.shape[1])
        for front in self.fronts:
            own = front.inverse @ reduced[front.done]
            reduced[front.done] = own
            reduced[front.shared] -= front.coupling.T @ own
            work += np.einsum("ul,ul->l", own, own)
        return reduced, reduced[self.cut] * self.modulus, work * self.modulus

    def down(self, cuts: Array, reduced: Array | None = None) -> Array:
        """Displacements of all unknowns (unknowns, loads), zero on the hub.

        Parameters
        ----------
        cuts : (cut, loads) array
            Displacements of the cuts.
        reduced : (unknowns, loads) array, optional
            Of forces inside the sector; none unless given.
        """
        unknowns = 1 + max(int(front.done.max(initial=0)) for front in self.fronts)
        unknowns = max(unknowns, 1 + int(self.cut.max())) if reduced is None else len(reduced)
        moved = np.zeros((unknowns, cuts.shape[1]))
        moved[self.cut] = cuts
        for front in reversed(self.fronts):
            own = -(front.coupling @ moved[front.shared])
            if reduced is not None:
                own += reduced[front.done]
            moved[front.done] = front.inverse.T @ own
        return moved


def condensation(over: Dissection, elements: Array | Callable[[Integers], Array]) -> Condensation:
    """Condense a sector onto its cuts.

    Parameters
    ----------
    over : Dissection
        Groups of its elements, with so many components at a node.
    elements : (m, 6 components, 6 components) array, or callable
        Stiffness matrices of the triangles, unknown ``components`` i + component of their node i; or what gives
        those of some triangles.
    """
    fronts: list[_Front] = []
    left: list[Array] = []  # by groups that wait for the other half
    for group in over.groups:
        if group.halves:
            second, first = left.pop(), left.pop()
            matrix = np.zeros((group.size, group.size))
            for half, part in zip(group.halves, (first, second), strict=True):
                _add(matrix, part, half)
        else:
            matrix = _summed(group, elements)
        done, rest = slice(len(group.done)), slice(len(group.done), len(group.done) + len(group.shared))
        inverse = _inverse_of_factor(matrix[done, done])
        coupling = inverse @ matrix[done, rest]
        fronts.append(_Front(group.done, group.shared, inverse, coupling))
        left.append(matrix[rest, rest] - coupling.T @ coupling)
    (whole,) = left
    return Condensation(tuple(fronts), over.cut, whole[np.ix_(over.left, over.left)])


def _summed(group: Group, elements: Array | Callable[[Integers], Array]) -> Array:
    """Matrix of a few elements."""
    place = (group.places[:, :, None] * group.size + group.places[:, None, :]).ravel()
    matrices = elements(group.members) if callable(elements) else elements[group.members]
    summed = np.bincount(place, matrices.ravel(), group.size**2)
    return np.asarray(summed, dtype=float).reshape(group.size, group.size)


def _add(matrix: Array, part: Array, half: Half) -> None:
    """Add the matrix of a half to that of the whole, in place."""
    if half.runs is None:
        # columns, then whole rows: twice as fast as both at once
        rows = np.zeros((len(part), len(matrix)))
        rows[:, half.unknowns] = part
        matrix[half.unknowns] += rows
        return
    for row, row_of in half.runs:
        for column, column_of in half.runs:
            matrix[row, column] += part[row_of, column_of]


def _inverse_of_factor(matrix: Array) -> Array:
    """L^-1 of a symmetric definite matrix L L^T; of none, where a group has no other nodes."""
    if not len(matrix):
        return matrix
    with unclocked():
        from scipy.linalg.lapack import dtrtri

    # the transpose of rows is columns, as LAPACK has them: nothing is copied
    inverse, _ = dtrtri(np.linalg.cholesky(matrix).T, lower=0, overwrite_c=1)
    return np.asarray(inverse.T)
