"""State of the loaded contact under all torques: forces, gaps, levers, and what is not to be believed."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from base import Array, record
from fem.contact.face_share import FaceShare
from fem.contact.moved_side import MovedSide
from fem.contact.moving_corners import DEEPEST
from fem.contact.opposite_flanks import OppositeShare
from fem.laws.contact_candidates import ContactCandidates
from gears.sharing.active_set import LoadShare

__all__ = ["ContactState"]

FAR_APART = 0.5
"""Deflection of shafts in modules above which teeth mesh on another path."""


@record
class ContactState:
    """Solution of the contact for all torques.

    Leading dimensions of shares are (torques, pitches, positions).

    Attributes
    ----------
    candidates : ContactCandidates
        Contacts that may bear.
    share : LoadShare
        Forces, times ``lever_ratios``; of contacts that stay where moving ones did not settle.
    lever_ratios, tilted_lever_ratios : (positions, pairs) arrays
        kappa of the normal force, and levers of the force that friction tilts, over kappa r_b1.
    largest : (edges,) array
        Force up to which the laws of the tip edges hold [N].
    closing : (torques, pitches, positions) array
        Deflection without the wind-up of the hubs [m].
    open : (torques, pitches, positions, pairs) array
        Gap that remains where a pair does not bear [m].
    settled : bool
        Whether moving contacts converged.
    side : MovedSide or None
        What moving contacts of the loaded side are solved with; None where contacts stay.
    lost : two (2, torques, pitches, positions, pairs) arrays or None
        Parts of both base radii by which levers of forces, and of further ones, are shorter where contacts move.
    face : FaceShare or None
        Forces on the cells of the face.
    opposite : OppositeShare or None
        Flanks on the other side, where they were looked at.
    back : ContactState or None
        Moving flanks on the other side, seen in the mirror, with the turn D' and its slopes.
    """

    candidates: ContactCandidates
    share: LoadShare
    lever_ratios: Array
    tilted_lever_ratios: Array
    largest: Array
    closing: Array
    open: Array
    settled: bool = True
    side: MovedSide | None = None
    lost: tuple[Array, Array] | None = None
    face: FaceShare | None = None
    opposite: OppositeShare | None = None
    back: ContactState | None = None

    @property
    def touch(self) -> Array:
        """Transmission error at which the gears touch without load (pitches, positions) [m]."""
        return np.asarray(self.candidates.gap.min(axis=-1))

    def deflection(self, number: int) -> Array:
        """Turn under a torque less that without any, on shafts that are held (pitches, positions) [m]."""
        moved = self.share.transmission_error[number]
        return np.asarray(moved if self.opposite is None else moved - self.opposite.rest)

    def turn(self, number: int) -> Array:
        """Turn of the pinion under a torque, from where gears without deviations touch (pitches, positions) [m]."""
        bent = 0.0 if self.face is None else self.face.bent(number)
        return np.asarray(self.share.transmission_error[number] + bent + self.touch)

    def moments(self, loaded: Array, other: Array | None, lost: Array, behind: Array | float) -> Array:
        """Sums of forces kappa F, or of their slopes, by their levers about pinion and wheel (2, positions).

        Parameters
        ----------
        loaded : (positions, pairs) array
            Of the loaded flanks.
        other : (positions, pairs) array or None
            Of those on the other side, which turn the gears the other way.
        lost, behind : (2, positions, pairs) arrays
            Parts of the levers of either side that contacts which move lose.
        """
        sums = _levered(self.candidates, self.lever_ratios, loaded, lost)
        if other is not None and self.opposite is not None:
            sums = sums - _levered(self.opposite.candidates, self.opposite.lever_ratios, other, behind)
        return sums

    @cached_property
    def _lever_losses(self) -> tuple[Array, Array]:
        nothing = np.zeros((2, *self.share.forces.shape))
        if self.side is None or self.lost is None:
            return nothing, nothing
        turned = np.stack([self.side.turned_levers(), np.zeros_like(self.lever_ratios)])[:, None, None]
        half, whole = (loss + turned for loss in self.lost)
        return half, whole

    def lever_loss(self, number: int) -> tuple[Array, Array]:
        """Parts of both base radii by which levers of forces, and of further ones, are shorter.

        (2, pitches, positions, pairs) each, nothing for contacts that stay: half of what tilted flanks take from
        further forces, and what the pinion's corner gains by the turn D.
        """
        first, second = self._lever_losses
        return first[:, number], second[:, number]

    def lever_loss_behind(self, number: int) -> tuple[Array, Array]:
        """The same of the flanks on the other side."""
        if self.back is not None:
            return self.back.lever_loss(number)
        nothing = np.zeros((2, 1, 1, 1))
        return nothing, nothing

    def torques(self, number: int) -> Array:
        """Torque of each pair over the pinion's base radius (pitches, positions, pairs) [N]."""
        return np.asarray(
            self.share.forces[number] * (self.tilted_lever_ratios - self.lever_loss(number)[0][0])
        )

    def flank_rho(self, number: int) -> Array:
        """Curvature radii where pinion and wheel are touched (2, pitches, positions, pairs) [m], untouched ones too."""
        force, approach = self.share.forces[number], self.share.transmission_error[number]
        if self.side is None:
            return np.repeat(self.candidates.rho[:, None], len(force), axis=1)
        return self.side.rho(force, approach if self.face is None else approach + self.face.turned(number))

    def shafts_give_way(self, number: int) -> float:
        """Maximum deflection of both shafts on the face over the module; 0 of rigid ones."""
        held = None if self.face is None else self.face.shafts
        return 0.0 if held is None else float(np.max(held.most[number]))

    def refusal(self, number: int) -> str:
        """Why the solution for a torque is not to be believed, empty if it is."""
        candidates, turned = self.candidates, self.share.forces[number]
        if not self.settled:
            most = 1e3 * np.max(self.share.transmission_error)
            return (
                f"a deflection of {most:.2g} mm is far beyond the first order of contacts that move; reduce the "
                "torque, or let contacts stay"
            )
        if (far := self.shafts_give_way(number)) > FAR_APART:
            return (
                f"the shafts give way by {far:.2g} modules along the line of action, on which the teeth no longer mesh "
                "as they do; give stiffer shafts or bearings, bring them nearer to the gears, or reduce the torque"
            )
        deepest = float(np.max(self.share.transmission_error[number]))
        corners = self.side is not None and self.side.own is not None
        if self.side is not None and corners and deepest > DEEPEST * self.side.setup.pair.module:
            return (
                f"a deflection of {1e3 * deepest:.2g} mm is more than a quarter of the module, up to which corners "
                "that move have laws; reduce the torque, or let contacts stay"
            )
        if candidates.edge.any() and np.any(turned[..., candidates.edge] > self.largest):
            return "a tip edge presses over more than the strips cover; reduce the torque"
        if np.max(self.closing[number] + self.touch) > candidates.reach_gap:
            return (
                "the deflection closes gaps more than a base pitch outside the path, where no contact was looked "
                "for; reduce the torque or the deviations"
            )
        if np.any(turned[..., candidates.chamfered] > 0):
            return "a chamfer's face touches before its corner does, for which there is no law; reduce the torque"
        return "" if self.opposite is None else self.opposite.refusal(number)


def _levered(
    candidates: ContactCandidates, lever_ratios: Array, forces: Array, lost: Array | float = 0.0
) -> Array:
    """Sum by the levers of the normals (2, positions)."""
    lever = np.where(forces != 0.0, candidates.lever, 0.0) / lever_ratios
    return np.asarray(np.sum((lever - lost) * forces, axis=-1))
