"""Contacts on the loaded side of the teeth, and on both sides: what they are solved with where loads are even.

The turn D closes gaps on the loaded side and opens those on the other. It is counted from the first touch of the loaded
side, where that of the other is left by j and the first touches of both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.contact.loaded_flanks import LoadedFlanks, hub_lever
from fem.influence.gear_shape import FINE, MeshLevel
from fem.laws.contact_candidates import ContactCandidates
from fem.laws.local_law import FilmLaw, PairLaws
from fem.laws.mesh_setup import MeshSetup
from gears.sharing.active_set import LoadShare
from gears.sharing.both_flanks import share_between
from gears.sharing.load_sharing import share_load
from gears.sharing.staying_contacts import JointLaw

if TYPE_CHECKING:
    from base import Integers
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["ContactSides", "across", "between", "both_sides", "one_side"]


@record
class JoinedLaws(JointLaw):
    """Laws of the pairs on either side, one after the other."""

    first: PairLaws | FilmLaw
    second: PairLaws | FilmLaw
    count: int

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Both together."""
        first = self.first.value_and_slope(force[..., : self.count])
        second = self.second.value_and_slope(force[..., self.count :])
        value, slope = (np.concatenate(parts, axis=-1) for parts in zip(first, second, strict=True))
        return value, slope

    def at(self, position: int) -> JoinedLaws:
        """Laws of a single position."""
        return JoinedLaws(self.first.at(position), self.second.at(position), self.count)


@record
class ContactSides:
    """Contacts of pairs on the loaded side, and on the other after them.

    Attributes
    ----------
    setups : tuple of MeshSetup
        Of the loaded side, and of the other.
    flanks : tuple of LoadedFlanks
    matrix : (positions, pairs, pairs) array
        Compliance of the bodies along the normals [m/N].
    gaps : (pitches, positions, pairs) array
        Along them, at D = 0; inf where nothing can touch [m].
    """

    setups: tuple[MeshSetup, ...]
    flanks: tuple[LoadedFlanks, ...]
    matrix: Array
    gaps: Array

    @property
    def count(self) -> int:
        """Pairs on the loaded side."""
        return len(self.flanks[0].candidates.offset)

    @property
    def sign(self) -> Array:
        """1 of pairs whose gap D closes, -1 of those on the other side (pairs,)."""
        return np.where(np.arange(self.matrix.shape[-1]) < self.count, 1.0, -1.0)

    @property
    def lever_ratios(self) -> Array:
        """Of the normals (positions, pairs)."""
        return np.concatenate([side.lever_ratios for side in self.flanks], axis=-1)

    @property
    def reach(self) -> Array:
        """By how much D closes the gaps; below 0 where it opens them (positions, pairs)."""
        return self.sign * self.lever_ratios

    @property
    def tilted_lever_ratios(self) -> Array:
        """Of the forces, which friction tilts (positions, pairs)."""
        return np.concatenate([side.tilted_lever_ratios for side in self.flanks], axis=-1)

    @property
    def laws(self) -> PairLaws | JoinedLaws:
        """Laws of each contact."""
        first, *others = (side.laws for side in self.flanks)
        return JoinedLaws(first, others[0], self.count) if others else first

    @property
    def oil(self) -> FilmLaw | JoinedLaws | None:
        """Films of each contact; None where it is dry."""
        first, *others = (side.oil for side in self.flanks)
        if first is None or (others and others[0] is None):
            return None
        return JoinedLaws(first, others[0], self.count) if others and others[0] is not None else first

    @property
    def radius(self) -> Array:
        """Radius of relative curvature (positions, pairs) [m]."""
        rho1, rho2 = np.concatenate([side.candidates.rho for side in self.flanks], axis=-1)
        return np.asarray(rho1 * rho2 / (rho1 + rho2))

    @property
    def touchable(self) -> Array:
        """Whether a contact can be at all (positions, pairs)."""
        return np.concatenate([side.candidates.touchable for side in self.flanks], axis=-1)

    @property
    def on_flank(self) -> Array:
        """Whether a contact can be one of two flanks (positions, pairs)."""
        able = [side.candidates.touchable & ~side.candidates.edge for side in self.flanks]
        return np.concatenate(able, axis=-1)

    @property
    def play(self) -> Array:
        """Turn between the first touches of both sides (pitches, positions) [m]."""
        touches = (side.candidates.gap.min(axis=-1) for side in self.flanks)
        return np.asarray(self.setups[0].backlash + sum(touches))

    def share(self, force: Array) -> LoadShare:
        """Share forces (torques, 1 or pitches, 1 or positions) [N]."""
        arguments = self.oil, self.tilted_lever_ratios, self.lever_ratios
        if len(self.flanks) == 1:
            return share_load(force, self.matrix, self.laws, self.gaps, *arguments)
        return share_between(force, self.matrix, self.laws, self.gaps, self.sign, *arguments)

    def open(self, share: LoadShare) -> Array:
        """Gaps that a share leaves to pairs that do not bear (torques, pitches, positions, pairs) [m]."""
        bent = (self.matrix @ share.forces[..., None])[..., 0] + self.gaps
        propped = 0.0 if self.oil is None else self.oil.approach(np.zeros_like(share.forces))
        return np.asarray(bent - propped - self.reach * share.transmission_error[..., None])

    def pressed(self) -> Array:
        """Where teeth overlap without a torque (pitches, positions).

        Films alone float them within their backlash, of any size: they thicken without bound as they bear less.
        """
        touches = self.gaps / self.lever_ratios
        first, behind = (
            touches[..., pairs].min(axis=-1) for pairs in (slice(self.count), slice(self.count, None))
        )
        return np.asarray(first + behind < 0.0)

    def at(self, pitch: int, position: int) -> ContactSides:
        """The same at a single position."""
        row = slice(position, position + 1)
        return ContactSides(
            self.setups,
            tuple(side.at(position) for side in self.flanks),
            self.matrix[row],
            self.gaps[pitch : pitch + 1, row],
        )


def one_side(setup: MeshSetup, flanks: LoadedFlanks) -> ContactSides:
    """Contacts of the loaded side alone."""
    return ContactSides((setup,), (flanks,), flanks.matrix, flanks.gaps)


def both_sides(
    setup: MeshSetup, bodies: PairCompliance, flanks: LoadedFlanks, other: LoadedFlanks
) -> ContactSides:
    """Put the loaded flanks of a setting and the others together."""
    count, more = len(flanks.candidates.offset), len(other.candidates.offset)
    matrix = np.zeros((setup.positions, count + more, count + more))
    matrix[:, :count, :count], matrix[:, count:, count:] = flanks.matrix, other.matrix
    cross = between(setup, bodies, flanks.candidates, other.candidates)
    matrix[:, :count, count:], matrix[:, count:, :count] = cross, np.swapaxes(cross, 1, 2)
    touch = flanks.candidates.gap.min(axis=-1, keepdims=True)
    behind = other.lever_ratios * (setup.backlash + other.candidates.gap + touch)
    gaps = np.concatenate([flanks.gaps, behind], axis=-1)
    return ContactSides((setup, setup.opposite), (flanks, other), matrix, gaps)


def between(
    setup: MeshSetup,
    bodies: PairCompliance,
    loaded: ContactCandidates,
    other: ContactCandidates,
    level: MeshLevel = FINE,
) -> Array:
    """Compliance between the loaded flanks and the others (positions, pairs, others) [m/N]."""
    compliance = across(bodies, *((other, loaded) if setup.back else (loaded, other)), level)
    return np.swapaxes(compliance, 1, 2) if setup.back else compliance


def across(
    bodies: PairCompliance,
    front: ContactCandidates,
    back: ContactCandidates,
    level: MeshLevel = FINE,
) -> Array:
    """Compliance between contacts of front and back flanks (positions, front pairs, back pairs) [m/N].

    The rotation of each body on its hub is felt by all teeth, by the levers of the forces about its axis, as in the
    compliance of either side: with a weak hub it is all but a small part, and what both sides yield would else not be
    that of one body. The rest dies away with the teeth between; forces at tip edges are taken along the normals of the
    flanks in it.
    """
    positions, pair = len(front.place), bodies.pair
    if "coupling" in bodies.left_out:
        return np.zeros((positions, len(front.offset), len(back.offset)))
    moved = np.zeros((positions, len(front.offset), len(back.offset)))
    back_flanks = bodies.back_flanks if level == FINE else bodies.coarse_backs
    numbers, hubs = (pair.pinion.teeth, pair.wheel.teeth), (bodies.pinion, bodies.wheel)
    for gear, (flexible, teeth, hub) in enumerate(zip(back_flanks, numbers, hubs, strict=True)):
        here, there = front.teeth[gear, :positions, :, None], back.teeth[gear, :positions, None, :]
        # following teeth of the pinion stand clockwise, those of the wheel anticlockwise
        tooth = _nearest(here - there if gear == 0 else there - here, teeth)
        seen = flexible.across(tooth, front.rho[gear][:, :, None], back.rho[gear][:, None, :])
        felt = np.isin(tooth, list(flexible.series))
        first, second = (hub_lever(hub, side.rho[gear], side.leaning[gear]) for side in (front, back))
        turned = first[:, :, None] * second[:, None, :]  # torques of the two sides are opposed
        moved = moved + seen + hub.hub_windup * (felt - turned)
    return np.asarray(moved / pair.face_width + bodies.common_across)


def _nearest(steps: Integers, teeth: int) -> Integers:
    """Steps round a gear by the shorter way."""
    half = teeth // 2
    return np.asarray((steps + half) % teeth - half)
