"""A pair of spur gears that is known to mesh."""

from __future__ import annotations

import dataclasses
import math
import warnings
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from base import Array, Fault, Figure, Limit, described, view
from gears.errors import GeometryError, GeometryWarning
from gears.gear import Gear
from gears.guards import Findings, check_gear, check_mesh
from gears.involute import involute_function, tangent_from_involute
from gears.material import STEEL, Material, reduced_modulus
from gears.path import PathOfContact, PathPoints
from gears.placement import Placement, place
from gears.profile import ToothProfile, generate
from gears.rack import ISO_53_A, BasicRack

LIMITS = {
    "module": Limit(1e-5, 1.0, "m", "give the module in metres (2 mm is 2e-3)"),
    "face_width": Limit(1e-6, 100.0, "m", "give the face width in metres (40 mm is 40e-3)"),
    "centre_distance": Limit(
        0.0, 1e4, "m", "give the distance of the axes in metres, or None", low_open=True
    ),
}
"""What the numbers of a pair itself may be."""

BACKLASH = Limit(0.0, 1.0, "m", "give the normal backlash in metres (50 um is 50e-6)")
"""What the normal backlash of a pair may be."""


@dataclass(frozen=True)
class GearPair:
    """A pair of external spur gears cut by one basic rack.

    Without `centre_distance` the gears mesh at the working pressure angle for which nominal teeth have no
    backlash, inv alpha_w = 2 (x1 + x2) / (z1 + z2) tan alpha + inv alpha; with it, cos alpha_w =
    (r_b1 + r_b2) / a and the backlash follows. The path of contact ends where the involutes end (tip circle
    or start of the chamfer). Symbols of ISO 21771.

    Parameters
    ----------
    pinion, wheel : Gear
        The gears; the pinion drives, anticlockwise.
    module : float
        m [m].
    face_width : float
        b [m].
    rack : BasicRack
        Basic rack tooth profile; ISO 53 profile A unless given.
    material : Material or (Material, Material)
        Of both gears, or of pinion and wheel.
    centre_distance : float or None
        a [m].

    Raises
    ------
    GeometryError
        With every fault of the values and of the geometry that follows from them: pointed teeth, undercut
        that leaves no tooth, bore against root, contact ratio below one, interference with the fillet, tip
        against root circle, teeth that jam.

    Warns
    -----
    GeometryWarning
        Top land thinner than 0.2 modules; rim thinner than half the tooth depth.

    Examples
    --------
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> pair
    GearPair(36:40 teeth, module 2 mm, face width 40 mm, centre distance 76 mm, contact ratio 1.703)
    >>> 1e3 * pair.base_pitch
    5.904...
    >>> 1e6 * pair.with_backlash(50e-6).backlash
    50.0...
    """

    pinion: Gear
    wheel: Gear
    module: float = field(metadata={"figure": Figure("m", "module", shown="mm")})  # m, m
    face_width: float = field(metadata={"figure": Figure("m", "face width", shown="mm")})  # b, m
    rack: BasicRack = ISO_53_A
    material: Material | tuple[Material, Material] = STEEL
    centre_distance: float | None = None  # a, m

    def __post_init__(self) -> None:
        """Refuse values and geometries that no pair has, all faults at once."""
        found = Findings()
        self._check_values(found)
        wrong = [fault.where for fault in found.found]
        if not any(where == "module" or where.startswith("rack") for where in wrong):
            for name, gear in (("pinion", self.pinion), ("wheel", self.wheel)):
                if not any(where.startswith(name) for where in wrong):
                    check_gear(found, name, gear, self.module, self.rack)
        if not found.found:
            check_mesh(found, self)
        found.raise_if_any(GeometryError)
        for message in found.warnings:
            warnings.warn(message, GeometryWarning, stacklevel=3)

    def _check_values(self, found: Findings) -> None:
        """Note faults of single values of the pair and its parts: wrong kind, not finite, out of bounds."""
        found.fields(self, LIMITS)
        for name, kind in (("pinion", Gear), ("wheel", Gear), ("rack", BasicRack)):
            if isinstance(part := getattr(self, name), kind):
                found.extend(part.faults(name))
            else:
                found.add(name, part, f"must be a {kind.__name__}", f"pass gears.{kind.__name__}(...)")
        several = isinstance(self.material, tuple)
        if len(self.materials) != 2 or not all(isinstance(material, Material) for material in self.materials):
            remedy = "pass gears.Material(...)"
            found.add("material", self.material, "must be a Material or two of them", remedy)
            return
        for name, material in zip(("pinion", "wheel") if several else ("",), self.materials, strict=several):
            found.extend(material.faults(f"material.{name}".strip(".")))

    def __repr__(self) -> str:
        """One line: teeth, sizes and what follows from them."""
        return (
            f"GearPair({self.pinion.teeth}:{self.wheel.teeth} teeth, module {1e3 * self.module:.6g} mm, "
            f"face width {1e3 * self.face_width:.6g} mm, "
            f"centre distance {1e3 * self.working_centre_distance:.7g} mm, "
            f"contact ratio {self.contact_ratio:.4g})"
        )

    _repr_html_ = view

    @cached_property
    def materials(self) -> tuple[Material, Material]:
        """Materials of pinion and wheel."""
        return self.material if isinstance(self.material, tuple) else (self.material, self.material)

    @cached_property
    def teeth_profiles(self) -> tuple[ToothProfile, ToothProfile]:
        """Generated teeth of pinion and wheel."""
        first, second = (generate(gear, self.module, self.rack) for gear in (self.pinion, self.wheel))
        assert first is not None
        assert second is not None
        return first, second

    def _of_both(self, name: str) -> tuple[float, float]:
        """Length that each tooth has, of pinion and wheel [m]."""
        first, second = (getattr(tooth, name) for tooth in self.teeth_profiles)
        return first, second

    @property
    @described("m", "gear", shown="mm")
    def reference_radii(self) -> tuple[float, float]:
        """Reference radius, r = m z / 2."""
        return self._of_both("reference_radius")

    @property
    @described("m", "gear", shown="mm")
    def base_radii(self) -> tuple[float, float]:
        """Base radius, r_b = r cos alpha."""
        return self._of_both("base_radius")

    @property
    @described("m", "gear", shown="mm")
    def root_radii(self) -> tuple[float, float]:
        """Root radius, r_f = r - m (h_fP - x)."""
        return self._of_both("root_radius")

    @property
    @described("m", "gear", shown="mm")
    def tip_radii(self) -> tuple[float, float]:
        """Tip radius, r_a = r + m (h_aP + x + k)."""
        return self._of_both("tip_radius")

    @property
    @described("m", "gear", shown="mm")
    def form_radii(self) -> tuple[float, float]:
        """Form radius, at which the involute starts."""
        return self._of_both("form_radius")

    @property
    @described("m", "gear", shown="mm")
    def bore_radii(self) -> tuple[float, float]:
        """Bore radius, half the root radius where none was given."""
        return self._of_both("bore_radius")

    @property
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
        tangent = math.tan(self.rack.alpha)
        teeth = self.pinion.teeth + self.wheel.teeth
        return 2.0 * shifts / teeth * tangent + float(involute_function(tangent))

    @property
    @described("rad", shown="deg")
    def working_pressure_angle(self) -> float:
        """Working pressure angle, alpha_w."""
        return math.atan(self._working_tangent)

    @cached_property
    @described("m", shown="mm")
    def working_centre_distance(self) -> float:
        """Centre distance, a = (r_b1 + r_b2) / cos alpha_w."""
        if self.centre_distance is not None:
            return float(self.centre_distance)
        return sum(self.base_radii) * math.hypot(1.0, self._working_tangent)

    @property
    @described("m", shown="mm")
    def line_of_action(self) -> float:
        """Line of action, between the base circles' tangent points: rho1 + rho2 = a sin alpha_w."""
        return sum(self.base_radii) * self._working_tangent

    @property
    @described("m", "gear", shown="mm")
    def pitch_radii(self) -> tuple[float, float]:
        """Working pitch radius, r_b / cos alpha_w."""
        first, second = self.base_radii
        scale = math.hypot(1.0, self._working_tangent)
        return first * scale, second * scale

    @property
    @described("m", shown="mm")
    def base_pitch(self) -> float:
        """Base pitch, p_b = pi m cos alpha."""
        return math.pi * self.module * math.cos(self.rack.alpha)

    @cached_property
    def points(self) -> PathPoints:
        """Points A to E of the line of action by rho1 [m]."""
        first, second = self.teeth_profiles
        start = self.line_of_action - second.flank_rho[1]
        end = first.flank_rho[1]
        pitch = self.base_radii[0] * self._working_tangent
        return PathPoints(A=start, B=end - self.base_pitch, C=pitch, D=start + self.base_pitch, E=end)

    @property
    @described("1")
    def contact_ratio(self) -> float:
        """Transverse contact ratio, length of the path over the base pitch."""
        return (self.points.E - self.points.A) / self.base_pitch

    @cached_property
    @described("m", shown="um")
    def backlash(self) -> float:
        """Normal backlash, along the line of action.

        j_bn = m cos alpha [(z1 + z2) (inv alpha_w - inv alpha) - 2 (x1 + x2) tan alpha] + (A1 + A2) cos alpha.
        """
        thinning = self.pinion.thickness_allowance + self.wheel.thickness_allowance
        return self._nominal_backlash + thinning * math.cos(self.rack.alpha)

    @property
    def _nominal_backlash(self) -> float:
        """Normal backlash of the pair without thickness allowances [m]."""
        if self.centre_distance is None:
            return 0.0
        tangent = math.tan(self.rack.alpha)
        spread = float(involute_function(self._working_tangent) - involute_function(tangent))
        shifts = self.pinion.profile_shift + self.wheel.profile_shift
        teeth = self.pinion.teeth + self.wheel.teeth
        return self.module * math.cos(self.rack.alpha) * (teeth * spread - 2.0 * shifts * tangent)

    def with_backlash(self, normal_backlash: float) -> GearPair:
        """Pair with a wanted normal backlash, both teeth thinned by the same amount.

        Parameters
        ----------
        normal_backlash : float
            j_bn [m]; at least what the centre distance gives by itself.

        Returns
        -------
        GearPair
            The same pair with new thickness allowances (those it had are replaced).
        """
        least = self._nominal_backlash
        found = BACKLASH.faults("backlash", normal_backlash)
        if not found and normal_backlash < least:
            allowed = f"must be at least {least:.6g} m, which the centre distance gives"
            remedy = "ask for more, or reduce the centre distance"
            found = (Fault("backlash", f"{normal_backlash!r}", allowed, remedy),)
        if found:
            raise GeometryError(found)
        allowance = 0.5 * (normal_backlash - least) / math.cos(self.rack.alpha)
        return dataclasses.replace(
            self,
            pinion=dataclasses.replace(self.pinion, thickness_allowance=allowance),
            wheel=dataclasses.replace(self.wheel, thickness_allowance=allowance),
        )

    @property
    def reduced_modulus(self) -> float:
        """Reduced modulus E' = 2 / [(1 - nu1^2)/E1 + (1 - nu2^2)/E2] [Pa]."""
        return reduced_modulus(*self.materials)

    def normal_force(self, torque: float) -> float:
        """Return the normal force T / r_b1 [N] of a pinion torque T [N m]."""
        return torque / self.base_radii[0]

    @property
    def moments_of_inertia(self) -> tuple[float, float]:
        """Polar moments of inertia of discs from the bore to the reference circle [kg m^2].

        J = pi rho b (r^4 - r_bore^4) / 2
        """
        first, second = (
            0.5
            * math.pi
            * material.density
            * self.face_width
            * (tooth.reference_radius**4 - tooth.bore_radius**4)
            for material, tooth in zip(self.materials, self.teeth_profiles, strict=True)
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
            fault = Fault(
                "rho1", f"{np.min(first):g} .. {np.max(first):g}", allowed, "stay on the line of action"
            )
            raise GeometryError([fault])
        return PathOfContact(first, total - first, self.points.A, self.base_radii)

    def path_of_contact(self, n: int = 9) -> PathOfContact:
        """Path of contact at `n` equally spaced points from A to E, both included."""
        if n < 2:
            raise GeometryError(
                [Fault("n", str(n), "must be at least 2 points", "A and E are both included")]
            )
        return self.path_at(np.linspace(self.points.A, self.points.E, n))

    def placement(self, rho1: float) -> Placement:
        """Rotations that bring one tooth of each gear into contact at `rho1` [m]; see `gears.Placement`."""
        return place(self, rho1)
