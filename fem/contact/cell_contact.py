"""Contact of all cells of the face of whole pairs: compliances, laws, gaps and levers of cells, put together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Self, TypeAlias

import numpy as np

from base import Array, Integers, record
from fem.contact.cell_coupling import CellCoupling
from fem.contact.cell_laws import (
    WITHIN,
    CellLaws,
    between_middles,
    face_load_factors,
    gap_drops,
    greatest_error,
    partial_cells,
)
from fem.contact.cell_matrix import cell_coupling, cross_coupling
from fem.contact.cell_share import CellLaw, CellProblem, CellShare, Couplings, by_cells, flat
from fem.contact.contact_sides import ContactSides
from fem.elasticity.flamant import hertz_half_width
from fem.pair.face_shafts import ShaftsUnderFace, shafts_under_face
from fem.pair.line_shafts import ShaftsUnderLines
from fem.pair.wide_contact import shared_by_width
from gears.sharing.staying_contacts import JointLaw

if TYPE_CHECKING:
    from fem.laws.contact_candidates import ContactCandidates
    from fem.pair.face_setting import FaceSetting
    from fem.pair.pair_compliance import PairCompliance
    from gears import GearPair, LoadShare

__all__ = ["CellContact", "UnderShafts", "along_cells"]

UnderShafts: TypeAlias = ShaftsUnderFace | ShaftsUnderLines
"""Shafts under cells that lie along the face, or on lines across it."""


@record
class CellContact:
    """What is shared over the face of whole pairs.

    Attributes
    ----------
    bodies : PairCompliance
    whole : (torques, 1, 1) array
        Torques over the base radius [N].
    sides : ContactSides
        Contacts of whole pairs, on one side of the teeth or both.
    brought : mapping of int to (1, pitches, positions, pairs, cells) array, optional
        Forces that have brought the shafts where they are held, by the number of cells [N]; else the load shared does.
    """

    bodies: PairCompliance
    whole: Array
    sides: ContactSides
    brought: Mapping[int, Array] | None = None

    @property
    def pair(self) -> GearPair:
        """Gears in mesh."""
        return self.sides.setups[0].pair

    @property
    def helical(self) -> bool:
        """Whether cells lie on lines that cross the flanks."""
        return self.sides.setups[0].helical

    def faces(self, face: FaceSetting) -> tuple[FaceSetting, ...]:
        """A face of the loaded side as either side has it."""
        return (face, face.opposite(self.pair.working_pressure_angle))[: len(self.sides.flanks)]

    def coupling(self, face: FaceSetting) -> CellCoupling:
        """Compliance of the bodies between cells of all pairs."""
        parts = [cell_coupling(face, self.bodies, side.candidates, side.matrix) for side in self.sides.flanks]
        if len(parts) == 1:
            return parts[0]
        cross = self.sides.matrix[:, : self.sides.count, self.sides.count :]
        loaded, other = (side.candidates for side in self.sides.flanks)
        back = self.sides.setups[0].back
        return parts[0].beside(parts[1], cross_coupling(face, self.bodies, back, (loaded, other), cross))

    def shared(
        self, face: FaceSetting, near: Array, rise: Array | None = None, *, held: bool = True
    ) -> CellShare:
        """Share over cells of a face.

        Parameters
        ----------
        face : FaceSetting
            Of the loaded side.
        near : (torques, ..., pairs, parts) array
            Forces to begin with, on some parts of it [N].
        rise : (torques, ..., pairs, cells) array, optional
            By how much smallest gaps of cells fall short of their mean (`gap_drops`) [m]; otherwise cells touch all
            over or nowhere.
        held : bool
            Whether the share is measured from the first touch on shafts that are held; else it counts the shafts.
        """
        apart, (reach, levers) = self._apart(face), self.levers(face)
        shafts, parting = self.shafts(face), self._parting(face, len(near))
        problem = CellProblem(
            self.whole,
            flat(self.spread(face, near)),
            np.broadcast_to(apart if parting is None else apart + parting, (len(near), *apart.shape)),
            None if rise is None else flat(rise),
            reach,
            levers,
            np.repeat(self.sides.sign > 0.0, face.cells),
            *self._yielding(face, None if parting is not None else shafts, rise),
            self.films(face),
        )
        load_share, strips = self.by_width(face, near, problem.share)
        tilts, turns = self.tilts(face) if held else None, []
        if tilts is not None:
            turns.append(reach * tilts)
        if held and shafts is not None:
            turns.append(shafts.levers(len(self.sides.sign), self.sides.count))
        bends, slopes = problem.bent(load_share.forces, strips, turns)
        remaining_gaps = by_cells(problem.left(bends, load_share.transmission_error), face.cells)
        bends, reached = bends if parting is None else bends + parting, None
        if held and shafts is not None:
            load_share, reached = shafts.held(
                load_share,
                self.sides.lever_ratios,
                self.sides.gaps,
                slopes[-1],
                levers,
                self.sides.count,
                None if self.brought is None else flat(self.brought[face.cells]),
            )
        return CellShare(
            load_share,
            by_cells(bends, face.cells),
            remaining_gaps,
            strips,
            np.zeros_like(remaining_gaps) if rise is None else rise,
            reached,
            None if tilts is None else np.stack(slopes[0]),
        )

    def _yielding(
        self, face: FaceSetting, shafts: UnderShafts | None, rise: Array | None
    ) -> tuple[Couplings, CellLaw]:
        """Couplings of cells by strips, without and with shafts, and their laws; large ones are kept nowhere else."""
        laws = self.laws(face)

        @lru_cache(maxsize=1)
        def couplings(strip: float) -> tuple[CellCoupling, CellCoupling]:
            own = self.coupling(replace(face, strip=strip))
            return own, self._on_shafts(own, shafts)

        @lru_cache(maxsize=1)
        def law(strip: float, torques: tuple[int, ...]) -> JointLaw:
            if rise is None:
                return laws
            return partial_cells(laws, couplings(strip)[0], flat(rise)[list(torques)])

        return couplings, law

    def levers(self, face: FaceSetting) -> tuple[Array, Array]:
        """By how much D closes gaps of cells, below 0 where it opens them, and levers of forces (positions, n).

        Friction tilts the forces.
        """
        cells = face.cells
        reach = np.repeat(self.sides.reach, cells, axis=-1)
        return reach, np.repeat(self.sides.sign * self.sides.tilted_lever_ratios, cells, axis=-1)

    def shafts(self, face: FaceSetting) -> UnderShafts | None:
        """Shafts under the cells of a face; None where both are rigid."""
        return shafts_under_face(face, self.pair)

    def _parting(self, face: FaceSetting, torques: int) -> Array | None:
        """What held shafts part cells by along the normals (torques, ..., pairs cells) [m]; None of others."""
        shafts = self.shafts(face)
        if self.brought is None or shafts is None:
            return None
        parting = shafts.parting(flat(self.brought[face.cells]), self.sides.count)
        return np.broadcast_to(parting, (torques, *parting.shape[1:]))

    def tilts(self, face: FaceSetting) -> Array | None:
        """What a turn across the line of action closes of D at each cell (positions, n) [m]; None if not looked at."""
        del face
        return None

    def laws(self, face: FaceSetting) -> JointLaw:
        """Laws of cells that touch all over."""
        return CellLaws(self.sides.laws, face.cells)

    def films(self, face: FaceSetting) -> JointLaw | None:
        """Films of cells; None where they are dry."""
        return None if self.sides.oil is None else CellLaws(self.sides.oil, face.cells)

    def spread(self, face: FaceSetting, near: Array) -> Array:
        """Forces on parts of the pairs (torques, ..., pairs, parts) as those on cells (..., pairs, cells) [N]."""
        return np.asarray(between_middles(near, face.cells) * (near.shape[-1] / face.cells))

    def by_width(
        self, face: FaceSetting, near: Array, share: Callable[[float, Integers], LoadShare]
    ) -> tuple[LoadShare, Array]:
        """Share all torques, with strips where contacts are as wide as cells (`shared_by_width`).

        Parameters
        ----------
        face : FaceSetting
        near : (torques, ..., pairs, parts) array
            Forces to begin with [N].
        share : callable
            Shares some torques with a strip.
        """
        unit = self.pair.face_width / face.cells

        def widest(load_share: LoadShare) -> Array:
            return self._half_widths(by_cells(load_share.forces, face.cells).max(axis=-1) / unit)

        mean = self._half_widths(near.sum(axis=-1) / self.pair.face_width)
        return shared_by_width(share, widest, unit, mean)

    def line_loads(self, forces: Array) -> Array:
        """Line loads times the face width (..., loaded pairs, cells) [N], of forces on cells of all pairs."""
        return np.asarray(forces.shape[-1] * forces[..., : self.sides.count, :])

    def factors(self, loads: Array) -> Array:
        """Maximum line load (..., loaded pairs, cells) of the most loaded pair over that pair's mean (...)."""
        return face_load_factors(loads)

    def largest(self, loads: Array) -> Array:
        """Maximum (...) of line loads (..., loaded pairs, cells)."""
        return np.asarray(loads.max(axis=(-2, -1)))

    def largest_error(
        self, loads: Array, at: tuple[int, int], fewer: Array, few_at: tuple[int, int], over_mean: bool
    ) -> float:
        """Relative error of a maximum, by half as many cells.

        Parameters
        ----------
        loads, fewer : (pitches, positions, loaded pairs, cells) arrays
            Line loads.
        at, few_at : (int, int)
            Where the maximum is of either.
        over_mean : bool
            Whether the maximum is that of the factor, over the mean; else that of the loads.
        """
        first, second = self._most_loaded(loads[at], over_mean), self._most_loaded(fewer[few_at], over_mean)
        return greatest_error(first, second)

    def _most_loaded(self, here: Array, over_mean: bool) -> Array:
        """Line loads (cells,) of the pair (pairs, cells) that decides a maximum."""
        if over_mean:
            most = here[int(np.argmax(here.sum(axis=-1)))]
            return np.asarray(most / most.mean())
        return np.asarray(here[int(np.argmax(here.max(axis=-1)))])

    def centre(self, forces: Array) -> Array:
        """Centre of the load along the face (...) [m] of forces (..., pairs, cells), those of the loaded side."""
        loaded = forces[..., : self.sides.count, :]
        parts = loaded.shape[-1]
        z = ((np.arange(parts) + 0.5) / parts - 0.5) * self.pair.face_width
        whole = loaded.sum(axis=(-2, -1))
        return np.asarray((loaded.sum(axis=-2) @ z) / np.where(whole > 0.0, whole, 1.0))

    def with_doubts(self, face: FaceSetting, coarse: CellShare) -> dict[str, CellShare]:
        """Shares of gears that are off by each doubt of them (``HelixEnds.off_by``); none of spur pairs.

        Parameters
        ----------
        face : FaceSetting
            Of the loaded side.
        coarse : CellShare
            On that face.
        """
        del face, coarse
        return {}

    def gap_drops(self, face: FaceSetting, coarse: CellShare) -> Array:
        """By how much the minimum gap of cells falls short of their mean (torques, ..., pairs, cells) [m].

        By a solution with as many cells, or fewer.
        """
        return gap_drops(self._over_sides(face, _gaps_within), coarse.bends)

    def open(self, face: FaceSetting, forces: Array, approach: Array) -> Array:
        """Gaps that forces leave, each the smallest of its cell (torques, ..., pairs, cells) [m].

        Parameters
        ----------
        face : FaceSetting
            Of the loaded side.
        forces : (torques, pitches, positions, pairs, cells) array
            [N]
        approach : (torques, pitches, positions) array
            D, with what shafts give way [m].
        """
        loads, (reach, _) = flat(forces), self.levers(face)
        wanted, parting = np.ones(loads.shape[:-1], dtype=bool), self._parting(face, len(loads))
        coupling = self._on_shafts(self.coupling(face), self.shafts(face) if parting is None else None)
        bends = coupling.applied(loads, wanted, np.zeros_like(loads))
        bends = bends if parting is None else bends + parting
        gaps, film = bends + self._apart(face) - reach * approach[..., None], self.films(face)
        if film is not None:
            gaps = gaps - film.approach(np.zeros_like(loads))
        drops = gap_drops(self._over_sides(face, _gaps_within), by_cells(bends, face.cells))
        return np.asarray(by_cells(gaps, face.cells) - drops)

    def _on_shafts(self, coupling: CellCoupling, shafts: UnderShafts | None) -> CellCoupling:
        """A compliance of the bodies with that of the shafts."""
        if shafts is None:
            return coupling
        if isinstance(shafts, ShaftsUnderLines):
            blocks = zip(coupling.blocks, shafts.compliances(), strict=True)
            return CellCoupling(
                coupling.cells, tuple(bodies + beams for bodies, beams in blocks), coupling.unknowns
            )
        return coupling.plus(shafts.compliance, self.sides.count)

    def _apart(self, face: FaceSetting) -> Array:
        """Gaps without load, beyond where the first place of the face touches (pitches, positions, pairs cells) [m]."""
        apart = self.sides.gaps[..., None] + self._over_sides(face, along_cells)
        return flat(np.where(self.sides.touchable[..., None], apart, np.inf))

    def _over_sides(
        self, face: FaceSetting, along: Callable[[FaceSetting, GearPair, ContactCandidates], Array]
    ) -> Array:
        """What gaps along the face are, along the normals of all pairs (positions, pairs, places)."""
        sides = zip(self.faces(face), self.sides.flanks, strict=True)
        gaps = np.concatenate([along(each, self.pair, side.candidates) for each, side in sides], axis=1)
        return np.asarray(self.sides.lever_ratios[..., None] * gaps)

    def _half_widths(self, line_load: Array) -> Array:
        """Largest half-widths of contacts of two flanks (torques,) [m] by line loads (torques, ..., pairs)."""
        flanks, modulus = self.sides.on_flank, self.bodies.pinion.law.plane_modulus
        other = self.bodies.wheel.law.plane_modulus
        load = np.where(flanks, line_load, 0.0)
        radius = np.where(flanks, self.sides.radius, 1.0)
        wide = hertz_half_width(load, radius, 2.0 / (1.0 / modulus + 1.0 / other))
        return np.asarray(wide.max(axis=(1, 2, 3)))

    def at(self, torque: int, pitch: int, position: int) -> Self:
        """The same at a single torque and position."""
        whole = np.broadcast_to(self.whole, (len(self.whole), *self.sides.gaps.shape[:-1]))
        single = whole[torque, pitch, position].reshape(1, 1, 1)
        here = slice(pitch, pitch + 1), slice(position, position + 1)
        brought = self.brought and {cells: forces[:, *here] for cells, forces in self.brought.items()}
        return replace(self, whole=single, sides=self.sides.at(pitch, position), brought=brought)


def along_cells(face: FaceSetting, pair: GearPair, candidates: ContactCandidates) -> Array:
    """Gaps of cells beyond where the first place of the face touches (positions, pairs, cells) [m]."""
    least = np.asarray(face.least_gap(pair, candidates.rho))
    return np.asarray(np.maximum(face.gaps(pair, candidates.rho) - least[..., None], 0.0))


def _gaps_within(face: FaceSetting, pair: GearPair, candidates: ContactCandidates) -> Array:
    """Gaps at equal distances along the face (positions, pairs, places) [m]."""
    return face.gaps_within(pair, candidates.rho, WITHIN)
