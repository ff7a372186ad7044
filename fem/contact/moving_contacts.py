"""Contacts that move: cells of the face or, with a single cell, the plane.

The pinion turns as a whole, so that all its cells roll on by D; what they yield between each other changes by D C',
with C' = dC/dx_1 of the pinion's waves and free ends, and of Hertz's law cell by cell. Corners of the tips are met by
each cell as its own gap leaves it: its flanks have closed by D - g_c.

How a flank tilts and moves along itself where a cell bears is the tooth's doing, and follows a wave of load the less
the shorter it is; tilt and motion do so nearly alike, by s(k) = tau(k)/tau(0) of the tilt, whose waves are known
(``fem.influence.gear_face``). With f = n F the force of a whole face at a cell's line load, and S = T^T diag(s) T,

    U_3 = sum_c [cubic f_c (S f)_c^2 + local f_c^2.5]/n :

of even loads the plane's, of slow waves that of slices.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, Integers, record
from fem.contact.cell_coupling import CellCoupling
from fem.laws.corner_law import Pushed
from gears.sharing.active_set import Linearised
from gears.sharing.load_coupling import Coupling
from gears.sharing.staying_contacts import JointLaw

if TYPE_CHECKING:
    from fem.contact.moving_contact import ContactMoves
    from fem.contact.moving_corners import MovedFlanks
    from gears import LoadShare

__all__ = ["MovingContacts"]


@record
class MovingContacts:
    """Contacts that move (``gears.sharing.active_set.ContactForces``); n of them are pairs times cells.

    Attributes
    ----------
    cells : int
    coupling, roll : Coupling
        C, without the pinion's own flanks where corners move, and C'.
    laws, film
        Of the cells.
    clear : (..., pitches, positions, n) array
        Gaps along the normals where the first pair touches [m], without those of corners that move; 0 where there is no
        contact.
    along : (..., positions, n) array
        By how much less than D each cell has closed beside its pair's own gap [m].
    least : float or (positions,) array
        Turn at which the first cell touches, from where straight, aligned gears do [m].
    touchable : (pitches, positions, n) boolean array
    lever_ratios, tilted_lever_ratios : (positions, pairs) arrays
        Of normals and of forces at D = 0, where what corners add by D is not counted yet.
    moves : ContactMoves
        Of the pairs.
    smoothing : (positions, pairs, cells, cells) array
    own : MovedFlanks or None
        Of the pairs.
    """

    cells: int
    coupling: Coupling
    roll: Coupling
    laws: JointLaw
    film: JointLaw | None
    clear: Array
    along: Array
    least: Array | float
    touchable: Booleans
    lever_ratios: Array
    tilted_lever_ratios: Array
    moves: ContactMoves
    smoothing: Array
    own: MovedFlanks | None

    @property
    def start(self) -> float:
        """As of ``ContactForces``."""
        return self.coupling.start

    @property
    def apart(self) -> bool:
        """As of ``ContactForces``."""
        return self.coupling.apart

    def turn(self, approach: Array) -> Array:
        """Distance that the pinion rolls on (...) [m]."""
        return np.asarray(approach + self.least)

    def split(self, values: Array) -> Array:
        """(..., n) as (..., pairs, cells)."""
        return values.reshape(*values.shape[:-1], -1, self.cells)

    def _first(self, values: Array) -> Array:
        """(..., n) as (cells, ..., pairs)."""
        return np.moveaxis(self.split(values), -1, 0)

    def _last(self, values: Array) -> Array:
        """(cells, ..., pairs) as (..., n)."""
        moved = np.moveaxis(values, 0, -1)
        return moved.reshape(*moved.shape[:-2], -1)

    def everywhere(self, pairs: Array) -> Array:
        """(..., pairs) as (..., n), the same in all cells."""
        return np.repeat(pairs, self.cells, axis=-1)

    def bent_by(self, give: Array) -> MovingContacts:
        """The same where shafts have given way at the cells (..., n) [m]."""
        return replace(self, along=self.along + give)

    def parted(self, give: Array) -> MovingContacts:
        """The same with gaps that are so much larger at the cells (..., n) [m], along the normals."""
        return replace(self, clear=self.clear + give)

    def plus(self, more: Array) -> MovingContacts:
        """With a further compliance between cells, as of ``fem.contact.cell_coupling.CellCoupling.plus``."""
        assert isinstance(self.coupling, CellCoupling)
        return replace(self, coupling=self.coupling.plus(more, self.lever_ratios.shape[-1]))

    @cached_property
    def _held_reach(self) -> Array:
        """By how much a turn closes the gaps at D = 0 (positions, n)."""
        return self.everywhere(self.lever_ratios)

    def _closed(self, approach: Array) -> Array:
        """By how much turns (...) close the gaps (..., n) [m], but for what corners add."""
        return np.asarray(self._held_reach * approach[..., None])

    @cached_property
    def _propped(self) -> Array | float:
        """What films hold the flanks apart without a force [m]."""
        return 0.0 if self.film is None else self.film.approach(np.zeros_like(self.clear))

    def bent(self, loads: Array, wanted: Booleans, known: Array | None) -> Array:
        """C F and C' F (2, ..., n), as of ``ContactForces``."""
        before = np.zeros((2, *loads.shape)) if known is None else known
        couplings = (self.coupling, self.roll)
        return np.stack(
            [each.applied(loads, wanted, row) for each, row in zip(couplings, before, strict=True)]
        )

    def all_bent(self, loads: Array) -> Array:
        """The same at all positions."""
        return self.bent(loads, np.ones(loads.shape[:-1], dtype=bool), None)

    def _tilted(self, loads: Array) -> tuple[tuple[Integers, ...], Array, Array, Array]:
        """Pairs that bear, as an index of (..., pairs), their forces f (k, cells), S (k, cells, cells) and S f."""
        force = self.cells * self.split(loads)
        bear = np.nonzero(force.max(axis=-1) > 0.0)
        force, smoothing = force[bear], self.smoothing[bear[-2:]]
        return bear, force, smoothing, (smoothing @ force[..., None])[..., 0]

    def _gained(self, loads: Array, bear: tuple[Integers, ...], of_pairs: Array) -> Array:
        """(k, cells) of pairs that bear as (..., n), zero elsewhere."""
        gains = np.zeros_like(self.split(loads))
        gains[bear] = of_pairs
        return gains.reshape(loads.shape)

    def tooth(self, loads: Array) -> Array:
        """What cells gain by U_3 of the tooth (..., n) [m]."""
        bear, force, smoothing, smooth = self._tilted(loads)
        less = smooth**2 + 2 * (smoothing @ (force * smooth)[..., None])[..., 0]
        return self._gained(loads, bear, self.moves.cubic[0][bear[-2:]][:, None] * less)

    def thrust(self, loads: Array) -> tuple[Array, Array]:
        """What cells gain by U_3 (..., n) [m], and blocks of its second derivatives (..., cells, cells) [m/N]."""
        bear, force, smoothing, smooth = self._tilted(loads)
        cubic, local = (
            coefficients[0][bear[-2:]][:, None] for coefficients in (self.moves.cubic, self.moves.local)
        )
        root = np.sqrt(np.maximum(force, 0.0))
        less = smooth**2 + 2 * (smoothing @ (force * smooth)[..., None])[..., 0]
        across = smooth[..., :, None] * smoothing
        second = across + np.swapaxes(across, -1, -2) + (smoothing * force[..., None, :]) @ smoothing
        second *= 2 * self.cells * cubic[..., None]
        cell = np.arange(self.cells)
        second[..., cell, cell] += 3.75 * self.cells * local * root
        blocks = np.zeros((*self.split(loads).shape, self.cells))
        blocks[bear] = second
        return self._gained(loads, bear, cubic * less + 2.5 * local * root**3), blocks

    def _pushed(self, loads: Array, approach: Array) -> tuple[Pushed, Pushed]:
        """What the pinion's own flanks and the corners yield, of cells (..., n)."""
        assert self.own is not None
        n, force = self.cells, self.cells * self._first(loads)
        pushes = (
            self.own.rolled(force, self.turn(approach)[..., None]),
            self.own.cornered(force, self._first(approach[..., None] - self.along)),
        )
        flank, corner = (
            Pushed(
                *(
                    self._last(np.broadcast_to(part, force.shape))
                    for part in (
                        pushed.approach,
                        n * pushed.slope,
                        pushed.push / n,
                        pushed.less,
                        pushed.stiff / n,
                    )
                )
            )
            for pushed in pushes
        )
        return flank, corner

    def linearised(self, loads: Array, approach: Array, bent: Array) -> Linearised:
        """As of ``ContactForces``."""
        (bends, rolled), (thrust, blocks) = bent, self.thrust(loads)
        turn, levers = self.turn(approach), self.everywhere(self.tilted_lever_ratios)
        approached, slope = self.laws.value_and_slope(loads)
        closed, rolled_on = self._closed(approach), turn[..., None] * rolled
        residual = bends + approached + self.clear - thrust + rolled_on - closed
        if self.film is not None:
            props, falls = self.film.value_and_slope(loads)
            residual, slope = residual - props, slope - falls
        slope, reach = np.where(loads > 0, slope, 1.0), self._held_reach - rolled
        carried, stiff = np.sum((levers - 0.5 * rolled) * loads, axis=-1), np.zeros_like(approach)
        if self.own is not None:
            for more in self._pushed(loads, approach):
                residual, slope = residual + more.approach, slope + more.slope
                reach = reach - more.less
                carried, stiff = carried - more.push.sum(axis=-1), stiff + more.stiff.sum(axis=-1)
        jacobian = self.coupling.changed(self.roll, turn, -blocks)
        further = levers - (self._held_reach - reach)
        return Linearised(residual, reach, further, carried, slope, jacobian, stiff)

    def unloaded(self, loads: Array, approach: Array, bent: Array) -> Array:
        """As of ``ContactForces``."""
        (bends, rolled), turn = bent, self.turn(approach)
        gaps = bends + self.clear - self.tooth(loads) + turn[..., None] * rolled - self._closed(approach)
        gaps = gaps - self._propped
        if self.own is not None:
            gaps = gaps + self._last(self.own.opened(self._first(approach[..., None] - self.along)))
        return np.asarray(gaps)

    def lever_losses(self, share: LoadShare, crossing: Array | float = 0.0) -> tuple[Array, Array]:
        """Parts of base radii (2, ..., pairs) by which levers of pairs' forces, and of further ones, are shorter.

        Half of what tilted flanks take from further forces, and what the pinion's corner takes.

        Parameters
        ----------
        share : LoadShare
            Of all contacts (..., n).
        crossing : (..., n) array or 0.0
            What loads on the other side of the teeth take.
        """
        loads, slopes = share.forces, share.pair_stiffness
        pairs, steeper = (self.split(values).sum(axis=-1) for values in (loads, slopes))
        bears = (pairs > 0.0) & (steeper != 0.0)
        size, per_turn = np.where(bears, pairs, 1.0), np.where(bears, steeper, 1.0)
        rolled = self.all_bent(loads)[1] + crossing
        half = np.stack(2 * [0.5 * self.split(rolled * loads).sum(axis=-1)])
        whole = np.stack(2 * [self.split(rolled * slopes).sum(axis=-1)])
        if self.own is not None:
            pushes = self._pushed(loads, share.transmission_error)
            for gears, more in zip((slice(2), slice(1)), pushes, strict=True):
                half[gears] += self.split(more.push).sum(axis=-1)
                whole[gears] += self.split(more.less * slopes + more.stiff).sum(axis=-1)
        return np.where(bears, half / size, 0.0), np.where(bears, whole / per_turn, 0.0)
