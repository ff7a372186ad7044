r"""The mesh between two bodies with six freedoms each: wrenches of its cells, linearised about the loaded state.

Axes: x along the transverse line of action, in which the driving pinion presses, z the axis about which it turns
anticlockwise, y = z x x. A body's freedoms are displacements along these and turns about them, at mid-face on its
axis. A cell at curvature radius rho and height z stands at

.. math:: r_1 = (\rho_1, -r_{b1}, z), \qquad r_2 = (-\rho_2, r_{b2}, z)

from its gear's middle. The pinion presses along :math:`N = \cos\beta_b\,(1, 0, -\tan\beta_b)`, and both gears approach
each other there by :math:`\delta = g \cdot q` with :math:`g = (N, r_1 \times N, -N, -r_2 \times N)`.

Along a plane of action all :math:`g` depend on :math:`\xi = z + \rho_1 \tan\beta_b` alone, and linearly: whatever its
cells, a mesh reaches two relative motions, an approach and a tilt.
"""

from __future__ import annotations

import numpy as np

import fem
import gears
from base import Array, Faults, record

__all__ = ["FREEDOMS", "SpatialMesh", "cell_wrenches", "spatial_mesh"]

FREEDOMS = ("x", "y", "z", "about x", "about y", "about z")
"""Of a body: displacements, then turns."""


@record
class SpatialMesh:
    """Mesh over one base pitch, at the midpoints of equal intervals.

    Attributes
    ----------
    stiffness : (positions, 12, 12) array
        Of g g^T by the slopes of forces: of pinion, then wheel [N/m, N, N m].
    load : (positions, 12) array
        Sum of F_c g: what the static load presses the bodies apart with [N, N m].
    turn : (positions,) array
        Turn of the pinion times its base radius with the wheel held, under that load [m].
    pair : gears.GearPair
    torque : float
        Of the pinion [N m].
    coarser : (positions, 12, 12) array or None
        Stiffness with half as many cells.
    """

    stiffness: Array
    load: Array
    turn: Array
    pair: gears.GearPair
    torque: float
    coarser: Array | None = None

    @property
    def torsion(self) -> Array:
        """Approach along the transverse line of action by the pinion alone (12,): 1 in its turn times base radius."""
        unit = np.zeros(12)
        unit[5] = 1.0 / self.pair.base_radii[0]
        return unit

    @property
    def torsional_stiffness(self) -> Array:
        """Stiffness of the pair that turns alone (positions,) [N/m]."""
        return np.asarray(self.torsion @ self.stiffness @ self.torsion)

    @property
    def free_turn(self) -> Array:
        """Rotation of both gears on which no mesh acts (12,)."""
        unit = self.torsion
        unit[11] = -1.0 / self.pair.base_radii[1]
        return unit


def cell_wrenches(pair: gears.GearPair, rho1: Array, z: Array) -> Array:
    r"""Approach of both flanks by the freedoms of both bodies (..., 12).

    Parameters
    ----------
    pair : gears.GearPair
    rho1, z : (...) arrays
        Curvature radius on the pinion in the transverse section, and place along the face [m].

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, helix_angle=0.35)
    >>> g = cell_wrenches(pair, np.array(pair.points.C), np.array(0.0))
    >>> bool(np.isclose(g[5], pair.base_radii[0] * pair.helix.base_cosine)), g[:3].tolist() == (-g[6:9]).tolist()
    (True, True)
    """
    cosine, slope = pair.helix.base_cosine, pair.helix.base_tangent
    normal = cosine * np.array([1.0, 0.0, -slope])
    first, second = pair.base_radii
    rho, place = np.broadcast_arrays(np.asarray(rho1, dtype=np.float64), np.asarray(z, dtype=np.float64))
    arms = (
        np.stack([rho, np.full_like(rho, -first), place], axis=-1),
        np.stack([rho - pair.line_of_action, np.full_like(rho, second), place], axis=-1),
    )
    parts = [np.broadcast_to(normal, arms[0].shape), np.cross(arms[0], normal)]
    parts += [np.broadcast_to(-normal, arms[1].shape), -np.cross(arms[1], normal)]
    return np.concatenate(parts, axis=-1)


def spatial_mesh(cycle: fem.MeshCycle) -> SpatialMesh:
    """Mesh of a helical pair with six freedoms a body, by its loaded contact.

    The stiffness is that of the linearised contact against the two motions that bodies reach, an approach and a tilt,
    with the couplings of all cells by the bodies (`fem.LineLoads.tilting`).

    Parameters
    ----------
    cycle : fem.MeshCycle
        Of a helical pair; measured against "body", as motion is.

    Raises
    ------
    InputError
        Of a cycle without lines of contact, or of back flanks.

    Examples
    --------
    >>> from flankfilm.coupling import spatial_mesh
    >>> mesh = spatial_mesh(fem.mesh_cycle(pair, 600.0, 16))  # doctest: +SKIP
    """
    lines, pair = cycle.lines, cycle.pair
    with Faults() as faults:
        if lines is None:
            allowed = "must have lines of contact, as those of helical pairs do"
            faults.add("cycle", pair, allowed, "give helix_angle, or take `pair_drive` for a spur pair")
        elif cycle.flank == "back":
            allowed = "must be of a pinion that drives"
            faults.add(
                "cycle.torque", f"{cycle.torque:g}", allowed, "take the other hand and a torque above 0"
            )
    assert lines is not None
    pitch_point, cosine = np.array(pair.points.C), pair.helix.base_cosine
    there = cell_wrenches(pair, pitch_point, np.array(0.0))
    moved = np.stack([there, cell_wrenches(pair, pitch_point, np.array(1.0)) - there]) / cosine
    fine, coarse = np.einsum("ai,npab,bj->npij", moved, lines.tilting, moved)
    wrench = cell_wrenches(pair, np.nan_to_num(lines.rho[0]), np.nan_to_num(lines.z))
    # forces at tip edges and on relief along the line of action, as large as the torque about the pinion makes them
    load = np.einsum("plc,plci->pi", lines.force * np.nan_to_num(lines.levers[0]), wrench)
    return SpatialMesh(fine, load, cycle.transmission_error, pair, cycle.torque, coarse)
