"""Load sharing over pairs and cells of the face: the plane's equations with more unknowns.

Every pair's face is divided into equal cells. With F_ic the force on a cell and n of them, n F_ic is the force that the
whole face would bear at that line load, so that laws of the plane hold for it. With z the cells' middles, T the cosine
transform over the face and k_m = m pi/b,

    approach = n T^T diag(B_ij + W_ij(k_m)) T F_j + E_ij F_j + law(n F_i) + gap_i + g_c ,

B the plane's compliance, W what waves yield beyond it (``fem.influence.gear_face``), E what free ends add. Modes of a
tip edge, whose law holds tooth and body, change by W as those of a flank at its corner do. One active set runs over
all.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.contact.cell_contact import CellContact
from fem.contact.face_errors import CellErrors, cell_errors, half_as_many
from fem.laws.local_law import Film, film_yielding
from fem.pair.face_shafts import HeldShafts

if TYPE_CHECKING:
    from fem.contact.contact_sides import ContactSides
    from fem.pair.pair_compliance import PairCompliance
    from gears import LoadShare

__all__ = ["FaceShare", "of_pairs", "settled_gaps", "share_over_face", "yielding_over_face"]


@record
class FaceShare:
    """Forces on cells.

    Attributes
    ----------
    forces : (torques, pitches, positions, pairs, cells) array
        [N]
    remaining_gaps : (torques, pitches, positions, pairs, cells) array
        Gap that is left under load [m]; where a cell bears, minus what the contact's own law yields.
    errors : CellErrors
        By the cells, and of the face-load factor by free ends.
    shafts : HeldShafts or None
        None where they are rigid.
    strips, rise
        As of ``fem.contact.cell_contact.CellShare``.
    least : float
        Turn at which the first place of the face touches, from where straight, aligned gears do [m].
    """

    forces: Array
    remaining_gaps: Array
    errors: CellErrors
    shafts: HeldShafts | None
    strips: Array
    rise: Array
    least: float

    def of_pairs(self, pairs: slice) -> FaceShare:
        """The same of some of the pairs."""
        parts = (array[..., pairs, :] for array in (self.forces, self.remaining_gaps, self.rise))
        forces, remaining_gaps, rise = parts
        return replace(self, forces=forces, remaining_gaps=remaining_gaps, rise=rise)

    @property
    def open(self) -> Array:
        """Minimum gap that is left along the face (torques, pitches, positions, pairs) [m]."""
        return np.asarray(self.remaining_gaps.min(axis=-1))

    def bent(self, number: int) -> Array:
        """By how much more the pinion turns before flanks touch (pitches, positions) [m], because of the shafts.

        Parameters
        ----------
        number : int
            Of the torque.
        """
        return np.zeros(self.forces.shape[1:3]) if self.shafts is None else self.shafts.touch[number]

    def turned(self, number: int) -> Array:
        """By how much more than D the pinion turns (pitches, positions) [m]: to close gaps, and to bend shafts."""
        return self.least + self.bent(number)


def share_over_face(bodies: PairCompliance, whole: Array, sides: ContactSides) -> tuple[LoadShare, FaceShare]:
    """Share forces over pairs and cells.

    Parameters
    ----------
    bodies : PairCompliance
    whole : (torques, 1, 1) array
        Torques over the base radius [N].
    sides : ContactSides
        Contacts of whole pairs, on one side of the teeth or both.

    Returns
    -------
    LoadShare
        Of the pairs.
    FaceShare
        Of their cells.
    """
    setup = sides.setups[0]
    assert setup.face is not None
    over = CellContact(bodies, whole, sides)
    few, _ = half_as_many(setup.face)
    coarse = over.shared(few, sides.share(whole).forces[..., None], held=False)
    coarse = over.shared(few, coarse.forces, over.gap_drops(few, coarse))
    fine = over.shared(setup.face, coarse.forces, over.gap_drops(setup.face, coarse))
    errors = cell_errors(over, setup.face, fine, coarse)
    return of_pairs(fine.share, setup.face.cells), FaceShare(
        fine.forces,
        settled_gaps(fine.remaining_gaps, fine.forces),
        errors,
        fine.shafts,
        fine.strips,
        fine.rise,
        setup.face.least_gap(setup.pair),
    )


def of_pairs(load_share: LoadShare, cells: int) -> LoadShare:
    """Share of pairs from that of their cells (..., pairs cells)."""
    forces, slopes = (
        values.reshape(*values.shape[:-1], -1, cells).sum(axis=-1)
        for values in (load_share.forces, load_share.pair_stiffness)
    )
    return replace(load_share, forces=forces, pair_stiffness=slopes)


def settled_gaps(remaining_gaps: Array, forces: Array) -> Array:
    """Gaps that are left, of cells that bear over a part of their length none."""
    return np.where(forces > 0.0, np.minimum(remaining_gaps, 0.0), remaining_gaps)


def yielding_over_face(film: Film, rho1: Array, forces: Array, shares: Array) -> Array:
    """What films of all cells yield beyond the transmission error (positions,) [m], see ``film_yielding``.

    Parameters
    ----------
    film : Film
        Of a whole face.
    rho1 : (positions, pairs) array
        Places [m]; nan where a pair is dry.
    forces : (positions, pairs, cells) array
        [N]
    shares : (positions, pairs) array
        Of the pairs, of the whole force.
    """
    positions, pairs, cells = forces.shape
    whole = forces.sum(axis=-1, keepdims=True)
    part = np.divide(forces, whole, out=np.zeros_like(forces), where=whole > 0.0)
    flat = (positions, pairs * cells)
    places = np.repeat(rho1, cells, axis=-1)
    return film_yielding(film, places, cells * forces.reshape(flat), (shares[..., None] * part).reshape(flat))
