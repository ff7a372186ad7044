"""Condensation of a sector onto its cuts by nested groups of elements, all in dense blocks.

The elements are halved again and again across the longer side of the region that they fill. In a group of few
elements the nodes that no other element has are eliminated, then in each union of two groups those that only these two
have, up to the whole sector, where the cuts are left (nested dissection: A. George, SIAM J. Numer. Anal. 10, 1973,
doi:10.1137/0710032; fronts: I. S. Duff and J. K. Reid, ACM Trans. Math. Softw. 9, 1983, doi:10.1145/356044.356047).
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

__all__ = ["Condensation", "condensation", "unknowns_of"]

FEW, LEAST = 32, 4
"""Elements of a group that is not halved, of two unknowns at a node, and the smallest of them with more unknowns."""


LONG = 32
"""Mean unknowns of neighbouring nodes from which on matrices are added block by block."""


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


@record
class _Group:
    """Nodes that a group of elements shares with others, in order of their numbers.

    Attributes
    ----------
    nodes, used : (n,) arrays of int
        Nodes, and how many elements of the group have each.
    stiffness : (2n, 2n) array
    """

    nodes: Integers
    used: Integers
    stiffness: Array


def condensation(
    points: Array,
    triangles: Integers,
    elements: Array | Callable[[Integers], Array],
    cut: Integers,
    hub: Integers,
    components: int = 2,
) -> Condensation:
    """Condense a sector onto its cuts.

    Parameters
    ----------
    points : (n, 2) array
        Nodes.
    triangles : (m, 6) array
    elements : (m, 6 components, 6 components) array, or callable
        Stiffness matrices of the triangles, unknown ``components`` i + component of their node i; or what gives
        those of some triangles.
    cut, hub : index arrays
        Nodes on the cuts, in the order that is wanted, and held ones.
    components : int
        Displacements of a node.
    """
    users = np.bincount(triangles.ravel(), minlength=len(points))
    users[cut] += 1  # never all in one group
    users[hub] = 0
    middles = points[triangles[:, :3]].mean(axis=1)
    number = np.empty(len(points), dtype=np.int64)  # of each node in the group at work
    fronts: list[_Front] = []

    def few(members: Integers) -> _Group:
        times = np.bincount(triangles[members].ravel())
        nodes = np.flatnonzero(times)
        order, ends = _order(users[nodes], times[nodes])
        nodes = nodes[order]
        number[nodes] = np.arange(len(nodes))
        unknown = unknowns_of(number[triangles[members].ravel()], components).reshape(len(members), -1)
        size = components * len(nodes)
        place = (unknown[:, :, None] * size + unknown[:, None, :]).ravel()
        element_matrices = elements(members) if callable(elements) else elements[members]
        summed = np.bincount(place, element_matrices.ravel(), size * size)
        matrix = np.asarray(summed, dtype=float).reshape(size, size)
        return eliminated(nodes, times[nodes], matrix, ends)

    def merged(first: _Group, second: _Group) -> _Group:
        times = np.zeros(len(points), dtype=np.int64)
        for part in (first, second):
            times[part.nodes] += part.used
        nodes = np.flatnonzero(times)
        order, ends = _order(users[nodes], times[nodes])
        nodes = nodes[order]
        number[nodes] = np.arange(len(nodes))
        matrix = np.zeros((components * len(nodes), components * len(nodes)))
        for part in (first, second):
            _add(matrix, part.stiffness, number[part.nodes], components)
        return eliminated(nodes, times[nodes], matrix, ends)

    def eliminated(nodes: Integers, used: Integers, matrix: Array, ends: tuple[int, int]) -> _Group:
        first, last = (components * end for end in ends)
        done, rest = slice(first), slice(first, last)
        inverse = _inverse_of_factor(matrix[done, done])
        coupling = inverse @ matrix[done, rest]
        kept = nodes[ends[0] : ends[1]]
        own, shared = (unknowns_of(group_nodes, components) for group_nodes in (nodes[: ends[0]], kept))
        fronts.append(_Front(own, shared, inverse, coupling))
        return _Group(kept, used[ends[0] : ends[1]], matrix[rest, rest] - coupling.T @ coupling)

    def group(members: Integers) -> _Group:
        if len(members) <= max(LEAST, 2 * FEW // components):
            return few(members)
        place = middles[members]
        along = place[:, int(np.argmax(np.ptp(place, axis=0)))]
        order = np.argpartition(along, len(members) // 2)
        return merged(group(members[order[: len(members) // 2]]), group(members[order[len(members) // 2 :]]))

    whole = group(np.arange(len(triangles)))
    number[whole.nodes] = np.arange(len(whole.nodes))
    place = unknowns_of(number[cut], components)
    stiffness = whole.stiffness[np.ix_(place, place)]
    return Condensation(tuple(fronts), unknowns_of(cut, components), stiffness)


def _add(matrix: Array, part: Array, nodes: Integers, components: int) -> None:
    """Add the matrix of some nodes to that of all, in place: blocks of neighbours where they are long."""
    starts = np.flatnonzero(np.diff(nodes, prepend=-2) != 1)
    ends = np.append(starts[1:], len(nodes))
    if LONG * len(starts) > len(part):
        unknown = unknowns_of(nodes, components)
        # columns, then whole rows: twice as fast as both at once
        rows = np.zeros((len(part), len(matrix)))
        rows[:, unknown] = part
        matrix[unknown] += rows
        return
    first, low, high = (components * each for each in (nodes[starts], starts, ends))
    blocks = [
        (slice(at, at + b - a), slice(a, b))
        for at, a, b in zip(first.tolist(), low.tolist(), high.tolist(), strict=True)
    ]
    for row, row_of in blocks:
        for column, column_of in blocks:
            matrix[row, column] += part[row_of, column_of]


def _order(users: Integers, used: Integers) -> tuple[Integers, tuple[int, int]]:
    """Order that puts nodes of this group alone first and held ones last, and where the first two kinds end."""
    kind = np.where(users == 0, 2, np.where(used == users, 0, 1))
    order = np.argsort(kind, kind="stable")
    first, second, _ = np.bincount(kind, minlength=3)
    return order, (int(first), int(first + second))


def _inverse_of_factor(matrix: Array) -> Array:
    """L^-1 of a symmetric definite matrix L L^T; of none, where a group has no other nodes."""
    if not len(matrix):
        return matrix
    with unclocked():
        from scipy.linalg.lapack import dtrtri

    # the transpose of rows is columns, as LAPACK has them: nothing is copied
    inverse, _ = dtrtri(np.linalg.cholesky(matrix).T, lower=0, overwrite_c=1)
    return np.asarray(inverse.T)


def unknowns_of(nodes: Integers, components: int = 2) -> Integers:
    """Unknowns of nodes, one after the other (components n,)."""
    unknowns: Integers = (components * nodes[:, None] + np.arange(components)).ravel()
    return unknowns
