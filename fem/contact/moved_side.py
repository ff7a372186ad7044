"""Flanks of one side of the teeth whose contacts move: what they are solved with."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.contact.cell_contact import along_cells
from fem.contact.cell_laws import CellLaws, PartialCells, partial_cells
from fem.contact.cell_matrix import cell_coupling
from fem.contact.loaded_flanks import LoadedFlanks
from fem.contact.moving_contact import ContactMoves, contact_moves, moved_places
from fem.contact.moving_contacts import MovingContacts
from fem.contact.moving_corners import MovedFlanks, moved_flanks
from fem.contact.moving_coupling import cell_roll, other_pairs, tooth_smoothing
from fem.laws.local_law import PairLaws
from fem.laws.mesh_setup import MeshSetup
from gears.sharing.load_coupling import Coupling, DenseCoupling

if TYPE_CHECKING:
    from fem.laws.corner_laws import CornerLaws
    from fem.pair.pair_compliance import PairCompliance
    from gears.sharing.staying_contacts import JointLaw

__all__ = ["MovedSide", "moved_side"]


@record
class MovedSide:
    """Flanks on one side whose contacts move.

    Attributes
    ----------
    setup : MeshSetup
    flanks : LoadedFlanks
        Of contacts that stay.
    moves : ContactMoves
    own : MovedFlanks or None
        Of the corners.
    """

    setup: MeshSetup
    flanks: LoadedFlanks
    moves: ContactMoves
    own: MovedFlanks | None

    @property
    def lever_ratios(self) -> Array:
        """Of the normals at D = 0 (positions, pairs), where what corners add by D is not counted yet."""
        return self.flanks.lever_ratios if self.own is None else self.own.lever_ratios

    @property
    def tilted_lever_ratios(self) -> Array:
        """The same of the forces."""
        return np.asarray(self.flanks.tilted_lever_ratios - self.turned_levers())

    @property
    def matrix(self) -> Array:
        """Compliance that does not depend on D (positions, pairs, pairs) [m/N]."""
        return self.flanks.matrix if self.own is None else self.own.matrix

    @property
    def laws(self) -> PairLaws:
        """Laws of each contact that do not depend on D."""
        return self.flanks.laws if self.own is None else self.own.laws

    @property
    def gaps(self) -> Array:
        """Beyond the first touch (pitches, positions, pairs), without those of corners that move [m]."""
        return self.flanks.gaps if self.own is None else self.own.gaps

    def contacts(self, bodies: PairCompliance, rise: Array, strip: float = 0.0) -> MovingContacts:
        """Put the contacts together; cells that touch over a part of their length do as those that stay.

        Parameters
        ----------
        bodies : PairCompliance
        rise : (torques, pitches, positions, pairs, cells) array
            By how much smallest gaps of cells fall short of their mean [m].
        strip : float
            Half-width of strips of pressure over a cell's length.
        """
        face, flanks, candidates = replace(self.setup.face, strip=strip), self.flanks, self.flanks.candidates
        gaps, along = self.gaps, along_cells(face, self.setup.pair, candidates)
        touchable = np.repeat(candidates.touchable & np.isfinite(candidates.gap), face.cells, axis=-1)
        short = rise.reshape(*rise.shape[:-2], -1)
        clear = np.where(np.isfinite(gaps), gaps, 0.0)[..., None] + self.lever_ratios[..., None] * along
        laws: JointLaw = CellLaws(self.laws, face.cells)
        # those of all positions are solved together where they are few
        coupling: Coupling = DenseCoupling(self.matrix)
        roll: Coupling = DenseCoupling(self.moves.roll)
        if not face.even_load:
            stiff = cell_coupling(face, bodies, candidates, flanks.matrix)
            coupling = other_pairs(stiff, candidates.touchable, self.matrix - flanks.matrix)
            roll = cell_roll(face, bodies, candidates, self.moves)
            stays = partial_cells(CellLaws(flanks.laws, face.cells), stiff, short)
            laws = PartialCells(CellLaws(self.laws, face.cells), short, stays.whole)
        return MovingContacts(
            face.cells,
            coupling,
            roll,
            laws,
            None if flanks.oil is None else CellLaws(flanks.oil, face.cells),
            np.where(touchable, clear.reshape(*gaps.shape[:-1], -1) - short, 0.0),
            along.reshape(*along.shape[:-2], -1),
            face.first_gap(self.setup.pair, candidates.rho, candidates.touchable),
            touchable,
            self.lever_ratios,
            self.tilted_lever_ratios,
            self.moves,
            tooth_smoothing(face, bodies, candidates),
            self.own,
        )

    @property
    def sides(self) -> tuple[MovedSide]:
        """It alone."""
        return (self,)

    def turned_levers(self) -> Array:
        """Part of the pinion's base radius by which levers about the wheel's axis are longer (positions, pairs)."""
        return np.asarray(self.flanks.lever_ratios - self.lever_ratios)

    def rho(self, force: Array, approach: Array) -> Array:
        """Curvature radii where pinion and wheel are touched (2, pitches, positions, pairs) [m].

        Parameters
        ----------
        force : (pitches, positions, pairs) array
            [N]
        approach : (pitches, positions) array
            By how much the pinion has turned [m].
        """
        candidates = self.flanks.candidates
        rho = np.repeat(candidates.rho[:, None], len(force), axis=1)
        rho = rho + np.where(candidates.edge, 0.0, moved_places(self.moves, force, approach))
        if self.own is not None:
            rho = np.where(candidates.edge, self.own.edge_rho(self.flanks, self.setup, approach), rho)
        ends = [profile.flank_rho for profile in self.setup.pair.teeth_profiles]
        return np.stack([np.clip(radii, *end) for radii, end in zip(rho, ends, strict=True)])


def moved_side(
    setup: MeshSetup, bodies: PairCompliance, flanks: LoadedFlanks, corner_laws: CornerLaws
) -> MovedSide:
    """Flanks of one side with contacts that move; arguments as for ``loaded_flanks``."""
    own = None
    if setup.beyond_path:
        own = moved_flanks(setup, bodies, flanks, corner_laws)
    return MovedSide(setup, flanks, contact_moves(bodies, flanks.candidates, setup.beyond_path), own)
