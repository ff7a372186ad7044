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

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, record
from fem.contact.loaded_flanks import LoadedFlanks, loaded_flanks
from fem.contact.moved_side import MovedSide, moved_side
from fem.contact.moving_contacts import MovingContacts
from fem.contact.opposite_flanks import ROUNDING, BothSides, between, both_sides
from gears.sharing.active_set import Linearised, LoadShare, share_forces
from gears.sharing.load_coupling import DenseCoupling

if TYPE_CHECKING:
    from fem.laws.edge_tables import EdgeTables
    from fem.laws.local_law import Film
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["BothMoved", "MovingSides", "both_moved", "moving_sides"]

STEP = 1e-3
"""Part of the module over which X is differentiated by the place."""


@record
class MovingSides:
    """Loaded flanks and those on the other side, one after the other (``gears.sharing.active_set.ContactForces``).

    Attributes
    ----------
    front, back : MovingContacts
        In the plane.
    play : (pitches, positions) array
        Turn between the first touches of both sides [m].
    cross : (3, positions, front pairs, back pairs) array
        X [m/N], and its derivatives by the places of the pinion's loaded and other flanks [1/N].
    """

    front: MovingContacts
    back: MovingContacts
    play: Array
    cross: Array

    @property
    def count(self) -> int:
        """Pairs on the loaded side."""
        return int(self.cross.shape[-2])

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

    def _crossing(self, approach: Array) -> Array:
        """X where the pinion has turned by D."""
        turn, behind = approach[..., None, None], self.behind(approach)[..., None, None]
        return np.asarray(self.cross[0] + turn * self.cross[1] + behind * self.cross[2])

    def crossed(self, loads: Array) -> tuple[Array, Array]:
        """dX/dD G, and dX/dD' F, by which the levers on either side are shorter."""
        front, back = self.split(loads)
        turned = self.cross[1] - self.cross[2]
        return (turned @ back[..., None])[..., 0], -(np.swapaxes(turned, -1, -2) @ front[..., None])[..., 0]

    def _pressed(self, loads: Array, approach: Array) -> Array:
        """X G and X F (..., front and back pairs) [m]."""
        (front, back), cross = self.split(loads), self._crossing(approach)
        sides = (cross @ back[..., None])[..., 0], (np.swapaxes(cross, -1, -2) @ front[..., None])[..., 0]
        return np.concatenate(sides, axis=-1)

    def bent(self, loads: Array, wanted: Booleans, known: Array | None) -> Array:
        """What each side bends by itself (2, ..., n), as of ``MovingContacts``."""
        before = (None, None) if known is None else self.split(known)
        sides = zip((self.front, self.back), self.split(loads), before, strict=True)
        return np.concatenate([side.bent(force, wanted, row) for side, force, row in sides], axis=-1)

    def linearised(self, loads: Array, approach: Array, bent: Array) -> Linearised:
        """As of ``ContactForces``."""
        (front, back), (front_bent, back_bent) = self.split(loads), self.split(bent)
        here = self.front.linearised(front, approach, front_bent)
        there = self.back.linearised(back, self.behind(approach), back_bent)
        front_loss, back_loss = self.crossed(loads)
        assert isinstance(here.jacobian, DenseCoupling)
        assert isinstance(there.jacobian, DenseCoupling)
        return Linearised(
            np.concatenate([here.residual, there.residual], axis=-1) + self._pressed(loads, approach),
            np.concatenate([here.reach - front_loss, back_loss - there.reach], axis=-1),
            np.concatenate(
                [here.further_lever_ratios - front_loss, back_loss - there.further_lever_ratios], axis=-1
            ),
            here.carried - there.carried - np.sum(front_loss * front, axis=-1),
            np.concatenate([here.own, there.own], axis=-1),
            here.jacobian.beside(there.jacobian, self._crossing(approach)),
            here.stiff + there.stiff,
        )

    def unloaded(self, loads: Array, approach: Array, bent: Array) -> Array:
        """As of ``ContactForces``."""
        (front, back), (front_bent, back_bent) = self.split(loads), self.split(bent)
        here = self.front.unloaded(front, approach, front_bent)
        there = self.back.unloaded(back, self.behind(approach), back_bent)
        return np.concatenate([here, there], axis=-1) + self._pressed(loads, approach)

    def open(self, share: LoadShare) -> Array:
        """Gaps that a share leaves where nothing bears (..., n) [m]."""
        bent = self.bent(share.forces, np.ones(share.stiffness.shape, dtype=bool), None)
        return self.unloaded(share.forces, share.transmission_error, bent)

    def of_sides(self, share: LoadShare) -> tuple[LoadShare, LoadShare]:
        """Share of either side, by the turn that closes its gaps."""
        loads, slopes = self.split(share.forces), self.split(share.pair_stiffness)
        behind = self.behind(share.transmission_error)
        return (
            replace(share, forces=loads[0], pair_stiffness=slopes[0]),
            replace(share, forces=loads[1], transmission_error=behind, pair_stiffness=-slopes[1]),
        )

    def lever_losses(self, share: LoadShare) -> tuple[tuple[Array, Array], ...]:
        """Of either side, as of ``MovingContacts``."""
        sides = zip((self.front, self.back), self.of_sides(share), self.crossed(share.forces), strict=True)
        return tuple(contacts.lever_losses(part, crossing) for contacts, part, crossing in sides)


def moving_sides(bodies: PairCompliance, front: MovedSide, back: MovedSide) -> MovingSides:
    """Put both sides together, the loaded one first."""
    setup = front.setup
    step, turn = STEP * setup.pair.module, np.array([1.0, 0.0])[:, None, None]
    ratio_products = (front.flanks.lever_ratios / front.lever_ratios)[:, :, None] * (
        back.flanks.lever_ratios / back.lever_ratios
    )[:, None, :]

    def coupling(first: float, second: float) -> Array:
        here, there = (
            replace(
                side.flanks,
                candidates=replace(side.flanks.candidates, rho=side.flanks.candidates.rho + by * turn),
            )
            for side, by in ((front, first), (back, second))
        )
        return np.asarray(between(setup, bodies, here, there) * ratio_products)

    rolls = [
        (coupling(*ahead) - coupling(*behind)) / (2 * step)
        for ahead, behind in (((step, 0.0), (-step, 0.0)), ((0.0, step), (0.0, -step)))
    ]
    touches = (side.flanks.candidates.gap.min(axis=-1) for side in (front, back))
    play = setup.pair.backlash + sum(touches)
    cross = np.stack([coupling(0.0, 0.0), *rolls])
    return MovingSides(front.in_plane(), back.in_plane(), np.asarray(play), cross)


def _between(
    problem: MovingSides, stays: BothSides, force: Array, alone: LoadShare | None, apart: Booleans
) -> LoadShare | None:
    """Share forces (torques, 1 or pitches, 1 or positions) [N] among both sides.

    Parameters
    ----------
    problem : MovingSides
    stays : BothSides
        The same contacts that stay: what is begun with where flanks on both sides bear.
    force : (torques, pitches, positions) array
        [N]
    alone : LoadShare or None
        Of the loaded side by itself, kept where it lets nothing overlap; None without a torque.
    apart : (torques,) boolean array
        Torques for which it is kept whatever it lets overlap.

    Returns
    -------
    LoadShare or None
        Of both sides; None where Newton's method does not settle.
    """
    clear, near = np.zeros(force.shape, dtype=bool), None
    if alone is not None:
        nothing = np.zeros((*force.shape, problem.cross.shape[-1]))
        near = replace(
            alone,
            forces=np.concatenate([alone.forces, nothing], axis=-1),
            pair_stiffness=np.concatenate([alone.pair_stiffness, nothing], axis=-1),
        )
        remaining_gaps = problem.open(near)[..., problem.count :]
        clear = np.all(remaining_gaps >= -ROUNDING * np.abs(near.transmission_error)[..., None], axis=-1)
        clear |= apart[:, None, None]
        if clear.all():
            return near
        force = np.where(apart[:, None, None], np.min(force[~apart]), force)
    begin = stays.share(force)
    moved = share_forces(problem, force, begin.forces, begin.transmission_error)
    if moved is None and near is not None:
        begin_alone = np.where(clear[..., None], begin.forces, near.forces)
        approach = np.where(clear, begin.transmission_error, near.transmission_error)
        moved = share_forces(problem, force, begin_alone, approach)
    if moved is None or near is None:
        return moved
    pairs = clear[..., None]
    return LoadShare(
        np.where(pairs, near.forces, moved.forces),
        np.where(clear, near.transmission_error, moved.transmission_error),
        np.where(clear, near.stiffness, moved.stiffness),
        np.where(pairs, near.pair_stiffness, moved.pair_stiffness),
        near.iterations + moved.iterations,
    )


@record
class BothMoved:
    """Flanks on both sides that move, solved.

    Attributes
    ----------
    problem : MovingSides
    front, back : MovedSide
    share : LoadShare
        Of both sides, one after the other; of contacts that stay where ``settled`` is False.
    rest : (pitches, positions) array
        D without torque, as of ``fem.contact.opposite_flanks.OppositeShare`` [m].
    settled : bool
    """

    problem: MovingSides
    front: MovedSide
    back: MovedSide
    share: LoadShare
    rest: Array
    settled: bool


def both_moved(
    setup: MeshSetup,
    bodies: PairCompliance,
    force: Array,
    film: Film | None,
    flanks: LoadedFlanks,
    alone: tuple[LoadShare, MovedSide | None] | None,
    apart: Booleans,
    reach: float,
    tables: EdgeTables,
) -> BothMoved:
    """Share forces (torques,) [N] among flanks on both sides that move.

    Parameters
    ----------
    setup, bodies, force, film, flanks, apart, reach, tables
        As for ``fem.contact.opposite_flanks.share_with_opposite``.
    alone : (LoadShare, MovedSide) or None
        The loaded side by itself, solved; None without a torque.
    """
    most, whole = float(np.max(force)), force[:, None, None]
    other = loaded_flanks(setup.opposite, bodies, film, reach, most, tables)
    stays = both_sides(setup, bodies, flanks, other)
    front = None if alone is None else alone[1]
    front = moved_side(setup, bodies, flanks, most, tables) if front is None else front
    back = moved_side(setup.opposite, bodies, other, most, tables)
    problem = moving_sides(bodies, front, back)
    pressed, rest = stays.pressed(), np.zeros(problem.play.shape)
    asked = whole + 0.0 * pressed
    share = _between(problem, stays, asked, None if alone is None else alone[0], apart)
    if share is None:
        return BothMoved(problem, front, back, stays.share(asked), rest, False)
    settled = True
    if pressed.any():
        small = np.where(pressed, 0.0, max(float(np.min(force)), 1.0))[None]
        begin = stays.share(small)
        free = share_forces(problem, small, begin.forces, begin.transmission_error)
        settled = free is not None
        rest = rest if free is None else np.where(pressed, free.transmission_error[0], 0.0)
    return BothMoved(problem, front, back, share, rest, settled)
