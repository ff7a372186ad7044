"""Guards of a pair: values, teeth that cannot exist, gears that cannot run together."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from base import Fault
from gears.gear import Gear
from gears.involute import tangent_from_involute
from gears.profile import ToothProfile, generate
from gears.rack import BasicRack

if TYPE_CHECKING:
    from gears.pair import GearPair

THIN_TIP = 0.2
"""Thickness of the top land below which a pair warns [modules]."""

THIN_RIM = 0.5
"""Rim thickness over tooth depth below which a pair warns."""

THINNEST_RIM = 0.25
"""Rim thickness below which a pair is refused [modules]."""

ROUNDING = 1e-12
"""Lengths of this many modules are rounding: a backlash of -1e-16 m is none, not a jam."""


@dataclass(frozen=True)
class Findings:
    """Faults and warnings of a pair, in the order in which they were found."""

    faults: tuple[Fault, ...] = ()
    warnings: tuple[str, ...] = ()

    def __add__(self, other: Findings) -> Findings:
        """Both lists joined."""
        return Findings(self.faults + other.faults, self.warnings + other.warnings)


def gear_findings(name: str, gear: Gear, module: float, rack: BasicRack) -> Findings:
    """Faults and warnings of one generated gear.

    Parameters
    ----------
    name : str
        ``pinion`` or ``wheel``.
    gear, module, rack : Gear, float, BasicRack
        Specification, free of value faults.

    Returns
    -------
    Findings
        Root against axis and bore, tooth cut through by its fillets, pointed tip, chamfer and relief longer
        than the flank; thin tips and rims as warnings.
    """
    root = module * (0.5 * gear.teeth - rack.h_fP + gear.profile_shift)
    if root <= 0.0:
        least = f"must be more than {rack.h_fP - 0.5 * gear.teeth:.4g}"
        fault = Fault(
            f"{name}.profile_shift", f"{gear.profile_shift:g}", least, "the rack cuts through the axis"
        )
        return Findings((fault,))
    depth = module * (rack.h_aP + rack.h_fP + gear.tip_alteration)
    if gear.tip_chamfer >= depth > 0.0:
        allowed = f"must be less than the tooth depth, {depth:.4g} m"
        return Findings((Fault(f"{name}.tip_chamfer", f"{gear.tip_chamfer:g}", allowed, "chamfer less"),))
    tooth = generate(gear, module, rack)
    if tooth is None or not _has_flank(tooth):
        found = Fault(
            f"{name}.profile_shift",
            f"{gear.profile_shift:g}",
            "must leave an involute between fillet and tip",
            "the fillet cuts away the whole flank: raise profile_shift, teeth or tip_alteration, or shorten "
            "the tip chamfer",
        )
        return Findings((found,)) + _blank_findings(name, gear, root, module, None)
    return _tooth_findings(name, gear, tooth) + _blank_findings(name, gear, root, module, tooth)


def _has_flank(tooth: ToothProfile) -> bool:
    return tooth.flank_end_radius > tooth.form_radius * (1.0 + ROUNDING)


def _tooth_findings(name: str, gear: Gear, tooth: ToothProfile) -> Findings:
    """Neck, tip and relief of a tooth that has a flank."""
    faults: list[Fault] = []
    neck = float(np.min(tooth.fillet(np.linspace(0.0, 1.0, 65))[:, 0]))
    if neck <= 0.0:
        thinned = gear.thickness_allowance > 0.0
        cause = "thickness_allowance" if thinned else "profile_shift"
        value = f"{gear.thickness_allowance if thinned else gear.profile_shift:g}"
        remedy = "the fillets of the two sides meet in the tooth: " + (
            "thin the tooth less" if thinned else "raise profile_shift or teeth"
        )
        faults.append(Fault(f"{name}.{cause}", value, "must leave the tooth a neck", remedy))
    if tooth.tip_half_angle <= 0.0:
        faults.append(_pointed(name, gear, tooth))
    relief, flank = tooth.tip_relief, tooth.flank_rho[1] - tooth.flank_rho[0]
    if relief is not None and relief.length > flank:
        allowed = f"must be at most the flank's {flank:.6g} m"
        faults.append(Fault(f"{name}.tip_relief.length", f"{relief.length:g}", allowed, "shorten the relief"))
    if relief is not None and relief.amount > 0.5 * tooth.module:
        allowed = "must be at most half a module"
        faults.append(Fault(f"{name}.tip_relief.amount", f"{relief.amount:g}", allowed, "relieve less"))
    land = 2.0 * tooth.tip_radius * tooth.tip_half_angle / tooth.module
    thin = (f"{name}: the top land is {land:.3f} modules thick, thinner than {THIN_TIP:g}",)
    return Findings(tuple(faults), thin if 0.0 < land < THIN_TIP else ())


def _pointed(name: str, gear: Gear, tooth: ToothProfile) -> Fault:
    """Fault of a pointed tooth, with the highest tip that the flanks allow."""
    spare = gear.thickness_allowance + 2.0 * tooth.reference_radius * tooth.tip_half_angle
    if gear.thickness_allowance > 0.0 and spare > 0.0:
        value, allowed = f"{gear.thickness_allowance:g}", f"must be less than {spare:.4g} m"
        return Fault(f"{name}.thickness_allowance", value, allowed, "the tip is pointed: thin the tooth less")
    point = tooth.base_radius * math.hypot(1.0, tangent_from_involute(max(tooth.base_half_angle, 1e-9)))
    excess = (tooth.tip_radius - point) / tooth.module
    highest = gear.tip_alteration - excess
    value = f"{gear.tip_alteration:g}"
    allowed = f"must be less than {highest:.4g} modules, where the flanks meet"
    if gear.tip_chamfer > 0.0 and excess < 0.0:
        value, where = f"{gear.tip_chamfer:g}", f"{name}.tip_chamfer"
        return Fault(where, value, "must leave a top land", "the tip is pointed: chamfer less")
    remedy = "the tip is pointed: reduce profile_shift or tip_alteration"
    return Fault(f"{name}.tip_alteration", value, allowed, remedy)


def _blank_findings(
    name: str, gear: Gear, root: float, module: float, tooth: ToothProfile | None
) -> Findings:
    """Bore and rim."""
    bore = 0.5 * root if gear.bore_radius is None else gear.bore_radius
    largest = root - THINNEST_RIM * module
    if bore > largest:
        why = "is not inside the root circle" if bore >= root else "leaves a rim too thin for a gear"
        remedy = f"the bore {why} (root radius {root:.6g} m): reduce it"
        return Findings(
            (Fault(f"{name}.bore_radius", f"{bore:g}", f"must be at most {largest:.6g} m", remedy),)
        )
    if tooth is None or root - bore >= THIN_RIM * (tooth.tip_radius - root):
        return Findings()
    share = (root - bore) / (tooth.tip_radius - root)
    return Findings(
        (), (f"{name}: the rim is {share:.2f} of the tooth depth thick, thinner than {THIN_RIM:g}",)
    )


def mesh_findings(pair: GearPair) -> Findings:
    """Faults of two sound gears that cannot run together: axes, jam, contact ratio, interference, tips."""
    bases = sum(pair.base_radii)
    if pair.centre_distance is not None and pair.centre_distance <= bases:
        allowed = f"must be more than the sum of the base radii, {bases:.6g} m"
        where, value = "centre_distance", f"{pair.centre_distance:g}"
        return Findings((Fault(where, value, allowed, "there is no line of action: move the axes apart"),))
    if pair.centre_distance is None and pair._working_involute <= 0.0:
        value = f"{pair.pinion.profile_shift + pair.wheel.profile_shift:g}"
        remedy = "no working pressure angle exists: raise a profile shift, or give centre_distance"
        return Findings(
            (Fault("pinion.profile_shift + wheel.profile_shift", value, "must be larger", remedy),)
        )
    faults: list[Fault] = []
    rounding = ROUNDING * pair.module
    if pair.backlash < -rounding:
        faults.append(_jam(pair))
    if not pair.contact_ratio >= 1.0:
        remedy = "the next pair comes too late: reduce the working pressure angle, or lengthen the teeth"
        faults.append(Fault("contact_ratio", f"{pair.contact_ratio:.6g}", "must be at least 1", remedy))
    first, second = pair.teeth_profiles
    if pair.contact_ratio > 0.0:
        wheel_lowest = pair.line_of_action - pair.points.E
        for name, other, tooth, mate, lowest in (
            ("pinion", "wheel", first, second, pair.points.A),
            ("wheel", "pinion", second, first, wheel_lowest),
        ):
            if lowest < tooth.flank_rho[0] - rounding:
                faults.append(_interference(pair, name, other, tooth, mate))
    for name, other, mate, tooth in (("pinion", "wheel", first, second), ("wheel", "pinion", second, first)):
        clearance = pair.working_centre_distance - tooth.tip_radius - mate.root_radius
        if clearance <= 0.0:
            allowed = f"must be less than {pair.working_centre_distance - mate.root_radius:.6g} m"
            remedy = f"the tip of the {other} meets the root circle of the {name}: give the {other} "
            remedy += f"a negative tip_alteration of {clearance / pair.module:.3g} or less"
            faults.append(Fault(f"{other}.tip_radius", f"{tooth.tip_radius:.6g}", allowed, remedy))
    return Findings(tuple(faults))


def _jam(pair: GearPair) -> Fault:
    """Teeth thicker than their gaps at the given centre distance."""
    free = sum(pair.base_radii) * math.hypot(1.0, tangent_from_involute(max(pair._working_involute, 1e-300)))
    allowance = -pair.backlash / math.cos(pair.rack.alpha)
    remedy = f"the teeth jam: move the axes apart, shift the profiles less or add {allowance:.3g} m of "
    remedy += "thickness_allowance in all"
    allowed = f"must be at least {free:.6g} m for nominal teeth"
    return Fault("centre_distance", f"{pair.working_centre_distance:.6g}", allowed, remedy)


def _interference(pair: GearPair, name: str, other: str, tooth: ToothProfile, mate: ToothProfile) -> Fault:
    """Fault of a mate whose flank end would touch below the form circle of `tooth`."""
    longest = pair.line_of_action - tooth.flank_rho[0]
    where, value = f"{other}.tip_radius", f"{mate.flank_end_radius:.6g}"
    remedy = f"the tip of the {other} would work on the fillet of the {name}, below its form circle: "
    if longest <= 0.0:
        return Fault(where, value, "must be smaller", remedy + f"raise {name}.profile_shift")
    largest = math.hypot(mate.base_radius, longest)
    lower = (mate.flank_end_radius - largest) / mate.module
    remedy += f"lower {other}.tip_alteration by {lower:.4g}, chamfer the {other}"
    if tooth.undercut:
        remedy += f" or raise {name}.profile_shift, which lessens the undercut"
    return Fault(where, value, f"must be at most {largest:.6g} m where the flank ends", remedy)
