"""One factorisation of a sector that serves all: condensation onto its cuts, and loads with the cuts held or free.

The unknowns are ordered with the cuts last, and the cuts stand on stiff springs, k on every component. With L U
the factors of that matrix, the trailing blocks give the stiffness seen from the cuts, S + k = L_cc U_cc, as the
remainder of the elimination. A solution for forces f on the inner unknowns and g on the cuts then holds more than
its displacements x and y: what the springs and the cuts carry, (S + k) y, is the force g - K_ci K_ii^-1 f that
the inner forces hand on to cuts that are held. The springs keep y small, so that differences keep their digits
however slender the sector is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Integers, record, unclocked

if TYPE_CHECKING:
    from scipy.sparse import csc_array

__all__ = ["Condensation", "condensation"]


@record
class Condensation:
    """A sector's factors.

    Attributes
    ----------
    factor : scipy.sparse.linalg.SuperLU
        Of the stiffness with springs, inner unknowns in an order that keeps the fill small, then the cuts.
    order : (inner + cut,) array
        Which unknown, inner ones first as they are numbered outside, stands in each place of the factor.
    sprung : (cut, cut) array
        S + k in Cartesian components.
    stiffness : (cut, cut) array
        S.
    modulus : float
        Over that of what was factorised.
    """

    factor: Any
    order: Integers
    sprung: Array
    stiffness: Array
    modulus: float = 1.0

    def stiffer(self, factor: float) -> Condensation:
        """Condensation of a sector that is stiffer by a factor."""
        return Condensation(
            self.factor, self.order, self.sprung * factor, self.stiffness * factor, self.modulus * factor
        )

    def solve(self, inner: Array, cut: Array) -> tuple[Array, Array]:
        """Displacements of inner unknowns and cuts (..., loads) with the springs, by forces on both."""
        force = np.concatenate([inner, cut])
        moved = np.empty_like(force)
        moved[self.order] = self.factor.solve(force[self.order]) / self.modulus
        return moved[: len(inner)], moved[len(inner) :]


def condensation(inner: Integers, cut: Integers, stiffness: csc_array) -> Condensation:
    """Factorise a sector and condense it onto its cuts.

    Parameters
    ----------
    inner, cut : index arrays
        Unknowns of the stiffness matrix, 2 node + component, in pairs.
    stiffness : sparse matrix
        Symmetric, definite once the hub is left out.
    """
    with unclocked():
        from scipy.sparse import csc_array, diags_array
        from scipy.sparse.linalg import splu

    nodes = _little_fill(csc_array(stiffness[inner[::2]][:, inner[::2]]))
    number, cuts = len(inner), len(cut)
    places = (2 * nodes[:, None] + np.arange(2)).ravel()
    order = np.concatenate([places, np.arange(number, number + cuts)])
    free = np.concatenate([inner, cut])[order]
    spring = float(stiffness.diagonal()[cut].max())
    springs = diags_array(np.where(np.arange(number + cuts) < number, 0.0, spring))
    # symmetric and definite: no pivoting
    factor = splu(
        csc_array(stiffness[free][:, free] + springs),
        permc_spec="NATURAL",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    # SuperLU reorders by the elimination tree, at whose root the cuts are: each is coupled to every other by then
    place = factor.perm_c[number:] - number
    tail = slice(number, None)
    product = factor.L[tail, tail].toarray() @ factor.U[tail, tail].toarray()
    sprung = product[np.ix_(place, place)]
    sprung = 0.5 * (sprung + sprung.T)
    return Condensation(factor, order, sprung, sprung - spring * np.eye(cuts))


def _little_fill(coupled: csc_array) -> Integers:
    """Minimum-degree order of the nodes of a symmetric pattern, from an incomplete factorisation that drops all."""
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import spilu

    pattern = coupled.copy()
    pattern.data[:] = 1.0
    pattern.setdiag(1.0 + len(pattern.data))
    found = spilu(
        csc_array(pattern),
        drop_tol=1.0,
        fill_factor=1.0,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    return np.argsort(found.perm_c)
