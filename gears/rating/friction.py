"""Mean friction of the teeth as the scuffing methods of ISO/TR 13989 take it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from base import Faults, Limit
from gears.pair.gear_pair import GearPair
from gears.tooth.errors import GeometryError

LIMITS = {
    "viscosity_40": Limit(1e-6, 1e-2, "m2/s", "give nu_40 in m2/s: ISO VG 220 has 220e-6"),
    "viscosity_100": Limit(1e-6, 1e-3, "m2/s", "give nu_100 in m2/s: ISO VG 220 has about 19e-6"),
    "density_15": Limit(600.0, 1500.0, "kg/m3", "give the density at 15 degC: mineral oils have 850 to 900"),
    "temperature": Limit(253.15, 473.15, "K", "give the temperature of the oil in kelvins"),
}
"""What an oil of a data sheet may be."""

WALTHER = 0.8
"""Added to viscosities in mm2/s, whose logarithm's logarithm is then straight; ASTM D341 has 0.7."""

EXPANSION = 0.7
"""By how much the density of mineral oils falls with the temperature [kg/(m3 K)]."""


@dataclass(frozen=True)
class GearOil:
    """Mineral oil by its data sheet.

    A published listing has the temperatures of this law to their last digit, and its mesh loss with the density at 15
    degC: 16.25 K, 115.75 degC and 15.635 kW; ASTM D341 and a density that falls by 0.0007 give 16.246, 115.74, 15.637.

    Parameters
    ----------
    viscosity_40, viscosity_100 : float
        Kinematic viscosities at 40 and 100 degC [m2/s].
    density_15 : float
        Density at 15 degC [kg/m3].
    temperature : float
        Of the oil as it reaches the teeth [K].

    Examples
    --------
    >>> oil = GearOil(220e-6, 19e-6, 890.0, 353.15)
    >>> f"{1e6 * oil.kinematic_viscosity:.1f} mm2/s, {1e3 * oil.dynamic_viscosity:.1f} mPa s"
    '35.7 mm2/s, 30.1 mPa s'
    """

    viscosity_40: float  # nu_40, m2/s
    viscosity_100: float  # nu_100, m2/s
    density_15: float  # rho_15, kg/m3
    temperature: float  # K

    def check(self, faults: Faults) -> None:
        """Note what is wrong with the numbers: a viscosity that does not fall is wrong too."""
        faults.fields(self, LIMITS, "oil.")
        if not self.viscosity_100 < self.viscosity_40:
            allowed = "must be less than that at 40 degC"
            faults.add("oil.viscosity_100", f"{self.viscosity_100:g}", allowed, "see the oil's data sheet")

    @property
    def kinematic_viscosity(self) -> float:
        """Nu at the temperature [m2/s], straight in log log (nu + 0.8 mm2/s) over log T (DIN 51563)."""
        low, high = (
            math.log10(math.log10(1e6 * nu + WALTHER)) for nu in (self.viscosity_40, self.viscosity_100)
        )
        share = math.log(self.temperature / 313.15) / math.log(373.15 / 313.15)
        return float(1e-6 * (10.0 ** (10.0 ** (low + (high - low) * share)) - WALTHER))

    @property
    def dynamic_viscosity(self) -> float:
        """Eta at the temperature [Pa s], with a density that falls by 0.7 kg/m3 per kelvin (DIN 51757)."""
        return self.kinematic_viscosity * (self.density_15 - EXPANSION * (self.temperature - 288.15))


def check_oil(oil: GearOil) -> None:
    """Refuse an oil whose numbers are wrong, all faults at once."""
    with Faults(GeometryError) as faults:
        oil.check(faults)


def scuffing_friction(
    pair: GearPair, line_load: float, speed: float, viscosity: float, roughness: float
) -> float:
    """Mean coefficient of friction of the scuffing methods, of mineral oils.

    mu = 0.045 [w/(v_sumC rho_C)]^0.2 eta^-0.05 X_R,  X_R = 2.2 (Ra/rho_C)^0.25

    w in N/mm, v_sumC = 2 v_t sin(alpha_wt), the sum of both surface velocities at C, in m/s, rho_C at C in the normal
    section in mm, eta in mPa s, Ra in um.

    Parameters
    ----------
    pair : GearPair
    line_load : float
        w_Bt K_Bgamma, tangential load per length of face with all factors [N/m].
    speed : float
        Of the pinion [rad/s].
    viscosity : float
        Dynamic, at the temperature of the oil [Pa s].
    roughness : float
        Ra, the mean of both flanks [m].

    Notes
    -----
    A published listing gives mu 0.030 and X_R 0.712, which is that of the normal section (0.715 in the transverse one).
    Factors of other lubricants, X_L, are left out.

    References
    ----------
    ISO/TR 13989-2:2000, Calculation of scuffing load capacity of cylindrical, bevel and hypoid gears, part 2: Integral
    temperature method; DIN 3990-4:1987.

    Examples
    --------
    >>> from gears import Gear
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> f"{scuffing_friction(pair, 420e3, 209.44, 0.03, 0.6e-6):.4f}"
    '0.0764'
    """
    rolling = 2.0 * pair.reference_radii[0] * speed * pair.helix.transverse_cosine
    rolling *= math.tan(pair.working_pressure_angle)
    curvature = 1e3 * pitch_curvature(pair)
    loaded = (1e-3 * line_load / (rolling * curvature)) ** 0.2 * (1e3 * viscosity) ** -0.05
    return float(0.045 * loaded * roughness_factor(pair, roughness))


def roughness_factor(pair: GearPair, roughness: float) -> float:
    """X_R = 2.2 (Ra/rho_C)^0.25, Ra in um and rho_C in mm."""
    return float(2.2 * (1e6 * roughness / (1e3 * pitch_curvature(pair))) ** 0.25)


def pitch_curvature(pair: GearPair) -> float:
    """Radius of relative curvature at C in the normal section [m]."""
    rho1 = pair.points.C
    return rho1 * (pair.line_of_action - rho1) / pair.line_of_action / pair.helix.base_cosine
