"""Share of the load among cells: one active set over all of them, with strips as wide as the contact."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from base import Array, Booleans, Integers, record
from fem.contact.cell_coupling import CellCoupling
from gears.sharing.active_set import share_forces
from gears.sharing.central_path import share_forces_by_path
from gears.sharing.staying_contacts import DeflectionLaw, JointLaw, StayingContacts

if TYPE_CHECKING:
    from fem.pair.face_shafts import HeldShafts
    from gears import LoadShare

__all__ = ["CellLaw", "CellProblem", "CellShare", "Couplings", "by_cells", "flat"]

Couplings: TypeAlias = Callable[[float], tuple[CellCoupling, CellCoupling]]
"""Of the bodies, and with their shafts, by the half-width of strips over a cell's length."""

CellLaw: TypeAlias = Callable[[float, tuple[int, ...]], JointLaw]
"""Law of cells, by that half-width and the numbers of torques."""


@record
class CellShare:
    """Share of cells.

    Attributes
    ----------
    share : LoadShare
        (torques, pitches, positions, pairs cells).
    bends, remaining_gaps : (torques, pitches, positions, pairs, cells) arrays
        How far bodies bend, and the gap that is so left under load [m]; where a cell bears, minus what the contact's
        own law yields.
    strips : (torques,) array
        Half-widths of strips of pressure over a cell's length (``fem.pair.wide_contact``).
    rise : (torques, pitches, positions, pairs, cells) array
        By how much smallest gaps of cells fall short of their mean [m]; 0 where cells touch all over or nowhere.
    shafts : HeldShafts or None
        From whose first touch the share is measured; None where they are rigid.
    slopes : (2, torques, pitches, positions, pairs cells) array or None
        Of forces on cells by D and by a turn across the line of action (`CellContact.tilts`), without shafts [N/m, N].
    """

    share: LoadShare
    bends: Array
    remaining_gaps: Array
    strips: Array
    rise: Array
    shafts: HeldShafts | None = None
    slopes: Array | None = None

    @property
    def forces(self) -> Array:
        """On cells (torques, pitches, positions, pairs, cells) [N]."""
        return by_cells(self.share.forces, self.remaining_gaps.shape[-1])


@record
class CellProblem:
    """Cells of a face under all torques, in one row.

    Attributes
    ----------
    whole : (torques, ...) array
        Torques over the base radius [N].
    start : (torques, ..., n) array
        Forces to begin with [N].
    apart : (torques, ..., n) array
        Gaps without load, beyond where the first place touches [m].
    rise : (torques, ..., n) array or None
        As of ``CellShare``; None where cells touch all over or nowhere.
    reach, levers : (positions, n) arrays
        By how much D closes gaps, and levers of forces.
    ahead : (n,) boolean array
        Cells on the loaded side.
    couplings, law
        What cells yield.
    film : JointLaw or None
        None where they are dry.
    """

    whole: Array
    start: Array
    apart: Array
    rise: Array | None
    reach: Array
    levers: Array
    ahead: Booleans
    couplings: Couplings
    law: CellLaw
    film: JointLaw | None

    def share(self, strip: float, torques: Integers) -> LoadShare:
        """Share of some torques with strips of a half-width over a cell's length, 0 for lines."""
        alone, stiff = self.couplings(strip)
        law = self.law(strip, tuple(torques.tolist()))
        first = self.apart[torques] if self.rise is None else self.apart[torques] - self.rise[torques]
        # the turn is counted from the first touch, so that small ones keep their digits beside gaps
        least = (first / self.reach)[..., self.ahead].min(axis=-1)
        gaps = first - self.reach * least[..., None]
        contacts = StayingContacts(stiff, law, self.film, gaps, self.reach, self.levers)
        load_share = _settled(contacts, stiff, self.whole[torques], self.start[torques])
        load_share = replace(load_share, transmission_error=load_share.transmission_error + least)
        return _unique(load_share, alone, law, self.film)

    def bent(
        self, forces: Array, strips: Array, turns: Sequence[Array]
    ) -> tuple[Array, list[tuple[Array, Array]]]:
        """How far bodies and shafts bend (torques, ..., n) [m], and slopes of the forces on shafts that are held.

        Parameters
        ----------
        forces : (torques, ..., n) array
            [N]
        strips : (torques,) array
            As of ``CellShare``.
        turns : sequence of (..., n) arrays
            What further turns close gaps by: for each there are slopes by D and by it.
        """
        bends = np.zeros_like(forces)
        slopes = [(np.zeros_like(forces), np.zeros_like(forces)) for _ in turns]
        for strip in np.unique(strips).tolist():
            torques = np.flatnonzero(strips == strip)
            loads = forces[torques]
            wanted, nothing = np.ones(loads.shape[:-1], dtype=bool), np.zeros_like(loads)
            alone, stiff = self.couplings(strip)
            bends[torques] = stiff.applied(loads, wanted, nothing)
            if not turns:
                continue
            slope = self.law(strip, tuple(torques.tolist())).slope(loads)
            slope = slope if self.film is None else slope - self.film.slope(loads)
            for turn, (by_approach, by_turn) in zip(turns, slopes, strict=True):
                by_approach[torques], by_turn[torques] = alone.solved(
                    slope, self.reach + nothing, turn + nothing, loads > 0.0, wanted
                )
        return bends, slopes

    def left(self, bends: Array, approach: Array) -> Array:
        """Gaps that bends (torques, ..., n) and the turn D (torques, ...) leave under load (torques, ..., n) [m]."""
        gaps = bends + self.apart - self.reach * approach[..., None]
        return gaps if self.film is None else gaps - self.film.approach(np.zeros_like(bends))


def _settled(contacts: StayingContacts, coupling: CellCoupling, whole: Array, start: Array) -> LoadShare:
    """Share of cells, from forces to begin with; along the central path where cells come and go in circles."""
    from gears.tooth.errors import LoadSharingError

    whole = whole + np.zeros(start.shape[:-1])
    share = share_forces(contacts, whole, start, None)
    if share is None and (share := share_forces_by_path(contacts, whole, start)) is not None:
        slope, everywhere = contacts.laws(share.forces)[1], np.ones(whole.shape, dtype=bool)
        share = share if coupling.definite(slope, share.forces > 0.0, everywhere) else None
    if share is None:
        allowed = "must have deflections that grow with the force"
        raise LoadSharingError.at("cells", "no solution", allowed, "give fewer cells, or more torque")
    return share


def _unique(
    load_share: LoadShare, coupling: CellCoupling, laws: DeflectionLaw, film: DeflectionLaw | None
) -> LoadShare:
    """Return a share of cells that no other one stands beside, which wider strips else have.

    Laws of contacts that a tip corner cuts off may fall by the load, as far as the tooth in the plane yields more than
    that; in short waves along the face it yields less.
    """
    from gears.tooth.errors import LoadSharingError

    slope, bears = laws.slope(load_share.forces), load_share.forces > 0.0
    if film is not None:
        slope = slope - film.slope(load_share.forces)
    if not coupling.definite(slope, bears, np.any(bears & (slope < 0.0), axis=-1)):
        allowed = "must yield to short waves of load beside a tip corner, which these do not"
        raise LoadSharingError.at(
            "cells", coupling.unknowns, allowed, "reduce the torque, or give fewer cells"
        )
    return load_share


def by_cells(values: Array, cells: int) -> Array:
    """(..., pairs cells) as (..., pairs, cells)."""
    return values.reshape(*values.shape[:-1], -1, cells)


def flat(values: Array) -> Array:
    """(..., pairs, cells) as (..., pairs cells)."""
    return np.asarray(values.reshape(*values.shape[:-2], -1))
