"""Stress on one gear's fillets under loads on the cells of all pairs, at any instants and places along the face."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from base import Array, Integers, record
from fem.fillet_face import FilletFace
from fem.root_peaks import LOADED, OTHER, RootPeak, extreme

__all__ = ["CellLoads", "StressOverFace"]

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
        By what varies along the face, between walls.
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
        found = []
        for column, offset in enumerate(self.offsets):
            rows = np.flatnonzero(loads.load[:, column].max(axis=-1) > 0.0)
            away = self.turn * int(tooth - offset)
            found.append((rows, away, loads.rho[rows, column], loads.load[rows, column]))
        return found

    def greatest(self, loads: CellLoads, z: Array) -> tuple[Array, Array]:
        """Greatest tension, and greatest compression as a positive number (n, teeth, places) [Pa]."""
        arc, count = self.fillets.influence.line.arc, len(loads.load)
        tension, compression = np.zeros((2, count, len(self.teeth), len(z)))
        step = max(1, MOST // (2 * len(arc) * len(z)))
        for first in range(0, count, step):
            rows = slice(first, first + step)
            some = CellLoads(loads.load[rows], loads.rho[rows])
            for i, tooth in enumerate(self.teeth):
                found = self.along(some, int(tooth), z)
                tension[rows, i] = extreme(arc, found[:, :, LOADED])[0]
                compression[rows, i] = extreme(arc, -found[:, :, OTHER])[0]
        return tension, compression

    def at_place(self, loads: CellLoads, z: float) -> Array:
        """Stress (n, teeth, 2, samples) [Pa] at one place of the face."""
        return np.stack([self.along(loads, int(tooth), np.array([z]))[:, 0] for tooth in self.teeth], axis=1)

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
