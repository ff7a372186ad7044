"""Face-load factor after ISO 6336-1, method C."""

from __future__ import annotations

import math

from base import Faults, Limit, quantity, record
from base.units import factor
from gears.closed_form.record import STANDARD
from gears.closed_form.tooth_stiffness import iso6336
from gears.pair.gear_pair import GearPair
from gears.tooth.errors import GeometryError

LEAST_DEPTHS = 3.0
"""Smallest face width over tooth depth that enters the exponent of the root stress."""

_LIMITS = {
    "torque": Limit.above(0.0, 1e9, "N m", "give the pinion's torque, dynamic factors in it"),
    "misalignment": Limit(0.0, 5e-3, "m", "give the deviation over the face width in metres"),
}


@record
class Iso6336FaceLoad:
    """Face-load factor for pitting after ISO 6336-1."""

    K_Hbeta: float = quantity("1", "face-load factor: maximum over mean line load")
    K_Fbeta: float = quantity("1", "face-load factor of the root stress: K_Hbeta to the power N_F")
    N_F: float = quantity("1", "its exponent, by the face width over the tooth depth")
    b_cal: float = quantity(
        "1", "calculated face width that bears, over the face width; above 1 where all of it does"
    )
    c_gamma_beta: float = quantity("N/(mm um)", "mesh stiffness along the face")

    no_error = STANDARD
    headline = ("K_Hbeta", "b_cal")


def iso6336_face_load(pair: GearPair, torque: float, misalignment: float) -> Iso6336FaceLoad:
    """Face-load factor K_Hbeta of a pair with a known misalignment in the plane of action.

    With F_m/b the mean tangential line load at the reference circle and c_gamma_beta = 0.85 c_gamma_alpha,

        K = 1 + F_by c_gb/(2 F_m/b)          while the whole face bears (K <= 2),
        K = sqrt(2 F_by c_gb/(F_m/b))        otherwise.

    The teeth are a linear spring in slices that know of each other by their common approach alone; the factor grows by
    the square root where the load lets go of one end.

    F_by is given here: the standard's ways to it from deflections and tolerances, F_bx = 1.33 B_1 f_sh + B_2 f_ma with
    factors for modified leads, guide values of crowning and end relief (Annex B) and running in, are left out.

    A root feels the load of its surroundings: its factor is K_Fbeta = K_Hbeta^N_F, with the face width b over the tooth
    depth h, the smaller of both gears' and at least 3,

        N_F = 1/(1 + h/b + (h/b)^2) .

    Parameters
    ----------
    pair : GearPair
    torque : float
        Of the pinion, with application and dynamic factors [N m].
    misalignment : float
        F_by, the effective equivalent misalignment that is left after running in, over the face [m].

    Returns
    -------
    Iso6336FaceLoad

    Raises
    ------
    GeometryError
        If a number is out of range.

    References
    ----------
    ISO 6336-1:2019, clause 7.

    Examples
    --------
    >>> from gears import Gear
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> f"{iso6336_face_load(pair, 600.0, 20e-6).K_Hbeta:.2f}"
    '1.42'
    """
    with Faults(GeometryError) as faults:
        faults.number("torque", torque, _LIMITS["torque"])
        faults.number("misalignment", misalignment, _LIMITS["misalignment"])
    line_load = torque / pair.reference_radii[0] / pair.face_width
    stiffness = iso6336(pair).c_gamma_beta
    opened = misalignment * stiffness * factor("N/(mm um)") / line_load
    K = 1.0 + 0.5 * opened if opened <= 2.0 else math.sqrt(2.0 * opened)
    bears = math.inf if opened == 0.0 else 0.5 + 1.0 / opened if opened <= 2.0 else math.sqrt(2.0 / opened)
    exponent = _bending_exponent(pair)
    return Iso6336FaceLoad(K, K**exponent, exponent, bears, stiffness)


def _bending_exponent(pair: GearPair) -> float:
    """N_F = 1/(1 + h/b + (h/b)^2), of the gear whose face is narrower in tooth depths h, and of no less than three."""
    depths = (profile.tip_radius - profile.root_radius for profile in pair.teeth_profiles)
    narrow = min(width / depth for width, depth in zip(pair.face_widths, depths, strict=True))
    over = 1.0 / max(narrow, LEAST_DEPTHS)
    return 1.0 / (1.0 + over + over**2)
