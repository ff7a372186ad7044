"""What follows from the sizes of a pair of gears: radii, angles, path of contact, backlash, forces, inertia."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from base import Array, Described, Figure, described
from base.results import EXACT
from gears.pair.path import PathOfContact, PathPoints
from gears.tooth.errors import GeometryError
from gears.tooth.gear import Gear
from gears.tooth.helix import Helix
from gears.tooth.involute import involute_function, tangent_from_involute
from gears.tooth.material import STEEL, Material, reduced_modulus
from gears.tooth.profile import ToothProfile, generate
from gears.tooth.rack import ISO_53_A, BasicRack

ROUNDING = 1e-13
"""Backlash over the module that rounding leaves of none."""

OF_HELICES = (
    "helix_angle",
    "base_helix_angle",
    "normal_pressure_angle",
    "transverse_module",
    "transverse_pressure_angle",
    "overlap_ratio",
    "total_contact_ratio",
    "transverse_backlash",
)
"""Figures that say nothing new of a spur pair, whose normal section is the transverse one."""


def _of_both(name: str, meaning: str) -> Described[tuple[float, float]]:
    """Length that each tooth has, of pinion and wheel [m]."""

    def lengths(pair: PairGeometry) -> tuple[float, float]:
        first, second = (getattr(tooth, name) for tooth in pair.teeth_profiles)
        return first, second

    lengths.__doc__ = meaning
    return described("m", "gear", shown="mm")(lengths)


@dataclass(frozen=True)
class PairGeometry:
    """Sizes of a pair, not yet known to mesh, and what follows from them; see `gears.GearPair`."""

    no_error = EXACT

    pinion: Gear
    wheel: Gear
    module: float = field(metadata={"figure": Figure("m", "module", shown="mm")})  # m, m
    face_width: float = field(metadata={"figure": Figure("m", "face width", shown="mm")})  # b, m
    rack: BasicRack = ISO_53_A
    material: Material | tuple[Material, Material] = STEEL
    centre_distance: float | None = None  # a, m
    tight: bool = False
    helix_angle: float = field(  # beta, rad
        default=0.0, metadata={"figure": Figure("rad", "helix angle on the reference cylinder", shown="deg")}
    )

    @cached_property
    def helix(self) -> Helix:
        """Helix angles and pressure angles of the normal and of the transverse section."""
        return Helix(self.helix_angle, self.rack.alpha)

    @cached_property
    def materials(self) -> tuple[Material, Material]:
        """Materials of pinion and wheel."""
        return self.material if isinstance(self.material, tuple) else (self.material, self.material)

    @described("m", "gear", shown="mm")
    def face_widths(self) -> tuple[float, float]:
        """Face width of each gear, the pair's where it has no other."""
        first, second = (
            self.face_width if gear.face_width is None else float(gear.face_width)
            for gear in (self.pinion, self.wheel)
        )
        return first, second

    @property
    def face_offsets(self) -> tuple[float, float]:
        """Middle of each gear's face, from that of the face in contact [m]."""
        return float(self.pinion.face_offset), float(self.wheel.face_offset)

    @cached_property
    def teeth_profiles(self) -> tuple[ToothProfile, ToothProfile]:
        """Generated teeth of pinion and wheel."""
        first, second = (
            generate(gear, self.module, self.rack, width, self.helix_angle)
            for gear, width in zip((self.pinion, self.wheel), self.face_widths, strict=True)
        )
        assert first is not None
        assert second is not None
        return first, second

    # m and alpha of the transverse section: m_t = m_n / cos beta, alpha_t
    reference_radii = _of_both("reference_radius", "Reference radius, r = m z / 2.")
    base_radii = _of_both("base_radius", "Base radius, r_b = r cos alpha.")
    root_radii = _of_both("root_radius", "Root radius, r_f = r - m (h_fP - x).")
    tip_radii = _of_both("tip_radius", "Tip radius, r_a = r + m (h_aP + x + k).")
    form_radii = _of_both("form_radius", "Form radius, at which the involute starts.")
    bore_radii = _of_both("bore_radius", "Bore radius, half the root radius where none was given.")

    rim_thicknesses = _of_both(
        "rim_thickness", "Rim thickness below the root circle, of a disc down to the bore."
    )

    @described("m", "gear", shown="mm")
    def web_thicknesses(self) -> tuple[float, float]:
        """Thickness of the web along the axis, of a disc the face width."""
        first, second = (
            width * (tooth.zones[1].thickness if tooth.steps else 1.0)
            for width, tooth in zip(self.face_widths, self.teeth_profiles, strict=True)
        )
        return first, second

    @described("1")
    def ratio(self) -> float:
        """Gear ratio, z2 / z1."""
        return self.wheel.teeth / self.pinion.teeth

    @cached_property
    def _working_tangent(self) -> float:
        """Tangent of the working pressure angle."""
        bases = sum(self.base_radii)
        if self.centre_distance is not None:
            excess = self.centre_distance / bases
            return math.sqrt((excess - 1.0) * (excess + 1.0))
        return tangent_from_involute(self._working_involute)

    @property
    def _working_involute(self) -> float:
        """Involute function of alpha_w of a pair whose nominal teeth have no backlash [rad]."""
        shifts = self.pinion.profile_shift + self.wheel.profile_shift
        teeth = self.pinion.teeth + self.wheel.teeth
        transverse = float(involute_function(self.helix.transverse_tangent))
        return 2.0 * shifts / teeth * math.tan(self.rack.alpha) + transverse

    @described("rad", shown="deg")
    def working_pressure_angle(self) -> float:
        """Working pressure angle, alpha_w."""
        return math.atan(self._working_tangent)

    @described("m", shown="mm", kept=True)
    def working_centre_distance(self) -> float:
        """Centre distance, a = (r_b1 + r_b2) / cos alpha_w."""
        if self.centre_distance is not None:
            return float(self.centre_distance)
        return sum(self.base_radii) * math.hypot(1.0, self._working_tangent)

    @described("m", shown="mm")
    def line_of_action(self) -> float:
        """Line of action, between the base circles' tangent points: rho1 + rho2 = a sin alpha_w."""
        return sum(self.base_radii) * self._working_tangent

    @described("m", "gear", shown="mm")
    def pitch_radii(self) -> tuple[float, float]:
        """Working pitch radius, r_b / cos alpha_w."""
        first, second = self.base_radii
        scale = math.hypot(1.0, self._working_tangent)
        return first * scale, second * scale

    @described("m", shown="mm")
    def base_pitch(self) -> float:
        """Base pitch, p_b = pi m cos alpha.

        That of the transverse section, m_t and alpha_t: pi m_n cos alpha_n / cos beta_b.
        """
        return math.pi * self.module * math.cos(self.rack.alpha) / self.helix.base_cosine

    @described("m", shown="mm")
    def transverse_module(self) -> float:
        """Transverse module, m_t = m_n / cos beta."""
        return self.module / self.helix.cosine

    @described("rad", shown="deg")
    def normal_pressure_angle(self) -> float:
        """Normal pressure angle, alpha_n of the rack."""
        return float(self.rack.alpha)

    @described("rad", shown="deg")
    def transverse_pressure_angle(self) -> float:
        """Transverse pressure angle, tan alpha_t = tan alpha_n / cos beta."""
        return self.helix.transverse_pressure_angle

    @described("rad", shown="deg")
    def base_helix_angle(self) -> float:
        """Helix angle on the base cylinder, sin beta_b = sin beta cos alpha_n; its sign is the hand."""
        return self.helix.base_angle

    @cached_property
    def points(self) -> PathPoints:
        """Points A to E of the line of action by rho1 [m]."""
        first, second = self.teeth_profiles
        start = self.line_of_action - second.flank_rho[1]
        end = first.flank_rho[1]
        pitch = self.base_radii[0] * self._working_tangent
        return PathPoints(A=start, B=end - self.base_pitch, C=pitch, D=start + self.base_pitch, E=end)

    @property
    def active_profiles(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Curvature radii at start and end of the active profiles of pinion and wheel, transverse section [m]."""
        start, end, line = self.points.A, self.points.E, self.line_of_action
        return (start, end), (line - end, line - start)

    @described("1")
    def contact_ratio(self) -> float:
        """Transverse contact ratio, length of the path over the base pitch."""
        return (self.points.E - self.points.A) / self.base_pitch

    @described("1")
    def overlap_ratio(self) -> float:
        """Overlap ratio, eps_beta = b sin beta / (pi m_n) = b tan beta_b / p_bt."""
        return self.face_width * abs(self.helix.base_tangent) / self.base_pitch

    @described("1")
    def total_contact_ratio(self) -> float:
        """Total contact ratio, eps_gamma = eps_alpha + eps_beta."""
        return self.contact_ratio + self.overlap_ratio

    @described("m", shown="um", kept=True)
    def backlash(self) -> float:
        """Normal backlash, along the line of action.

        j_bn = m_n cos alpha_n [(z1 + z2) (inv alpha_wt - inv alpha_t) - 2 (x1 + x2) tan alpha_n]
        + (A1 + A2) cos alpha_n, with the shifts at which the gears are cut. What rounding leaves of none is 0.
        """
        return self._rounded(self._least_backlash + self._allowed_backlash)

    @described("m", shown="um")
    def transverse_backlash(self) -> float:
        """Transverse backlash, arc of the working pitch circles j_wt = j_bn / (cos alpha_wt cos beta_b)."""
        return self.backlash * math.hypot(1.0, self._working_tangent) / self.helix.base_cosine

    @property
    def base_tangent_backlash(self) -> float:
        """Backlash along the transverse line of action, j_bn / cos beta_b = j_wt cos alpha_wt [m]."""
        return self.backlash / self.helix.base_cosine

    def _rounded(self, backlash: float) -> float:
        """Backlash [m], 0 where it is what rounding leaves of none."""
        return 0.0 if abs(backlash) < ROUNDING * self.module else backlash

    @property
    def _allowed_backlash(self) -> float:
        """Normal backlash by the thickness allowances [m]."""
        thinning = self.pinion.thickness_allowance + self.wheel.thickness_allowance
        return thinning * math.cos(self.rack.alpha)

    @property
    def _cut_backlash(self) -> float:
        """Normal backlash by the generating shifts [m]."""
        thinner = sum(gear.profile_shift - gear.cut_shift for gear in (self.pinion, self.wheel))
        return 2.0 * self.module * thinner * math.sin(self.rack.alpha)

    @property
    def _least_backlash(self) -> float:
        """Normal backlash of the pair without thickness allowances [m]."""
        return self._rounded(self._nominal_backlash + self._cut_backlash)

    @property
    def _nominal_backlash(self) -> float:
        """Normal backlash of nominal teeth at the given centre distance [m]."""
        if self.centre_distance is None:
            return 0.0
        transverse = involute_function(self.helix.transverse_tangent)
        spread = float(involute_function(self._working_tangent) - transverse)
        shifts = self.pinion.profile_shift + self.wheel.profile_shift
        teeth = self.pinion.teeth + self.wheel.teeth
        excess = teeth * spread - 2.0 * shifts * math.tan(self.rack.alpha)
        return self.module * math.cos(self.rack.alpha) * excess

    def centre_distance_of_backlash(self, backlash: float) -> float:
        """Centre distance at which these teeth have a normal backlash [m], both in metres.

        inv alpha_wt grows by (j - j_0)/(2 (r_b1 + r_b2) cos beta_b) from that of no backlash.
        """
        bases = sum(self.base_radii)
        more = (backlash - self._allowed_backlash - self._cut_backlash) / (2.0 * bases)
        more /= self.helix.base_cosine
        involute = max(self._working_involute + more, 1e-300)
        return bases * math.hypot(1.0, tangent_from_involute(involute))

    @property
    def reduced_modulus(self) -> float:
        """Reduced modulus E' = 2 / [(1 - nu1^2)/E1 + (1 - nu2^2)/E2] [Pa]."""
        return reduced_modulus(*self.materials)

    def normal_force(self, torque: float) -> float:
        """Return the normal force F_bn = T / (r_b1 cos beta_b) [N] of a pinion torque T [N m]."""
        return torque / self.base_radii[0] / self.helix.base_cosine

    def base_tangent_force(self, torque: float) -> float:
        """Return the force along the transverse line of action F_bt = T / r_b1 [N] of a pinion torque T [N m]."""
        return torque / self.base_radii[0]

    def tangential_force(self, torque: float) -> float:
        """Return the tangential force F_t = T / r_1 [N] at the reference cylinders, of a pinion torque T [N m]."""
        return torque / self.reference_radii[0]

    def radial_force(self, torque: float) -> float:
        """Return the radial force F_t tan alpha_t [N] at the reference cylinders, of a pinion torque T [N m]."""
        return self.tangential_force(torque) * self.helix.transverse_tangent

    def axial_force(self, torque: float) -> float:
        """Axial force on the pinion, T tan beta_b / r_b1 = F_t tan beta; the wheel has the opposite.

        Parameters
        ----------
        torque : float
            T of the driving pinion [N m].

        Returns
        -------
        float
            [N], positive along the axis about which the pinion turns anticlockwise: that of a right-handed driver.
        """
        return torque / self.base_radii[0] * self.helix.base_tangent

    @property
    def moments_of_inertia(self) -> tuple[float, float]:
        """Polar moments of inertia from the bore to the reference circle, zone by zone [kg m^2].

        J = pi rho b Sum t (r_o^4 - r_i^4) / 2, b the gear's own face width, t the thickness of a zone over it, 1 in a
        disc
        """
        first, second = (
            0.5
            * math.pi
            * width
            * material.density
            * (
                tooth.reference_radius**4
                - tooth.bore_radius**4
                - sum((1.0 - zone.thickness) * (zone.outer**4 - zone.inner**4) for zone in tooth.zones)
            )
            for width, material, tooth in zip(
                self.face_widths, self.materials, self.teeth_profiles, strict=True
            )
        )
        return first, second

    def path_at(self, rho1: float | Array) -> PathOfContact:
        """Path of contact at given curvature radii of the pinion.

        Parameters
        ----------
        rho1 : float or (n,) array
            Curvature radii [m], from 0 to `line_of_action`; they need not lie between A and E.

        Returns
        -------
        PathOfContact
            The points.
        """
        first = np.atleast_1d(np.asarray(rho1, dtype=float))
        total = self.line_of_action
        if not np.all((first >= 0.0) & (first <= total)):
            allowed = f"must be finite, at least 0 and at most {total:.6g} m (the line of action)"
            span = f"{np.min(first):g} .. {np.max(first):g}"
            raise GeometryError.at("rho1", span, allowed, "stay on the line of action")
        return PathOfContact(first, total - first, self.points.A, self.base_radii)

    def path_of_contact(self, n: int = 9) -> PathOfContact:
        """Path of contact at `n` equally spaced points from A to E, both included."""
        if n < 2:
            raise GeometryError.at("n", n, "must be at least 2 points", "A and E are both included")
        return self.path_at(np.linspace(self.points.A, self.points.E, n))
