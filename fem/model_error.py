"""What the model of the contacts in a mesh cycle leaves out, found when it is first asked for."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.contact_candidates import REACHES
from fem.edge_tables import EdgeTables
from fem.loaded_flanks import loaded_flanks
from fem.moving_contact import contact_moves, model_error
from fem.sharing import one_sided

if TYPE_CHECKING:
    from fem.bodies import Compliance
    from fem.contact_candidates import ContactCandidates
    from fem.setting import Setting

__all__ = ["LoadedContacts"]


@record
class LoadedContacts:
    """What the model error of a mesh cycle is found from when it is first asked for: it needs third-order energies.

    Attributes
    ----------
    given : Setting
    bodies : Compliance
    where : ContactCandidates
    force : (..., pairs) array, or (cells, ..., pairs) array
        Forces times their levers over the base radius [N]; of whole faces at the line loads of the cells.
    approach : (...) array
        Deflection [m].
    load : float
        Torque over the pinion's base radius [N].
    """

    given: Setting
    bodies: Compliance
    where: ContactCandidates
    force: Array
    approach: Array
    load: float

    def model_error(self) -> float:
        """Estimate what the model of the contacts leaves out, as ``moving_contact.model_error``.

        With what the motion changes in all, by solutions of the loaded flanks with and without it: beside the corners
        that is more than along the flanks.
        """
        moves = contact_moves(self.bodies, self.where)
        if self.given.beyond_path:
            ends = contact_moves(self.bodies, self.where, corners=True)
            moves = replace(moves, cubic=ends.cubic, local=ends.local)
        moving = self.given.moving_contact
        return model_error(moves, self.force, self.approach, moving, self._changed())

    def _changed(self) -> float:
        """Greatest change of D by the motion over a base pitch; the whole of it where there is no solution."""
        if not (self.given.beyond_path and self.load):
            return 0.0
        force, found = np.array([abs(self.load)]), []
        for moving in (False, True):
            given = replace(self.given, moving_contact=moving, pitches=1, both=False)
            tables = EdgeTables(given, self.bodies)
            flanks = loaded_flanks(given, self.bodies, None, REACHES[0], float(force[0]), tables)
            solution = one_sided(given, self.bodies, force, flanks, tables)
            if not solution.settled:
                return 1.0
            found.append(solution.share.transmission_error)
        return float(np.max(np.abs(found[1] / found[0] - 1)))
