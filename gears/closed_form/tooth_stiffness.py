"""Tooth stiffness after ISO 6336-1, method B."""

from __future__ import annotations

import math
import warnings

from base import RangeWarning, described, quantity, record
from base.units import factor
from gears.closed_form.record import STANDARD
from gears.pair.gear_pair import GearPair
from gears.pair.hertz import NORMAL_FORCE
from gears.tooth.errors import GeometryError
from gears.tooth.profile import ToothProfile

CORRECTION = 0.8
"""C_M, what measurements found of the theoretical stiffness of a solid disc."""

WEB_RATIO = (0.2, 1.2)
"""b_s/b for which C_R was made; beyond it counts as its end."""

THINNEST_RIM = 1.0
"""Rim [modules] below which C_R takes it as this thick."""

LIGHT_LOAD = 100.0
"""Load per face width [N/mm] below which the stiffness falls with the fourth root of the load."""

FACE_STIFFNESS = 0.85
"""c_gamma_beta over c_gamma_alpha."""

_STEEL = 206e9  # Pa, for which the polynomial holds


@record
class Iso6336Stiffness:
    """Tooth stiffness per face width after ISO 6336-1."""

    c_th: float = quantity("N/(mm um)", "theoretical single stiffness c'_th")
    c_prime: float = quantity("N/(mm um)", "single stiffness c', the largest of one pair of teeth")
    c_gamma: float = quantity("N/(mm um)", "mesh stiffness c_gamma_alpha, mean over the mesh cycle")
    C_R: float = quantity("1", "gear blank factor, 1 for solid discs")
    C_B: float = quantity("1", "basic rack factor")
    face_width: float = quantity("m", "face width b", shown="mm")

    no_error = STANDARD
    headline = ("c_th", "c_prime", "c_gamma", "C_R", "C_B")

    @described("N/(mm um)")
    def c_gamma_beta(self) -> float:
        """Mesh stiffness c_gamma_beta along the face, 0.85 c_gamma_alpha."""
        return FACE_STIFFNESS * self.c_gamma

    @described("N/m")
    def single_stiffness(self) -> float:
        """Single stiffness c' b."""
        return self.c_prime * factor("N/(mm um)") * self.face_width

    @described("N/m")
    def mesh_stiffness(self) -> float:
        """Mesh stiffness c_gamma b."""
        return self.c_gamma * factor("N/(mm um)") * self.face_width


def iso6336(pair: GearPair, force: float | None = None) -> Iso6336Stiffness:
    """Single and mesh stiffness of a pair after ISO 6336-1.

    q' = 0.04723 + 0.15551/z_n1 + 0.25791/z_n2 - 0.00635 x1 - 0.11654 x1/z_n1 - 0.00193 x2 - 0.24188 x2/z_n2
    + 0.00529 x1^2 + 0.00182 x2^2 [um mm/N]; c'_th = 1/q'; c' = 0.8 c'_th C_R C_B cos(beta) E/E_steel with C_R of the
    weaker blank (`blank_factor`) and C_B = [1 + 0.5 (1.2 - h_fP)] [1 - 0.02 (20 deg - alpha_n)];
    c_gamma_alpha = c' (0.75 epsilon_alpha + 0.25), c_gamma_beta = 0.85 c_gamma_alpha, z_n = z/(cos^2(beta_b)
    cos(beta)). A gear that is cut at a generating shift x_E has the dedendum h_fP + x - x_E, and C_B is the mean of
    both gears'.

    Parameters
    ----------
    pair : GearPair
        The gears; the one with fewer teeth is gear 1 of the standard.
    force : float or None
        Normal force with the application factor in it [N]: where the tangential load F cos(alpha_n) cos(beta) / b is
        below 100 N/mm, c' is multiplied by its ratio to that to the power 0.25. None is no reduction.

    Returns
    -------
    Iso6336Stiffness
        c'_th, c', c_gamma and the factors.

    Raises
    ------
    GeometryError
        If the force is not a finite positive number.

    Warns
    -----
    RangeWarning
        Outside x1 >= x2, -0.5 <= x1 + x2 <= 2 and 1.2 <= epsilon_alpha <= 1.9, or of what C_R was made for.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> round(iso6336(pair).c_gamma, 2)
    20.54
    """
    first, second = sorted((pair.pinion, pair.wheel), key=lambda gear: (gear.teeth, -gear.profile_shift))
    helix, x1, x2 = pair.helix, first.profile_shift, second.profile_shift
    z1, z2 = helix.virtual_teeth(first.teeth), helix.virtual_teeth(second.teeth)
    _warn_outside(x1, x2, pair)
    q = 0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 - 0.11654 * x1 / z1
    q += -0.00193 * x2 - 0.24188 * x2 / z2 + 0.00529 * x1**2 + 0.00182 * x2**2
    C_R = min(blank_factor(profile) for profile in pair.teeth_profiles)
    angle = math.degrees(pair.rack.alpha)
    deeper = 0.5 * sum(gear.profile_shift - gear.cut_shift for gear in (first, second))
    C_B = (1.0 + 0.5 * (1.2 - pair.rack.h_fP - deeper)) * (1.0 - 0.02 * (20.0 - angle))
    E1, E2 = (material.youngs_modulus for material in pair.materials)
    c_prime = CORRECTION * C_R * C_B / q * (2.0 * E1 * E2 / (E1 + E2) / _STEEL) * helix.cosine
    if force is not None:
        if faults := NORMAL_FORCE.faults("force", force):
            raise GeometryError(faults)
        load = force * math.cos(pair.rack.alpha) * helix.cosine / (pair.face_width * 1e3)
        c_prime *= min(load / LIGHT_LOAD, 1.0) ** 0.25
    c_gamma = c_prime * (0.75 * pair.contact_ratio + 0.25)
    return Iso6336Stiffness(1.0 / q, c_prime, c_gamma, C_R, C_B, pair.face_width)


def blank_factor(profile: ToothProfile) -> float:
    """C_R of a gear on a web: 1 + ln(b_s/b)/(5 exp(s_R/(5 m))), 1 for a solid disc.

    Mean values for a mate of the same or a stiffer blank. b_s/b counts from 0.2 to 1.2, s_R/m from 1 on.

    Parameters
    ----------
    profile : ToothProfile
        Tooth with the steps of its blank.
    """
    if not profile.steps:
        return 1.0
    low, high = WEB_RATIO
    web = min(max(profile.zones[1].thickness, low), high)
    rim = max(profile.rim_thickness / profile.module, THINNEST_RIM)
    return 1.0 + math.log(web) / (5.0 * math.exp(rim / 5.0))


def _warn_outside(x1: float, x2: float, pair: GearPair) -> None:
    outside, contact_ratio = [], pair.contact_ratio
    for name, profile in zip(("pinion", "wheel"), pair.teeth_profiles, strict=True):
        if profile.steps and profile.zones[1].thickness < WEB_RATIO[0]:
            web = profile.zones[1].thickness
            outside.append(f"the {name}'s web of {web:.3g} face widths counts as {WEB_RATIO[0]:g}")
        if profile.steps and profile.rim_thickness < THINNEST_RIM * profile.module:
            rim = profile.rim_thickness / profile.module
            outside.append(f"the {name}'s rim of {rim:.3g} modules counts as {THINNEST_RIM:g}")
    if x1 < x2:
        outside.append(f"x1 = {x1:g} is less than x2 = {x2:g}")
    if not -0.5 <= x1 + x2 <= 2.0:
        outside.append(f"x1 + x2 = {x1 + x2:g} is not within -0.5 to 2")
    if not 1.2 <= contact_ratio <= 1.9:
        outside.append(f"contact ratio {contact_ratio:.3f} is not within 1.2 to 1.9")
    if outside:
        warnings.warn("ISO 6336-1: " + "; ".join(outside), RangeWarning, stacklevel=3)
