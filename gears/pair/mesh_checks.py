"""Guards of a pair: values, teeth that cannot exist, gears that cannot run together."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING

import numpy as np

from base import Faults, rounded_down, rounded_up
from gears.pair.module_check import fitting_normal_module, transverse_module_warning
from gears.tooth.errors import GeometryError
from gears.tooth.gear import LIMITS, Gear
from gears.tooth.involute import tangent_from_involute
from gears.tooth.profile import ToothProfile, generate
from gears.tooth.rack import BasicRack

if TYPE_CHECKING:
    from gears.pair.pair_geometry import PairGeometry

THIN_TIP = 0.2
"""Thickness of the top land below which a pair warns [modules]."""

THIN_RIM = 0.5
"""Rim thickness over tooth depth below which a pair warns."""

THINNEST_RIM = 0.25
"""Rim thickness below which a pair is refused [modules]."""

LEAST_CLEARANCE = 1e-3
"""Clearance between tip and root circle that a remedy leaves at least [modules]."""

TIGHTEST = 0.1
"""Overlap of flanks up to which a tight pair is accepted [modules]."""

LAST_DIGIT = 0.002
"""Modules by which a centre distance may be short of that of no backlash, as rounded data are."""

ROUNDING = 1e-12
"""Lengths of this many modules are rounding: a backlash of -1e-16 m is none, not a jam."""


class Findings(Faults):
    """Collects faults and warnings of a pair, in the order in which they are found."""

    def __init__(self) -> None:
        super().__init__(GeometryError)
        self.warnings: list[str] = []


def check_gear(
    findings: Findings,
    name: str,
    gear: Gear,
    module: float,
    rack: BasicRack,
    face_width: float | None = None,
    helix_angle: float = 0.0,
) -> None:
    """Note faults and warnings of one generated gear.

    They are: root against axis and bore, a tooth cut through by its fillets, a pointed tip, chamfer and relief
    longer than the flank, a blank that does not fit; thin tips and rims as warnings.

    Parameters
    ----------
    findings : Findings
        Where to.
    name : str
        ``pinion`` or ``wheel``.
    gear, module, rack : Gear, float, BasicRack
        Specification, free of value faults.
    face_width : float, optional
        Against which the web is checked [m]; it is not unless given.
    helix_angle : float
        On the reference cylinder [rad].
    """
    named = "profile_shift" if gear.generating_shift is None else "generating_shift"
    shift = f"{name}.{named}", f"{gear.cut_shift:g}"
    reference = 0.5 * gear.teeth / math.cos(helix_angle)  # in modules
    root = module * (reference - rack.h_fP + gear.cut_shift)
    if root <= 0.0:
        least = f"must be more than {rounded_up(rack.h_fP - reference, 4)}"
        findings.add(*shift, least, "the rack cuts through the axis: raise profile_shift or teeth")
        return
    depth = module * (rack.h_aP + rack.h_fP + gear.tip_alteration + gear.profile_shift - gear.cut_shift)
    if gear.tip_chamfer >= depth > 0.0:
        allowed = f"must be less than the tooth depth, {rounded_down(depth, 4)} m"
        findings.add(f"{name}.tip_chamfer", f"{gear.tip_chamfer:g}", allowed, "chamfer less")
        return
    bore = 0.5 * root if gear.bore_radius is None else gear.bore_radius
    if gear.blank is not None:
        gear.blank.check(findings, f"{name}.blank", root, bore, module, face_width)
    tooth = generate(gear, module, rack, helix_angle=helix_angle)
    if tooth is not None and tooth.flank_end_radius > tooth.form_radius * (1.0 + ROUNDING):
        _check_tooth(findings, name, gear, tooth, rack)
        _check_rim(findings, name, root, tooth.bore_radius, module, tooth.tip_radius - root)
    else:
        remedy = (
            "the fillet cuts away the whole flank: raise profile_shift, teeth or tip_alteration, or shorten "
        )
        remedy += "the tip chamfer"
        findings.add(*shift, "must leave an involute between fillet and tip", remedy)
        _check_rim(findings, name, root, bore, module)


def _neck(tooth: ToothProfile) -> float:
    """Half the minimum thickness between the fillets [m]."""
    return float(np.min(tooth.fillet(np.linspace(0.0, 1.0, 65))[:, 0]))


def _check_tooth(findings: Findings, name: str, gear: Gear, tooth: ToothProfile, rack: BasicRack) -> None:
    """Neck, tip and relief of a tooth that has a flank."""
    if _neck(tooth) <= 0.0:
        unthinned = dataclasses.replace(gear, thickness_allowance=0.0)
        whole = generate(unthinned, tooth.module, rack, helix_angle=tooth.fillet_curve.helix_angle)
        thinned = gear.thickness_allowance > 0.0 and whole is not None and _neck(whole) > 0.0
        cause = "thickness_allowance" if thinned else "profile_shift"
        remedy = "the fillets of the two sides meet in the tooth: "
        remedy += "thin the tooth less" if thinned else "raise profile_shift or teeth"
        findings.add(f"{name}.{cause}", f"{getattr(gear, cause):g}", "must leave the tooth a neck", remedy)
    if tooth.tip_half_angle <= 0.0:
        _add_pointed(findings, name, gear, tooth)
    relief, flank = tooth.tip_relief, tooth.flank_rho[1] - tooth.flank_rho[0]
    if relief is not None and relief.length > flank:
        allowed = f"must be at most the flank's {rounded_down(flank)} m"
        findings.add(f"{name}.tip_relief.length", f"{relief.length:g}", allowed, "shorten the relief")
    if relief is not None and relief.amount > 0.5 * tooth.module:
        allowed = f"must be at most half a module, {rounded_down(0.5 * tooth.module)} m"
        findings.add(f"{name}.tip_relief.amount", f"{relief.amount:g}", allowed, "relieve less")
    land = 2.0 * tooth.tip_radius * tooth.tip_half_angle / tooth.module
    if 0.0 < land < THIN_TIP:
        findings.warnings.append(
            f"{name}: the top land is {land:.3f} modules thick, thinner than {THIN_TIP:g}"
        )


def _add_pointed(findings: Findings, name: str, gear: Gear, tooth: ToothProfile) -> None:
    """Note a pointed tooth, with what thins it, with the highest tip that the flanks allow."""
    spare = gear.thickness_allowance + 2.0 * tooth.reference_radius * tooth.tip_half_angle
    point = tooth.base_radius * math.hypot(1.0, tangent_from_involute(max(tooth.base_half_angle, 1e-9)))
    excess = (tooth.tip_radius - point) / tooth.module
    if gear.thickness_allowance > 0.0 and spare > 0.0:
        cause, allowed = "thickness_allowance", f"must be less than {rounded_down(spare, 4)} m"
        remedy = "thin the tooth less"
    elif gear.cut_shift < gear.profile_shift:
        cause, allowed = "generating_shift", f"must be nearer to the profile shift, {gear.profile_shift:g}"
        remedy = "raise generating_shift, or reduce tip_alteration"
    elif gear.tip_chamfer > 0.0 and excess < 0.0:
        cause, allowed, remedy = "tip_chamfer", "must leave a top land", "chamfer less"
    elif (highest := gear.tip_alteration - excess) > LIMITS["tip_alteration"].low:
        cause = "tip_alteration"
        allowed = f"must be less than {rounded_down(highest, 4)} modules, where the flanks meet"
        remedy = "reduce profile_shift or tip_alteration"
    else:
        cause, allowed = "profile_shift", "must leave a top land, which no tip_alteration does"
        remedy = "reduce profile_shift"
    findings.add(f"{name}.{cause}", f"{getattr(gear, cause):g}", allowed, f"the tip is pointed: {remedy}")


def _check_rim(
    findings: Findings, name: str, root: float, bore: float, module: float, depth: float = 0.0
) -> None:
    """Bore and rim; `depth` of the tooth [m], 0 where there is none."""
    largest = root - THINNEST_RIM * module
    if bore > largest + ROUNDING * module:
        why = "is not inside the root circle" if bore >= root else "leaves a rim too thin for a gear"
        remedy = f"the bore {why} (root radius {root:.6g} m): reduce it"
        findings.add(f"{name}.bore_radius", f"{bore:g}", f"must be at most {rounded_down(largest)} m", remedy)
    elif root - bore < THIN_RIM * depth:
        share = (root - bore) / depth
        findings.warnings.append(
            f"{name}: the rim is {share:.2f} of the tooth depth thick, thinner than {THIN_RIM:g}"
        )


def unrounded_distance(findings: Findings, pair: PairGeometry) -> float | None:
    """Centre distance of no backlash where the given one is short of it by rounding alone, with a remark.

    Parameters
    ----------
    findings : Findings
        Where the remark goes.
    pair : PairGeometry
        Two sound gears.

    Returns
    -------
    float or None
        The distance [m]; None where the given one stands: long enough, too short, or of a pair that may be tight.
    """
    distance = pair.centre_distance
    if distance is None or pair.tight or distance <= sum(pair.base_radii):
        return None
    least = pair.centre_distance_of_backlash(0.0)
    short = (least - distance) / pair.module
    if not ROUNDING < short <= LAST_DIGIT:
        return None
    findings.warnings.append(
        f"centre_distance: {1e3 * distance:.9g} mm is {1e6 * (least - distance):.2g} um short of {1e3 * least:.9g} mm, "
        "at which these teeth have no backlash: taken as rounded, the longer one is used"
    )
    return least


def check_mesh(findings: Findings, pair: PairGeometry) -> None:
    """Note why two sound gears cannot run together: axes, jam, contact ratio, interference, tips."""
    bases = sum(pair.base_radii)
    if pair.centre_distance is not None and pair.centre_distance <= bases:
        allowed = f"must be more than the sum of the base radii, {rounded_up(bases)} m"
        remedy = "there is no line of action: move the axes apart" + fitting_normal_module(pair)
        findings.add("centre_distance", f"{pair.centre_distance:g}", allowed, remedy)
        return
    if pair.centre_distance is None and pair._working_involute <= 0.0:
        value = f"{pair.pinion.profile_shift + pair.wheel.profile_shift:g}"
        remedy = "no working pressure angle exists: raise a profile shift, or give centre_distance"
        findings.add("pinion.profile_shift + wheel.profile_shift", value, "must be larger", remedy)
        return
    if (remark := transverse_module_warning(pair)) is not None:
        findings.warnings.append(remark)
    rounding = ROUNDING * pair.module
    if pair.backlash < (-TIGHTEST * pair.module if pair.tight else -rounding):
        _add_jam(findings, pair)
    # overlap hands over from pair to pair too, where there is a path at all
    handed_over = pair.total_contact_ratio if pair.contact_ratio > 0.0 else pair.contact_ratio
    if not handed_over >= 1.0:
        remedy = (
            "the next pair comes too late: lengthen the teeth by tip_alteration, or bring the axes closer"
        )
        findings.add("contact_ratio", f"{handed_over:.6g}", "must be at least 1", remedy)
    first, second = pair.teeth_profiles
    # each gear with its mate, and its curvature radius where contact comes nearest to its root
    meshing = (
        ("pinion", "wheel", first, second, pair.points.A),
        ("wheel", "pinion", second, first, pair.line_of_action - pair.points.E),
    )
    if pair.contact_ratio > 0.0:
        for name, other, tooth, mate, lowest in meshing:
            if lowest < tooth.flank_rho[0] - rounding:
                _add_interference(findings, pair, name, other, tooth, mate)
    for name, other, tooth, mate, _ in meshing:
        clearance = pair.working_centre_distance - mate.tip_radius - tooth.root_radius
        if clearance <= 0.0:
            allowed = f"must be less than {rounded_down(pair.working_centre_distance - tooth.root_radius)} m"
            remedy = f"the tip of the {other} meets the root circle of the {name}: "
            lowered = _lowered(pair, other, LEAST_CLEARANCE - clearance / pair.module)
            remedy += " or ".join([*lowered, "move the axes apart by centre_distance"])
            findings.add(f"{other}.tip_radius", f"{mate.tip_radius:.6g}", allowed, remedy)


def _add_jam(findings: Findings, pair: PairGeometry) -> None:
    """Note teeth thicker than their gaps at the given centre distance, by more than a tight pair may be."""
    least = pair.centre_distance_of_backlash(-TIGHTEST * pair.module if pair.tight else 0.0)
    allowance = -pair.backlash / math.cos(pair.rack.alpha)
    remedy = (
        f"the teeth jam: move the axes apart, shift the profiles less or add {rounded_up(allowance, 3)} m of "
    )
    remedy += "thickness_allowance in all"
    if not pair.tight and pair.backlash >= -TIGHTEST * pair.module:
        remedy += ", or let both sides of the teeth bear: tight = true"
    remedy += fitting_normal_module(pair)
    allowed = f"must be at least {rounded_up(least)} m"
    findings.add("centre_distance", f"{pair.working_centre_distance:.6g}", allowed, remedy)


def _add_interference(
    findings: Findings, pair: PairGeometry, name: str, other: str, tooth: ToothProfile, mate: ToothProfile
) -> None:
    """Note a mate whose flank end would touch below the form circle of `tooth`."""
    longest = pair.line_of_action - tooth.flank_rho[0]
    remedy = f"the tip of the {other} would work on the fillet of the {name}, below its form circle: "
    allowed, remedies = "must be smaller", []
    if longest > 0.0:
        largest = math.hypot(mate.base_radius, longest)
        allowed = f"must be at most {rounded_down(largest)} m where the flank ends"
        if largest > mate.form_radius:
            remedies = _lowered(pair, other, (mate.flank_end_radius - largest) / mate.module)
    if tooth.undercut or not remedies:
        why = ", which lessens the undercut" if tooth.undercut else ""
        remedies.append(f"raise {name}.profile_shift{why}, or {name}.teeth")
    findings.add(
        f"{other}.tip_radius", f"{mate.flank_end_radius:.6g}", allowed, remedy + ", or ".join(remedies)
    )


def _lowered(pair: PairGeometry, name: str, by: float) -> list[str]:
    """Remedy of a tip that is too high by some modules; none where a gear may not be shortened by as much."""
    gear: Gear = getattr(pair, name)
    least = LIMITS["tip_alteration"].low
    enough = rounded_up(by, 4)
    return (
        [f"lower {name}.tip_alteration by {enough}"] if gear.tip_alteration - float(enough) >= least else []
    )
