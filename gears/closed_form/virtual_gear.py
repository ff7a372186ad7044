"""Virtual spur gear of ISO 6336-3, whose teeth are those of a helical gear in its normal section."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gears.tooth.helix import Helix
from gears.tooth.involute import involute_function
from gears.tooth.profile import ToothProfile


@dataclass(frozen=True)
class VirtualGear:
    """Spur gear of the normal module, of the reference circle d/cos^2(beta_b) and the heights of the helical gear.

    Parameters
    ----------
    helix : Helix
        Of the helical gear.
    teeth : float
        z_n = z/(cos^2(beta_b) cos(beta)).
    base_radius : float
        r_bn = r_n cos(alpha_n) [m].
    flank_end_radius : float
        r_an = r_n + r_a - r, where the flank ends [m].
    base_half_angle : float
        psi_bn = (pi/2 + 2 x tan(alpha_n))/z_n + inv(alpha_n), less A/(2 r_n) [rad].
    """

    helix: Helix
    teeth: float  # z_n
    base_radius: float  # r_bn, m
    flank_end_radius: float  # r_an, m
    base_half_angle: float  # psi_bn, rad

    @property
    def tip_rho(self) -> float:
        """Curvature radius where the flank ends [m]."""
        return math.sqrt(self.flank_end_radius**2 - self.base_radius**2)

    def load_rho(self, profile: ToothProfile, rho_outer: float, base_pitch: float) -> float:
        """Curvature radius at the outer point of single pair contact of the virtual pair [m].

        rho_an - p_bn (epsilon_alpha,n - 1) with p_bn = p_bt cos(beta_b), epsilon_alpha,n = epsilon_alpha/cos^2(beta_b),
        written as the point of the helical gear and differences that are zero in spur gears.

        Parameters
        ----------
        profile : ToothProfile
            Of the helical gear.
        rho_outer : float
            Curvature radius at its outer point of single pair contact, rho_a - p_bt (epsilon_alpha - 1) [m].
        base_pitch : float
            p_bt [m].
        """
        cosine = self.helix.base_cosine
        pitch = base_pitch * self.helix.base_sine**2 / cosine
        return rho_outer / cosine - pitch + (self.tip_rho - profile.flank_rho[1] / cosine)


def virtual_gear(profile: ToothProfile, helix: Helix) -> VirtualGear:
    """Virtual gear of a generated tooth.

    Parameters
    ----------
    profile : ToothProfile
    helix : Helix

    References
    ----------
    ISO 6336-3:2006, clause 6.2.3.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(24), Gear(95), module=14e-3, face_width=0.36, helix_angle=math.radians(10.0))
    >>> round(virtual_gear(pair.teeth_profiles[0], pair.helix).teeth, 3)
    25.037
    """
    reference = profile.reference_radius / helix.base_cosine**2
    teeth = helix.virtual_teeth(profile.teeth)
    smaller = profile.teeth / teeth
    normal, transverse = (
        float(involute_function(tangent))
        for tangent in (math.tan(helix.normal_pressure_angle), helix.transverse_tangent)
    )
    return VirtualGear(
        helix,
        teeth,
        reference * math.cos(helix.normal_pressure_angle),
        profile.flank_end_radius + (reference - profile.reference_radius),
        profile.base_half_angle * smaller + (normal - transverse * smaller),
    )
