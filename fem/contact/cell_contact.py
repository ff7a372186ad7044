"""Contact of all cells of the face of whole pairs: one active set, with strips as wide as the contact."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.contact.cell_laws import CellLaws, between_middles
from fem.contact.cell_matrix import cell_coupling
from fem.contact.partial_cells import WITHIN, gap_drops, partial_cells
from fem.elasticity.flamant import hertz_half_width
from fem.laws.local_law import FilmLaw, PairLaws
from fem.pair.face_shafts import HeldShafts, shafts_under_face
from fem.pair.wide_contact import shared_by_width

if TYPE_CHECKING:
    from fem.contact.cell_coupling import CellCoupling
    from fem.laws.contact_candidates import ContactCandidates
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.face_setting import FaceSetting
    from fem.pair.pair_compliance import PairCompliance
    from gears import GearPair, LoadShare
    from gears.sharing.staying_contacts import DeflectionLaw

__all__ = ["CellContact", "CellShare", "along_cells"]


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
    """

    share: LoadShare
    bends: Array
    remaining_gaps: Array
    strips: Array
    rise: Array
    shafts: HeldShafts | None = None

    @property
    def forces(self) -> Array:
        """On cells (torques, pitches, positions, pairs, cells) [N]."""
        return _by_cells(self.share.forces, self.remaining_gaps.shape[-1])


@record
class CellContact:
    """What is shared over the face of whole pairs, arguments as of ``gears.share_load``."""

    setup: MeshSetup
    bodies: PairCompliance
    whole: Array
    candidates: ContactCandidates
    lever_ratios: Array
    matrix: Array
    laws: PairLaws
    gaps: Array
    oil: FilmLaw | None
    tilted_lever_ratios: Array | None

    def shared(
        self, face: FaceSetting, near: Array, rise: Array | None = None, *, held: bool = True
    ) -> CellShare:
        """Share over cells of a face.

        Parameters
        ----------
        face : FaceSetting
        near : (torques, ..., pairs, parts) array
            Forces to begin with, on some parts of it [N].
        rise : (torques, ..., pairs, cells) array, optional
            By how much smallest gaps of cells fall short of their mean (`gap_drops`) [m]; otherwise cells touch all
            over or nowhere.
        held : bool
            Whether the share is measured from the first touch on shafts that are held; else it counts the shafts.
        """
        from gears.sharing.load_sharing import share_load

        cells, unit = face.cells, self.setup.pair.face_width / face.cells
        apart, film = self._apart(face), None if self.oil is None else CellLaws(self.oil, cells)
        cell_lever_ratios = (
            None if self.tilted_lever_ratios is None else np.repeat(self.tilted_lever_ratios, cells, axis=-1)
        )
        start, laws = (
            _flat(between_middles(near, cells) * (near.shape[-1] / cells)),
            CellLaws(self.laws, cells),
        )

        shafts = shafts_under_face(face, self.setup.pair)

        @lru_cache(maxsize=1)  # large ones are kept nowhere else
        def coupling(strip: float) -> tuple[CellCoupling, CellCoupling]:
            """Of the bodies, and with the shafts."""
            own = cell_coupling(
                replace(face, strip=strip), self.bodies, self.candidates, self.lever_ratios, self.matrix
            )
            return own, own if shafts is None else own.plus(shafts.compliance, self.lever_ratios)

        @lru_cache(maxsize=1)
        def law(strip: float, torques: tuple[int, ...]) -> DeflectionLaw:
            return (
                laws if rise is None else partial_cells(laws, coupling(strip)[0], _flat(rise)[list(torques)])
            )

        def share(strip: float, torques: Integers) -> LoadShare:
            alone, stiff = coupling(strip)
            own, first = (
                law(strip, tuple(torques.tolist())),
                apart if rise is None else apart - _flat(rise)[torques],
            )
            least = first.min(axis=-1)
            load_share = share_load(
                self.whole[torques],
                stiff,
                own,
                first - least[..., None],
                film,
                cell_lever_ratios,
                start[torques],
            )
            load_share = replace(load_share, transmission_error=load_share.transmission_error + least)
            return _unique(load_share, alone, own, film)

        def widest(load_share: LoadShare) -> Array:
            return self._half_widths(_by_cells(load_share.forces, cells).max(axis=-1) / unit)

        mean = self._half_widths(near.sum(axis=-1) / self.setup.pair.face_width)
        load_share, strips = shared_by_width(share, widest, unit, mean)
        bends = np.zeros_like(load_share.forces)
        slopes = np.zeros_like(bends), np.zeros_like(bends)
        for strip in np.unique(strips).tolist():
            torques = np.flatnonzero(strips == strip)
            forces = load_share.forces[torques]
            wanted, nothing = np.ones(forces.shape[:-1], dtype=bool), np.zeros_like(forces)
            alone, stiff = coupling(strip)
            bends[torques] = stiff.applied(forces, wanted, nothing)
            if held and shafts is not None:
                slope = law(strip, tuple(torques.tolist())).slope(forces)
                slope = slope if film is None else slope - film.slope(forces)
                by_tilt = nothing + shafts.levers(self.lever_ratios)
                slopes[0][torques], slopes[1][torques] = alone.solved(
                    slope, np.ones_like(forces), by_tilt, forces > 0.0, wanted
                )
        remaining_gaps = bends + apart - load_share.transmission_error[..., None]
        if film is not None:
            remaining_gaps = remaining_gaps - film.approach(np.zeros_like(load_share.forces))
        bends, remaining_gaps = _by_cells(bends, cells), _by_cells(remaining_gaps, cells)
        reached = None
        if held and shafts is not None:
            load_share, reached = shafts.held(
                load_share,
                self.lever_ratios,
                self.gaps,
                slopes,
                1.0 if cell_lever_ratios is None else cell_lever_ratios,
            )
        return CellShare(
            load_share,
            bends,
            remaining_gaps,
            strips,
            np.zeros_like(remaining_gaps) if rise is None else rise,
            reached,
        )

    def gap_drops(self, face: FaceSetting, coarse: CellShare) -> Array:
        """By how much the minimum gap of cells falls short of their mean (torques, ..., pairs, cells) [m].

        By a solution with as many cells, or fewer.
        """
        return gap_drops(face.gaps_within(self.setup.pair, self._radius, WITHIN), coarse.bends)

    def _apart(self, face: FaceSetting) -> Array:
        """Gaps without load, beyond where the first place of the face touches (pitches, positions, pairs cells) [m]."""
        apart = self.gaps[..., None] + along_cells(face, self.setup.pair, self.candidates)
        return _flat(np.where(self.candidates.touchable[..., None], apart, np.inf))

    @property
    def _radius(self) -> Array:
        return _radius(self.candidates)

    def _half_widths(self, line_load: Array) -> Array:
        """Largest half-widths of contacts of two flanks (torques,) [m] by line loads (torques, ..., pairs)."""
        flanks, modulus = (
            self.candidates.touchable & ~self.candidates.edge,
            self.bodies.pinion.law.plane_modulus,
        )
        other = self.bodies.wheel.law.plane_modulus
        load = np.where(flanks, line_load / self.lever_ratios, 0.0)
        radius = np.where(flanks, self._radius, 1.0)
        wide = hertz_half_width(load, radius, 2.0 / (1.0 / modulus + 1.0 / other))
        return np.asarray(wide.max(axis=(1, 2, 3)))

    def at(self, torque: int, pitch: int, position: int) -> CellContact:
        """The same at a single torque and position."""
        row, candidates = slice(position, position + 1), self.candidates
        return replace(
            self,
            whole=self.whole[torque : torque + 1],
            candidates=replace(
                candidates,
                rho=candidates.rho[:, row],
                touchable=candidates.touchable[row],
                edge=candidates.edge[row],
            ),
            lever_ratios=self.lever_ratios[row],
            matrix=self.matrix[row],
            laws=self.laws.at(position),
            gaps=self.gaps[pitch : pitch + 1, row],
            oil=None if self.oil is None else FilmLaw(self.oil.film, self.oil.rho1[row]),
            tilted_lever_ratios=None if self.tilted_lever_ratios is None else self.tilted_lever_ratios[row],
        )


def along_cells(face: FaceSetting, pair: GearPair, candidates: ContactCandidates) -> Array:
    """Gaps of cells beyond where the first place of the face touches (positions, pairs, cells) [m]."""
    return np.maximum(face.gaps(pair, _radius(candidates)) - face.least_gap(pair), 0.0)


def _radius(candidates: ContactCandidates) -> Array:
    rho1, rho2 = candidates.rho
    return np.asarray(rho1 * rho2 / (rho1 + rho2))


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


def _by_cells(values: Array, cells: int) -> Array:
    """(..., pairs cells) as (..., pairs, cells)."""
    return values.reshape(*values.shape[:-1], -1, cells)


def _flat(values: Array) -> Array:
    """(..., pairs, cells) as (..., pairs cells)."""
    return np.asarray(values.reshape(*values.shape[:-2], -1))
