"""ISO 6336-3: the tabulated factors for load at the tip, exact geometry of the gears, and the rack.

Table: form factor Y_Fa and stress-correction factor Y_Sa after DIN 3990 and ISO 6336-3 for alpha = 20 deg,
h_aP 1, h_fP 1.25, rho_fP 0.38, no shift, load at the tip, as machine-design textbooks print it (last digits
rounded to 0.01, Y_Sa in places to 0.005).
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from base import RangeWarning
from gears import BasicRack, Gear, GearPair, GeometryError
from gears.closed_form import iso6336_3

TABLE = {
    17: (2.97, 1.52),
    18: (2.91, 1.53),
    19: (2.85, 1.54),
    20: (2.80, 1.55),
    21: (2.76, 1.56),
    22: (2.72, 1.57),
    25: (2.62, 1.59),
    30: (2.52, 1.625),
    35: (2.45, 1.65),
    40: (2.40, 1.67),
    50: (2.32, 1.70),
    60: (2.28, 1.73),
    80: (2.22, 1.77),
    100: (2.18, 1.79),
    150: (2.14, 1.83),
    200: (2.12, 1.865),
    10000: (2.06, 1.97),
}


def pair_of(teeth, shift=0.0, rack=None, **more):
    return GearPair(Gear(teeth, shift, **more), Gear(60), 2e-3, 20e-3, rack=rack or BasicRack())


@pytest.mark.parametrize("teeth", TABLE)
def test_table_of_factors_for_load_at_the_tip(teeth):
    section = iso6336_3(pair_of(teeth), 1000.0, load_at="tip").sections[0]
    form, correction = TABLE[teeth]
    # the table was read off charts: two units of its last digit
    assert abs(section.Y_F - form) < 0.02
    assert abs(section.Y_S - correction) < 0.01


@pytest.mark.parametrize(
    ("teeth", "shift", "alpha"),
    [
        (17, 0.2, 20),
        (36, 0.0, 20),
        (100, -0.3, 20),
        (25, 0.5, 25),
        (1000, 0.1, 20),
        (12, 0.5, 20),
        (40, 0, 14.5),
    ],
)
@pytest.mark.parametrize("allowance", [0.0, 80e-6])
def test_section_lies_on_the_generated_fillet(teeth, shift, alpha, allowance):
    """Where the exact trochoid's tangent leans by 30 degrees: chord, lever and curvature of the standard."""
    rack = BasicRack(alpha=math.radians(alpha))
    pair = pair_of(teeth, shift, rack, thickness_allowance=allowance)
    section = iso6336_3(pair, 1000.0).sections[0]
    tooth, m = pair.teeth_profiles[0], pair.module

    def direction(t):
        x, y = tooth.fillet_normal(np.array([t]))[0]
        return math.atan2(x, y)

    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if direction(middle) < math.pi / 3 else (low, middle)
    point = tooth.fillet(np.array([low]))[0] / m
    assert 2 * point[0] == pytest.approx(section.s_Fn, rel=1e-10)
    # the load's line is tangent to the base circle
    crossing = tooth.base_radius / m / math.cos(section.alpha_Fen)
    assert crossing - point[1] == pytest.approx(section.h_Fe, rel=1e-10)
    step = 1e-4
    before, after = tooth.fillet(np.array([low - step, low + step])) / m
    turned = direction(low + step) - direction(low - step)
    assert np.hypot(*(after - before)) / turned == pytest.approx(section.rho_F, rel=1e-6)


def test_many_teeth_tend_to_the_rack():
    """Sections of the rack itself: an arc between straight lines, the load at the tip along the normal."""
    rack = BasicRack()
    angle, tangent = rack.alpha, math.tan(rack.alpha)
    E = math.pi / 4 - 1.25 * tangent - (1 - math.sin(angle)) * 0.38 / math.cos(angle)
    chord = math.pi - 2 * E - math.sqrt(3) * 0.38
    depth = 1.25 - 0.38 + 0.38 * math.sin(math.pi / 6)
    lever = 1.0 - (math.pi / 4 - tangent) * tangent + depth
    form = 6 * lever / chord**2
    sections = [iso6336_3(pair_of(z), 1.0, "tip").sections[0] for z in (2500, 5000, 10000)]
    for name, exact in (("s_Fn", chord), ("rho_F", 0.38), ("h_Fe", lever), ("Y_F", form)):
        few, more, many = (getattr(section, name) for section in sections)
        # the first and second order in 1/z taken out
        limit = (4 * (2 * many - more) - (2 * more - few)) / 3
        assert limit == pytest.approx(exact, rel=1e-6)
        assert abs(many / exact - 1) < abs(more / exact - 1) < abs(few / exact - 1)


def test_stress_is_of_the_tangential_load_and_the_rim_raises_it():
    found = iso6336_3(pair_of(36), 1000.0)
    section = found.sections[0]
    nominal = 1000.0 * math.cos(math.radians(20)) / (20e-3 * 2e-3)
    assert found.stresses[0] == pytest.approx(nominal * section.Y_F * section.Y_S, rel=1e-12)
    tooth_depth = 2.25 * 2e-3
    root = pair_of(36).root_radii[0]
    for ratio, factor in ((1.3, 1.0), (1.2, 1.0), (0.8, 1.6 * math.log(2.242 / 0.8))):
        thin = iso6336_3(pair_of(36, bore_radius=root - ratio * tooth_depth), 1000.0)
        assert thin.Y_B[0] == pytest.approx(factor, rel=2e-4)
        assert thin.stresses[0] == pytest.approx(found.stresses[0] * factor, rel=2e-4)


def test_same_for_every_module_and_for_turned_pairs():
    small = GearPair(Gear(20, 0.3), Gear(50), 1e-3, 10e-3)
    large = GearPair(Gear(20, 0.3), Gear(50), 5e-3, 50e-3)
    turned = GearPair(Gear(50), Gear(20, 0.3), 1e-3, 10e-3)
    one, other, back = iso6336_3(small, 1e3), iso6336_3(large, 25e3), iso6336_3(turned, 1e3)
    assert one.stresses == pytest.approx(other.stresses, rel=1e-12)
    assert one.stresses == pytest.approx(back.stresses[::-1], rel=1e-12)


@pytest.mark.filterwarnings("ignore:pinion. the rim:gears.GeometryWarning")
def test_ranges_are_told_and_nonsense_is_refused():
    with pytest.warns(RangeWarning, match="contact ratio"):
        iso6336_3(pair_of(40, 0.0, BasicRack(h_aP=1.35, h_fP=1.6, rho_fP=0.25)), 1000.0)
    with pytest.warns(RangeWarning, match="q_s"):
        iso6336_3(pair_of(1000, 0.0, BasicRack(rho_fP=0.05)), 1000.0)
    with pytest.raises(GeometryError, match=r"(?s)force.*load_at"):
        iso6336_3(pair_of(40), -1.0, "E")
    root = pair_of(36).root_radii[0]
    with pytest.raises(GeometryError, match="rim"):
        iso6336_3(pair_of(36, bore_radius=root - 0.4 * 4.5e-3), 1000.0)
