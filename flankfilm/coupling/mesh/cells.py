"""The cells of a mesh cycle: what they bear, and at which places, on the face or on lines of contact across it.

A load that is even along the face has one cell. Cells of a face stand at the place of their pair, those of a line of
contact each at its own.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

import fem
from base import Array

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["Cells", "cells_of", "has_cells", "line_loads"]


class Cells(NamedTuple):
    """Cells at all positions.

    Attributes
    ----------
    loads : fem.FaceLoads or fem.LineLoads
        What they bear.
    rho1 : ndarray, shape (positions, pairs, cells)
        Curvature radius of the pinion's flank [m]; nan where no two flanks can touch, at tip edges too.
    line_load : ndarray, of the same shape
        Force per length of face, or per length of the line of contact [N/m]; 0 where flanks stand clear.
    length : ndarray, of the same shape
        Of each cell, along the face or along its line of contact [m].
    bear : ndarray of bool, of the same shape
        Which of them bear, flank on flank.
    inside : ndarray of bool, of the same shape
        Which of them count for the largest line load: of a line of contact those that bear away from its ends
        (`fem.LineLoads.inside`).
    part : ndarray, of the same shape
        Of each cell that is flank on flank, and has a film: lines of contact may go on over tip edges, which have none.
    """

    loads: fem.FaceLoads | fem.LineLoads
    rho1: Array
    line_load: Array
    length: Array
    bear: NDArray[np.bool_]
    inside: NDArray[np.bool_]
    part: Array

    @property
    def greatest(self) -> float:
        """Line load of the most loaded cell, away from ends of lines [N/m]."""
        return float(np.max(self.line_load, where=self.inside, initial=0.0))

    @property
    def force(self) -> Array:
        """Normal force on each cell (positions, pairs, cells) [N]."""
        return self.line_load * self.length


def has_cells(cycle: MeshCycle) -> bool:
    """Whether the load of a cycle varies along the contact, by cells of the face or of lines across it."""
    return cycle.face is not None or cycle.lines is not None


def cells_of(cycle: MeshCycle) -> Cells:
    """Cells of a cycle that has them (`has_cells`)."""
    if (lines := cycle.lines) is not None:
        load, part = np.nan_to_num(lines.line_load), lines.on_path
        rho1 = np.where(part > 0.0, lines.rho[0], np.nan)
        length = np.broadcast_to(lines.length[..., None], load.shape)
        bear = np.isfinite(rho1) & (load > 0.0)
        return Cells(lines, rho1, load, length, bear, bear & lines.inside, part)
    face = cycle.face
    assert face is not None
    load = face.line_load
    rho1 = np.broadcast_to(cycle.rho1[..., None], load.shape)
    length = np.broadcast_to(face.pair.face_width / load.shape[-1], load.shape)
    bear = np.isfinite(rho1) & (load > 0.0)
    return Cells(face, rho1, load, length, bear, load > 0.0, np.ones(load.shape))


def line_loads(cycle: MeshCycle, face_width: float) -> Array:
    """Line loads of all cells (positions, pairs, cells) [N/m]: of one, as wide as the face [m], where they are even."""
    return cells_of(cycle).line_load if has_cells(cycle) else cycle.forces[..., None] / face_width
