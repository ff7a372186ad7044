"""Safety against scuffing by the integral temperature, after ISO/TR 13989-2 and DIN 3990-4."""

from __future__ import annotations

import math

from base import Faults, Limit, quantity, record
from base.results import EXACT
from gears.closed_form.record import STANDARD
from gears.closed_form.tooth_stiffness import iso6336
from gears.pair.gear_pair import GearPair
from gears.rating.friction import GearOil, check_oil, roughness_factor, scuffing_friction
from gears.rating.load_factors import LoadFactors
from gears.tooth.errors import GeometryError

ZERO = 273.15
"""0 degC [K]."""

BULK, INTEGRAL = 0.7, 1.5
"""Shares C_1 of the bulk and C_2 of the integral temperature that the mean flash temperature has."""

LIMITS = {
    "speed": Limit.above(0.0, 1e5, "rad/s", "give the pinion's speed"),
    "roughness": Limit(1e-8, 1e-4, "m", "give the mean Ra of both flanks in metres"),
    "relief": Limit(0.0, 1e-3, "m", "give C_a in metres"),
    "test_torque": Limit.above(
        0.0, 1e4, "N m", "give T_1T of the load stage that scuffs, 714.2 N m of stage 14"
    ),
    "structure": Limit.above(0.0, 2.0, remedy="X_WrelT, 1 of case-hardened steel as in the test"),
    "supply": Limit.above(0.0, 2.0, remedy="X_S, 1 of gears that dip into the oil"),
}
"""What a rating of scuffing takes."""


@record
class ScuffingSafety:
    """Safety against scuffing by the integral temperature, with every factor."""

    S_intS: float = quantity("1", "safety against scuffing, of temperatures in degC")
    theta_int: float = quantity("K", "integral temperature of the flanks")
    theta_Sint: float = quantity("K", "integral temperature that scuffs, by the test's load stage")
    theta_M: float = quantity("K", "bulk temperature")
    theta_flaint: float = quantity("K", "mean flash temperature, a difference")
    mu: float = quantity("1", "mean coefficient of friction")
    w_Bt: float = quantity("N/m", "tangential load per length of face, with factors", shown="N/mm")
    K_Bgamma: float = quantity("1", "helical load factor of scuffing")
    B_M: tuple[float, float] = quantity(
        "W s^0.5/(m2 K)", "thermal contact coefficients", "gear", no_error=EXACT
    )
    X_M: float = quantity("1", "thermal flash factor, in units of the standard")
    X_alphabeta: float = quantity("1", "pressure angle factor")
    X_R: float = quantity("1", "roughness factor")
    X_BE: float = quantity("1", "geometry factor at the pinion's tip")
    X_eps: float = quantity("1", "contact ratio factor")
    X_Ca: float = quantity("1", "tip relief factor")

    no_error = STANDARD
    headline = ("S_intS", "theta_int", "theta_Sint", "mu")

    @property
    def error(self) -> None:
        """Model error, which a standard cannot know: None is unknown, never zero."""
        return


def scuffing_safety(
    pair: GearPair,
    speed: float,
    factors: LoadFactors,
    oil: GearOil,
    *,
    roughness: float,
    relief: float,
    test_torque: float,
    structure: float,
    supply: float,
) -> ScuffingSafety:
    """Safety against scuffing S_intS = theta_Sint/theta_int of a pair that is run in, with a driving pinion.

    In units of the standard (N, mm, m/s, K; temperatures in degC):

        theta_flaint = mu X_M X_BE X_alphabeta (K_Bgamma w_Bt)^0.75 v^0.5/a^0.25 X_eps/X_Ca
        theta_M = theta_oil + 0.7 X_S theta_flaint,  theta_int = theta_M + 1.5 theta_flaint
        theta_Sint = 80 + 0.23 T_1T + 1.5 X_WrelT 0.2 T_1T (100/nu_40)^0.02

        w_Bt = F_t/b K_A K_v K_Hbeta K_Halpha,  X_M = E_r^0.25 sqrt(1000)/B_M
        K_Bgamma = 1 + 0.2 sqrt((eps_gamma - 2)(5 - eps_gamma)), 1 up to 2 and 1.3 from 3.5 on
        X_alphabeta = 1.22 [sin(alpha_wt) cos(alpha_n) cos(beta)]^0.25/[cos(alpha_wt) cos(alpha_t)]^0.5
        X_BE = 0.51 sqrt(u + 1) [sqrt(rho_E1) - sqrt(rho_E2/u)]/(rho_E1 rho_E2)^0.25
        X_eps = [0.7 (e1^2 + e2^2) - 0.22 eps_alpha + 0.52 - 0.6 e1 e2]/(2 eps_alpha e1)
        X_Ca = 1 + (0.06 + 0.18 C_a/C_eff) e + (0.02 + 0.69 C_a/C_eff) e^2,  e = max(e1, e2)

    v at the reference circle, e1 and e2 the parts of the contact ratio after and before C, C_eff = K_A F_t/(b c_gamma),
    C_a at most C_eff.

    Parameters
    ----------
    pair : GearPair
    speed : float
        Of the pinion [rad/s].
    factors : LoadFactors
        Of the torque.
    oil : GearOil
    roughness : float
        Ra, the mean of both flanks [m].
    relief : float
        Tip relief C_a [m].
    test_torque : float
        T_1T, pinion torque of the load stage at which the oil scuffs in the FZG test A/8.3/90 [N m].
    structure : float
        X_WrelT, structural factor of the steel.
    supply : float
        X_S, of the way in which oil reaches the teeth.

    Returns
    -------
    ScuffingSafety

    Raises
    ------
    GeometryError
        With every fault of the numbers; for contact ratios from 2 on or parts of it from 1 on, whose X_eps no source
        confirms; for a part after C below two thirds of that before, whose approach factor X_Q is not 1.

    Notes
    -----
    A published listing has every factor to its last digit (docs/validation/ratings.md). Left out, since nothing
    confirms it: X_Q other than 1, X_eps of other contact ratios, X_E of teeth that are not run in, X_L of other
    lubricants.

    References
    ----------
    ISO/TR 13989-2:2000; DIN 3990-4:1987.

    Examples
    --------
    >>> from gears import Gear
    >>> from gears.rating import RatedSteel, load_factors, run_in, tolerances
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> steels = (RatedSteel("Eh", 1500e6, 430e6),) * 2
    >>> effective = run_in(pair, steels, 209.44, tolerances(pair, 6))
    >>> given = {"application_factor": 1.0, "effective": effective, "relief": 2e-6, "face_load_factor": 1.15}
    >>> loads = load_factors(pair, 600.0, 209.44, **given)
    >>> test = {"test_torque": 450.1, "structure": 1.0, "supply": 1.0}
    >>> oil = GearOil(220e-6, 19e-6, 890.0, 353.15)
    >>> scuffing_safety(pair, 209.44, loads, oil, roughness=0.6e-6, relief=2e-6, **test).S_intS
    2.29...
    """
    check_oil(oil)
    with Faults(GeometryError) as faults:
        faults.numbers(LIMITS, (speed, roughness, relief, test_torque, structure, supply))
        e1, e2 = contact_parts(pair, faults)
    w_Bt, K_Bgamma = factors.line_load * factors.contact, helical_factor(pair.total_contact_ratio)
    mu = scuffing_friction(pair, w_Bt * K_Bgamma, speed, oil.dynamic_viscosity, roughness)
    B_M = contact_coefficients(pair)
    X_M, X_ab = flash_factor(pair), angle_factor(pair)
    X_BE = geometry_factor(pair, pair.points.E)
    ratio = e1 + e2
    X_eps = (0.7 * (e1**2 + e2**2) - 0.22 * ratio + 0.52 - 0.6 * e1 * e2) / (2.0 * ratio * e1)
    softness = iso6336(pair).c_gamma * 1e9
    relieved = min(relief * softness / (factors.K_A * factors.line_load), 1.0)
    e = max(e1, e2)
    X_Ca = 1.0 + (0.06 + 0.18 * relieved) * e + (0.02 + 0.69 * relieved) * e**2
    velocity = pair.reference_radii[0] * speed
    loaded = (1e-3 * w_Bt * K_Bgamma) ** 0.75 * math.sqrt(velocity) / (1e3 * _distance(pair)) ** 0.25
    flash = mu * X_M * abs(X_BE) * X_ab * loaded * X_eps / X_Ca
    bulk = oil.temperature + BULK * supply * flash
    integral = bulk + INTEGRAL * flash
    thick = (100e-6 / oil.viscosity_40) ** 0.02
    scuffs = 80.0 + 0.23 * test_torque + INTEGRAL * structure * 0.2 * test_torque * thick
    return ScuffingSafety(
        scuffs / (integral - ZERO),
        integral,
        scuffs + ZERO,
        bulk,
        flash,
        mu,
        w_Bt,
        K_Bgamma,
        B_M,
        X_M,
        X_ab,
        roughness_factor(pair, roughness),
        X_BE,
        X_eps,
        X_Ca,
    )


def contact_parts(pair: GearPair, faults: Faults) -> tuple[float, float]:
    """Parts of the contact ratio after and before C; notes where the confirmed X_eps and X_Q do not hold."""
    points, pitch = pair.points, pair.base_pitch
    after, before = (points.E - points.C) / pitch, (points.C - points.A) / pitch
    if not (1.0 <= after + before < 2.0 and 0.0 < after < 1.0 and 0.0 < before < 1.0):
        parts = f"{before:.3g} before and {after:.3g} after C"
        allowed = "must be 0 to 1 each and 1 to 2 together, where the contact ratio factor is confirmed"
        faults.add("contact_ratio", parts, allowed, "take temperatures of the film")
    elif before > 1.5 * after:
        allowed = "must be at most 1.5, beyond which no source confirms the approach factor X_Q"
        faults.add("approach", f"{before / after:.3g}", allowed, "take temperatures of the film")
    return after, before


def helical_factor(total_contact_ratio: float) -> float:
    """K_Bgamma over the total contact ratio.

    Examples
    --------
    >>> helical_factor(1.7), round(helical_factor(2.884), 3), helical_factor(3.5)
    (1.0, 1.274, 1.3)
    """
    ratio = min(max(total_contact_ratio, 2.0), 3.5)
    return 1.0 + 0.2 * math.sqrt((ratio - 2.0) * (5.0 - ratio))


def contact_coefficients(pair: GearPair) -> tuple[float, float]:
    """B_M = sqrt(k rho c) of both gears [W s^0.5/(m2 K)]; 1e3 of it are 1 N/(mm^0.5 m^0.5 s^0.5 K)."""
    first, second = (math.sqrt(m.conductivity * m.density * m.heat_capacity) for m in pair.materials)
    return first, second


def flash_factor(pair: GearPair) -> float:
    """X_M = E_r^0.25 sqrt(1000)/B_M of two gears, B_M their mean, in units of the standard."""
    mean = 1e-3 * 0.5 * sum(contact_coefficients(pair))
    return float((1e-6 * pair.reduced_modulus) ** 0.25 * math.sqrt(1e3) / mean)


def angle_factor(pair: GearPair) -> float:
    """X_alphabeta of the pressure angles and the helix."""
    working = pair.working_pressure_angle
    numerator = math.sin(working) * math.cos(pair.rack.alpha) * pair.helix.cosine
    return float(1.22 * numerator**0.25 / math.sqrt(math.cos(working) * pair.helix.transverse_cosine))


def geometry_factor(pair: GearPair, rho1: float) -> float:
    """X_B at a curvature radius of the pinion [m]; below 0 before C, where the wheel's flank is the faster one."""
    rho2, u = pair.line_of_action - rho1, pair.ratio
    return float(0.51 * math.sqrt(u + 1.0) * (math.sqrt(rho1) - math.sqrt(rho2 / u)) / (rho1 * rho2) ** 0.25)


def _distance(pair: GearPair) -> float:
    """Working centre distance [m]."""
    return sum(pair.base_radii) / math.cos(pair.working_pressure_angle)
