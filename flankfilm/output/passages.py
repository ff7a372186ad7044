"""Root stress as a tooth of one gear has it: while it passes through the mesh, and along its fillets."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Quantity
from base.results import EXACT
from flankfilm.output.variables import figure_of

if TYPE_CHECKING:
    from fem.stress.gear_root import GearRootStress

__all__ = ["fillet_stress", "passage"]

FLAT = "not estimated: where the stress is largest it is flat"

TANGENT = "angle of the fillet's tangent to the tooth's centre line"


def passage(gear: GearRootStress) -> tuple[Quantity, ...]:
    """Follow one tooth through the mesh: an entry for each instant."""
    order = np.argsort(gear.tooth_position, axis=None, kind="stable")

    def stress(name: str, meaning: str, values: Array, arc: Array) -> tuple[Quantity, Quantity]:
        tangent = np.interp(arc.ravel()[order], gear.line.arc, gear.line.tangent_angle)
        return (
            figure_of(name, "Pa", meaning, "instant", values.ravel()[order], shown="MPa"),
            figure_of(
                f"{name}_tangent", "rad", f"where: {TANGENT}", "instant", tangent, shown="deg", no_error=FLAT
            ),
        )

    travel = gear.tooth_position.ravel()[order]
    tension = "largest principal stress along the fillet under the loaded flank"
    compression = "minimum principal stress along the other fillet"
    return (
        figure_of(
            "travel",
            "1",
            "travel since the tooth's pair was at A, in base pitches",
            "instant",
            travel,
            no_error=EXACT,
        ),
        *stress("tension", tension, gear.tension_Pa, gear.tension_arc),
        *stress("compression", compression, gear.compression_Pa, gear.compression_arc),
    )


def fillet_stress(gear: GearRootStress) -> tuple[Quantity, ...]:
    """Look along the fillets at the worst instants, and over a passage."""
    amplitude, mean = gear.fatigue()
    loaded, other = "stress under the loaded flank", "stress on the other side"
    stresses = {
        "loaded_side": (f"{loaded} at the instant of the maximum tension", gear.greatest_tension.along_Pa),
        "other_side": (
            f"{other} at the instant of the maximum compression",
            gear.greatest_compression.along_Pa,
        ),
        "loaded_side_amplitude": (f"amplitude of the {loaded} over a passage", amplitude[0]),
        "loaded_side_mean": (f"mean of the {loaded} over a passage", mean[0]),
    }
    return (
        figure_of(
            "arc",
            "m",
            "arc length from the middle of the gap",
            "arc",
            gear.line.arc,
            shown="mm",
            no_error=EXACT,
        ),
        figure_of("tangent", "rad", TANGENT, "arc", gear.line.tangent_angle, shown="deg", no_error=EXACT),
        *(figure_of(name, "Pa", text, "arc", curve, shown="MPa") for name, (text, curve) in stresses.items()),
    )
