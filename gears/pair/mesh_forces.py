"""Forces of a mesh at the reference cylinders by the torque alone, and the moment of the axial force."""

from __future__ import annotations

from typing import TYPE_CHECKING

from base import Faults, Limit, quantity, record
from base.results import EXACT
from gears.tooth.errors import GeometryError

if TYPE_CHECKING:
    from gears.pair.pair_geometry import PairGeometry

__all__ = ["MeshForces", "mesh_forces"]

TORQUE = Limit(-1e9, 1e9, "N m", "give the torque on the pinion")
"""What the torque may be."""


@record
class MeshForces:
    """Force of the flanks of one gear on those of the other, and its components.

    F_bn^2 = F_t^2 + F_r^2 + F_a^2. All are those of the torque without factors, of either gear; the sign of F_a is
    that on the pinion.
    """

    normal: float = quantity("N", "normal force F_bn of the mesh, in the normal section of the flanks")
    tangential: float = quantity("N", "tangential force F_t, at the reference cylinders")
    radial: float = quantity("N", "radial force F_r, at the reference cylinders")
    axial: float = quantity("N", "axial force F_a on the pinion; above 0 along the axis about which it turns")
    tilting_moment: tuple[float, float] = quantity(
        "N m", "tilting moment of the axial force, F_a d_w / 2", "gear"
    )

    no_error = EXACT


def mesh_forces(pair: PairGeometry, torque: float) -> MeshForces:
    """Forces of the mesh of a pair by a torque on its pinion.

    F_bn = T/(r_b1 cos beta_b), F_t = T/r_1, F_r = F_t tan alpha_t, F_a = F_t tan beta, and the moment F_a r_w that
    tilts either gear about the axis across both shafts, in the same sense.

    Parameters
    ----------
    pair : GearPair
        Spur or helical.
    torque : float
        Of the pinion [N m]; negative where the wheel drives.

    Returns
    -------
    MeshForces

    Raises
    ------
    GeometryError
        For a torque that is no finite number within 1e9 N m.

    References
    ----------
    ISO 21771:2007; ISO 6336-1:2006, clause 4.

    Examples
    --------
    >>> import math
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, helix_angle=math.radians(20.0))
    >>> mesh_forces(pair, 600.0)
    MeshForces(normal 17736 N, tangential 15662 N, radial 6066.2 N, axial 5700.3 N)
    """
    with Faults(GeometryError) as faults:
        faults.number("torque", torque, TORQUE)
    axial = pair.axial_force(torque)
    first, second = pair.pitch_radii
    return MeshForces(
        pair.normal_force(torque),
        pair.tangential_force(torque),
        pair.radial_force(torque),
        axial,
        (axial * first, axial * second),
    )
