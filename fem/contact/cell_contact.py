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
    from gears.sharing.load_sharing import DeflectionLaw

__all__ = ["CellContact", "CellShare", "along_cells"]


@record
class CellShare:
    """Share of cells.

    Attributes
    ----------
    share : LoadShare
        (torques, pitches, positions, pairs cells).
    bends, left : (torques, pitches, positions, pairs, cells) arrays
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
    left: Array
    strips: Array
    rise: Array
    shafts: HeldShafts | None = None

    @property
    def forces(self) -> Array:
        """On cells (torques, pitches, positions, pairs, cells) [N]."""
        return _by_cells(self.share.forces, self.left.shape[-1])


@record
class CellContact:
    """What is shared over the face of whole pairs, arguments as of ``gears.share_load``."""

    given: MeshSetup
    bodies: PairCompliance
    whole: Array
    where: ContactCandidates
    kappa: Array
    matrix: Array
    laws: PairLaws
    gaps: Array
    oil: FilmLaw | None
    levers: Array | None

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

        cells, unit = face.cells, self.given.pair.face_width / face.cells
        apart, film = self._apart(face), None if self.oil is None else CellLaws(self.oil, cells)
        arms = None if self.levers is None else np.repeat(self.levers, cells, axis=-1)
        start, laws = (
            _flat(between_middles(near, cells) * (near.shape[-1] / cells)),
            CellLaws(self.laws, cells),
        )

        shafts = shafts_under_face(face, self.given.pair)

        @lru_cache(maxsize=1)  # large ones are kept nowhere else
        def coupling(strip: float) -> tuple[CellCoupling, CellCoupling]:
            """Of the bodies, and with the shafts."""
            own = cell_coupling(replace(face, strip=strip), self.bodies, self.where, self.kappa, self.matrix)
            return own, own if shafts is None else own.plus(shafts.compliance, self.kappa)

        @lru_cache(maxsize=1)
        def law(strip: float, some: tuple[int, ...]) -> DeflectionLaw:
            return laws if rise is None else partial_cells(laws, coupling(strip)[0], _flat(rise)[list(some)])

        def share(strip: float, some: Integers) -> LoadShare:
            alone, stiff = coupling(strip)
            own, first = (
                law(strip, tuple(some.tolist())),
                apart if rise is None else apart - _flat(rise)[some],
            )
            least = first.min(axis=-1)
            found = share_load(
                self.whole[some], stiff, own, first - least[..., None], film, arms, start[some]
            )
            found = replace(found, transmission_error=found.transmission_error + least)
            return _unique(found, alone, own, film)

        def widest(found: LoadShare) -> Array:
            return self._half_widths(_by_cells(found.forces, cells).max(axis=-1) / unit)

        mean = self._half_widths(near.sum(axis=-1) / self.given.pair.face_width)
        found, strips = shared_by_width(share, widest, unit, mean)
        bends = np.zeros_like(found.forces)
        slopes = np.zeros_like(bends), np.zeros_like(bends)
        for strip in np.unique(strips).tolist():
            some = np.flatnonzero(strips == strip)
            forces = found.forces[some]
            every, nothing = np.ones(forces.shape[:-1], dtype=bool), np.zeros_like(forces)
            alone, stiff = coupling(strip)
            bends[some] = stiff.applied(forces, every, nothing)
            if held and shafts is not None:
                slope = law(strip, tuple(some.tolist())).slope(forces)
                slope = slope if film is None else slope - film.slope(forces)
                by_tilt = nothing + shafts.levers(self.kappa)
                slopes[0][some], slopes[1][some], _ = alone.solved(slope, by_tilt, forces > 0.0, every)
        left = bends + apart - found.transmission_error[..., None]
        if film is not None:
            left = left - film.approach(np.zeros_like(found.forces))
        bends, left = _by_cells(bends, cells), _by_cells(left, cells)
        reached = None
        if held and shafts is not None:
            found, reached = shafts.held(found, self.kappa, self.gaps, slopes, 1.0 if arms is None else arms)
        return CellShare(found, bends, left, strips, np.zeros_like(left) if rise is None else rise, reached)

    def gap_drops(self, face: FaceSetting, coarse: CellShare) -> Array:
        """By how much the minimum gap of cells falls short of their mean (torques, ..., pairs, cells) [m].

        By a solution with as many cells, or fewer.
        """
        return gap_drops(face.gaps_within(self.given.pair, self._radius, WITHIN), coarse.bends)

    def _apart(self, face: FaceSetting) -> Array:
        """Gaps without load, beyond where the first place of the face touches (pitches, positions, pairs cells) [m]."""
        apart = self.gaps[..., None] + along_cells(face, self.given.pair, self.where)
        return _flat(np.where(self.where.touchable[..., None], apart, np.inf))

    @property
    def _radius(self) -> Array:
        return _radius(self.where)

    def _half_widths(self, line_load: Array) -> Array:
        """Largest half-widths of contacts of two flanks (torques,) [m] by line loads (torques, ..., pairs)."""
        flanks, modulus = self.where.touchable & ~self.where.edge, self.bodies.pinion.law.plane_modulus
        other = self.bodies.wheel.law.plane_modulus
        load = np.where(flanks, line_load / self.kappa, 0.0)
        radius = np.where(flanks, self._radius, 1.0)
        wide = hertz_half_width(load, radius, 2.0 / (1.0 / modulus + 1.0 / other))
        return np.asarray(wide.max(axis=(1, 2, 3)))

    def at(self, torque: int, pitch: int, position: int) -> CellContact:
        """The same at a single torque and position."""
        one, where = slice(position, position + 1), self.where
        return replace(
            self,
            whole=self.whole[torque : torque + 1],
            where=replace(where, rho=where.rho[:, one], touchable=where.touchable[one], edge=where.edge[one]),
            kappa=self.kappa[one],
            matrix=self.matrix[one],
            laws=self.laws.at(position),
            gaps=self.gaps[pitch : pitch + 1, one],
            oil=None if self.oil is None else FilmLaw(self.oil.film, self.oil.rho1[one]),
            levers=None if self.levers is None else self.levers[one],
        )


def along_cells(face: FaceSetting, pair: GearPair, where: ContactCandidates) -> Array:
    """Gaps of cells beyond where the first place of the face touches (positions, pairs, cells) [m]."""
    return np.maximum(face.gaps(pair, _radius(where)) - face.least_gap(pair), 0.0)


def _radius(where: ContactCandidates) -> Array:
    rho1, rho2 = where.rho
    return np.asarray(rho1 * rho2 / (rho1 + rho2))


def _unique(
    found: LoadShare, coupling: CellCoupling, laws: DeflectionLaw, film: DeflectionLaw | None
) -> LoadShare:
    """Return a share of cells that no other one stands beside, which wider strips else have.

    Laws of contacts that a tip corner cuts off may fall by the load, as far as the tooth in the plane yields more than
    that; in short waves along the face it yields less.
    """
    from gears.tooth.errors import LoadSharingError

    slope, bears = laws.slope(found.forces), found.forces > 0.0
    if film is not None:
        slope = slope - film.slope(found.forces)
    if not coupling.definite(slope, bears, np.any(bears & (slope < 0.0), axis=-1)):
        allowed = "must yield to short waves of load beside a tip corner, which these do not"
        raise LoadSharingError.at(
            "cells", coupling.unknowns, allowed, "reduce the torque, or give fewer cells"
        )
    return found


def _by_cells(values: Array, cells: int) -> Array:
    """(..., pairs cells) as (..., pairs, cells)."""
    return values.reshape(*values.shape[:-1], -1, cells)


def _flat(values: Array) -> Array:
    """(..., pairs, cells) as (..., pairs cells)."""
    return np.asarray(values.reshape(*values.shape[:-2], -1))
