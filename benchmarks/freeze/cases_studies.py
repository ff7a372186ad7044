"""Every example study with few rows, through the command line."""

from __future__ import annotations

from typing import Any

import numpy as np

from .case import Cases, Room
from .cases_scenes import command, shortened

STUDIES: dict[str, dict[str, Any]] = {
    "wear": {"vary": {"pair.wheel.wear.factor": [0.0, 1.0]}},
    "helix_angle": {"vary": {"pair.helix_angle_deg": [0.0, 20.0]}},
    "whole_overlap": {"vary": {"pair.face_width_mm": [13.7781, 18.3708]}},
    "bore": {"vary": {"pair.pinion.bore_mm": [15.0, 40.0], "pair.wheel.bore_mm": [17.0, 45.0]}},
    "film_alpha": {"vary": {"lubricant.pressure_viscosity_per_GPa": [19.6, 32.6]}},
    "film_speed": {"vary": {"operating.pinion_speed_rpm": [1500, 2500]}},
    "film_torque": {"vary": {"operating.pinion_torque_Nm": [100, 500]}},
    "film_viscosity": {"vary": {"lubricant.viscosity_Pa_s": [0.04, 0.12]}},
    "lubricant": {"vary": {"operating.pinion_speed_rpm": [500, 4000], "lubricant.viscosity_Pa_s": [0.075]}},
    "misalignment": {
        "vary": {"alignment.in_plane_um": [0.0, 20.0], "pair.pinion.crowning_um": [10.0]},
    },
    "rating": {
        "vary": {"operating.pinion_torque_Nm": [200.0], "pair.pinion.profile_shift": [0.0, 0.4]},
    },
    "tolerances": {"samples": 16},
    "profile_shift": {"vary": {"pair.pinion.profile_shift": [-0.1, 0.4]}},
    "tip_relief": {
        "vary": {
            "pair.pinion.tip_relief.amount_um": [0.0, 20.0],
            "operating.pinion_torque_Nm": [300.0],
            "pair.pinion.tip_relief.length_mm": [1.5],
        }
    },
    "web": {
        "vary": {
            "pair.wheel.blank.rim_thickness_mm": [4.05],
            "pair.wheel.blank.web_thickness_mm": [8.0, 20.0],
        }
    },
}
"""Studies of ``examples/studies/`` with the values that they have here."""

QUICK = ("profile_shift",)

case = Cases("studies")


def study(room: Room, name: str) -> dict[str, Any]:
    """Rows of a study and the text of its file."""
    source = room.tree / "examples" / "studies" / f"{name}.toml"
    rows = command(room, "study", str(shortened(source, STUDIES[name])), "--workers", "1")
    return {**rows, "study": np.array(source.read_text(encoding="utf-8").splitlines())}


for _name in STUDIES:
    case.add(_name, lambda room, name=_name: study(room, name), quick=_name in QUICK)  # type: ignore[misc]
