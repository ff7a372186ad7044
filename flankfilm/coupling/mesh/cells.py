"""The cells of a mesh cycle: what they bear, and at which places; a load that is even along the face has one."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

import fem
from base import Array

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["Cells", "cells_of", "line_loads"]


class Cells(NamedTuple):
    """Cells at all positions.

    Attributes
    ----------
    face : fem.FaceLoads
        What they bear.
    rho1 : ndarray, shape (positions, pairs, cells)
        Curvature radius of the pinion's flank [m]; nan where no two flanks can touch.
    bear : ndarray of bool, of the same shape
        Which of them bear, flank on flank.
    """

    face: fem.FaceLoads
    rho1: Array
    bear: NDArray[np.bool_]

    @property
    def greatest(self) -> Array:
        """Line load of each pair's most loaded cell (positions, pairs) [N/m]."""
        return np.asarray(self.face.line_load.max(axis=-1))


def cells_of(cycle: MeshCycle) -> Cells:
    """Cells of a cycle that has them (`MeshCycle.face`)."""
    face = cycle.face
    assert face is not None
    rho1 = np.broadcast_to(cycle.rho1[..., None], face.line_load.shape)
    return Cells(face, rho1, np.isfinite(rho1) & (face.line_load > 0.0))


def line_loads(cycle: MeshCycle, face_width: float) -> Array:
    """Line loads of all cells (positions, pairs, cells) [N/m]: of one, as wide as the face [m], where they are even."""
    face = cycle.face
    return cycle.forces[..., None] / face_width if face is None else face.line_load
