"""Safety against pitting after ISO 6336-2."""

from __future__ import annotations

import math

from base import Faults, Limit, described, part, quantity, record
from base.results import EXACT
from gears.closed_form.contact_stress import Iso6336ContactStress, iso6336_2
from gears.closed_form.record import STANDARD
from gears.pair.gear_pair import GearPair
from gears.rating.life import contact_curve
from gears.rating.load_factors import LoadFactors
from gears.rating.steels import Steels, check_steels
from gears.tooth.errors import GeometryError

FACTOR = Limit.above(0.0, 2.0, remedy="1 unless a source says otherwise")
"""Work hardening and size factors that may be given."""

_LOAD = {
    "torque": Limit.above(0.0, 1e9, "N m", "give the pinion's torque, without factors"),
    "speed": Limit.above(0.0, 1e5, "rad/s", "give the pinion's speed"),
}
LIMITS = {
    "viscosity_40": Limit(1e-6, 1e-2, "m2/s", "give nu_40 in m2/s: ISO VG 220 has 220e-6"),
    "roughness": Limit(1e-8, 1e-4, "m", "give the mean Rz of both flanks in metres, about 6 Ra"),
    "life": Limit.above(0.0, 3.6e10, "s", "give the life in seconds"),
    "Z_X": FACTOR,
}
"""What else a rating of the flanks takes."""


@record
class PittingSafety:
    """Safety of both gears against pitting, with every factor of ISO 6336-2."""

    sigma_H: tuple[float, float] = quantity("Pa", "contact stress", "gear", shown="MPa")
    sigma_HG: tuple[float, float] = quantity("Pa", "pitting stress limit", "gear", shown="MPa")
    S_H: tuple[float, float] = quantity("1", "safety against pitting", "gear")
    Z_L: float = quantity("1", "lubricant factor")
    Z_V: float = quantity("1", "velocity factor")
    Z_R: float = quantity("1", "roughness factor")
    Z_NT: tuple[float, float] = quantity("1", "life factors", "gear")
    Z_W: tuple[float, float] = quantity("1", "work hardening factors, as given", "gear", no_error=EXACT)
    Z_X: float = quantity("1", "size factor, as given", no_error=EXACT)
    cycles: tuple[float, float] = quantity("1", "load cycles N_L", "gear", no_error=EXACT)
    nominal: Iso6336ContactStress = part("nominal stress with its factors")

    no_error = STANDARD

    def __repr__(self) -> str:
        """One line: stress, limit and safety of each gear."""
        gears = (
            f"S_H {safety:.4g} of {1e-6 * limit:.5g} MPa over {1e-6 * stress:.5g} MPa"
            for safety, limit, stress in zip(self.S_H, self.sigma_HG, self.sigma_H, strict=True)
        )
        return f"PittingSafety({', '.join(gears)})"

    @described("1")
    def safety(self) -> float:
        """Smaller one of both gears' safeties."""
        return min(self.S_H)

    @property
    def error(self) -> None:
        """Model error, which a standard cannot know: None is unknown, never zero."""
        return


def pitting_safety(
    pair: GearPair,
    torque: float,
    speed: float,
    factors: LoadFactors,
    steels: Steels,
    *,
    viscosity_40: float,
    roughness: float,
    life: float,
    Z_W: tuple[float, float],
    Z_X: float,
    pitting_permitted: bool = False,
) -> PittingSafety:
    """Safety against pitting S_H = sigma_HG/sigma_H of both gears, method B.

    sigma_H = Z_B,D sigma_H0 sqrt(K_A K_v K_Hbeta K_Halpha), sigma_HG = sigma_Hlim Z_NT Z_L Z_V Z_R Z_W Z_X. With
    C_L = 0.83 below 850 MPa, sigma_Hlim/4375 + 0.6357 up to 1200 MPa and 0.91 above, of the smaller sigma_Hlim,

        Z_L = C_L + 4 (1 - C_L)/(1.2 + 134/nu_40)^2
        Z_V = C_V + 2 (1 - C_V)/sqrt(0.8 + 32/v),   C_V = C_L + 0.02
        Z_R = (3/Rz10)^C_R,   Rz10 = Rz (10/rho_red)^(1/3)

    C_R = 0.15 below 850 MPa, 0.32 - 0.0002 sigma_Hlim up to 1200 MPa, 0.08 above; nu_40 in mm2/s, v at the reference
    circle in m/s, Rz in um, rho_red at C in the transverse section in mm. Z_NT is that of `contact_curve`.

    Parameters
    ----------
    pair : GearPair
    torque : float
        Nominal torque of the pinion [N m].
    speed : float
        Of the pinion [rad/s].
    factors : LoadFactors
    steels : tuple of RatedSteel
    viscosity_40 : float
        Kinematic viscosity at 40 degC [m2/s].
    roughness : float
        Mean peak-to-valley roughness Rz, the mean of both flanks [m].
    life : float
        Time under load [s].
    Z_W : tuple of float
        Work hardening factors of both gears; 1 unless a ground hard pinion runs with a soft wheel.
    Z_X : float
        Size factor.
    pitting_permitted : bool
        Whether limited pitting is permitted.

    Returns
    -------
    PittingSafety

    Raises
    ------
    GeometryError
        With every fault of the numbers and steels.

    Notes
    -----
    A published listing and ISO/TR 6336-30 example 1 confirm Z_L, Z_V and Z_R above 1200 MPa (docs/validation/
    ratings.md); branches below are those of two open programs that agree. Formulas of Z_W and Z_X are left out.

    References
    ----------
    ISO 6336-2:2006, clauses 11 (life factor), 12 (Z_L, Z_V, Z_R), 13 (Z_W) and 14 (Z_X).

    Examples
    --------
    >>> from gears import Gear
    >>> from gears.rating import RatedSteel, load_factors, run_in, tolerances
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> steels = (RatedSteel("Eh", 1500e6, 430e6),) * 2
    >>> effective = run_in(pair, steels, 209.44, tolerances(pair, 6))
    >>> loads = load_factors(
    ...     pair, 600.0, 209.44, application_factor=1.0, effective=effective, relief=2e-6, face_load_factor=1.15
    ... )
    >>> oil = {"viscosity_40": 220e-6, "roughness": 4.8e-6}
    >>> pitting_safety(pair, 600.0, 209.44, loads, steels, **oil, life=3.6e7, Z_W=(1.0, 1.0), Z_X=1.0).safety
    0.86...
    """
    with Faults(GeometryError) as faults:
        faults.numbers(_LOAD, (torque, speed))
        check_flanks(faults, viscosity_40, roughness, life, Z_W, Z_X)
        check_steels(faults, pair, steels)
    nominal = iso6336_2(pair, pair.normal_force(torque))
    weaker = 1e-6 * min(steel.contact_strength for steel in steels)
    C_L, C_R = _exponents(weaker)
    C_V, v = C_L + 0.02, pair.reference_radii[0] * speed
    Z_L = C_L + 4.0 * (1.0 - C_L) / (1.2 + 134e-6 / viscosity_40) ** 2
    Z_V = C_V + 2.0 * (1.0 - C_V) / (0.8 + 32.0 / v) ** 0.5
    rho1 = pair.points.C
    curvature = 1e3 * rho1 * (pair.line_of_action - rho1) / pair.line_of_action
    Z_R = (3.0 / (1e6 * roughness * (10.0 / curvature) ** (1.0 / 3.0))) ** C_R
    cycles = load_cycles(pair, speed, life)
    Z_NT = tuple(
        contact_curve(s.kind, pitting_permitted).factor(n) for s, n in zip(steels, cycles, strict=True)
    )
    stresses = tuple(stress * factors.contact**0.5 for stress in nominal.single_pair_stresses)
    common = Z_L * Z_V * Z_R * Z_X
    limits = tuple(s.contact_strength * n * w * common for s, n, w in zip(steels, Z_NT, Z_W, strict=True))
    safeties = limits[0] / stresses[0], limits[1] / stresses[1]
    return PittingSafety(
        (stresses[0], stresses[1]),
        (limits[0], limits[1]),
        safeties,
        Z_L,
        Z_V,
        Z_R,
        (Z_NT[0], Z_NT[1]),
        Z_W,
        Z_X,
        cycles,
        nominal,
    )


def check_flanks(
    faults: Faults, viscosity_40: float, roughness: float, life: float, Z_W: tuple[float, float], Z_X: float
) -> None:
    """Note what is wrong with oil, roughness, life and given factors; arguments as of `pitting_safety`."""
    faults.numbers(LIMITS, (viscosity_40, roughness, life, Z_X))
    for name, value in zip(("pinion", "wheel"), Z_W, strict=True):
        faults.number(f"{name}.Z_W", value, FACTOR)


def load_cycles(pair: GearPair, speed: float, life: float) -> tuple[float, float]:
    """Load cycles of pinion and wheel in a time [s] at a pinion speed [rad/s], one mate each.

    Examples
    --------
    >>> from gears import Gear
    >>> pair = GearPair(Gear(20), Gear(40), module=2e-3, face_width=40e-3)
    >>> [round(n) for n in load_cycles(pair, 6.283185307, 100.0)]
    [100, 50]
    """
    turns = speed * life / (2.0 * math.pi)
    return turns, turns / pair.ratio


def _exponents(strength: float) -> tuple[float, float]:
    """C_ZL and C_ZR of the smaller sigma_Hlim [MPa]."""
    if strength < 850.0:
        return 0.83, 0.15
    if strength > 1200.0:
        return 0.91, 0.08
    return strength / 4375.0 + 0.6357, 0.32 - 0.0002 * strength
