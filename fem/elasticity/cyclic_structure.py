"""A ring of equal links, each with stiffness S seen from its two ends: influence of one end on all others.

In an endless chain the force balance of the ends q_j is
    S_LR q_(j-1) + (S_RR + S_LL) q_j + S_RL q_(j+1) = f_j .
Leaving out every second end, again and again, keeps the form and squares the coupling (cyclic reduction;
D. A. Bini and B. Meini, SIAM J. Matrix Anal. Appl. 17, 1996): after a few steps the diagonal is the inverse
of G_0, the displacement at the loaded end. Away from the load q_(j+1) = X q_j, in the other direction
q_(j-1) = Y q_j. The ring of z links is the chain with the load repeated every z ends:

    G_j = X^j (1 - X^z)^-1 G_0 + Y^(z-j) (1 - Y^z)^-1 G_0,   0 <= j < z,

exact, at a cost that grows as the logarithm of z.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from base import Array, Fault, InputError, record

__all__ = ["CyclicStructure", "cyclic_structure"]

STEPS = 60


@record
class CyclicStructure:
    """Answer of the ring to forces on end 0.

    Attributes
    ----------
    links : int
        z
    onward, back : (n, n) arrays
        X and Y.
    forth_start, back_start : (n, n) arrays
        (1 - X^z)^-1 G_0 and (1 - Y^z)^-1 G_0.
    """

    links: int
    onward: Array
    back: Array
    forth_start: Array
    back_start: Array

    def stiffer(self, factor: float) -> CyclicStructure:
        """Answer of links that are stiffer by a factor."""
        return replace(self, forth_start=self.forth_start / factor, back_start=self.back_start / factor)

    def influence(self, j: int) -> Array:
        """Displacements of end j (any whole number) by unit forces on end 0, (n, n) array."""
        j %= self.links
        if j not in self._influences:
            power = np.linalg.matrix_power
            forth = power(self.onward, j) @ self.forth_start
            self._influences[j] = forth + power(self.back, self.links - j) @ self.back_start
        return self._influences[j]

    def at_ends(self, force: Array, link: int) -> Array:
        """Displacements of both ends of a link when forces act on both ends of link 0.

        Parameters
        ----------
        force : (2n, loads) array
            Right end first.
        link : int

        Returns
        -------
        (2n, loads) array
            Right end first.
        """
        half = len(force) // 2
        behind, here, ahead = (self.influence(link + step) for step in (-1, 0, 1))
        right, left = force[:half], force[half:]
        return np.concatenate([here @ right + behind @ left, ahead @ right + here @ left])

    @cached_property
    def _influences(self) -> dict[int, Array]:
        return {}

    def all_ends(self, force: Array) -> Array:
        """Displacements (z, n) of all ends by one force (n,) on end 0."""
        ends = np.empty((self.links, len(force)))
        forth, back = self.forth_start @ force, self.back_start @ force
        for j in range(self.links):
            ends[j] = forth
            forth = self.onward @ forth
        for j in range(self.links - 1, -1, -1):
            back = self.back @ back
            ends[j] += back
        return ends


def cyclic_structure(stiffness: Array, links: int) -> CyclicStructure:
    """Close a ring of equal links.

    Parameters
    ----------
    stiffness : (2n, 2n) array
        Symmetric stiffness of one link, right end first; the left end of one is the right end of the next.
    links : int

    Raises
    ------
    base.InputError
        When the chain is not held, so that no displacement decays.
    """
    n = len(stiffness) // 2
    ahead, behind = stiffness[:n, n:], stiffness[n:, :n]
    middle = stiffness[:n, :n] + stiffness[n:, n:]
    to_next, to_last, diagonal = ahead, behind, middle
    from_right, from_left = middle, middle  # with everything on one side left out
    size = np.abs(middle).max()
    for _ in range(STEPS):
        by_neighbours = np.linalg.solve(diagonal, np.concatenate([to_last, to_next], axis=1))
        by_last, by_next = by_neighbours[:, :n], by_neighbours[:, n:]
        over_right, over_left = to_next @ by_last, to_last @ by_next
        from_right, from_left = from_right - over_right, from_left - over_left
        diagonal = diagonal - over_right - over_left
        to_last, to_next = -to_last @ by_last, -to_next @ by_next
        if max(np.abs(to_last).max(), np.abs(to_next).max()) <= 1e-18 * size:
            break
    else:
        raise InputError([Fault("hub", "free", "must be held on the bore", "give the gear a larger bore")])
    start = np.linalg.inv(diagonal)
    onward, back = -np.linalg.solve(from_right, behind), -np.linalg.solve(from_left, ahead)
    power, unit = np.linalg.matrix_power, np.eye(n)
    return CyclicStructure(
        links,
        np.asarray(onward),
        np.asarray(back),
        np.linalg.solve(unit - power(onward, links), start),
        np.linalg.solve(unit - power(back, links), start),
    )
