"""State of the loaded contact under all torques: forces, gaps, levers, and what is not to be believed."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.contact.loaded_flanks import FlanksInPlace, LoadedFlanks
from fem.contact.moved_side import MovedSide
from fem.contact.moving_corners import DEEPEST
from fem.contact.shared_contacts import SharedContacts
from fem.laws.line_friction import further_levers
from fem.laws.mesh_setup import MeshSetup

if TYPE_CHECKING:
    from fem.contact.contact_sides import ContactSides
    from fem.laws.contact_candidates import ContactCandidates
    from fem.pair.pair_compliance import PairCompliance
    from gears import LoadShare

__all__ = ["ContactState", "contact_state"]

FAR_APART = 0.5
"""Deflection of shafts in modules above which teeth mesh on another path."""

LIMITS = (
    "a tip edge presses over more than the strips cover, or closes a gap of more than half a module; reduce the torque "
    "or the deviations",
    "the deflection closes gaps more than a base pitch outside the path, where no contact was looked for; reduce the "
    "torque or the deviations",
    "a chamfer's face touches before its corner does, for which there is no law; reduce the torque",
)
"""What the flanks that a torque loads must not do."""

LIMITS_BEHIND = (
    "a tip edge of a back flank presses over more than the strips cover, or closes a gap of more than half a module; "
    "give more backlash",
    "back flanks overlap by more than was looked for outside the path; give more backlash",
    "the face of a chamfer touches on a back flank, for which there is no law; give more backlash",
)
"""The same of those on the other side."""


@record
class ContactState:
    """Contacts on one side of the teeth, solved for all torques; those on the other side are seen in the mirror.

    Leading dimensions of shares are (torques, pitches, positions).

    Attributes
    ----------
    setup : MeshSetup
        With these flanks loaded.
    flanks : FlanksInPlace
    side : MovedSide or None
        What moving contacts are solved with; None where contacts stay.
    contacts : SharedContacts
        Forces, and the turn that closes gaps on this side; of contacts that stay where moving ones did not settle.
    closing : (torques, pitches, positions) array
        That turn without the wind-up of the hubs [m].
    settled : bool
        Whether moving contacts converged.
    rest : (pitches, positions) array or 0.0
        Turn without torque, from where the loaded flanks touch: not 0 where teeth overlap that are pressed together
        [m].
    unshared : tuple of int
        Numbers of the torques for which no load sharing of both sides was found.
    opposite : ContactState or None
        Flanks on the other side, where they were looked at.
    """

    setup: MeshSetup
    flanks: FlanksInPlace
    side: MovedSide | None
    contacts: SharedContacts
    closing: Array
    settled: bool = True
    rest: Array | float = 0.0
    unshared: tuple[int, ...] = ()
    opposite: ContactState | None = None

    @property
    def candidates(self) -> ContactCandidates:
        """Contacts that may bear."""
        return self.flanks.candidates

    @property
    def share(self) -> LoadShare:
        """Share of the pairs."""
        return self.contacts.share

    @property
    def bears(self) -> bool:
        """Whether a flank on this side bears anywhere."""
        return bool(np.any(self.share.forces > 0.0))

    @property
    def touch(self) -> Array:
        """Transmission error at which the gears touch without load (pitches, positions) [m]."""
        return np.asarray(self.candidates.gap.min(axis=-1))

    def deflection(self, number: int) -> Array:
        """Turn under a torque less that without any, on shafts that are held (pitches, positions) [m]."""
        return np.asarray(self.share.transmission_error[number] - self.rest)

    def bent(self, number: int) -> Array | float:
        """By how much more the pinion turns before flanks touch (pitches, positions) [m], because of the shafts."""
        shafts = self.contacts.shafts
        return 0.0 if shafts is None else shafts.touch[number]

    def turn(self, number: int) -> Array:
        """Turn of the pinion under a torque, from where gears without deviations touch (pitches, positions) [m]."""
        return np.asarray(self.share.transmission_error[number] + self.bent(number) + self.touch)

    def cell_forces(self, number: int) -> Array:
        """Normal forces on cells under a torque (pitches, positions, pairs, cells) [N]."""
        return np.asarray(self.contacts.forces[number])

    def moments(self, number: int) -> tuple[Array, Array]:
        """Sums of forces, and of their slopes by D, by their levers about both gears (2, positions).

        In the first pitch; flanks on the other side turn the gears the other way.
        """
        forces, slopes = self._levered(number)
        if self.opposite is not None:
            back_forces, back_slopes = self.opposite._levered(number)
            forces, slopes = forces - back_forces, slopes + back_slopes
        return forces, slopes

    def _levered(self, number: int) -> tuple[Array, Array]:
        """The same of this side, slopes by the turn that closes its gaps."""
        parts = zip(
            (self.share.forces[number, 0], self.share.pair_stiffness[number, 0]),
            self.lever_loss(number)[:, :, 0],
            strict=True,
        )
        first, second = (
            np.sum((np.where(each != 0.0, self.candidates.lever, 0.0) - lost) * each, axis=-1)
            for each, lost in parts
        )
        return first, second

    def lever_loss(self, number: int) -> Array:
        """Parts of both base radii by which levers of forces, and of further ones, are shorter.

        (2, 2, pitches, positions, pairs), nothing for contacts that stay: half of what tilted flanks take from further
        forces, and what the pinion's corner gains by the turn D.
        """
        return self.contacts.lost[:, :, number]

    def torques(self, number: int) -> Array:
        """Torque of each pair over the pinion's base radius (pitches, positions, pairs) [N]."""
        levers = self.flanks.tilted_lever_ratios - self.lever_loss(number)[0, 0]
        return np.asarray(self.share.forces[number] * levers + self.by_cells(number))

    def by_cells(self, number: int) -> Array:
        """What friction and tip edges, which differ from cell to cell, add to these (pitches, positions, pairs) [N]."""
        lines, forces = self.candidates.lines, self.cell_forces(number)
        if lines is None:
            return np.zeros(forces.shape[:-1])
        return np.asarray((forces * further_levers(self.setup, lines, forces.shape[-1])).sum(axis=-1))

    def flank_rho(self, number: int) -> Array:
        """Curvature radii where pinion and wheel are touched (2, pitches, positions, pairs) [m], untouched ones too."""
        force, approach = self.share.forces[number], self.share.transmission_error[number]
        if self.side is None:
            return np.repeat(self.candidates.rho[:, None], len(force), axis=1)
        radii, touchable = self.candidates.rho, self.candidates.touchable
        first = self.setup.face.first_gap(self.setup.pair, radii, touchable)
        return self.side.rho(force, approach + (first + self.bent(number)))

    def tilted(self, number: int) -> Array | float:
        """By how much shafts close gaps elsewhere on the face than at the first touch (pitches, positions) [m]."""
        shafts = self.contacts.shafts
        return 0.0 if shafts is None else shafts.most[number] * self.setup.pair.module - shafts.touch[number]

    def shafts_give_way(self, number: int) -> float:
        """Maximum deflection of both shafts on the face over the module; 0 of rigid ones."""
        shafts = self.contacts.shafts
        return 0.0 if shafts is None else float(np.max(shafts.most[number]))

    def refusal(self, number: int) -> str:
        """Why the solution for a torque is not to be believed, empty if it is."""
        if not self.settled:
            most = 1e3 * np.max(self.share.transmission_error)
            return (
                f"a deflection of {most:.2g} mm is far beyond the first order of contacts that move, in which strained "
                "teeth stiffen without bound; reduce the torque, or let contacts stay"
            )
        if (far := self.shafts_give_way(number)) > FAR_APART:
            return (
                f"the shafts give way by {far:.2g} modules along the line of action, on which the teeth no longer mesh "
                "as they do; give stiffer shafts or bearings, bring them nearer to the gears, or reduce the torque"
            )
        deepest = float(np.max(self.share.transmission_error[number]))
        corners = self.side is not None and self.side.own is not None
        if corners and deepest > DEEPEST * self.setup.pair.module:
            return (
                f"a deflection of {1e3 * deepest:.2g} mm is more than a quarter of the module, up to which corners "
                "that move have laws; reduce the torque, or let contacts stay"
            )
        return self._beyond(number, LIMITS) or self._refused_with_opposite(number)

    def _refused_with_opposite(self, number: int) -> str:
        """Why flanks on both sides are not to be believed together."""
        other = self.opposite
        if other is None:
            return ""
        if number in self.unshared:
            return "no load sharing with back flanks was found; give more backlash, or reduce the torque"
        return other._beyond(number, LIMITS_BEHIND)

    def _beyond(self, number: int, limits: tuple[str, str, str]) -> str:
        """Which limit of the laws or of the candidates is passed, empty if none is."""
        candidates, forces = self.candidates, self.share.forces[number]
        if np.max(self.closing[number] + self.touch) > candidates.reach_gap:
            return limits[1]
        largest = self.flanks.largest if isinstance(self.flanks, LoadedFlanks) else 0.0
        if candidates.edge.any() and np.any(forces[..., candidates.edge] > largest):
            return limits[0]
        return limits[2] if np.any(forces[..., candidates.chamfered] > 0.0) else ""


def contact_state(
    bodies: PairCompliance,
    force: Array,
    sides: ContactSides,
    contacts: SharedContacts,
    moved: tuple[MovedSide, ...] = (),
    *,
    settled: bool = True,
    rest: Array | float = 0.0,
    unshared: tuple[int, ...] = (),
) -> ContactState:
    """Solution of one side of the teeth, or of both.

    Parameters
    ----------
    bodies : PairCompliance
    force : (torques,) array
        [N]
    sides : ContactSides
    contacts : SharedContacts
        Of the pairs on all sides, one after the other.
    moved : tuple of MovedSide
        Of each side; none where contacts stay.
    settled, rest, unshared
        As of ``ContactState``.
    """
    turn, count, shafts = contacts.share.transmission_error, sides.count, contacts.shafts
    play = sides.play if shafts is None else sides.play + shafts.touch + shafts.behind
    ways = ((slice(count), turn, 1.0), (slice(count, None), -(turn + play), -1.0))
    states = [
        ContactState(
            setup,
            flanks,
            side,
            contacts.of_side(pairs, approach, sign),
            approach - sign * (bodies.turning * force[:, None, None]),
            settled,
            rest,
            unshared,
        )
        for setup, flanks, side, (pairs, approach, sign) in zip(
            sides.setups, sides.flanks, moved or (None, None), ways, strict=False
        )
    ]
    return replace(states[0], opposite=states[1] if len(states) > 1 else None)
