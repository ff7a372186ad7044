"""Stress on one gear's fillets under loads on the cells of all pairs, at any instants and places along the face."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from base import Array, Integers, record
from fem.influence.fillet_face import FilletFace
from fem.stress.root_peaks import LOADED, OTHER, RootPeak, extreme

__all__ = ["CellLoads", "StressOverFace"]

MOST = 4_000_000
"""Stresses that are held at once."""

NEAR = 2.0
"""Modules of the face to either side of a place that its root feels most."""

OWN = 0.5
"""Modules around a contact that no root stress is looked for in.

A load P on a short length of the face draws the free surface at a distance r by (1 - 2 nu) P/(2 pi r^2), as a force on
a half-space does: without end where r is small, and no bending.
"""


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

    def part(self, row: int) -> CellLoads:
        """Loads at a single instant."""
        return CellLoads(self.load[row : row + 1], self.rho[row : row + 1])

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
class StressOverFace:
    """Stress on the fillets of one gear under loads on cells; columns of loads are pairs, so many base pitches ahead.

    Attributes
    ----------
    fillets : FilletFace
    offsets : (pairs,) array of int
    teeth : (teeth,) array of int
        On which the stress is wanted, base pitches ahead.
    turn : int
        1 on the pinion, where the pair ahead is the next tooth anticlockwise; -1 on the wheel.
    offset : float
        Middle of the gear's own face from that of the face in contact [m].
    """

    fillets: FilletFace
    offsets: Integers
    teeth: Integers
    turn: int
    offset: float

    def with_cells(self, count: int) -> StressOverFace:
        """Return the same under loads on another number of cells."""
        edges = self.fillets.edges
        finer = np.linspace(edges[0], edges[-1], count + 1)
        return replace(self, fillets=replace(self.fillets, edges=finer))

    def along(self, loads: CellLoads, tooth: int, z: Array) -> Array:
        """Stress along the fillets of a tooth (n, places, 2, samples) [Pa] at places of the face in contact."""
        total = np.zeros((len(loads.load), len(z), 2, len(self.fillets.influence.line.arc)))
        for rows, away, rho, load in self._loaded(loads, tooth):
            total[rows] += self.fillets.tangential(away, rho, load, z - self.offset)
        return total

    def von_mises(self, loads: CellLoads, tooth: int, z: Array) -> Array:
        """Von Mises stress at a single instant (places, 2, samples) [Pa]."""
        parts = [
            self.fillets.components(away, rho, load, z - self.offset)
            for _, away, rho, load in self._loaded(loads, tooth)
        ]
        return self.fillets.von_mises(parts)

    def _loaded(self, loads: CellLoads, tooth: int) -> list[tuple[Integers, int, Array, Array]]:
        """Instants, tooth counted from the loaded one, places and loads of every pair that bears."""
        loaded = []
        for column, offset in enumerate(self.offsets):
            rows = np.flatnonzero(loads.load[:, column].max(axis=-1) > 0.0)
            away = self.turn * int(tooth - offset)
            loaded.append((rows, away, loads.rho[rows, column], loads.load[rows, column]))
        return loaded

    def greatest(self, loads: CellLoads, z: Array) -> tuple[Array, Array]:
        """Maximum tension, and maximum compression as a positive number (n, teeth, places) [Pa]."""
        arc, count = self.fillets.influence.line.arc, len(loads.load)
        tension, compression = np.zeros((2, count, len(self.teeth), len(z)))
        step = max(1, MOST // (2 * len(arc) * len(z)))
        for first in range(0, count, step):
            rows = slice(first, first + step)
            batch = CellLoads(loads.load[rows], loads.rho[rows])
            for i, tooth in enumerate(self.teeth):
                stress = self._clear(self.along(batch, int(tooth), z), batch, int(tooth))
                tension[rows, i] = extreme(arc, stress[:, :, LOADED])[0]
                compression[rows, i] = extreme(arc, -stress[:, :, OTHER])[0]
        return tension, compression

    def at_place(self, loads: CellLoads, z: float) -> Array:
        """Stress (n, teeth, 2, samples) [Pa] at one place of the face."""
        return np.stack([self.along(loads, int(tooth), np.array([z]))[:, 0] for tooth in self.teeth], axis=1)

    def clear(self, stress: Array, loads: CellLoads) -> Array:
        """Stress of ``at_place`` without what contacts do next to themselves: no more than where that ends."""
        each = [self._clear(stress[:, i, None], loads, int(tooth)) for i, tooth in enumerate(self.teeth)]
        return np.concatenate(each, axis=1)

    def _clear(self, stress: Array, loads: CellLoads, tooth: int) -> Array:
        """Stress of one tooth (n, places, 2, samples); the fillet under the loaded flank ends short of the contact."""
        column = np.flatnonzero(self.offsets == tooth)
        if not len(column):
            return stress
        rho, bears = loads.rho[:, column[0]], loads.load[:, column[0]].max(axis=-1) > 0.0
        influence = self.fillets.influence
        contact = influence.profile.involute(np.where(bears, rho, influence.rho_range[1]))
        away = np.linalg.norm(influence.line.points - contact[:, None], axis=-1)
        last = np.maximum(np.sum(away >= OWN * self.fillets.module, axis=1), 3) - 1
        samples = np.where(
            bears[:, None], np.minimum(np.arange(away.shape[1]), last[:, None]), np.arange(away.shape[1])
        )
        clear = stress.copy()
        clear[:, :, LOADED] = np.take_along_axis(stress[:, :, LOADED], samples[:, None], axis=-1)
        return clear

    def beside(self, peak: RootPeak, loads: CellLoads, side: int) -> Beside:
        """Stress of a peak's fillet sample, at its place and near it, by loads at one instant."""
        near = peak.face_position + NEAR * self.fillets.module * np.linspace(-1.0, 1.0, 9)
        half = 0.5 * self.fillets.width
        z = np.concatenate([[peak.face_position], np.clip(near, self.offset - half, self.offset + half)])
        sample = int(np.argmin(np.abs(self.fillets.influence.line.arc - peak.arc)))
        walls = replace(self, fillets=replace(self.fillets, ends=None))
        true, even, held = (
            of.along(by, peak.tooth, z)[0, :, side, sample]
            for of, by in ((self, loads), (walls, loads.even), (walls, loads))
        )
        compared = self.von_mises(loads, peak.tooth, z[:1])[0, side, sample]
        return Beside(
            float(true[0]), float(held[0] - even[0]), float(np.max(np.abs(true - held))), float(compared)
        )
