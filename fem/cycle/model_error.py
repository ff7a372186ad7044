"""What the model of the contacts in a mesh cycle leaves out, found when it is first asked for."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.contact.loaded_flanks import loaded_flanks
from fem.contact.moving_contact import ContactMoves, contact_moves, model_error
from fem.contact.solver import solve_contact, solve_one_side
from fem.laws.contact_candidates import REACHES
from fem.laws.corner_laws import CornerLaws
from fem.pair.references import held_turns

if TYPE_CHECKING:
    from fem.laws.contact_candidates import ContactCandidates
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["LoadedContacts"]


@record
class LoadedContacts:
    """What the model error of a mesh cycle is found from when it is first asked for: it needs third-order energies.

    Attributes
    ----------
    setup : MeshSetup
    bodies : PairCompliance
    candidates : ContactCandidates
    force : (cells, ..., pairs) array
        Of whole faces at the line loads of the cells [N].
    approach : (...) array
        Deflection [m].
    load : float
        Torque over the pinion's base radius [N].
    behind : (ContactCandidates, array) or None
        The flanks on the other side and their forces, where they bear.
    """

    setup: MeshSetup
    bodies: PairCompliance
    candidates: ContactCandidates
    force: Array
    approach: Array
    load: float
    behind: tuple[ContactCandidates, Array] | None = None

    @property
    def reference(self) -> str:
        """What `approach` is measured against; empty where that is not one turn for all pairs."""
        return held_turns(self.bodies)[0]

    def model_error(self) -> float:
        """Estimate what the model of the contacts leaves out, as ``moving_contact.model_error``.

        With what the motion changes in all, by solutions with and without it: beside the corners, and where flanks on
        both sides bear, that is more than along the flanks.
        """
        moving, error = self.setup.moving_contact, 0.0
        if self.behind is not None:
            candidates, force = self.behind
            law = np.abs(self._moves(candidates).thrust(force, 1)[0])
            borne = self.force.sum(axis=-1) * self.approach
            error = float(np.max(np.sum(force * law, axis=-1) / borne))
        return error + model_error(
            self._moves(self.candidates), self.force, self.approach, moving, self._changed()
        )

    def _moves(self, candidates: ContactCandidates) -> ContactMoves:
        moves = contact_moves(self.bodies, candidates)
        if not self.setup.beyond_path:
            return moves
        ends = contact_moves(self.bodies, candidates, corners=True)
        return replace(moves, cubic=ends.cubic, local=ends.local)

    def _changed(self) -> float:
        """Largest change of D by the motion over a base pitch; the whole of it where there is no solution.

        Half the change of the mean tangent, if that is more: near the end of the first order, where strained teeth
        stiffen without bound, it grows first.
        """
        both_sides = self.behind is not None
        if not both_sides and not (self.setup.beyond_path and self.load):
            return 0.0
        force, shares = np.array([abs(self.load)]), []
        for moving in (False, True):
            setup = replace(self.setup, moving_contact=moving, pitches=1, two_sided=both_sides)
            corner_laws = CornerLaws(setup, self.bodies)
            if both_sides:
                solution = solve_contact(setup, self.bodies, force, None, corner_laws)
            else:
                flanks = loaded_flanks(setup, self.bodies, None, REACHES[0], corner_laws)
                solution = solve_one_side(setup, self.bodies, force, flanks, corner_laws)
            if not solution.settled:
                return 1.0
            shares.append(solution.share)
        stays, moves = shares
        tangent = abs(float(moves.stiffness.mean() / stays.stiffness.mean()) - 1)
        deflection = np.abs(moves.transmission_error / stays.transmission_error - 1)
        return max(float(np.max(deflection)), 0.5 * tangent)
