"""Sizes of both gears as drawings and inspection sheets have them: diameters, thicknesses, span, over pins or balls."""

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
    from gears.tooth.helix import Helix
    from gears.tooth.profile import ToothProfile

PIN = Limit.above(0.0, 10.0, "m", "give the diameter of the pins in metres")
"""What the diameter of a measuring pin may be."""


@record
class Dimensions:
    """Sizes of pinion and wheel with the tooth thickness that they have, thinned by allowances and generating shifts.

    Thicknesses are those of the normal section, in which helical teeth are measured. Diameters go from the tip to the
    root. Symbols of ISO 21771. A size that a gear does not have, such as a span whose points of contact would lie off
    the involute, is nan, and its number of teeth 0.
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
    tooth_thickness: Array = quantity("m", "tooth thickness s_n, normal arc at d", "gear", shown="mm")
    chordal_thickness: Array = quantity("m", "tooth thickness, normal chord at d", "gear", shown="mm")
    chordal_height: Array = quantity("m", "height of the tip above that chord", "gear", shown="mm")
    tip_thickness: Array = quantity(
        "m", "thickness of the top land s_an, normal arc at d_a", "gear", shown="mm"
    )
    span_teeth: NDArray[np.int64] = quantity("1", "number of teeth k of the span", "gear")
    span: Array = quantity("m", "span W_k over k teeth", "gear", shown="mm")
    span_diameter: Array = quantity("m", "diameter at which the span touches", "gear", shown="mm")
    pin_diameter: Array = quantity("m", "diameter of the measuring pins or balls D_M", "gear", shown="mm")
    over_pins: Array = quantity("m", "size over two pins or balls M_dR or M_dK", "gear", shown="mm")
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

    With the transverse base tooth thickness :math:`s_{bt} = 2 r_b \psi_b` and base pitch :math:`p_{bt}`

    .. math:: W_k = [(k - 1) p_{bt} + s_{bt}] \cos\beta_b, \quad
       \mathrm{inv}\,\alpha_{Kt} = \frac{D_M}{d_b \cos\beta_b} - (\pi/z - \psi_b), \quad
       M_{d} = D_M + d_b / \cos\alpha_{Kt} \; [\cos(\pi/2z) \text{ for odd } z],

    k such that the span touches nearest to the diameter d + 2 x m_n. The span touches at :math:`d_M^2 = d_b^2 + W_k^2
    \cos^2\beta_b` and requires a face of :math:`W_k \sin\beta_b`. :math:`M_d` is the size over two balls in one
    transverse plane, in spur gears that over pins. Tooth thicknesses are :math:`s_n = s_t \cos\beta`, on the tip
    cylinder with its own helix angle; the chord is that of the gear of :math:`d_n = d/\cos^2\beta`. Tip relief is
    left out of the flank that spans and pins may touch.

    Parameters
    ----------
    pair : GearPair
    pin_diameters : (float or None, float or None)
        Of the pins or balls for pinion and wheel [m]; those that touch at d + 2 x m_n, rounded up to two digits, unless
        given.

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
    helix = pair.helix
    # the normal section of the reference cylinder has the curvature of this circle
    normal_radius, normal_half = radius / helix.cosine**2, half * helix.cosine**3
    tip_cosine = 1.0 / math.hypot(1.0, math.tan(helix.angle) * tooth.tip_radius / radius)
    middle = _middle(tooth, gear.profile_shift)
    name = ("pinion", "wheel")[number]
    pin = (
        _rounded_up(_touching_pin(tooth, helix, middle)) if chosen_pin is None else _checked(name, chosen_pin)
    )
    over_pins, pin_contact = _over_pins(tooth, helix, pin)
    span_teeth, span, span_contact = _span(tooth, helix, middle, pair.face_widths[number])
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
        "tooth_thickness": 2.0 * radius * half * helix.cosine,
        "chordal_thickness": 2.0 * normal_radius * math.sin(normal_half),
        "chordal_height": tooth.tip_radius - (radius - normal_radius) - normal_radius * math.cos(normal_half),
        "tip_thickness": 2.0 * tooth.tip_radius * tooth.tip_half_angle * tip_cosine,
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


def _span(tooth: ToothProfile, helix: Helix, middle: float, face_width: float) -> tuple[int, float, float]:
    """Number of teeth, span and diameter of its contacts [m]; 0 and nan where no number touches both involutes."""
    base, (low, high) = tooth.base_radius, _measurable(tooth)
    numbers = np.arange(2, int(0.5 * tooth.teeth / helix.base_cosine**2) + 1)
    transverse = base * (tooth.pitch_angle * (numbers - 1) + 2.0 * tooth.base_half_angle)
    spans = transverse * helix.base_cosine
    radii = np.hypot(base, 0.5 * spans * helix.base_cosine)
    good = (radii >= low) & (radii <= high) & (spans * abs(helix.base_sine) <= face_width)
    if not good.any():
        return 0, math.nan, math.nan
    best = int(np.argmin(np.where(good, np.abs(radii - middle), np.inf)))
    return int(numbers[best]), float(spans[best]), 2.0 * float(radii[best])


def _touching_pin(tooth: ToothProfile, helix: Helix, radius: float) -> float:
    """Diameter of the pin or ball that touches both flanks of a gap at a radius [m].

    Of spur gears D_M = d_b [tan(alpha + eta) - tan(alpha)], eta half the angle of the gap at the radius. A ball touches
    helical flanks beside its transverse plane: with D = D_M/d_b

        D cos(beta_b) = tan(alpha + eta - D sin^2(beta_b)/cos(beta_b)) - tan(alpha),

    by Newton's method from above.
    """
    tangent = math.sqrt(max((radius / tooth.base_radius) ** 2 - 1.0, 0.0))
    gap = 0.5 * tooth.pitch_angle - tooth.base_half_angle + float(involute_function(tangent))
    beside = helix.base_sine**2 / helix.base_cosine
    size = (math.tan(math.atan(tangent) + gap) - tangent) / helix.base_cosine
    for _ in range(60):
        centre = math.tan(math.atan(tangent) + gap - beside * size)
        excess = size - (centre - tangent) / helix.base_cosine
        size -= excess / (1.0 + beside * (1.0 + centre**2) / helix.base_cosine)
        if abs(excess) <= 1e-15 * abs(size):
            break
    return 2.0 * tooth.base_radius * size


def _rounded_up(length: float) -> float:
    """Length with two digits [m], a hair of rounding left aside."""
    step = 10.0 ** (math.floor(math.log10(length)) - 1)
    return float(f"{math.ceil(length / step - 1e-9) * step:.3g}")


def _over_pins(tooth: ToothProfile, helix: Helix, pin: float) -> tuple[float, float]:
    """Size over two pins or balls of a diameter, and diameter of their contacts [m].

    nan where pins touch no involute, the root, or lie below the tip.
    """
    base, (low, high) = tooth.base_radius, _measurable(tooth)
    involute = 0.5 * pin / base / helix.base_cosine - 0.5 * tooth.pitch_angle + tooth.base_half_angle
    if involute <= 0.0:
        return math.nan, math.nan
    tangent = tangent_from_involute(involute)
    touching = base * tangent - 0.5 * pin * helix.base_cosine
    centre, contact = base * math.hypot(1.0, tangent), math.hypot(base, touching)
    odd = math.cos(0.25 * tooth.pitch_angle) if tooth.teeth % 2 else 1.0
    touches = touching >= 0.0 and low <= contact <= high
    if not touches or centre - 0.5 * pin < tooth.root_radius or centre + 0.5 * pin < tooth.tip_radius:
        return math.nan, math.nan
    return 2.0 * centre * odd + pin, 2.0 * contact
