"""Misalignment over the face after ISO 6336-1, method C: shafts that bend, teeth that deviate, running in."""

from __future__ import annotations

import math

from base import Faults, Limit, quantity, record
from base.results import EXACT
from gears.closed_form.record import STANDARD
from gears.pair.gear_pair import GearPair
from gears.rating.grades import Tolerances
from gears.rating.running_in import lead_allowance
from gears.rating.steels import Steels
from gears.tooth.errors import GeometryError

_SHARE = Limit(0.0, 1.0, remedy="1 of teeth that are not modified along the face")
LIMITS = {
    "torque": Limit.above(0.0, 1e9, "N m", "give the pinion's torque, K_A and K_v in it"),
    "speed": Limit(0.0, 1e5, "rad/s", "give the pinion's speed"),
    "shaft": Limit(-1e3, 1e3, remedy="K' l s/d_1^2 (d_1/d_sh)^4, 0 of a pinion midway between its bearings"),
    "B_1": _SHARE,
    "B_2": _SHARE,
}
"""What method C takes."""


@record
class Misalignment:
    """Equivalent misalignment of a pair over its face, in the plane of action, after ISO 6336-1, method C."""

    f_sh: float = quantity("m", "by deflection of the pinion's shaft and body", shown="um")
    f_ma: float = quantity("m", "by helix slope deviations of both gears", shown="um", no_error=EXACT)
    F_bx: float = quantity("m", "initial equivalent misalignment", shown="um")
    y_beta: float = quantity("m", "running-in allowance", shown="um")
    F_by: float = quantity("m", "effective equivalent misalignment, after running in", shown="um")

    no_error = STANDARD
    headline = ("F_by", "f_sh", "f_ma")


def misalignment(
    pair: GearPair,
    torque: float,
    speed: float,
    steels: Steels,
    deviations: Tolerances,
    *,
    shaft: float = 0.0,
    B_1: float = 1.0,
    B_2: float = 1.0,
) -> Misalignment:
    """Misalignment F_by that `gears.closed_form.iso6336_face_load` takes, of a stage of spur or helical gears.

    With F_m/b in N/mm, b and d_1 in mm and f_sh in um,

        f_sh = F_m/b 0.023 (abs(1 + shaft - 0.3) + 0.3) (b/d_1)^2,   f_ma = sqrt(f_Hbeta1^2 + f_Hbeta2^2)
        F_bx = 1.33 B_1 f_sh + B_2 f_ma,   F_by = F_bx - (y_beta1 + y_beta2)/2

    Parameters
    ----------
    pair : GearPair
    torque : float
        Of the pinion, with application and dynamic factor [N m].
    speed : float
        Of the pinion [rad/s].
    steels : tuple of RatedSteel
    deviations : Tolerances
        Their f_Hbeta are the mesh misalignment by manufacture.
    shaft : float
        K' l s/d_1^2 (d_1/d_sh)^4 with the distance l of the bearings, the offset s of the pinion and its shaft's
        diameter d_sh. 0 is a pinion midway.
    B_1, B_2 : float
        What modifications along the face leave of f_sh and f_ma; 1 without.

    Returns
    -------
    Misalignment

    Raises
    ------
    GeometryError
        With every fault of the numbers; for hardened steels that start with more than 40 um, whose bound of y_beta no
        source here confirms.

    Notes
    -----
    ISO/TR 6336-30 example 1 confirms shaft = 0 and B_1 = B_2 = 1 of hardened steels: K_Hbeta 1.16. K' for places of
    the pinion and factors B of modifications are in one open program alone, and stay parameters. Double helical gears
    are left out.

    References
    ----------
    ISO 6336-1:2006, clause 7.5 (f_sh, f_ma, F_bx) and 7.4.2 (y_beta).

    Examples
    --------
    >>> from gears import Gear
    >>> from gears.rating import RatedSteel, tolerances
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> steels = (RatedSteel("Eh", 1500e6, 430e6),) * 2
    >>> round(1e6 * misalignment(pair, 600.0, 200.0, steels, tolerances(pair, 6)).F_by, 1)
    13.6
    """
    with Faults(GeometryError) as faults:
        faults.numbers(LIMITS, (torque, speed, shaft, B_1, B_2))
    diameter = 2.0 * pair.reference_radii[0]
    line_load = 1e-3 * pair.tangential_force(torque) / pair.face_width
    f_sh = 1e-6 * line_load * 0.023 * (abs(1.0 + shaft - 0.3) + 0.3) * (pair.face_width / diameter) ** 2
    f_ma = math.hypot(*deviations.f_Hbeta)
    initial = 1.33 * B_1 * f_sh + B_2 * f_ma
    if initial > 40e-6 and any(steel.hardened for steel in steels):
        allowed = "must be at most 40 um where a gear is hardened, up to which running in is confirmed"
        raise GeometryError.at(
            "F_bx", f"{1e6 * initial:.3g} um", allowed, "give the effective misalignment itself"
        )
    velocity = pair.reference_radii[0] * speed
    first, second = (lead_allowance(steel, initial, velocity) for steel in steels)
    y = 0.5 * (first + second)
    return Misalignment(f_sh, f_ma, initial, y, initial - y)
