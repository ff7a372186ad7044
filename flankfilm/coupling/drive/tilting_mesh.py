"""The mesh between gears that tilt: where its force acts, how it resists tilt, and how much both vary."""

from __future__ import annotations

from typing import Any

import numpy as np

from base import Array
from flankfilm.coupling.drive.train import Train
from flankfilm.coupling.drive.travelling_load import load_travel
from flankfilm.coupling.mesh.mesh_curves import MeshCycle


def tilting_mesh(cycle: MeshCycle | None) -> dict[str, Any]:
    r"""Arguments of `pair_drive` about tilt, of a mesh cycle on shafts with cells over the face or along lines.

    With the mean matrix M between (approach, tilt) and (force, moment) about mid-face, the force acts at
    :math:`z = M_{10} / M_{00}`, and :math:`M_{11} - M_{10}^2 / M_{00}` resists tilt about that place. Along lines of
    contact z has :math:`(\rho_1 - \rho_{1C}) \tan\beta_b` besides. The load travels about the mean of its place. There
    are none of any other cycle.

    Parameters
    ----------
    cycle : MeshCycle or None

    Returns
    -------
    dict
        ``tilt_stiffness``, ``load_centre``, ``mesh_matrix`` and ``travel``, or empty.

    Examples
    --------
    >>> from gears import Bearing, Gear, GearPair, Shaft, ShaftSegment
    >>> from flankfilm.coupling import Flanks, mesh_cycle
    >>> pair = GearPair(Gear(20), Gear(30), 2e-3, 0.02)
    >>> shaft = Shaft((ShaftSegment(0.2, 0.03),), (Bearing(0.0, 3e8), Bearing(0.2, 3e8)), 0.06, 0.2)
    >>> flanks = Flanks(False, cells=8, face_model="walls", shafts=(shaft, shaft))
    >>> tilting = tilting_mesh(mesh_cycle(pair, 80.0, tolerance=0.02, flanks=flanks))
    >>> tilting["tilt_stiffness"] > 0.0, abs(tilting["load_centre"]) < 0.5 * pair.face_width
    (True, True)
    >>> 0.0 < tilting["travel"].range < pair.face_width
    True
    """
    matrix = None if cycle is None or cycle.face is None else cycle.face.mesh_matrix
    if cycle is not None and cycle.lines is not None and any(cycle.lines.setting.shafts):
        matrix = cycle.lines.tilting[0]
    if cycle is None or matrix is None:
        return {}
    resists, place = resistance_and_place(matrix.mean(axis=0))
    means = {"tilt_stiffness": float(resists), "load_centre": float(place)}
    return means | {"mesh_matrix": matrix, "travel": load_travel(cycle)}


def resistance_and_place(matrix: Array) -> tuple[Array, Array]:
    """Stiffness against tilt about the place of the force [N m/rad], and that place [m], of matrices (..., 2, 2)."""
    force, moment, turned = matrix[..., 0, 0], matrix[..., 1, 0], matrix[..., 1, 1]
    return np.asarray(turned - moment**2 / force), np.asarray(moment / force)


def change_over_cycle(train: Train, squares: Array, modes: Array, matrix: Array, place: float) -> float:
    """Maximum relative change of a natural frequency by the tilt and place of the mesh at one position of its cycle.

    Parameters
    ----------
    train : Train
        With the mean of both.
    squares : ndarray, shape (m,)
        Of its natural frequencies in contact.
    modes : ndarray, shape (n, m)
        Of a mass of one; the change is sought among them (Ritz).
    matrix : ndarray, shape (positions, 2, 2)
        The mesh over its cycle.
    place : float
        Where the force acts in the mean [m].
    """
    resists, places = resistance_and_place(matrix)
    approach, tilt = modes.T @ train.direction, modes.T @ train.tilt
    moved = approach + (places - place)[:, None] * tilt
    more = train.mesh_stiffness * (np.einsum("pi,pj->pij", moved, moved) - np.outer(approach, approach))
    more += (resists - train.tilt_stiffness)[:, None, None] * np.outer(tilt, tilt)
    eigenvalues = np.linalg.eigvalsh(np.diag(squares) + more)
    return float(np.max(np.abs(np.sqrt(np.maximum(eigenvalues, 0.0) / squares) - 1.0)))
