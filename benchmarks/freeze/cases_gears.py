"""Geometry, inspection, load sharing without elasticity's numbers, closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np

import gears
from gears import closed_form

from .case import Cases, take
from .pairs import PAIR, RELIEVED, SHAFTS, SHIFTED, SPEED, TORQUE

case = Cases("gears")
FIGURES = (
    "contact_ratio base_pitch base_radii backlash working_centre_distance working_pressure_angle line_of_action "
    "tip_radii root_radii form_radii pitch_radii reference_radii bore_radii moments_of_inertia rim_thicknesses "
    "reduced_modulus ratio"
)
PAIRS = {"article": PAIR, "relieved": RELIEVED, "shifted": SHIFTED}


@case(quick=True)
def geometry() -> dict[str, Any]:
    """Figures of pairs, the path of contact, contours, placement, inspection."""
    figures: dict[str, Any] = {}
    for name, pair in PAIRS.items():
        path = pair.path_of_contact(n=41)
        placed = pair.placement(path.rho1[7])
        figures[name] = {
            **take(pair, FIGURES),
            "points": take(pair.points, "A B C D E"),
            "path": take(path, "rho1 rho2 radius radii specific_sliding position"),
            "entrainment": path.entrainment(SPEED),
            "sliding": path.sliding(SPEED),
            "contours": [gears.outline(profile) for profile in pair.teeth_profiles],
            "placement": take(placed, "pinion_angle wheel_angle wheel_centre contact_point normal"),
            "inspection": take(
                gears.dimensions(pair),
                "tip_diameter active_tip_diameter active_root_diameter form_diameter root_diameter tooth_thickness "
                "chordal_thickness chordal_height tip_thickness span_teeth span span_diameter pin_diameter over_pins "
                "pin_contact_diameter sliding_at_root sliding_at_tip tip_clearance",
            ),
            "meshing": take(
                gears.check_meshing(pair), "angle_deviation back_clearance tip_clearances overlap"
            ),
        }
    return figures


@case(quick=True)
def closed_forms() -> dict[str, Any]:
    """Deflection by closed forms, their parts; factors of ISO 6336-1 to -3; losses."""
    figures: dict[str, Any] = {}
    for name, pair in PAIRS.items():
        path, force = pair.path_of_contact(n=21), pair.normal_force(TORQUE)
        forms = {
            "ishikawa": closed_form.ishikawa(pair, path),
            "potential-energy": closed_form.potential_energy(pair, path),
            "weber-banaschek": closed_form.weber_banaschek(pair, path, force),
        }
        root = closed_form.iso6336_3(pair, force)
        figures[name] = {
            **{f"{key}/stiffness": np.asarray(form) for key, form in forms.items()},
            **{f"{key}/parts": form.parts for key, form in forms.items()},
            "iso6336-1": {
                name_of: take(closed_form.iso6336(pair, load), "c_th c_prime C_R C_B c_gamma")
                for name_of, load in (("unloaded", None), ("loaded", force))
            },
            "iso6336-2": take(closed_form.iso6336_2(pair, force), "Z_H Z_B Z_D Z_E Z_eps stresses"),
            "iso6336-3": {
                "stresses": root.stresses,
                **{
                    f"{k}": take(section, "Y_F Y_S s_Fn h_Fe rho_F")
                    for k, section in enumerate(root.sections)
                },
            },
        }
    return figures


@case()
def flanks_and_heat() -> dict[str, Any]:
    """Leads, deviations, warm pairs, independent pairs, ISO 6336-1 over the face."""
    lead = gears.Lead(crowning=10e-6, slope=4e-6, end_relief=6e-6, end_relief_length=3e-3)
    z = np.linspace(-0.5, 0.5, 33) * PAIR.face_width
    trace = gears.ProfileDeviation(tuple(np.linspace(7e-3, 15e-3, 9)), tuple(1e-6 * np.sin(np.arange(9.0))))
    warm = gears.warm_pair(SHIFTED, gears.Heat(363.15, 353.15, 333.15))
    force = PAIR.normal_force(TORQUE)
    stiffness = np.linspace(3e8, 5e8, 20).reshape(10, 2)
    return {
        "lead": lead.removed(z, PAIR.face_width),
        "trace": trace.at(np.linspace(8e-3, 14e-3, 31)),
        "pitches": gears.PitchDeviations.from_single([1e-6, -2e-6, 3e-6, -2e-6]).cumulative,
        "warm": take(warm, "backlash pressure_angle centre_distance base_pitch_difference"),
        "independent": take(
            gears.independent_pairs(force, stiffness), "forces transmission_error stiffness pair_stiffness"
        ),
        "contact": {
            "half_width": gears.half_width(1e5, np.linspace(5e-3, 2e-2, 9), PAIR.reduced_modulus),
            "pressure": gears.peak_pressure(1e5, np.linspace(5e-3, 2e-2, 9), PAIR.reduced_modulus),
        },
        "shafts": [take(shaft, "length places") for shaft in SHAFTS],
    }
