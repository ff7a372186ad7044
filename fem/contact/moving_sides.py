"""Contacts that move where flanks on both sides of the teeth bear: one energy of both sides and of what couples them.

The pinion turns by D, so that its loaded flanks roll on by D from their first touch. Its other flanks, seen in the
mirror, roll on by D' = -(D + j), j the backlash between first touches of both sides. With the energy of each side by
itself (``fem.contact.moving_contact``) and X, what loads on one side do to the other (``fem.contact.opposite_flanks``),
at the places x_1 and x_1' of the pinion's flanks,

    U* = U_front(F, D) + U_back(G, D') + F.X(D, D') G,      X = X_0 + D dX/dx_1 + D' dX/dx_1',

    D = dU*/dF_i + gap_i,    -D = dU*/dG_k + j + gap_k,    T/r_b1 = sum l_i F_i - sum l_k G_k - dU*/dD :

levers are shorter by half of dX/dD G on the loaded side, and longer by half of dX/dD F on the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, record
from fem.contact.cell_coupling import CellCoupling
from fem.contact.cell_matrix import cross_coupling
from fem.contact.contact_sides import between
from fem.contact.moved_share import open_gaps
from fem.contact.moved_side import MovedSide
from fem.contact.moving_contacts import MovingContacts
from fem.contact.moving_coupling import CellCross, CrossCoupling, DenseCross
from fem.contact.shared_contacts import SharedContacts
from gears.sharing.active_set import Linearised, LoadShare

if TYPE_CHECKING:
    from fem.laws.contact_candidates import ContactCandidates
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["MovedSides", "MovingSides"]

STEP = 1e-3
"""Part of the module over which X is differentiated by the place."""


@record
class MovingSides:
    """Loaded flanks and those on the other side, one after the other (``gears.sharing.active_set.ContactForces``).

    Attributes
    ----------
    front, back : MovingContacts
    play : (pitches, positions) array
        Turn between the first touches of both sides [m].
    cross : CrossCoupling
        X, and its derivatives by the places of the pinion's loaded and other flanks.
    """

    front: MovingContacts
    back: MovingContacts
    play: Array
    cross: CrossCoupling

    @property
    def count(self) -> int:
        """Contacts on the loaded side."""
        return int(self.front.touchable.shape[-1])

    @property
    def apart(self) -> bool:
        """As of ``ContactForces``."""
        return self.front.apart

    @property
    def start(self) -> float:
        """As of ``ContactForces``."""
        return self.front.start

    @property
    def touchable(self) -> Booleans:
        """As of ``ContactForces``."""
        return np.concatenate([self.front.touchable, self.back.touchable], axis=-1)

    def split(self, values: Array) -> tuple[Array, Array]:
        """(..., front and back pairs) as those of either side."""
        return values[..., : self.count], values[..., self.count :]

    def behind(self, approach: Array) -> Array:
        """D' by which the other flanks have rolled on [m]."""
        return np.asarray(-(approach + self.play))

    def bent(self, loads: Array, wanted: Booleans, known: Array | None) -> Array:
        """What sides bend by themselves and each other (5, ..., n), as of ``MovingContacts`` and ``CrossCoupling``."""
        before = np.zeros((5, *loads.shape)) if known is None else known
        sides = zip((self.front, self.back), self.split(loads), self.split(before[:2]), strict=True)
        own = np.concatenate([side.bent(force, wanted, row) for side, force, row in sides], axis=-1)
        return np.concatenate([own, self.cross.applied(*self.split(loads), wanted, before[2:])])

    def all_bent(self, loads: Array) -> Array:
        """The same at all positions."""
        return self.bent(loads, np.ones(loads.shape[:-1], dtype=bool), None)

    def _pressed(self, approach: Array, bent: Array) -> Array:
        """X G and X F (..., front and back contacts) [m] where the pinion has turned by D."""
        turn, behind = approach[..., None], self.behind(approach)[..., None]
        return np.asarray(bent[2] + turn * bent[3] + behind * bent[4])

    def crossed(self, bent: Array) -> tuple[Array, Array]:
        """dX/dD G, and dX/dD' F, by which the levers on either side are shorter."""
        front, back = self.split(bent[3] - bent[4])
        return front, -back

    def linearised(self, loads: Array, approach: Array, bent: Array) -> Linearised:
        """As of ``ContactForces``."""
        (front, back), (front_bent, back_bent) = self.split(loads), self.split(bent[:2])
        here = self.front.linearised(front, approach, front_bent)
        there = self.back.linearised(back, self.behind(approach), back_bent)
        front_loss, back_loss = self.crossed(bent)
        return Linearised(
            np.concatenate([here.residual, there.residual], axis=-1) + self._pressed(approach, bent),
            np.concatenate([here.reach - front_loss, back_loss - there.reach], axis=-1),
            np.concatenate(
                [here.further_lever_ratios - front_loss, back_loss - there.further_lever_ratios], axis=-1
            ),
            here.carried - there.carried - np.sum(front_loss * front, axis=-1),
            np.concatenate([here.own, there.own], axis=-1),
            self.cross.beside(here.jacobian, there.jacobian, approach, self.behind(approach)),
            here.stiff + there.stiff,
        )

    def unloaded(self, loads: Array, approach: Array, bent: Array) -> Array:
        """As of ``ContactForces``."""
        (front, back), (front_bent, back_bent) = self.split(loads), self.split(bent[:2])
        here = self.front.unloaded(front, approach, front_bent)
        there = self.back.unloaded(back, self.behind(approach), back_bent)
        return np.concatenate([here, there], axis=-1) + self._pressed(approach, bent)

    def bent_by(self, give: Array) -> MovingSides:
        """As of ``MovingContacts``."""
        front, back = self.split(give)
        return replace(self, front=self.front.bent_by(front), back=self.back.bent_by(back))

    def parted(self, give: Array) -> MovingSides:
        """As of ``MovingContacts``."""
        front, back = self.split(give)
        return replace(self, front=self.front.parted(front), back=self.back.parted(back))

    def plus(self, more: Array) -> MovingSides:
        """As of ``MovingContacts``, with what loads on one side do to the other."""
        assert isinstance(self.cross, CellCross)
        front, back, cross = self.front.plus(more), self.back.plus(more), self.cross.plus(more[0, 1])
        return replace(self, front=front, back=back, cross=cross)

    def of_sides(self, share: LoadShare) -> tuple[LoadShare, LoadShare]:
        """Share of either side, by the turn that closes its gaps."""
        loads, slopes = self.split(share.forces), self.split(share.pair_stiffness)
        behind = self.behind(share.transmission_error)
        return (
            replace(share, forces=loads[0], pair_stiffness=slopes[0]),
            replace(share, forces=loads[1], transmission_error=behind, pair_stiffness=-slopes[1]),
        )

    def lever_losses(self, share: LoadShare) -> tuple[Array, Array]:
        """Of the pairs on both sides, as of ``MovingContacts``."""
        crossing = self.crossed(self.all_bent(share.forces))
        sides = zip((self.front, self.back), self.of_sides(share), crossing, strict=True)
        half, whole = zip(*(contacts.lever_losses(part, by) for contacts, part, by in sides), strict=True)
        return np.concatenate(half, axis=-1), np.concatenate(whole, axis=-1)


@record
class MovedSides:
    """Flanks on both sides whose contacts move, the loaded one first."""

    front: MovedSide
    back: MovedSide

    def contacts(self, bodies: PairCompliance, rise: Array, strip: float = 0.0) -> MovingSides:
        """As of ``MovedSide``, with the pairs on the other side after those of the loaded one."""
        sides, setup = (self.front, self.back), self.front.setup
        count = len(self.front.flanks.candidates.offset)
        step, turn = STEP * setup.pair.module, np.array([1.0, 0.0])[:, None, None]
        parts = rise[..., :count, :], rise[..., count:, :]
        here, there = (side.contacts(bodies, part, strip) for side, part in zip(sides, parts, strict=True))

        def rolled(by: tuple[float, float]) -> tuple[ContactCandidates, ContactCandidates]:
            placed = (side.flanks.candidates for side in sides)
            first, second = (
                replace(each, rho=each.rho + way * turn) for each, way in zip(placed, by, strict=True)
            )
            return first, second

        ways = ((0.0, 0.0), (step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step))
        places = [rolled(by) for by in ways]
        still, *others = (between(setup, bodies, *placed) for placed in places)
        cross: CrossCoupling = DenseCross(np.stack([still, *_derivatives(others, step)]))
        if isinstance(here.coupling, CellCoupling) and isinstance(there.coupling, CellCoupling):
            face = replace(setup.face, strip=strip)
            still_cells, *other_cells = (
                cross_coupling(face, bodies, setup.back, placed, matrix)
                for placed, matrix in zip(places, (still, *others), strict=True)
            )
            by_position = (_derivatives(blocks, step) for blocks in zip(*other_cells, strict=True))
            slopes = zip(*by_position, strict=True)
            cross = CellCross((here.coupling.cells, there.coupling.cells), (still_cells, *slopes))
        touches = (side.flanks.candidates.gap.min(axis=-1) for side in sides)
        return MovingSides(here, there, np.asarray(setup.backlash + sum(touches)), cross)

    def rolled(self, bodies: PairCompliance, kept: SharedContacts) -> SharedContacts:
        """A loaded side that bears alone, with the gaps of the other where both have rolled on; those of cells stay."""
        if not self.front.setup.face.even_load:
            return kept
        gaps = open_gaps(self.contacts(bodies, kept.rise), kept.share)
        return replace(kept, remaining_gaps=gaps[..., None])

    def turned_levers(self) -> Array:
        """As of ``MovedSide``."""
        return np.concatenate([side.turned_levers() for side in (self.front, self.back)], axis=-1)

    @property
    def sides(self) -> tuple[MovedSide, MovedSide]:
        """Both, the loaded one first."""
        return self.front, self.back


def _derivatives(values: Sequence[Array], step: float) -> tuple[Array, Array]:
    """By both places, from values ahead of and behind either."""
    return (values[0] - values[1]) / (2 * step), (values[2] - values[3]) / (2 * step)
