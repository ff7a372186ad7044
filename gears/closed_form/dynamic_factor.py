"""Dynamic factor after ISO 6336-1, method B."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from base import Array, Faults, Limit, quantity, record
from base.units import factor
from gears.closed_form.record import STANDARD
from gears.closed_form.tooth_stiffness import iso6336
from gears.pair.gear_pair import GearPair
from gears.pair.hertz import NORMAL_FORCE
from gears.tooth.errors import GeometryError

_AMOUNT = Limit(0.0, unit="m", remedy="give its amount in metres")
_LIMITS = {
    "force": NORMAL_FORCE,
    "reduced_mass": Limit.above(0.0, unit="kg", remedy="give the mass in kilograms"),
    "pitch_deviation": _AMOUNT,
    "profile_deviation": _AMOUNT,
    "relief": _AMOUNT,
}


@record
class Iso6336DynamicFactor:
    """Dynamic factor over speed after ISO 6336-1, method B."""

    K_v: Array = quantity("1", "dynamic factor", "speed")
    N: Array = quantity("1", "resonance ratio, speed over resonance speed", "speed")
    N_S: float = quantity("1", "end of the subcritical range")
    resonance_speed: float = quantity("rad/s", "pinion speed at N = 1", shown="rpm")
    B_p: float = quantity("1", "effect of the pitch deviation, over the deflection")
    B_f: float = quantity("1", "effect of the profile deviation, over the deflection")
    B_k: float = quantity("1", "effect of the tip relief, over the deflection")

    no_error = STANDARD
    headline = ("resonance_speed", "N_S", "B_p", "B_f", "B_k")


def iso6336_dynamic(
    pair: GearPair,
    force: float,
    reduced_mass: float,
    speed: npt.ArrayLike,
    *,
    pitch_deviation: float = 0.0,
    profile_deviation: float = 0.0,
    relief: float = 0.0,
) -> Iso6336DynamicFactor:
    r"""Dynamic factor of a pair of solid discs after ISO 6336-1, method B.

    With :math:`N = z_1\Omega_1/\sqrt{c_\gamma b/m}` and the load per width w, B_p = c' f_pb/w, B_f = c' f_fa/w,
    B_k = \|1 - c' C_a/w\|: up to N_S K_v = N (C_v1 B_p + C_v2 B_f + C_v3 B_k) + 1; up to 1.15
    C_v1 B_p + C_v2 B_f + C_v4 B_k + 1; from 1.5 C_v5 B_p + C_v6 B_f + C_v7; linear between. The C_v are those of the
    total contact ratio.

    Parameters
    ----------
    pair : GearPair
        The gears.
    force : float
        Normal force with the application factor in it [N].
    reduced_mass : float
        Mass of both gears reduced to the line of action [kg], not per face width.
    speed : array_like
        Pinion speed [rad/s].
    pitch_deviation, profile_deviation : float
        Effective deviations f_pb and f_fa after running in [m].
    relief : float
        Tip relief C_a [m].

    Returns
    -------
    Iso6336DynamicFactor
        K_v and what it is made of.

    Raises
    ------
    GeometryError
        If a number is not finite, or not positive where it must be, or the contact ratio is 1 or less.

    Notes
    -----
    The constants C_v1 to C_v7 were checked against two public programs that agree, not against the standard's text.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> factor = iso6336_dynamic(pair, force=10e3, reduced_mass=0.38, speed=[100.0, 200.0], relief=10e-6)
    >>> factor.K_v
    array([..., ...])
    """
    omega = np.asarray(speed, dtype=np.float64)
    ratio = pair.total_contact_ratio
    with Faults(GeometryError) as faults:
        faults.numbers(_LIMITS, (force, reduced_mass, pitch_deviation, profile_deviation, relief))
        if not (np.all(np.isfinite(omega)) and np.all(omega >= 0.0)):
            faults.add("speed", "an entry", "must be finite and at least 0", "give rad/s")
        if not ratio > 1.0:
            faults.add("pair", f"{ratio:g}", "must have a contact ratio above 1", "method B requires it")
    stiffness = iso6336(pair, force)
    tangential = force * math.cos(pair.rack.alpha) * pair.helix.cosine / pair.face_width  # N/m
    load = tangential / 1e3  # N/mm
    limit = 0.85 if load >= 100.0 else 0.5 + 0.35 * math.sqrt(load / 100.0)
    resonance = math.sqrt(stiffness.mesh_stiffness / reduced_mass) / pair.pinion.teeth
    prime = stiffness.c_prime * factor("N/(mm um)")
    b_p, b_f = prime * pitch_deviation / tangential, prime * profile_deviation / tangential
    b_k = abs(1.0 - prime * relief / tangential)
    c1, c2, c3, c4, c5, c6, c7 = _constants(ratio)
    n = omega / resonance
    main = c1 * b_p + c2 * b_f + c4 * b_k + 1.0
    above = c5 * b_p + c6 * b_f + c7
    between = above + (main - above) * (1.5 - n) / 0.35
    rising = n * (c1 * b_p + c2 * b_f + c3 * b_k) + 1.0
    k_v = np.select([n >= 1.5, n > 1.15, n <= limit], [above, between, rising], main)
    return Iso6336DynamicFactor(k_v, n, limit, resonance, b_p, b_f, b_k)


def _constants(ratio: float) -> tuple[float, float, float, float, float, float, float]:
    """C_v1 to C_v7 of a contact ratio."""
    seven = 0.125 * math.sin(math.pi * (min(max(ratio, 1.5), 2.5) - 2.0)) + 0.875
    if ratio <= 2.0:
        return 0.32, 0.34, 0.23, 0.90, 0.47, 0.47, seven
    three, four = 0.096 / (ratio - 1.56), (0.57 - 0.05 * ratio) / (ratio - 1.44)
    return 0.32, 0.57 / (ratio - 0.3), three, four, 0.47, 0.12 / (ratio - 1.74), seven
