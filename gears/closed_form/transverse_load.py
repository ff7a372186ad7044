"""Transverse load factors after ISO 6336-1, method B."""

from __future__ import annotations

import math

from base import Faults, Limit, quantity, record
from base.units import factor
from gears.closed_form.contact_stress import iso6336_2
from gears.closed_form.record import STANDARD
from gears.closed_form.tooth_stiffness import iso6336
from gears.pair.gear_pair import GearPair
from gears.tooth.errors import GeometryError

_LIMITS = {
    "torque": Limit.above(0.0, 1e9, "N m", "give the pinion's torque, the other factors in it"),
    "pitch_deviation": Limit(0.0, 5e-3, "m", "give the deviation f_pb less what running in takes, in metres"),
}


@record
class Iso6336TransverseLoad:
    """Transverse load factors after ISO 6336-1: the most loaded pair of teeth over its share of the force."""

    K_Halpha: float = quantity("1", "transverse load factor of the contact stress")
    K_Falpha: float = quantity("1", "transverse load factor of the root stress")
    limits: tuple[float, float] = quantity(
        "1", "what both factors are at most: one pair bears alone", "stress"
    )

    no_error = STANDARD
    headline = ("K_Halpha", "K_Falpha")


def iso6336_transverse_load(pair: GearPair, torque: float, pitch_deviation: float) -> Iso6336TransverseLoad:
    """Transverse load factors of a pair with a difference of base pitches, after ISO 6336-1, method B.

    With q = c_gamma_alpha (f_pb - y_alpha)/(F_tH/b), F_tH/b the tangential line load at the reference circle,

        K = epsilon_gamma/2 (0.9 + 0.4 q)                                        for epsilon_gamma <= 2,
        K = 0.9 + 0.4 q sqrt(2 (epsilon_gamma - 1)/epsilon_gamma)                for epsilon_gamma > 2,

    at least 1, K_Halpha at most epsilon_gamma/(epsilon_alpha Z_eps^2), K_Falpha at most
    epsilon_gamma/(epsilon_alpha Y_eps) with Y_eps = 0.25 + 0.75 cos^2(beta_b)/epsilon_alpha.

    Parameters
    ----------
    pair : GearPair
        Spur or helical.
    torque : float
        Of the pinion, with application, dynamic and face-load factors [N m].
    pitch_deviation : float
        f_pb - y_alpha, the larger base pitch deviation less the running-in allowance [m].

    Returns
    -------
    Iso6336TransverseLoad

    Raises
    ------
    GeometryError
        If a number is out of range.

    Notes
    -----
    The formulas are remembered from the standard's text, not compared with a worked example.

    References
    ----------
    ISO 6336-1:2006, Calculation of load capacity of spur and helical gears, part 1: Basic principles, introduction and
    general influence factors, clause 8.

    Examples
    --------
    >>> from gears import Gear
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, helix_angle=0.35)
    >>> iso6336_transverse_load(pair, 600.0, 10e-6).K_Halpha
    1.12...
    """
    with Faults(GeometryError) as faults:
        faults.numbers(_LIMITS, (torque, pitch_deviation))
    total, ratio = pair.total_contact_ratio, pair.contact_ratio
    line_load = pair.tangential_force(torque) / pair.face_width
    uneven = iso6336(pair).c_gamma * factor("N/(mm um)") * pitch_deviation / line_load
    shared = 0.9 + 0.4 * uneven * math.sqrt(2.0 * (total - 1.0) / total)
    wanted = 0.5 * total * (0.9 + 0.4 * uneven) if total <= 2.0 else shared
    Y_eps = 0.25 + 0.75 * pair.helix.base_cosine**2 / ratio
    Z_eps = iso6336_2(pair, pair.normal_force(torque)).Z_eps
    highest = total / (ratio * Z_eps**2), total / (ratio * Y_eps)
    K_Halpha, K_Falpha = (max(1.0, min(wanted, most)) for most in highest)
    return Iso6336TransverseLoad(K_Halpha, K_Falpha, highest)
