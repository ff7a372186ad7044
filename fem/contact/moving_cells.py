"""Contacts that move on the cells of the face: how cells yield where the pinion rolls on, and move with their loads.

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

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, Integers, record
from fem.contact.cell_coupling import CellCoupling, solve_symmetric
from fem.contact.moving_newton import Linearised
from fem.laws.place_surface import Pushed

if TYPE_CHECKING:
    from fem.contact.cell_laws import CellLaws
    from fem.contact.moving_contact import ContactMoves
    from fem.contact.moving_corners import MovedFlanks
    from fem.contact.partial_cells import PartialCells

__all__ = ["MovingCells"]


@record
class MovingCells:
    """Cells of pairs whose contacts move; n of them are pairs times cells.

    Attributes
    ----------
    cells : int
    coupling, roll : CellCoupling
        C, without the pinion's own flanks where corners move, and C'.
    laws, film
        Of the cells.
    clear : (torques, pitches, positions, n) array
        Gaps at the first touch of each cell [m], without those of corners that move; 0 where there is no contact.
    along : (..., positions, n) array
        By how much less than D each cell has closed beside its pair's own gap [m].
    least : float
        Turn at which the first cell touches, from where straight, aligned gears do [m].
    touchable : (pitches, positions, n) boolean array
    tilted_lever_ratios : (positions, pairs) array
    moves : ContactMoves
        Of the pairs.
    smoothing : (positions, pairs, cells, cells) array
    own : MovedFlanks or None
        Of the pairs.
    """

    cells: int
    coupling: CellCoupling
    roll: CellCoupling
    laws: PartialCells
    film: CellLaws | None
    clear: Array
    along: Array
    least: float
    touchable: Booleans
    tilted_lever_ratios: Array
    moves: ContactMoves
    smoothing: Array
    own: MovedFlanks | None

    @property
    def start(self) -> float:
        """Part of the whole force with which a cell is taken in."""
        return self.coupling.start

    def turn(self, approach: Array) -> Array:
        """Distance that the pinion rolls on (...) [m]."""
        return approach + self.least

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

    def bent(self, loads: Array) -> tuple[Array, Array]:
        """C F and C' F (..., n)."""
        wanted, nothing = np.ones(loads.shape[:-1], dtype=bool), np.zeros_like(loads)
        return self.coupling.applied(loads, wanted, nothing), self.roll.applied(loads, wanted, nothing)

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

    def linearised(self, loads: Array, approach: Array) -> Linearised:
        """As of ``MovingForces``."""
        (bent, rolled), (thrust, blocks) = self.bent(loads), self.thrust(loads)
        turn, tilted_lever_ratios = self.turn(approach), self.everywhere(self.tilted_lever_ratios)
        approached, slope = self.laws.value_and_slope(loads)
        residual = bent + approached + self.clear - thrust
        residual += turn[..., None] * rolled - approach[..., None]
        if self.film is not None:
            residual, slope = residual - self.film.approach(loads), slope - self.film.slope(loads)
        slope, reach, blocks = np.where(loads > 0, slope, 1.0), 1 - rolled, -blocks
        carried, stiff = (
            np.sum((tilted_lever_ratios - 0.5 * rolled) * loads, axis=-1),
            np.zeros_like(approach),
        )
        if self.own is not None:
            for more in self._pushed(loads, approach):
                residual, slope = residual + more.approach, slope + more.slope
                reach = reach - more.less
                carried, stiff = carried - more.push.sum(axis=-1), stiff + more.stiff.sum(axis=-1)
        return Linearised(residual, reach, tilted_lever_ratios - (1 - reach), carried, stiff, slope, blocks)

    def solved(self, at: Linearised, approach: Array, active: Booleans) -> tuple[Array, Array]:
        """As of ``MovingForces``."""
        assert at.blocks is not None
        unit, response = np.zeros_like(at.residual), np.zeros_like(at.residual)
        turn = self.turn(approach)
        for index in np.ndindex(*approach.shape):
            cells, block, roll = (
                by_position[index[-1]]
                for by_position in (self.coupling.cells, self.coupling.blocks, self.roll.blocks)
            )
            jacobian = block + turn[index] * roll
            pairs = np.arange(len(cells) // self.cells)
            by_pair = jacobian.reshape(len(pairs), self.cells, len(pairs), self.cells)
            by_pair[pairs, :, pairs, :] += at.blocks[index][cells[:: self.cells] // self.cells]
            jacobian.flat[:: len(cells) + 1] += at.own[index][cells]
            bears = np.flatnonzero(active[index][cells])
            chosen = cells[bears]
            jacobian = jacobian.take(bears, axis=0).take(bears, axis=1)
            sides = np.stack([at.reach[index][chosen], at.residual[index][chosen]])
            unit[index][chosen], response[index][chosen] = solve_symmetric(jacobian, sides)
        return unit, response

    def unloaded(self, loads: Array, approach: Array) -> Array:
        """As of ``MovingForces``."""
        bent, rolled = self.bent(loads)
        turn = self.turn(approach)
        gaps = bent + self.clear - self.tooth(loads) + turn[..., None] * rolled - approach[..., None]
        if self.film is not None:
            gaps = gaps - self.film.approach(np.zeros_like(loads))
        if self.own is not None:
            gaps = gaps + self._last(self.own.opened(self._first(approach[..., None] - self.along)))
        return gaps

    def lever_losses(self, loads: Array, slopes: Array, approach: Array) -> tuple[Array, Array]:
        """Parts of base radii (2, ..., pairs) by which levers of pairs' forces, and of further ones, are shorter.

        Parameters
        ----------
        loads, slopes : (..., n) arrays
            Forces [N] and their slopes by D [N/m].
        approach : (...) array
            D [m].
        """
        pairs, steeper = (self.split(values).sum(axis=-1) for values in (loads, slopes))
        bears = (pairs > 0.0) & (steeper != 0.0)
        size, per_turn = np.where(bears, pairs, 1.0), np.where(bears, steeper, 1.0)
        _, rolled = self.bent(loads)
        half = np.stack(2 * [0.5 * self.split(rolled * loads).sum(axis=-1)])
        whole = np.stack(2 * [self.split(rolled * slopes).sum(axis=-1)])
        if self.own is not None:
            for gears, more in zip((slice(2), slice(1)), self._pushed(loads, approach), strict=True):
                half[gears] += self.split(more.push).sum(axis=-1)
                whole[gears] += self.split(more.less * slopes + more.stiff).sum(axis=-1)
        return np.where(bears, half / size, 0.0), np.where(bears, whole / per_turn, 0.0)
