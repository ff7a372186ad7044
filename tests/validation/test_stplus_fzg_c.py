"""Gears of type C of the FZG test rig as the program STplus 11.1F (FVA, method of ISO 6336 and DIN 3990) prints them.

Input: z 16/24, m 4.5 mm, a 91.5 mm, b 14 mm, x 0.1818/0.1714, d_a 82.45/118.35 mm, tool h_aP0 1.39, rho_aP0 0.25, cut
at x_E 0.1559/0.1454, 130 N m at 1500 rpm, E 210 GPa, nu 0.3. Beside it the undercut z 12, m 2 mm, rack 1.25/0.25.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from flankfilm.building.pair import gear_pair
from flankfilm.scene import parse_scene
from gears import BasicRack, Gear, GearPair, GeometryError, Material, check_meshing, closed_form, dimensions
from gears.pair.hertz import peak_pressure
from gears.tooth.profile import generate

TORQUE = 130.0
MODULE = 4.5e-3


def gear(teeth: int, shift: float, cut: float, tip_diameter: float) -> Gear:
    alteration = 0.5 * (tip_diameter / MODULE - teeth) - 1.0 - shift
    return Gear(teeth, shift, tip_alteration=alteration, generating_shift=cut)


PAIR = GearPair(
    gear(16, 0.1818, 0.1559, 82.45e-3),
    gear(24, 0.1714, 0.1454, 118.35e-3),
    MODULE,
    14e-3,
    rack=BasicRack.of_tool(h_aP0=1.39, rho_aP0=0.25),
    material=Material(210e9, 0.3, 7850.0),
    centre_distance=91.5e-3,
)
FORCE = PAIR.normal_force(TORQUE)


def printed(value: float, theirs: str, changed: float = 0.0) -> None:
    """Hold a value against a printed one: half a unit of its last digit, and what rounded input may have changed."""
    digits = len(theirs.partition(".")[2])
    assert abs(value - float(theirs)) <= 0.5 * 10.0**-digits + changed + 1e-9, (value, theirs)


def test_geometry():
    printed(PAIR.contact_ratio, "1.436")
    for radius, theirs in zip(PAIR.root_radii, ("60.893", "96.799"), strict=True):
        printed(2e3 * radius, theirs)
    for radius, theirs in zip(PAIR.tip_radii, ("82.450", "118.350"), strict=True):
        printed(2e3 * radius, theirs)


def test_stiffness_is_of_the_nominal_shifts_and_the_depth_of_the_tool():
    found = closed_form.iso6336(PAIR, FORCE)
    printed(found.c_prime, "11.5")
    printed(found.c_gamma, "15.2")
    # with the shifts at which the gears are cut instead, the mesh stiffness would be printed as 15.3
    cut = [Gear(one.teeth, one.cut_shift) for one in (PAIR.pinion, PAIR.wheel)]
    other = closed_form.iso6336(GearPair(*cut, MODULE, 14e-3, rack=PAIR.rack, material=PAIR.material))
    assert other.c_prime * (0.75 * PAIR.contact_ratio + 0.25) > 15.25


@pytest.mark.parametrize(
    ("index", "theirs"),
    [
        (0, ("1.933", "1.329", "0.501", "2.087", "1.758", "210.3")),
        (1, ("2.089", "1.385", "0.479", "1.866", "1.856", "198.5")),
    ],
)
def test_root(index, theirs):
    rounding = 5e-5  # of the generating shifts as they are printed
    deeper = replace(
        PAIR,
        pinion=replace(PAIR.pinion, generating_shift=0.1559 - rounding),
        wheel=replace(PAIR.wheel, generating_shift=0.1454 - rounding),
    )
    for value, other, one in zip(root(PAIR, index), root(deeper, index), theirs, strict=True):
        printed(value, one, abs(other - value))
        assert abs(other / value - 1) < 1e-4


def root(pair: GearPair, index: int) -> tuple[float, ...]:
    found = closed_form.iso6336_3(pair, FORCE)
    section = found.sections[index]
    lengths = section.s_Fn, section.h_Fe, section.rho_F
    return (*lengths, section.Y_F, section.Y_S, 1e-6 * found.stresses[index])


def test_contact_stress():
    found = closed_form.iso6336_2(PAIR, FORCE)
    printed(found.Z_H, "2.342")
    printed(1e-6 * found.stresses[0], "1013.8")
    assert found.stresses[0] == found.stresses[1]


def test_curvature_along_the_path():
    """A, middle of A and B, B, D, middle of D and E, E; the seventh, at C, is explained on the page."""
    p = PAIR.points
    places = np.array([p.A, 0.5 * (p.A + p.B), p.B, p.D, 0.5 * (p.D + p.E), p.E])
    for value, one in zip(
        1e3 * PAIR.path_at(places).radius,
        ("3.907", "5.820", "7.253", "8.729", "8.438", "7.667"),
        strict=True,
    ):
        printed(value, one)
    # R at C follows from distance and teeth alone, R = a sin(alpha_w) u/(1 + u)^2: 8.382 mm, where 8.366 is printed
    exact = 91.5 * math.sin(PAIR.working_pressure_angle) * 1.5 / 2.5**2
    assert 1e3 * PAIR.path_at(p.C).radius[0] == pytest.approx(exact, rel=1e-12)
    assert exact / 8.366 - 1 == pytest.approx(0.0019, abs=1e-4)


def test_tooth_loss_factor():
    """H_v of Niemann and Winter, from the parts of the contact ratio."""
    p, pitch, ratio = PAIR.points, PAIR.base_pitch, PAIR.ratio
    first, second = (p.E - p.C) / pitch, (p.C - p.A) / pitch
    loss = (
        math.pi * (ratio + 1) / (PAIR.pinion.teeth * ratio) * (1 - PAIR.contact_ratio + first**2 + second**2)
    )
    printed(loss, "0.195")


def clearance(teeth: int, module: float, depth: float, tip: float, diameter: float) -> float:
    """Least distance of a point of the involute from the tip arc of the rack, by rolling one on the other [mm]."""
    alpha, r = math.radians(20.0), 0.5 * module * teeth
    y = -(depth - tip) * module
    x = 0.25 * math.pi * module - y * math.tan(alpha) + tip * module / math.cos(alpha)
    angle = math.acos(r * math.cos(alpha) / (0.5 * diameter))
    half = 0.5 * math.pi / teeth + math.tan(alpha) - alpha - math.tan(angle) + angle
    travel = np.linspace(-4 * module, 4 * module, 400_001)
    turned = half + travel / r
    across = 0.5 * diameter * np.sin(turned) - (x + travel)
    up = 0.5 * diameter * np.cos(turned) - r - y
    return float(np.min(np.hypot(across, up)) - tip * module)


def test_start_of_the_flank_lies_where_the_tool_leaves_it():
    """Theirs lie outside it, by 0.003 to 0.017 mm of diameter, where tool and flank are apart already."""
    rack = BasicRack(h_fP=1.25, rho_fP=0.25)
    tooth = generate(Gear(12), 2e-3, rack)
    assert tooth is not None
    assert tooth.undercut
    assert 2e3 * tooth.form_radius == pytest.approx(22.63471, abs=5e-6)
    assert abs(clearance(12, 2.0, 1.25, 0.25, 2e3 * tooth.form_radius)) < 1e-6
    assert clearance(12, 2.0, 1.25, 0.25, 22.65128) == pytest.approx(2.0e-3, abs=0.1e-3)
    ours = [2e3 * radius for radius in PAIR.form_radii]
    assert ours == pytest.approx([67.6787, 101.8435], abs=5e-5)
    assert [theirs - own for theirs, own in zip((67.685, 101.847), ours, strict=True)] == pytest.approx(
        [0.0063, 0.0035], abs=5e-4
    )


def test_contact_ratio_of_the_undercut_pair_is_that_of_their_start():
    """The mate's tip would work on the fillet, so that this pair is refused; theirs ends at the start of the flank."""
    rack = BasicRack(h_fP=1.25, rho_fP=0.25)
    with pytest.raises(GeometryError, match="would work on the fillet"):
        GearPair(Gear(12), Gear(40), 2e-3, 20e-3, rack=rack)
    tooth = generate(Gear(12), 2e-3, rack)
    assert tooth is not None
    pitch = 2e-3 * math.pi * math.cos(rack.alpha)
    start = math.sqrt((0.5 * 22.65128e-3) ** 2 - tooth.base_radius**2)
    printed((tooth.flank_rho[1] - start) / pitch, "1.22647")


def test_the_same_pair_as_a_scene():
    scene = parse_scene(
        """
        wants = ["geometry"]
        [pair]
        module_mm = 4.5
        face_width_mm = 14
        centre_distance_mm = 91.5
        tool = { h_aP0 = 1.39, rho_aP0 = 0.25 }
        [pair.pinion]
        teeth = 16
        profile_shift = 0.1818
        generating_shift = 0.1559
        [pair.wheel]
        teeth = 24
        profile_shift = 0.1714
        generating_shift = 0.1454
        """
    )
    pair = gear_pair(scene)
    assert pair.root_radii == pytest.approx(PAIR.root_radii, rel=1e-12)
    assert pair.backlash == pytest.approx(PAIR.backlash, rel=1e-9)
    assert pair.backlash == pytest.approx(2 * MODULE * (0.0259 + 0.026) * math.sin(pair.rack.alpha), rel=1e-3)


def test_flanks_cut_deeper_mesh_with_the_backlash_that_is_said():
    found = check_meshing(PAIR)
    assert found.angle_deviation < 1e-14
    assert found.back_clearance == pytest.approx(PAIR.backlash, rel=1e-9)


@pytest.mark.parametrize("teeth", [(16, 24), (24, 16), (18, 90)])
def test_contact_stress_is_the_hertz_pressure_at_the_places_of_the_standard(teeth):
    """Z_H, Z_E: at C; Z_B and Z_D: at B and D, the whole force on one pair; Z_eps apart."""
    pair = GearPair(Gear(teeth[0], 0.1), Gear(teeth[1], 0.05), 3e-3, 20e-3)
    found, force = closed_form.iso6336_2(pair, 5e3), 5e3
    path = pair.path_at(np.array([pair.points.B, pair.points.C, pair.points.D]))
    at = peak_pressure(force / 20e-3, path.radius, pair.reduced_modulus) * found.Z_eps
    assert found.stresses == pytest.approx((at[1], at[1]), rel=1e-12)
    assert found.single_pair_stresses == pytest.approx((max(at[0], at[1]), max(at[2], at[1])), rel=1e-12)
    assert found.Z_eps == pytest.approx(math.sqrt((4 - pair.contact_ratio) / 3), rel=1e-12)


def test_sizes_are_those_of_the_thickness_that_was_cut():
    found = dimensions(PAIR)
    assert found.generating_shift.tolist() == [0.1559, 0.1454]
    thinner = [2 * MODULE * d * math.tan(PAIR.rack.alpha) for d in (0.1818 - 0.1559, 0.1714 - 0.1454)]
    nominal = [MODULE * (0.5 * math.pi + 2 * x * math.tan(PAIR.rack.alpha)) for x in (0.1818, 0.1714)]
    assert found.tooth_thickness + np.array(thinner) == pytest.approx(nominal, rel=1e-12)
