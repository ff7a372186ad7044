"""Scenes that several tests change and run."""

from __future__ import annotations

ISHIKAWA = """
title = "TITLE"
wants = [WANTS]
[pair]
module_mm = 2.0
face_width_mm = 40.0
pinion = { teeth = 36 }
wheel = { teeth = 40 }
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
[operating]
pinion_torque_Nm = 600
[stiffness]
model = "ishikawa"
pairs = "independent"
"""
"""Nothing that numba compiles, which would take most of the time."""

PAIR_WITH_BACKLASH = """
[pair]
module_mm = 2.0
face_width_mm = 40.0
pinion = { teeth = 36 }
wheel = { teeth = 40 }
backlash_um = 50
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
density_kg_per_m3 = 7850
"""
"""Full blanks that may leave contact: what scenes of motion start from."""

CLOSED_FORMS_WITH_FILM = (
    ISHIKAWA.replace("[WANTS]", '["geometry", "stiffness", "film", "fourier"]').replace(
        "pinion_torque_Nm = 600", "pinion_torque_Nm = 600\npinion_speed_rpm = 2000"
    )
    + """
[lubricant]
viscosity_Pa_s = 0.075
pressure_viscosity_per_GPa = 19.6
[film]
model = "dowson"
"""
)
"""Closed forms with a film by formula, which no solver takes part in."""

ARTICLE = """
[pair]
module_mm = 2.0
face_width_mm = 40.0
pinion = { teeth = 36, bore_mm = 33.5 }
wheel = { teeth = 40, bore_mm = 37.5 }
[material]
youngs_modulus_GPa = 200.2
poisson_ratio = 0.3
[operating]
pinion_torque_Nm = 600
pinion_speed_rpm = 2000
[lubricant]
viscosity_Pa_s = 0.075
pressure_viscosity_per_GPa = 19.6
density_kg_per_m3 = 910
"""
"""The article's pair, operating point and oil."""


def ishikawa(title: str, *wants: str) -> str:
    """A small scene of closed forms, as text."""
    return ISHIKAWA.replace("TITLE", title).replace("WANTS", ", ".join(f'"{want}"' for want in wants))
