"""Sizes of both gears as drawings and inspection sheets have them: diameters, thicknesses, span, over pins."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from base import Array, Faults, Limit, quantity, record
from base.results import EXACT
from gears.tooth.errors import GeometryError
from gears.tooth.involute import involute_function, tangent_from_involute

if TYPE_CHECKING:
    from gears.pair.pair_geometry import PairGeometry
    from gears.tooth.profile import ToothProfile

PIN = Limit.above(0.0, 10.0, "m", "give the diameter of the pins in metres")
"""What the diameter of a measuring pin may be."""


@record
class Dimensions:
    """Sizes of pinion and wheel with the tooth thickness that they have, thinned by allowances and generating shifts.

    Diameters go from the tip to the root. Symbols of ISO 21771. A size that a gear does not have, such as a span whose
    points of contact would lie off the involute, is nan, and its number of teeth 0.
    """

    no_error = EXACT

    teeth: NDArray[np.int64] = quantity("1", "number of teeth z", "gear")
    profile_shift: Array = quantity("1", "profile shift coefficient x, modules", "gear")
    generating_shift: Array = quantity("1", "generating shift coefficient x_E, modules", "gear")
    thickness_allowance: Array = quantity("m", "arc at d by which the tooth is thinned", "gear", shown="um")
    tip_diameter: Array = quantity("m", "tip diameter d_a", "gear", shown="mm")
    flank_end_diameter: Array = quantity(
        "m", "diameter d_Fa at which the involute ends: tip or start of the chamfer", "gear", shown="mm"
    )
    active_tip_diameter: Array = quantity(
        "m", "diameter d_Na at which contact is nearest to the tip", "gear", shown="mm"
    )
    pitch_diameter: Array = quantity("m", "working pitch diameter d_w", "gear", shown="mm")
    reference_diameter: Array = quantity("m", "reference diameter d", "gear", shown="mm")
    base_diameter: Array = quantity("m", "base diameter d_b", "gear", shown="mm")
    active_root_diameter: Array = quantity(
        "m", "diameter d_Nf at which contact is nearest to the root", "gear", shown="mm"
    )
    form_diameter: Array = quantity(
        "m", "root form diameter d_Ff, at which the involute begins", "gear", shown="mm"
    )
    root_diameter: Array = quantity("m", "root diameter d_f", "gear", shown="mm")
    bore_diameter: Array = quantity("m", "diameter of the bore", "gear", shown="mm")
    tip_clearance: Array = quantity("m", "clearance from the tip to the mate's root", "gear", shown="mm")
    tooth_thickness: Array = quantity("m", "tooth thickness s, arc at d", "gear", shown="mm")
    chordal_thickness: Array = quantity("m", "tooth thickness, chord at d", "gear", shown="mm")
    chordal_height: Array = quantity("m", "height of the tip above that chord", "gear", shown="mm")
    tip_thickness: Array = quantity("m", "thickness of the top land s_a, arc at d_a", "gear", shown="mm")
    span_teeth: NDArray[np.int64] = quantity("1", "number of teeth k of the span", "gear")
    span: Array = quantity("m", "span W_k over k teeth", "gear", shown="mm")
    span_diameter: Array = quantity("m", "diameter at which the span touches", "gear", shown="mm")
    pin_diameter: Array = quantity("m", "diameter of the measuring pins D_M", "gear", shown="mm")
    over_pins: Array = quantity("m", "size over two pins M_dR", "gear", shown="mm")
    pin_contact_diameter: Array = quantity("m", "diameter at which the pins touch", "gear", shown="mm")
    sliding_at_root: Array = quantity("1", "specific sliding where contact is nearest to the root", "gear")
    sliding_at_tip: Array = quantity("1", "specific sliding where contact is nearest to the tip", "gear")

    def __repr__(self) -> str:
        """One line: span and size over pins of both gears."""
        spans = [f"{w:.3f} mm over {k}" for w, k in zip(1e3 * self.span, self.span_teeth, strict=True)]
        pins = [f"{size:.3f} mm" for size in 1e3 * self.over_pins]
        return f"Dimensions(span {spans[0]} and {spans[1]} teeth, over pins {pins[0]} and {pins[1]})"


def dimensions(
    pair: PairGeometry, pin_diameters: tuple[float | None, float | None] = (None, None)
) -> Dimensions:
    r"""Sizes of both gears of a pair, with what is measured of their tooth thickness.

    With the base tooth thickness :math:`s_b = 2 r_b \psi_b` and the base pitch :math:`p_b`

    .. math:: W_k = (k - 1) p_b + s_b, \quad \mathrm{inv}\,\alpha_K = D_M/d_b - (\pi/z - \psi_b), \quad
       M_{dR} = D_M + d_b / \cos\alpha_K \; [\cos(\pi/2z) \text{ for odd } z],

    k such that the span touches nearest to the diameter d + 2 x m. Tip relief is left out of the flank that spans
    and pins may touch.

    Parameters
    ----------
    pair : GearPair
    pin_diameters : (float or None, float or None)
        Of the pins for pinion and wheel [m]; those that touch at d + 2 x m, rounded up to two digits, unless given.

    Raises
    ------
    GeometryError
        For a diameter that is no positive number.

    References
    ----------
    ISO 21771:2007, Gears - Cylindrical involute gears and gear pairs - Concepts and geometry.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> sizes = dimensions(pair)
    >>> sizes.span_teeth.tolist(), (1e3 * sizes.span).round(4).tolist()
    ([4, 5], [21.6733, 27.6896])
    """
    pinion, wheel = (_sizes(pair, gear, pin) for gear, pin in enumerate(pin_diameters))
    return Dimensions(**{name: np.array([pinion[name], wheel[name]]) for name in pinion})


def _sizes(pair: PairGeometry, number: int, chosen_pin: float | None) -> dict[str, float]:
    """Sizes of pinion (0) or wheel (1) by the names of `Dimensions`."""
    gear, tooth = (pair.pinion, pair.wheel)[number], pair.teeth_profiles[number]
    mate, points = pair.teeth_profiles[1 - number], pair.points
    ends = np.array([points.E, points.A] if number == 0 else [points.A, points.E])  # at the tip, at the root
    rho = ends if number == 0 else pair.line_of_action - ends
    at_tip, at_root = pair.path_at(ends).specific_sliding[number]
    radius, half = tooth.reference_radius, _half_angle(tooth)
    middle = _middle(tooth, gear.profile_shift)
    name = ("pinion", "wheel")[number]
    pin = _rounded_up(_touching_pin(tooth, middle)) if chosen_pin is None else _checked(name, chosen_pin)
    over_pins, pin_contact = _over_pins(tooth, pin)
    span_teeth, span, span_contact = _span(tooth, middle)
    return {
        "teeth": gear.teeth,
        "profile_shift": gear.profile_shift,
        "generating_shift": gear.cut_shift,
        "thickness_allowance": gear.thickness_allowance,
        **{
            f"{circle}_diameter": 2.0 * getattr(tooth, f"{circle}_radius")
            for circle in ("tip", "flank_end", "reference", "base", "form", "root", "bore")
        },
        "active_tip_diameter": 2.0 * math.hypot(tooth.base_radius, rho[0]),
        "active_root_diameter": 2.0 * math.hypot(tooth.base_radius, rho[1]),
        "pitch_diameter": 2.0 * pair.pitch_radii[number],
        "tip_clearance": pair.working_centre_distance - tooth.tip_radius - mate.root_radius,
        "tooth_thickness": 2.0 * radius * half,
        "chordal_thickness": 2.0 * radius * math.sin(half),
        "chordal_height": tooth.tip_radius - radius * math.cos(half),
        "tip_thickness": 2.0 * tooth.tip_radius * tooth.tip_half_angle,
        "span_teeth": span_teeth,
        "span": span,
        "span_diameter": span_contact,
        "pin_diameter": pin,
        "over_pins": over_pins,
        "pin_contact_diameter": pin_contact,
        "sliding_at_root": at_root,
        "sliding_at_tip": at_tip,
    }


def _checked(name: str, diameter: float) -> float:
    with Faults(GeometryError) as faults:
        return faults.number(f"pin_diameters.{name}", diameter, PIN)


def _half_angle(tooth: ToothProfile) -> float:
    """Half-thickness angle at the reference circle [rad], of undercut teeth that of the whole involute."""
    tangent = math.sqrt((tooth.reference_radius / tooth.base_radius) ** 2 - 1.0)
    return tooth.base_half_angle - float(involute_function(tangent))


def _measurable(tooth: ToothProfile) -> tuple[float, float]:
    """Radii between which flanks may be touched: from the form circle to the tip relief or the end of the flank [m]."""
    relieved = 0.0 if tooth.tip_relief is None else tooth.tip_relief.length
    return tooth.form_radius, math.hypot(tooth.base_radius, tooth.flank_rho[1] - relieved)


def _middle(tooth: ToothProfile, profile_shift: float) -> float:
    """Radius at which flanks are best touched [m]: r + x m, as far as the involute reaches."""
    low, high = _measurable(tooth)
    return min(max(tooth.reference_radius + profile_shift * tooth.module, low), high)


def _span(tooth: ToothProfile, middle: float) -> tuple[int, float, float]:
    """Number of teeth, span and diameter of its contacts [m]; 0 and nan where no number touches both involutes."""
    base, (low, high) = tooth.base_radius, _measurable(tooth)
    numbers = np.arange(2, tooth.teeth // 2 + 1)
    spans = base * (tooth.pitch_angle * (numbers - 1) + 2.0 * tooth.base_half_angle)
    radii = np.hypot(base, 0.5 * spans)
    good = (radii >= low) & (radii <= high)
    if not good.any():
        return 0, math.nan, math.nan
    best = int(np.argmin(np.where(good, np.abs(radii - middle), np.inf)))
    return int(numbers[best]), float(spans[best]), 2.0 * float(radii[best])


def _touching_pin(tooth: ToothProfile, radius: float) -> float:
    """Diameter of the pin that touches both flanks of a gap at a radius [m].

    D_M = d_b [tan(alpha + eta) - tan(alpha)], eta half the angle of the gap at the radius.
    """
    tangent = math.sqrt(max((radius / tooth.base_radius) ** 2 - 1.0, 0.0))
    gap = 0.5 * tooth.pitch_angle - tooth.base_half_angle + float(involute_function(tangent))
    return 2.0 * tooth.base_radius * (math.tan(math.atan(tangent) + gap) - tangent)


def _rounded_up(length: float) -> float:
    """Length with two digits [m], a hair of rounding left aside."""
    step = 10.0 ** (math.floor(math.log10(length)) - 1)
    return float(f"{math.ceil(length / step - 1e-9) * step:.3g}")


def _over_pins(tooth: ToothProfile, pin: float) -> tuple[float, float]:
    """Size over two pins of a diameter, and diameter of their contacts [m].

    nan where pins touch no involute, the root, or lie below the tip.
    """
    base, (low, high) = tooth.base_radius, _measurable(tooth)
    involute = 0.5 * pin / base - 0.5 * tooth.pitch_angle + tooth.base_half_angle
    if involute <= 0.0:
        return math.nan, math.nan
    tangent = tangent_from_involute(involute)
    centre, contact = base * math.hypot(1.0, tangent), math.hypot(base, base * tangent - 0.5 * pin)
    odd = math.cos(0.25 * tooth.pitch_angle) if tooth.teeth % 2 else 1.0
    touches = base * tangent >= 0.5 * pin and low <= contact <= high
    if not touches or centre - 0.5 * pin < tooth.root_radius or centre + 0.5 * pin < tooth.tip_radius:
        return math.nan, math.nan
    return 2.0 * centre * odd + pin, 2.0 * contact
