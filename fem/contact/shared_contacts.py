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

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Booleans, record
from fem.contact.cell_contact import CellContact
from fem.contact.cell_share import CellShare
from fem.contact.face_errors import CellErrors, cell_errors, half_as_many, no_errors
from fem.contact.line_contact import LineContact
from fem.laws.local_law import Film, film_yielding

if TYPE_CHECKING:
    from fem.contact.contact_sides import ContactSides
    from fem.pair.face_setting import FaceSetting
    from fem.pair.face_shafts import HeldShafts
    from fem.pair.pair_compliance import PairCompliance
    from gears import LoadShare

__all__ = ["SharedContacts", "of_pairs", "settled_gaps", "share_staying", "yielding_over_face"]


@record
class SharedContacts:
    """Contacts on one side of the teeth, or on both one after the other, that share loads over pairs and cells.

    Attributes
    ----------
    share : LoadShare
        Of the pairs.
    forces : (torques, pitches, positions, pairs, cells) array
        On cells [N].
    remaining_gaps : (torques, pitches, positions, pairs, cells) array
        Gap that is left under load [m]; where a cell bears, minus what the contact's own law yields.
    strips, rise
        As of ``fem.contact.cell_share.CellShare``.
    lost : (2, 2, torques, pitches, positions, pairs) array
        Parts of both base radii by which levers of forces, and of further ones, are shorter: 0 of contacts that stay.
    estimate : callable
        Gives `errors`, once.
    shafts : HeldShafts or None
        None where they are rigid.
    fewer : (torques, pitches, positions, pairs, cells) array or None
        Forces with half as many cells [N], of lines of contact.
    slopes : (torques, pitches, positions, pairs, cells) array or None
        Of forces on cells by D, of lines of contact, without shafts [N/m].
    tilting : (2, torques, pitches, positions, 2, 2) array or None
        Stiffness of their mesh against approach and tilt, and that with half as many cells; as of ``LineLoads``.
    reference : SharedContacts or None
        Under the single load that has brought the shafts where they are held; None where every load bends them.
    """

    share: LoadShare
    forces: Array
    remaining_gaps: Array
    strips: Array
    rise: Array
    lost: Array
    estimate: Callable[[], CellErrors]
    shafts: HeldShafts | None = None
    fewer: Array | None = None
    slopes: Array | None = None
    tilting: Array | None = None
    reference: SharedContacts | None = None

    @property
    def bending(self) -> Array:
        """Forces that have brought the shafts where they are: of each torque, or of all (1, ...) [N]."""
        return self.forces if self.reference is None else self.reference.forces

    @property
    def errors(self) -> CellErrors:
        """Errors by the cells, and of the face-load factor by free ends; found when they are first asked for."""
        return self.estimate()

    @classmethod
    def even(cls, share: LoadShare, open_: Array) -> SharedContacts:
        """Pairs whose loads are even along the face: each a single cell, with the gap that is left (..., pairs) [m]."""
        forces, count = share.forces[..., None], len(share.forces)
        lost = np.zeros((2, 2, *share.forces.shape))
        none = np.zeros_like(forces)
        return cls(share, forces, open_[..., None], np.zeros(count), none, lost, lambda: no_errors(count))

    @property
    def turn(self) -> Array:
        """D from the first touch on straight shafts (torques, pitches, positions) [m]."""
        turn = self.share.transmission_error
        return turn if self.shafts is None else turn + self.shafts.touch

    @property
    def open(self) -> Array:
        """Minimum gap that is left along the face (torques, pitches, positions, pairs) [m]."""
        return np.asarray(self.remaining_gaps.min(axis=-1))

    def of_side(self, pairs: slice, turn: Array, sign: float) -> SharedContacts:
        """Of the pairs on one side, with the turn that closes their gaps, of this sign by D (torques, ...) [m]."""
        forces, remaining_gaps, rise = (
            array[..., pairs, :] for array in (self.forces, self.remaining_gaps, self.rise)
        )
        share = replace(
            self.share,
            forces=self.share.forces[..., pairs],
            transmission_error=turn,
            pair_stiffness=sign * self.share.pair_stiffness[..., pairs],
        )
        shafts = self.shafts if self.shafts is None or sign > 0.0 else self.shafts.opposite
        return replace(
            self,
            share=share,
            forces=forces,
            remaining_gaps=remaining_gaps,
            rise=rise,
            lost=self.lost[..., pairs],
            shafts=shafts,
            reference=self.reference and replace(self.reference, forces=self.reference.forces[..., pairs, :]),
        )

    def beside(self, remaining_gaps: Array) -> SharedContacts:
        """With pairs after these that bear nothing, and the gaps that are left to them (..., pairs, cells) [m]."""
        nothing = np.zeros_like(remaining_gaps)
        forces, slopes = (
            np.concatenate([values, nothing[..., 0]], axis=-1)
            for values in (self.share.forces, self.share.pair_stiffness)
        )
        return replace(
            self,
            share=replace(self.share, forces=forces, pair_stiffness=slopes),
            forces=np.concatenate([self.forces, nothing], axis=-2),
            remaining_gaps=np.concatenate([self.remaining_gaps, remaining_gaps], axis=-2),
            rise=np.concatenate([self.rise, nothing], axis=-2),
            lost=np.concatenate([self.lost, np.zeros((2, 2, *nothing.shape[:-1]))], axis=-1),
            reference=self.reference and self.reference.beside(remaining_gaps[:1]),
        )

    def with_kept(self, kept: SharedContacts, clear: Booleans) -> SharedContacts:
        """The same with another share where that holds (torques, pitches, positions)."""

        def mixed(own: Array, its: Array) -> Array:
            chosen = clear.reshape(*clear.shape, *(1,) * (own.ndim - clear.ndim))
            return np.where(chosen, its, own)

        mine, other = self.share, kept.share
        share = replace(
            mine,
            forces=mixed(mine.forces, other.forces),
            transmission_error=mixed(mine.transmission_error, other.transmission_error),
            stiffness=mixed(mine.stiffness, other.stiffness),
            pair_stiffness=mixed(mine.pair_stiffness, other.pair_stiffness),
        )
        return replace(
            self,
            share=share,
            forces=mixed(self.forces, kept.forces),
            remaining_gaps=mixed(self.remaining_gaps, kept.remaining_gaps),
            rise=mixed(self.rise, kept.rise),
            shafts=None
            if self.shafts is None or kept.shafts is None
            else self.shafts.merged(kept.shafts, mixed),
        )


def share_staying(bodies: PairCompliance, whole: Array, sides: ContactSides) -> SharedContacts:
    """Share forces over pairs and cells that stay, on shafts that each load bends or that are held where one has.

    Parameters
    ----------
    bodies : PairCompliance
    whole : (torques, ...) array
        Torques over the base radius [N].
    sides : ContactSides
        Contacts of whole pairs, on one side of the teeth or both.
    """
    face, brought, reference = sides.setups[0].face, None, None
    whole = whole + np.zeros(sides.gaps.shape[:-1])
    if face.held_under is not None:
        bent = _shares(bodies, np.full_like(whole[:1], face.held_under), sides)
        reference = _of_cells(face, *bent)
        brought = {share.forces.shape[-1]: share.forces for share in bent[1:]}
    if face.even_load:
        even = sides.share(whole)
        return SharedContacts.even(even, sides.open(even))
    return replace(_of_cells(face, *_shares(bodies, whole, sides, brought)), reference=reference)


def _shares(
    bodies: PairCompliance, whole: Array, sides: ContactSides, brought: Mapping[int, Array] | None = None
) -> tuple[CellContact, CellShare, CellShare]:
    """What is shared over the face, its share over half as many cells, and over all."""
    face = sides.setups[0].face
    few, _ = half_as_many(face)
    if sides.setups[0].helical:
        over: CellContact
        over = lines = LineContact(bodies, whole, sides, brought)
        start = lines.even
    else:
        over, start = CellContact(bodies, whole, sides, brought), sides.share(whole).forces[..., None]
    coarse = over.shared(few, start, held=False)
    coarse = over.shared(few, coarse.forces, over.gap_drops(few, coarse))
    return over, coarse, over.shared(face, coarse.forces, over.gap_drops(face, coarse))


def _of_cells(face: FaceSetting, over: CellContact, coarse: CellShare, fine: CellShare) -> SharedContacts:
    """Contacts of pairs, from the shares of their cells."""
    few, _ = half_as_many(face)
    share = of_pairs(fine.share, face.cells)
    return SharedContacts(
        share,
        fine.forces,
        settled_gaps(fine.remaining_gaps, fine.forces),
        fine.strips,
        fine.rise,
        np.zeros((2, 2, *share.forces.shape)),
        cache(partial(cell_errors, over, face, fine, coarse)),
        fine.shafts,
        **(_of_lines(over, (face, few), (fine, coarse)) if isinstance(over, LineContact) else {}),
    )


def _of_lines(
    over: LineContact, faces: tuple[FaceSetting, FaceSetting], shares: tuple[CellShare, CellShare]
) -> dict[str, Any]:
    """What lines of contact have beside: forces on fewer cells, slopes by a turn and by tilt."""
    (fine, coarse), tilting = shares, []
    for face, share in zip(faces, shares, strict=True):
        assert share.slopes is not None
        tilting.append(over.approach_and_tilt(face, share.slopes))
    assert fine.slopes is not None
    return {
        "fewer": coarse.forces,
        "slopes": fine.slopes[0].reshape(fine.forces.shape),
        "tilting": np.stack(tilting),
    }


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


def yielding_over_face(
    film: Film,
    rho1: Array,
    forces: Array,
    shares: Array,
    faces: Array | None = None,
    wet: Array | None = None,
) -> Array:
    """What films of all cells yield beyond the transmission error (positions,) [m], see ``film_yielding``.

    Along the common normal: over cos(beta_b) it is along the transmission error of a helical pair.

    Parameters
    ----------
    film : Film
        Of a whole face.
    rho1 : (positions, pairs) or (positions, pairs, cells) array
        Places of pairs, or of their cells [m]; nan where these are dry.
    forces : (positions, pairs, cells) array
        [N]
    shares : (positions, pairs) array
        Of the pairs, of the whole force.
    faces : (positions, pairs, cells) array, optional
        Force of a whole face at a cell's line load over that of the cell; the number of cells unless given.
    wet : (positions, pairs, cells) array, optional
        Part of each cell that has a film; all of it unless given.
    """
    positions, pairs, cells = forces.shape
    whole = forces.sum(axis=-1, keepdims=True)
    part = np.divide(forces, whole, out=np.zeros_like(forces), where=whole > 0.0)
    part = part if wet is None else part * wet
    flat = (positions, pairs * cells)
    places = np.repeat(rho1, cells, axis=-1) if rho1.ndim == 2 else rho1.reshape(flat)
    whole_faces = (cells if faces is None else faces.reshape(flat)) * forces.reshape(flat)
    return film_yielding(film, places, whole_faces, (shares[..., None] * part).reshape(flat))
