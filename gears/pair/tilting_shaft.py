r"""How a shaft bends and tilts under forces and couples on its gear: what forces with an axial part need.

The axial part of a force at a contact point bends the shaft by a couple: by the arm of the point along the line of
action in the plane of that line and of the axis, and by the base radius in the plane at right angles to it. The beam,
alike in all directions across the axis, turns forces and couples at z' into deflections v and slopes v' at z, a matrix
that is symmetric by Maxwell and Betti,

.. math:: \begin{pmatrix} v(z) \\ v'(z) \end{pmatrix} = \Phi(z, z') \begin{pmatrix} F \\ C \end{pmatrix} .

Axial motion of the shaft is left out: one of its bearings holds it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from base import Array
from gears.pair.beams import bending, node_at
from gears.pair.shaft_face import joined, twisted
from gears.pair.shafts import SAME, Shaft

__all__ = ["TiltingShaft", "bearing_forces", "tilting_shaft"]


@dataclass(frozen=True, eq=False)
class TiltingShaft:
    """Flexibility of a shaft at places z of its gear's face.

    Attributes
    ----------
    bent : ndarray, shape (2, n, 2, n)
        Deflection [m] and slope [rad] at z by a unit force and by a unit couple at z' in the same plane.
    twisted : ndarray, shape (n, n)
        Turn at z by a unit torque at z' [rad/(N m)], against the end of the face on the torque's side.
    bearings : ndarray, shape (bearings, 2, n)
        Force that a bearing carries by a unit force [1], and by a unit couple [1/m], at z.
    """

    bent: Array
    twisted: Array
    bearings: Array


def tilting_shaft(shaft: Shaft, z: Array, offset: float = 0.0, face_width: float = 0.0) -> TiltingShaft:
    """Bend, tilt and twist a shaft by forces and couples on its gear.

    Parameters
    ----------
    shaft : Shaft
        Whose left end is at the smallest z.
    z : (n,) array
        Places along the face, growing, 0 at the middle of the face in contact [m].
    offset : float
        Middle of the gear's own face [m], which is at the shaft's ``gear_position``.
    face_width : float
        Of the face in contact, whose end on the torque's side does not turn; that of the outermost places if less [m].

    Returns
    -------
    TiltingShaft

    Examples
    --------
    >>> from gears import Bearing, ShaftSegment
    >>> shaft = Shaft((ShaftSegment(0.2, 0.03),), (Bearing(0.0, 1e12), Bearing(0.2, 1e12)), 0.1, 0.1)
    >>> found = tilting_shaft(shaft, np.array([0.0]))
    >>> f"{1e-6 / found.bent[0, 0, 0, 0]:.1f}"  # N/um under a force in the middle
    '46.8'
    >>> found.bearings[:, 1, 0] * 0.2 + 0.0  # a couple is carried by forces that are opposed, over the span
    array([-1.,  1.])
    """
    middle, half = shaft.gear_position - offset, 0.5 * face_width
    places = middle + np.asarray(z, dtype=float)
    ends = min(places.min(), middle - half), max(places.max(), middle + half)
    nodes, at = joined(np.concatenate([shaft.places, places]), SAME * shaft.length)
    at, count = at[len(shaft.places) :], len(places)
    freedoms = np.concatenate([2 * at, 2 * at + 1])
    loads = np.zeros((2 * len(nodes), 2 * count))
    loads[freedoms, np.arange(2 * count)] = 1.0
    moved = np.linalg.solve(bending(shaft, nodes)[0], loads)
    bent = moved[freedoms]
    carried = [bearing.stiffness * moved[2 * node_at(nodes, bearing.position)] for bearing in shaft.bearings]
    return TiltingShaft(
        (0.5 * (bent + bent.T)).reshape(2, count, 2, count),
        twisted(shaft, places, ends),
        np.array(carried).reshape(-1, 2, count),
    )


def bearing_forces(
    shaft: Shaft, along: Array, tilting: Array, across: Array | float, offset: float = 0.0
) -> Array:
    """Radial forces that bearings carry under the loads of a mesh (bearings, n, 2) [N].

    Along a force and across it; weights and what couplings add are left out.

    Parameters
    ----------
    shaft : Shaft
    along : (n,) array
        Force [N].
    tilting : (n,) array
        Moment of the loads about mid-face in its plane [N m].
    across : (n,) array or float
        Moment in the plane at right angles to it [N m].
    offset : float
        Of mid-face, as of `tilting_shaft` [m].
    """
    by_force, by_couple = np.moveaxis(tilting_shaft(shaft, np.zeros(1), offset).bearings[..., 0], 1, 0)
    in_plane = np.outer(by_force, along) + np.outer(by_couple, tilting)
    return np.stack([in_plane, np.outer(by_couple, np.full_like(along, across))], axis=-1)
