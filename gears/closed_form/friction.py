"""Mean coefficient of friction of lubricated teeth in closed form, after Schlenk."""

from __future__ import annotations

from base import Faults, Limit
from gears.pair.gear_pair import GearPair
from gears.pair.spur_only import check_spur
from gears.tooth.errors import GeometryError

_LIMITS = {
    "torque": Limit.above(0.0, unit="N m", remedy="of the pinion"),
    "speed": Limit.above(0.0, unit="rad/s", remedy="of the pinion"),
    "viscosity": Limit.above(
        0.0, unit="Pa s", remedy="of the oil as it reaches the teeth, at ambient pressure"
    ),
    "roughness": Limit.above(0.0, 1e-4, "m", "arithmetic mean roughness Ra of both flanks, 4e-7 is Ra 0.4"),
    "lubricant_factor": Limit.above(0.0, 10.0, remedy="1 for plain mineral oils"),
}


def schlenk_friction(
    pair: GearPair,
    torque: float,
    speed: float,
    viscosity: float,
    roughness: float,
    lubricant_factor: float = 1.0,
) -> float:
    """Mean coefficient of friction of the teeth, a fit to measured losses of test gears.

    ``mu = 0.048 [(F_bt/b)/(v_C rho_C)]^0.2 eta^-0.05 Ra^0.25 X_L`` with F_bt/b in N/mm, v_C = 2 v_t sin alpha_wt (the
    sum of both surface speeds at C) in m/s, rho_C (relative curvature at C) in mm, eta in mPa s and Ra in um.

    Range: that of the tests it was fitted to, case-hardened steel and mineral oil; no limits are applied.

    Parameters
    ----------
    pair : GearPair
    torque, speed : float
        Of the pinion [N m], [rad/s].
    viscosity : float
        Of the oil at its inlet temperature and ambient pressure [Pa s].
    roughness : float
        Arithmetic mean roughness, the mean of both flanks [m].
    lubricant_factor : float
        X_L, 1 for mineral oils without additives.

    Raises
    ------
    GeometryError
        With every fault of the numbers, and of helical pairs.

    References
    ----------
    L. Schlenk, Untersuchungen zur Fresstragfaehigkeit von Grosszahnraedern, thesis, Munich (1994). The constants are
    those of two open programs (docs/validation/losses.md), not of a print.

    Examples
    --------
    >>> from gears import Gear
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> f"{schlenk_friction(pair, 600.0, 209.44, 0.075, 0.4e-6):.4f}"
    '0.0516'
    """
    values = (torque, speed, viscosity, roughness, lubricant_factor)
    with Faults(GeometryError) as faults:
        check_spur(faults, pair, "Schlenk's friction")
        faults.numbers(_LIMITS, values)
    at_pitch = pair.path_at(pair.points.C)
    load = 1e-3 * torque / pair.base_radii[0] / pair.face_width
    rolling = 2.0 * at_pitch.entrainment(speed).item()
    curvature = 1e3 * at_pitch.radius.item()
    fitted = (load / (rolling * curvature)) ** 0.2 * (1e3 * viscosity) ** -0.05 * (1e6 * roughness) ** 0.25
    return float(0.048 * lubricant_factor * fitted)
