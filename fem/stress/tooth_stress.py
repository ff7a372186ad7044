"""Stress on one gear's fillets under loads on the cells of all pairs, at any instants and places along the face."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from base import Array, Booleans, Integers, record
from fem.influence.root_influence import RootInfluence
from fem.stress.root_peaks import LOADED, OTHER, extreme
from gears.sharing.arcs import CELLS, FORCE, Arcs

__all__ = ["CellLoads", "ToothStress"]

MOST = 4_000_000
"""Stresses that are held at once."""

NEAR = 2.0
"""Modules of the face to either side of a place that its root feels most."""


@record
class CellLoads:
    """Line loads on the cells of all pairs at some instants.

    Attributes
    ----------
    load : (n, pairs, cells) array
        [N/m]
    rho : (n, pairs) array
        Curvature radius at which the gear's flank is touched [m].
    """

    load: Array
    rho: Array

    def part(self, first: int, count: int = 1) -> CellLoads:
        """Loads at instants one after the other, or at a single one."""
        return CellLoads(self.load[first : first + count], self.rho[first : first + count])

    @property
    def bears(self) -> Booleans:
        """Whether a pair bears on any cell (n, pairs)."""
        return np.asarray(self.load.max(axis=-1) > 0.0)

    @property
    def even(self) -> CellLoads:
        """The same forces spread evenly."""
        return CellLoads(np.zeros_like(self.load) + self.load.mean(axis=-1, keepdims=True), self.rho)


@record
class Beside:
    """Stress along the fillet at a peak's place by loads at one instant [Pa], and what it is made of.

    Attributes
    ----------
    stress : float
    waves : float
        From the variation along the face, between walls.
    ends : float
        Most that free ends do at places near it, for what they do may vanish at the peak itself.
    von_mises : float
    """

    stress: float
    waves: float
    ends: float
    von_mises: float


@record
class ToothStress:
    """Stress on the fillets of one gear under loads on cells; columns of loads are pairs, so many base pitches ahead.

    Attributes
    ----------
    root : RootInfluence
    offsets : (pairs,) array of int
    gear : int
        0 is the pinion, 1 the wheel.
    """

    root: RootInfluence
    offsets: Integers
    gear: int

    @property
    def teeth(self) -> Integers:
        """Teeth whose stress is looked at (teeth,), base pitches ahead: of all pairs, and one more at either end."""
        return np.arange(self.offsets.min() - 1, self.offsets.max() + 2)

    def on_arcs(self, arcs: Arcs) -> CellLoads:
        """Loads at all nodes of arcs, one after the other."""
        pairs = np.concatenate([arc.pairs for arc in arcs.arcs if arc.pairs is not None])
        return CellLoads(pairs[..., CELLS:], pairs[..., FORCE + 1 + self.gear])

    def along(self, loads: CellLoads, tooth: int, z: Array) -> Array:
        """Stress along the fillets of a tooth (n, places, 2, samples) [Pa] at places of the face in contact."""
        total = np.zeros((len(loads.load), len(z), 2, len(self.root.influence.line.arc)))
        for rows, away, rho, load in self._loaded(loads, tooth):
            total[rows] += self.root.tangential(away, rho, load, z)
        return total

    def von_mises(self, loads: CellLoads, tooth: int, z: Array) -> Array:
        """Von Mises stress at a single instant (places, 2, samples) [Pa]."""
        loaded = self._loaded(loads, tooth)
        return self.root.von_mises(
            [self.root.components(away, rho, load, z) for _, away, rho, load in loaded]
        )

    def _loaded(self, loads: CellLoads, tooth: int) -> list[tuple[Integers, int, Array, Array]]:
        """Instants, tooth counted from the loaded one, places and loads of every pair that bears and is felt."""
        # the pair ahead is the next tooth anticlockwise on the pinion, clockwise on the wheel
        turn = 1 if self.gear == 0 else -1
        loaded = []
        for column, offset in enumerate(self.offsets):
            rows = np.flatnonzero(loads.bears[:, column])
            away = turn * int(tooth - offset)
            if rows.size and away in self.root.influence.series:
                loaded.append((rows, away, loads.rho[rows, column], loads.load[rows, column]))
        return loaded

    def greatest(self, loads: CellLoads, z: Array) -> Array:
        """Maximum tension, and maximum compression as a positive number (2, n, teeth, places) [Pa]."""
        arc, count = self.root.influence.line.arc, len(loads.load)
        maxima = np.zeros((2, count, len(self.teeth), len(z)))
        step = max(1, MOST // (2 * len(arc) * len(z)))
        for first in range(0, count, step):
            rows, batch = slice(first, first + step), loads.part(first, step)
            for i, tooth in enumerate(self.teeth):
                stress = self._clear(self.along(batch, int(tooth), z), batch, int(tooth))
                maxima[LOADED, rows, i] = extreme(arc, stress[:, :, LOADED])[0]
                maxima[OTHER, rows, i] = extreme(arc, -stress[:, :, OTHER])[0]
        return maxima

    def at(self, loads: CellLoads, z: Array) -> Array:
        """Stress (n, teeth, places, 2, samples) [Pa] at places of the face in contact."""
        return np.stack([self.along(loads, int(tooth), z) for tooth in self.teeth], axis=1)

    def clear(self, stress: Array, loads: CellLoads) -> Array:
        """Stress of ``at`` without what contacts do next to themselves: no more than where that ends."""
        each = [self._clear(stress[:, i], loads, int(tooth)) for i, tooth in enumerate(self.teeth)]
        return np.stack(each, axis=1)

    def _clear(self, stress: Array, loads: CellLoads, tooth: int) -> Array:
        """Stress of one tooth (n, places, 2, samples); the fillet under the loaded flank ends short of the contact."""
        influence, clear = self.root.influence, stress.copy()
        for column in np.flatnonzero(self.offsets == tooth):
            rows = np.flatnonzero(loads.bears[:, column])
            contact = influence.profile.involute(loads.rho[rows, column])
            away = np.linalg.norm(influence.line.points - contact[:, None], axis=-1)
            last = np.maximum(np.sum(away >= self.root.disturbed, axis=1), 3) - 1
            samples = np.minimum(np.arange(away.shape[1]), last[:, None])
            clear[rows, :, LOADED] = np.take_along_axis(stress[rows, :, LOADED], samples[:, None], axis=-1)
        return clear

    def beside(self, loads: CellLoads, tooth: int, side: int, arc: float, z: float) -> Beside:
        """Stress at the sample of a fillet nearest to an arc length, at a place of the face and near it."""
        root = self.root
        half, near = 0.5 * root.width, z + NEAR * root.module * np.linspace(-1.0, 1.0, 9)
        places = np.concatenate([[z], np.clip(near, root.offset - half, root.offset + half)])
        sample = int(np.argmin(np.abs(root.influence.line.arc - arc)))
        walls = replace(self, root=replace(root, ends=None))
        true, even, held = (
            of.along(by, tooth, places)[0, :, side, sample]
            for of, by in ((self, loads), (walls, loads.even), (walls, loads))
        )
        compared = self.von_mises(loads, tooth, places[:1])[0, side, sample]
        return Beside(
            float(true[0]), float(held[0] - even[0]), float(np.max(np.abs(true - held))), float(compared)
        )
