"""A pair of spur or helical gears that is known to mesh."""

from __future__ import annotations

import dataclasses
import math
import warnings
from dataclasses import dataclass

from base import Faults, Limit, plot, view
from gears.pair.faces_in_contact import check_faces
from gears.pair.mesh_checks import Findings, check_gear, check_mesh, unrounded_distance
from gears.pair.pair_geometry import PairGeometry
from gears.pair.placement import Placement, place
from gears.tooth.errors import GeometryError, GeometryWarning
from gears.tooth.face import STRAIGHT
from gears.tooth.gear import Gear
from gears.tooth.helix import HELIX_ANGLE
from gears.tooth.material import Material
from gears.tooth.rack import BasicRack

LIMITS = {
    "module": Limit(1e-5, 1.0, "m", "give the module in metres (2 mm is 2e-3)"),
    "face_width": Limit(1e-6, 100.0, "m", "give the face width in metres (40 mm is 40e-3)"),
    "centre_distance": Limit.above(0.0, 1e4, "m", "give the distance of the axes in metres, or None"),
    "helix_angle": HELIX_ANGLE,
}
"""What the numbers of a pair itself may be."""

BACKLASH = Limit(0.0, 1.0, "m", "give the normal backlash in metres (50 um is 50e-6)")
"""What the normal backlash of a pair may be."""


@dataclass(frozen=True)
class GearPair(PairGeometry):
    """A pair of external spur or helical gears cut by one basic rack.

    Module, pressure angle, rack, shifts and thickness allowances are those of the normal section (m_n, alpha_n, x_n,
    A_sn), which is the only one of spur gears. Radii, `base_pitch`, `contact_ratio`, path of contact and tooth profiles
    are those of the transverse section: m_t = m_n / cos beta, tan alpha_t = tan alpha_n / cos beta.

    Without `centre_distance` the gears mesh at the working pressure angle for which nominal teeth have no
    backlash, inv alpha_wt = 2 (x1 + x2) / (z1 + z2) tan alpha_n + inv alpha_t; with it, cos alpha_wt =
    (r_b1 + r_b2) / a and the backlash follows. A centre distance that is short of that of no backlash by at most
    0.002 modules, as rounded data are, is taken for it. The path of contact ends where the involutes end (tip circle
    or start of the chamfer). Symbols of ISO 21771.

    Parameters
    ----------
    pinion, wheel : Gear
        The gears; the pinion drives, anticlockwise.
    module : float
        m_n [m]; a drawing's m_t times cos beta.
    face_width : float
        b of the face in contact [m]; wider gears have a separate ``face_width``.
    rack : BasicRack
        Basic rack tooth profile; ISO 53 profile A unless given.
    material : Material or (Material, Material)
        Of both gears, or of pinion and wheel.
    centre_distance : float or None
        a [m]; longer than was given where a rounded one was taken for that of no backlash.
    tight : bool
        Whether teeth may be thicker than their gaps, by up to a tenth of the module: flanks on both sides then bear
        (``fem.mesh_cycle``). Otherwise such a pair is refused, since it jams.
    helix_angle : float
        beta on the reference cylinder [rad], at most 45 deg; positive where the pinion is right-handed, with a
        left-handed wheel, negative where it is left-handed. A double helical gear is two such pairs, each half by
        itself under half of the torque. 0 is a spur pair, to the last bit. Finite elements, films and motion refuse
        helical pairs.

    Raises
    ------
    GeometryError
        With every fault of the values and of the geometry that follows from them: pointed teeth, undercut
        that leaves no tooth, bore against root, contact ratio below one, interference with the fillet, tip
        against root circle, teeth that jam.

    Warns
    -----
    GeometryWarning
        Top land thinner than 0.2 modules; rim thinner than half the tooth depth; a centre distance that is short by
        rounding, with the one that is used; a module that looks like the transverse one.

    References
    ----------
    ISO 21771:2007, Gears - Cylindrical involute gears and gear pairs - Concepts and geometry.

    Examples
    --------
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> pair
    GearPair(36:40 teeth, module 2 mm, face width 40 mm, centre distance 76 mm, contact ratio 1.703)
    >>> 1e3 * pair.base_pitch
    5.904...
    >>> 1e6 * pair.with_backlash(50e-6).backlash
    50.0...
    >>> helical = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, helix_angle=math.radians(20.0))
    >>> helical
    GearPair(36:40 teeth, module 2 mm, helix angle 20 deg, ..., centre distance 80.87751 mm, contact ratio 1.56)
    >>> round(helical.overlap_ratio, 5), round(1e3 * helical.base_pitch, 5)
    (2.17737, 6.23506)
    """

    def __post_init__(self) -> None:
        """Refuse values and geometries that no pair has, all faults at once."""
        findings = Findings()
        self._check_values(findings)
        wrong = [fault.where for fault in findings.found]
        if not any(path in ("module", "helix_angle") or path.startswith("rack") for path in wrong):
            width = None if "face_width" in wrong else self.face_width
            for name, gear in (("pinion", self.pinion), ("wheel", self.wheel)):
                if not any(path.startswith(name) for path in wrong):
                    own = width if gear.face_width is None else gear.face_width
                    check_gear(findings, name, gear, self.module, self.rack, own, self.helix_angle)
            faces = ("pinion", "wheel", "face_width", "face_offset")
            if width is not None and not any(path.endswith(faces) for path in wrong):
                check_faces(findings, self)
        if not findings.found:
            if (distance := unrounded_distance(findings, self)) is not None:
                object.__setattr__(self, "centre_distance", distance)
            check_mesh(findings, self)
        findings.raise_if_any()
        for message in findings.warnings:
            warnings.warn(message, GeometryWarning, stacklevel=3)

    def _check_values(self, findings: Findings) -> None:
        """Note faults of single values of the pair and its parts: wrong kind, not finite, out of bounds."""
        findings.fields(self, LIMITS)
        if not isinstance(self.tight, bool):
            findings.add(
                "tight", self.tight, "must be True or False", "True lets both sides of the teeth bear"
            )
        for name, kind in (("pinion", Gear), ("wheel", Gear), ("rack", BasicRack)):
            if isinstance(part := getattr(self, name), kind):
                findings.extend(part.faults(name))
            else:
                findings.add(name, part, f"must be a {kind.__name__}", f"pass gears.{kind.__name__}(...)")
        several = isinstance(self.material, tuple)
        if len(self.materials) != 2 or not all(isinstance(material, Material) for material in self.materials):
            remedy = "pass gears.Material(...)"
            findings.add("material", self.material, "must be a Material or two of them", remedy)
            return
        for name, material in zip(("pinion", "wheel") if several else ("",), self.materials, strict=several):
            findings.extend(material.faults(f"material.{name}".strip(".")))

    def __repr__(self) -> str:
        """One line: teeth, sizes and what follows from them."""
        helix = f"helix angle {math.degrees(self.helix_angle):.6g} deg, " if self.helix_angle else ""
        return (
            f"GearPair({self.pinion.teeth}:{self.wheel.teeth} teeth, module {1e3 * self.module:.6g} mm, {helix}"
            f"face width {1e3 * self.face_width:.6g} mm, "
            f"centre distance {1e3 * self.working_centre_distance:.7g} mm, "
            f"contact ratio {self.contact_ratio:.4g})"
        )

    @property
    def straight(self) -> bool:
        """Whether the flanks of both gears are straight along the face, without a lead."""
        return self.pinion.lead == self.wheel.lead == STRAIGHT

    _repr_html_ = view
    plot = plot

    def with_backlash(self, normal_backlash: float) -> GearPair:
        """Pair with a wanted normal backlash, both teeth thinned by the same amount.

        Parameters
        ----------
        normal_backlash : float
            j_bn [m]; at least what the centre distance and the generating shifts give by themselves.

        Returns
        -------
        GearPair
            The same pair with new thickness allowances (those it had are replaced).
        """
        least = self._least_backlash
        with Faults(GeometryError) as faults:
            if faults.number("backlash", normal_backlash, BACKLASH) < least:
                cut = any(gear.generating_shift is not None for gear in (self.pinion, self.wheel))
                source = "centre distance and generating shifts give" if cut else "centre distance gives"
                allowed = f"must be at least {least:.6g} m, which the {source}"
                remedy = "ask for more, or reduce the centre distance"
                faults.add("backlash", normal_backlash, allowed, remedy)
        allowance = 0.5 * (normal_backlash - least) / math.cos(self.rack.alpha)
        return dataclasses.replace(
            self,
            pinion=dataclasses.replace(self.pinion, thickness_allowance=allowance),
            wheel=dataclasses.replace(self.wheel, thickness_allowance=allowance),
        )

    def placement(self, rho1: float) -> Placement:
        """Rotations that bring one tooth of each gear into contact at `rho1` [m]; see `gears.Placement`."""
        return place(self, rho1)
