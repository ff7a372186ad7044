"""Nominal tooth-root stress after ISO 6336-3, method B."""

from __future__ import annotations

import math
import warnings

from base import Faults, RangeWarning, described, part, quantity, record
from base.results import EXACT
from gears.closed_form.record import STANDARD
from gears.closed_form.virtual_gear import VirtualGear, virtual_gear
from gears.pair.gear_pair import GearPair
from gears.pair.hertz import NORMAL_FORCE
from gears.tooth.errors import GeometryError
from gears.tooth.involute import involute_function
from gears.tooth.profile import ToothProfile
from gears.tooth.rack import BasicRack

_SLOPE = math.pi / 3.0
"""The critical section touches the fillets at 30 degrees to the tooth's centre line: T = pi/2 - pi/6."""

_ITERATIONS = 60

STEEPEST = 30.0
"""Helix angle up to which Y_beta falls [deg]."""

THIN_RIM = 1.2
"""Rim thickness over tooth depth below which a rim's own bending raises the root stress."""


@record
class RootSection:
    """Critical section of one gear and its factors after ISO 6336-3, lengths in modules."""

    theta: float = quantity("rad", "auxiliary angle of the iteration")
    s_Fn: float = quantity("1", "chord between the points where tangents at 30 degrees touch the fillets")
    rho_F: float = quantity("1", "curvature radius of the fillet there")
    h_Fe: float = quantity("1", "lever of the load")
    alpha_Fen: float = quantity("rad", "angle of the load to the normal of the tooth's centre line")
    Y_F: float = quantity("1", "form factor")
    Y_S: float = quantity("1", "stress-correction factor")

    no_error = STANDARD
    headline = ("Y_F", "Y_S", "s_Fn", "h_Fe", "rho_F")

    @described("1")
    def q_s(self) -> float:
        """Notch parameter s_Fn / (2 rho_F)."""
        return self.s_Fn / (2.0 * self.rho_F)


@record
class Iso6336RootStress:
    """Nominal tooth-root stress sigma_F0 of both gears after ISO 6336-3."""

    sections: tuple[RootSection, RootSection] = part("tooth form of pinion and wheel, with Y_F and Y_S")
    Y_B: tuple[float, float] = quantity("1", "rim-thickness factors", "gear")
    stresses: tuple[float, float] = quantity("Pa", "tooth-root stress sigma_F0", "gear", shown="MPa")
    load_at: str = quantity("", "where the load was taken to act, D or tip")
    Y_beta: float = quantity(
        "1", "helix angle factor Y_beta of the root stress, 1 of spur gears", no_error=EXACT, default=1.0
    )

    no_error = STANDARD

    def __repr__(self) -> str:
        """One line: stresses and rims of both gears."""
        first, second = (1e-6 * stress for stress in self.stresses)
        rims = f"Y_B {self.Y_B[0]:.4g} and {self.Y_B[1]:.4g}"
        return f"Iso6336RootStress({first:.5g} and {second:.5g} MPa, load at {self.load_at}, {rims})"

    @property
    def error(self) -> None:
        """Model error, which a closed form cannot know: None stands for unknown, never for zero."""
        return


def iso6336_3(pair: GearPair, force: float, load_at: str = "D") -> Iso6336RootStress:
    """Nominal tooth-root stress of a pair after ISO 6336-3:2006, method B.

    sigma_F0 = F_t/(b m_n) Y_F Y_S Y_beta Y_B with F_t = F cos(alpha_n) cos(beta) at the reference circle (the factors K
    of part 1 are left to the user). Lengths in normal modules, T = pi/3, rho the tip radius of the rack, z = z_n the
    teeth of the virtual gear:

        E = pi/4 - h_fP tan(alpha_n) - (1 - sin(alpha_n)) rho/cos(alpha_n)
        G = rho - h_fP + x,  H = 2/z (pi/2 - E) - T,  theta = 2 G/z tan(theta) - H
        s_Fn = z sin(T - theta) + sqrt(3) (G/cos(theta) - rho)
        rho_F = rho + 2 G^2/[cos(theta) (z cos^2(theta) - 2 G)]
        h_Fe = [(cos(gamma_e) - sin(gamma_e) tan(alpha_Fen)) d_en - z cos(T - theta) - G/cos(theta) + rho]/2
        Y_F = 6 h_Fe cos(alpha_Fen)/(s_Fn^2 cos(alpha_n))
        Y_S = (1.2 + 0.13 L) q_s^(1/(1.21 + 2.3/L)),  L = s_Fn/h_Fe,  q_s = s_Fn/(2 rho_F)
        Y_beta = 1 - min(epsilon_beta, 1) min(beta, 30 deg)/120 deg
        Y_B = 1.6 ln(2.242 h_t/s_R) for a rim s_R below 1.2 tooth depths h_t, else 1; s_R is that of the blank, and
        reaches from the root circle to the bore in a disc

    The virtual gear has d_n = d/cos^2(beta_b), d_an = d_n + d_a - d and the load at the outer point of single contact
    of epsilon_alpha/cos^2(beta_b). A thickness allowance A is taken into the geometry: E + A/(2 m_n), and the tooth's
    half angle less A/(2 r_n). x is the shift at which the gear is cut.

    Parameters
    ----------
    pair : GearPair
        The gears.
    force : float
        Normal force F, `GearPair.normal_force` of the torque [N].
    load_at : {"D", "tip"}
        The outer point of single pair contact, as the standard has it, or the tip (Y_Fa and Y_Sa of tables).

    Returns
    -------
    Iso6336RootStress
        Factors and stresses of both gears.

    Raises
    ------
    GeometryError
        If the force is not finite and positive, `load_at` is unknown, the iteration finds no section, or the
        rim is thinner than half the tooth's depth.

    Warns
    -----
    RangeWarning
        Outside 1 <= q_s < 8, at a contact ratio of 2 or more (the standard then shares the load by a factor
        that this function leaves out), for a section above the form circle, or a rim thinner than 1.75
        modules.

    References
    ----------
    ISO 6336-3:2006, Calculation of load capacity of spur and helical gears, part 3: Calculation of tooth
    bending strength, clauses 5 to 9.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> iso6336_3(pair, force=10e3)
    Iso6336RootStress(... and ... MPa, load at D, Y_B 1 and 1)
    """
    with Faults(GeometryError) as faults:
        faults.number("force", force, NORMAL_FORCE)
        faults.choice("load_at", load_at, ("D", "tip"), "'D' is the standard's method B")
    points, helix = pair.points, pair.helix
    outer = points.D, pair.line_of_action - points.B
    sections, rims, outside = [], [], []
    for name, profile, gear, rho in zip(
        ("pinion", "wheel"), pair.teeth_profiles, (pair.pinion, pair.wheel), outer, strict=True
    ):
        virtual = virtual_gear(profile, helix)
        tip = virtual.tip_rho
        load = tip if load_at == "tip" else min(virtual.load_rho(profile, rho, pair.base_pitch), tip)
        section = root_section(name, profile, pair.rack, gear.cut_shift, load, virtual)
        sections.append(section)
        rims.append(_rim_factor(name, profile))
        outside += _outside(name, profile, section)
    ratio = pair.contact_ratio / helix.base_cosine**2
    if load_at == "D" and ratio >= 2.0:
        outside.append(f"contact ratio {ratio:.3f} is not below 2: no pair bears alone")
    if outside:
        warnings.warn("ISO 6336-3: " + "; ".join(outside), RangeWarning, stacklevel=2)
    Y_beta = helix_factor(helix.angle, pair.overlap_ratio)
    nominal = force * math.cos(pair.rack.alpha) * helix.cosine / (pair.face_width * pair.module)
    first, second = (
        nominal * section.Y_F * section.Y_S * rim * Y_beta
        for section, rim in zip(sections, rims, strict=True)
    )
    return Iso6336RootStress((sections[0], sections[1]), (rims[0], rims[1]), (first, second), load_at, Y_beta)


def helix_factor(helix_angle: float, overlap_ratio: float) -> float:
    """Y_beta = 1 - epsilon_beta beta/120 deg, with epsilon_beta counted to 1 and beta to 30 deg.

    Examples
    --------
    >>> helix_factor(math.radians(10.0), 1.4), helix_factor(0.0, 0.0)
    (0.91666..., 1.0)
    """
    angle = min(abs(math.degrees(helix_angle)), STEEPEST)
    return 1.0 - min(overlap_ratio, 1.0) * angle / 120.0


def root_section(
    name: str, profile: ToothProfile, rack: BasicRack, cut_shift: float, rho_load: float, virtual: VirtualGear
) -> RootSection:
    """Critical section and factors of one gear for a load at curvature radius `rho_load` of the virtual gear [m]."""
    z, m = virtual.teeth, profile.module
    rho, x = rack.fillet_radius, cut_shift
    nominal = (0.5 * math.pi + 2.0 * x * math.tan(rack.alpha)) / profile.teeth
    nominal += _inv(virtual.helix.transverse_tangent)
    thinning = nominal - profile.base_half_angle  # A/(2 r cos(beta))
    E = rack.tip_centre_offset + 0.5 * profile.teeth * thinning
    G = rho - rack.h_fP + x
    theta = _theta(name, z, G, 2.0 / z * (0.5 * math.pi - E) - _SLOPE)
    arm = G / math.cos(theta) - rho
    s_Fn = z * math.sin(_SLOPE - theta) + math.sqrt(3.0) * arm
    rho_F = rho + 2.0 * G**2 / (math.cos(theta) * (z * math.cos(theta) ** 2 - 2.0 * G))
    roll = rho_load / virtual.base_radius
    gamma = virtual.base_half_angle - _inv(roll)
    alpha_Fen = math.atan(roll) - gamma
    d_e = 2.0 * math.hypot(virtual.base_radius, rho_load) / m
    height = (math.cos(gamma) - math.sin(gamma) * math.tan(alpha_Fen)) * d_e
    h_Fe = 0.5 * (height - z * math.cos(_SLOPE - theta) - arm)
    Y_F = 6.0 * h_Fe * math.cos(alpha_Fen) / (s_Fn**2 * math.cos(rack.alpha))
    L = s_Fn / h_Fe
    Y_S = (1.2 + 0.13 * L) * (s_Fn / (2.0 * rho_F)) ** (1.0 / (1.21 + 2.3 / L))
    return RootSection(theta, s_Fn, rho_F, h_Fe, alpha_Fen, Y_F, Y_S)


def _theta(name: str, teeth: float, G: float, H: float) -> float:
    """Solve theta = 2 G/z tan(theta) - H by Newton's method from the standard's start, 30 degrees."""
    theta = math.pi / 6.0
    for _ in range(_ITERATIONS):
        excess = theta - 2.0 * G / teeth * math.tan(theta) + H
        step = excess / (1.0 - 2.0 * G / (teeth * math.cos(theta) ** 2))
        theta = min(max(theta - step, 1e-6), 0.5 * math.pi - 1e-6)
        if abs(step) < 1e-15:
            break
    if abs(theta - 2.0 * G / teeth * math.tan(theta) + H) > 1e-12:
        allowed = "must have a fillet with a tangent at 30 degrees to the tooth's centre line"
        raise GeometryError.at(name, f"theta = {theta:.6g} rad", allowed, "change shift or rack")
    return theta


def _rim_factor(name: str, profile: ToothProfile) -> float:
    """Y_B of a gear; refuses rims thinner than the standard has."""
    ratio = profile.rim_ratio
    if ratio <= 0.5:
        allowed = "must leave a rim of more than half the tooth's depth"
        value = f"{ratio:.3g} tooth depths"
        if profile.steps:
            remedy = (
                "ISO 6336-3 has no Y_B for it; finite elements (`fem.root_stress`) take the rim on its web"
            )
            raise GeometryError.at(f"{name}.blank.rim_thickness", value, allowed, remedy)
        remedy = "ISO 6336-3 has no Y_B for it, and finite elements held at the bore are unsafe too, since a held rim "
        remedy += "cannot bend: give the gear its rim and web (blank) and take finite elements"
        raise GeometryError.at(f"{name}.bore_radius", value, allowed, remedy)
    return rim_factor(ratio)


def rim_factor(ratio: float) -> float:
    """Y_B = 1.6 ln(2.242 h_t/s_R) of a rim of `ratio` s_R/h_t tooth depths below 1.2, else 1.

    The standard has it for s_R/h_t above 0.5. It stands for the rim's own bending, which adds to the stress at the
    fillet.

    Examples
    --------
    >>> round(rim_factor(0.6), 3), rim_factor(1.2)
    (2.109, 1.0)
    """
    return 1.6 * math.log(2.242 / ratio) if ratio < THIN_RIM else 1.0


def _outside(name: str, profile: ToothProfile, section: RootSection) -> list[str]:
    remarks = []
    if not 1.0 <= section.q_s < 8.0:
        remarks.append(f"q_s = {section.q_s:.3g} of the {name} is not within 1 to 8")
    rim = profile.rim_thickness / profile.module
    if rim < 1.75:
        remarks.append(f"the {name}'s rim of {rim:.3g} modules is thinner than 1.75")
    if section.theta > profile.fillet_curve.end:
        remarks.append(f"the section of the {name} lies above its form circle")
    return remarks


def _inv(tangent: float) -> float:
    return float(involute_function(tangent))
