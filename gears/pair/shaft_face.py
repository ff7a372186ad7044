r"""How a shaft gives way over the face of its gear: bending and twist between places along the face.

A force on the flank at z' moves the flank at z by the bending line of the shaft, Timoshenko's beam on its bearings
(``gears.pair.beams``), and by the twist of the shaft between the two and the place where the torque comes in,

.. math:: u(z) = s(z, z') F, \qquad
   u(z) = r_b^2 F \left|\int \frac{dx}{G I_p}\right| \text{ over what the ways from } z \text{ and } z' \text{ share},

both along the line of action and both symmetric (Maxwell and Betti). What bends and twists under the gear is the step
that the shaft has there.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos

import numpy as np

from base import Array, Integers
from gears.pair.beams import bending
from gears.pair.shafts import SAME, Shaft

__all__ = ["ShaftOverFace", "joined", "shaft_over_face", "twisted"]


@dataclass(frozen=True, eq=False)
class ShaftOverFace:
    """Flexibility of a shaft along the line of action at places z of its gear's face.

    Attributes
    ----------
    bent, twisted : ndarray, shape (n, n)
        Deflection at z by a unit force at z' [m/N]: along the force by bending, alike in all directions across the
        axis, and by twist.
    """

    bent: Array
    twisted: Array

    @property
    def between(self) -> Array:
        """Deflection at z by a unit force at z' along the same line of action (n, n) [m/N]."""
        return self.bent + self.twisted

    def across(self, apart: float) -> Array:
        """The same along a line of action by a force on the flanks of the other side (n, n) [m/N].

        Their torques are opposed, and their normals stand pi - `apart` from each other, 2 alpha_w of both lines [rad].
        """
        return np.asarray(-cos(apart) * self.bent - self.twisted)


def shaft_over_face(
    shaft: Shaft, z: Array, base_radius: float, offset: float = 0.0, face_width: float = 0.0
) -> ShaftOverFace:
    """Bend and twist a shaft by forces on its gear.

    Parameters
    ----------
    shaft : Shaft
        Whose left end is at the smallest z.
    z : (n,) array
        Places along the face, growing, 0 at the middle of the face in contact [m].
    base_radius : float
        Lever of the forces [m].
    offset : float
        Middle of the gear's own face [m], which is at the shaft's ``gear_position``.
    face_width : float
        Of the face in contact, whose end on the torque's side does not turn; that of the outermost places if less [m].

    Returns
    -------
    ShaftOverFace

    Examples
    --------
    >>> from gears import Bearing, ShaftSegment
    >>> shaft = Shaft((ShaftSegment(0.2, 0.03),), (Bearing(0.0, 1e12), Bearing(0.2, 1e12)), 0.1, 0.1)
    >>> found = shaft_over_face(shaft, np.array([-0.02, 0.0, 0.02]), 0.03)
    >>> f"{1e-6 / found.between[1, 1]:.1f}"  # N/um under a force at mid-face, as of gears.pair.beams.reduced
    '46.8'
    """
    places = shaft.gear_position - offset + np.asarray(z, dtype=float)
    middle, half = shaft.gear_position - offset, 0.5 * face_width
    ends = min(places.min(), middle - half), max(places.max(), middle + half)
    nodes, at = joined(np.concatenate([shaft.places, places]), SAME * shaft.length)
    at = at[len(shaft.places) :]
    loads = np.zeros((2 * len(nodes), len(places)))
    loads[2 * at, np.arange(len(places))] = 1.0
    bent = np.linalg.solve(bending(shaft, nodes)[0], loads)[2 * at]
    return ShaftOverFace(0.5 * (bent + bent.T), base_radius**2 * twisted(shaft, places, ends))


def joined(places: Array, apart: float) -> tuple[Array, Integers]:
    """Places from the left, those no farther apart than a distance as one, and the number of each.

    A beam between places that differ by rounding would have a stiffness beside which all others are lost.
    """
    distinct, number = np.unique(places, return_inverse=True)
    first = np.append(True, np.diff(distinct) > apart)
    return distinct[first], (np.cumsum(first) - 1)[number]


def twisted(shaft: Shaft, places: Array, face: tuple[float, float]) -> Array:
    """Turn at places by unit torques at places (n, n) [rad/(N m)], against the end of the face on the torque's side."""
    ends = np.concatenate([[0.0], np.cumsum([segment.length for segment in shaft.segments])])
    polar = np.array([2.0 * segment.second_moment for segment in shaft.segments])
    turned = np.concatenate([[0.0], np.cumsum(np.diff(ends) / (shaft.material.shear_modulus * polar))])
    enters = np.clip(shaft.torque_position, *face)
    way = np.interp(places, ends, turned) - np.interp(enters, ends, turned)
    same = way[:, None] * way > 0.0
    return np.where(same, np.minimum(np.abs(way)[:, None], np.abs(way)), 0.0)
