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
from fem.contact.contact_sides import between, both_sides
from fem.contact.cross_coupling import CellCross, CrossCoupling, PlaneCross
from fem.contact.loaded_flanks import LoadedFlanks, loaded_flanks
from fem.contact.moved_share import MovedShare, moved_share
from fem.contact.moved_side import MovedSide, moved_side
from fem.contact.moving_contacts import MovingContacts
from fem.contact.opposite_flanks import SharedContacts
from gears.sharing.active_set import Linearised, LoadShare

if TYPE_CHECKING:
    from fem.contact.face_share import FaceShare
    from fem.laws.edge_tables import EdgeTables
    from fem.laws.local_law import Film
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["BothMoved", "MovedSides", "MovingSides", "both_moved"]

STEP = 1e-3
"""Part of the module over which X is differentiated by the place."""


@record
class MovingSides:
    """Loaded flanks and those on the other side, one after the other (``gears.sharing.active_set.ContactForces``).

    Attributes
    ----------
    front, back : MovingContacts
        On cells of the face, or in the plane.
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

    def open(self, share: LoadShare) -> Array:
        """Gaps that a share leaves where nothing bears (..., n) [m]."""
        return self.unloaded(share.forces, share.transmission_error, self.all_bent(share.forces))

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

    @property
    def setup(self) -> MeshSetup:
        """Of the loaded side."""
        return self.front.setup

    def contacts(self, bodies: PairCompliance, rise: Array | None = None, strip: float = 0.0) -> MovingSides:
        """As of ``MovedSide``, with the pairs on the other side after those of the loaded one."""
        sides, setup = (self.front, self.back), self.setup
        count = len(self.front.flanks.candidates.offset)
        step, turn = STEP * setup.pair.module, np.array([1.0, 0.0])[:, None, None]
        face = None if setup.face is None or rise is None else replace(setup.face, strip=strip)

        def rolled(by: tuple[float, float]) -> tuple[LoadedFlanks, LoadedFlanks]:
            first, second = (
                replace(
                    side.flanks,
                    lever_ratios=side.lever_ratios,
                    candidates=replace(side.flanks.candidates, rho=side.flanks.candidates.rho + way * turn),
                )
                for side, way in zip(sides, by, strict=True)
            )
            return first, second

        ways = ((0.0, 0.0), (step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step))
        cross: CrossCoupling
        if face is None or rise is None:
            still, *others = (between(setup, bodies, *rolled(by)) for by in ways)
            contacts = [side.in_plane() for side in sides]
            cross = PlaneCross(np.stack([still, *_derivatives(others, step)]))
        else:
            still_cells, *other_cells = (
                cross_coupling(face, bodies, setup.back, flanks, between(setup, bodies, *flanks))
                for flanks in map(rolled, ways)
            )
            parts = rise[..., :count, :], rise[..., count:, :]
            contacts = [side.on_cells(bodies, part, strip) for side, part in zip(sides, parts, strict=True)]
            by_position = (_derivatives(others, step) for others in zip(*other_cells, strict=True))
            slopes = zip(*by_position, strict=True)
            here, there = (each.coupling for each in contacts)
            assert isinstance(here, CellCoupling)
            assert isinstance(there, CellCoupling)
            cross = CellCross((here.cells, there.cells), (still_cells, *slopes))
        touches = (side.flanks.candidates.gap.min(axis=-1) for side in sides)
        play = np.asarray(setup.pair.backlash + sum(touches))
        return MovingSides(contacts[0], contacts[1], play, cross)


def _derivatives(values: Sequence[Array], step: float) -> tuple[Array, Array]:
    """By both places, from values ahead of and behind either."""
    return (values[0] - values[1]) / (2 * step), (values[2] - values[3]) / (2 * step)


@record
class BothMoved:
    """Flanks on both sides that move, solved.

    Attributes
    ----------
    sides : MovedSides
    moved : MovedShare
        Of the pairs on both sides, one after the other; of contacts that stay where ``settled`` is False.
    behind : (torques, pitches, positions) array
        D' by which the other flanks have rolled on [m].
    rest : (pitches, positions) array
        D without torque, as of ``fem.contact.opposite_flanks.OppositeShare`` [m].
    settled : bool
    """

    sides: MovedSides
    moved: MovedShare
    behind: Array
    rest: Array
    settled: bool


def both_moved(
    setup: MeshSetup,
    bodies: PairCompliance,
    force: Array,
    film: Film | None,
    flanks: LoadedFlanks,
    alone: tuple[MovedSide, LoadShare, FaceShare | None] | None,
    apart: Booleans,
    reach: float,
    tables: EdgeTables,
) -> BothMoved:
    """Share forces (torques,) [N] among flanks on both sides that move.

    Parameters
    ----------
    setup, bodies, force, film, flanks, apart, reach, tables
        As for ``fem.contact.opposite_flanks.share_with_opposite``.
    alone : (MovedSide, LoadShare, FaceShare or None) or None
        The loaded side by itself, solved, and its cells; None without a torque.
    """
    most = float(np.max(force))
    other = loaded_flanks(setup.opposite, bodies, film, reach, most, tables)
    staying = both_sides(setup, bodies, flanks, other)
    front = moved_side(setup, bodies, flanks, most, tables) if alone is None else alone[0]
    sides = MovedSides(front, moved_side(setup.opposite, bodies, other, most, tables))
    asked = np.where(apart, np.min(force, where=~apart, initial=np.inf), force)[:, None, None]
    asked = asked + np.zeros(staying.gaps.shape[:-1])
    clear, kept, begin = np.zeros(asked.shape, dtype=bool), None, None
    if alone is not None:
        kept = SharedContacts.alone(staying, bodies, alone[1], alone[2], even=False)
        clear = _clear(sides, bodies, kept) | apart[:, None, None]
    if kept is not None and clear.all():
        moved, settled = _unmoved(kept), True
    else:
        begin = SharedContacts.jointly(staying, bodies, asked)
        solved = moved_share(sides, bodies, asked, begin.share, begin.face)
        if solved is None and kept is not None and kept.face is None:
            solved = moved_share(sides, bodies, asked, begin.with_kept(kept, ~clear).share, None)
        settled = solved is not None
        moved = _unmoved(begin) if solved is None else solved
        if kept is not None and solved is not None:
            moved = _with_kept(moved, kept, clear if kept.face is None else clear & apart[:, None, None])
    rest = np.zeros(staying.gaps.shape[:-1])
    pressed = staying.pressed()
    if settled and pressed.any():
        small = np.where(pressed, 0.0, max(float(np.min(force)), 1.0))[None]
        light = SharedContacts.jointly(staying, bodies, small)
        free = moved_share(sides, bodies, small, light.share, light.face)
        settled = free is not None
        rest = rest if free is None else np.where(pressed, free.share.transmission_error[0], 0.0)
    touches = (side.flanks.candidates.gap.min(axis=-1) for side in (sides.front, sides.back))
    play = setup.pair.backlash + sum(touches)
    return BothMoved(sides, moved, -(moved.share.transmission_error + play), rest, settled)


def _clear(sides: MovedSides, bodies: PairCompliance, kept: SharedContacts) -> Booleans:
    """Where nothing overlaps on the other side (torques, pitches, positions).

    On cells nowhere unless nothing does at all, by the compliance where nothing has rolled on.
    """
    if kept.face is not None:
        return np.full(kept.clear.shape, bool(kept.clear.all()))
    return replace(kept, open=sides.contacts(bodies).open(kept.share)).clear


def _unmoved(shared: SharedContacts) -> MovedShare:
    """A share whose levers lose nothing."""
    nothing = np.zeros((2, *shared.share.forces.shape))
    return MovedShare(shared.share, shared.open, (nothing, nothing), shared.face)


def _with_kept(moved: MovedShare, kept: SharedContacts, clear: Booleans) -> MovedShare:
    """The same with the loaded side alone where that holds."""
    mixed = replace(kept, share=moved.share, face=moved.face, open=moved.open).with_kept(kept, clear)
    return replace(moved, share=mixed.share, face=mixed.face)
