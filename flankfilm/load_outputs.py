"""Data of loaded contacts: pressures and sliding of each pair, torques, a revolution, root stress."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.dataset import Quantity

if TYPE_CHECKING:
    from fem import MeshCycle
    from fem.tooth_root import GearRootStress
    from flankfilm.coupling import RootStresses, TorqueCurves

Found = tuple[dict[str, Quantity], dict[str, Any]]
"""Variables of the dataset, and tables by the name of their CSV file."""


def load_outputs(values: Mapping[str, Any], speed: float | None) -> Iterator[Found]:
    """Variables and tables of what is at hand.

    Parameters
    ----------
    values : mapping
        Stage name to result.
    speed : float or None
        Of the pinion [rad/s].
    """
    if (dry := values.get("dry cycle")) is not None and dry.contact is not None:
        yield contacts(dry.contact, speed)
    if (torques := values.get("torques")) is not None:
        yield over_torque(torques)
    if (whole := values.get("revolution")) is not None:
        yield revolution(whole)
    if (roots := values.get("root stress")) is not None:
        yield root_stress(roots)


def contacts(cycle: MeshCycle, speed: float | None) -> Found:
    """Hertz contact and sliding of each pair over the dry cycle; NaN without contact of two flanks."""
    dims = ("dry_position", "dry_pair")
    touching = cycle.forces > 0
    specific = np.where(touching, cycle.specific_sliding, np.nan)
    quantities = {
        "dry_unloaded_transmission_error": Quantity(
            dims[:1], cycle.unloaded_transmission_error, "m", "way of the pinion until teeth touch, no load"
        ),
        "dry_hertz_pressure": Quantity(
            dims, cycle.hertz_pressure, "Pa", "largest Hertz pressure, flanks only"
        ),
        "dry_half_width": Quantity(dims, cycle.half_width, "m", "half-width of the contact, flanks only"),
        "dry_specific_sliding_pinion": Quantity(
            dims, specific[0], "1", "sliding over the pinion's own speed"
        ),
        "dry_specific_sliding_wheel": Quantity(dims, specific[1], "1", "sliding over the wheel's own speed"),
    }
    table: dict[str, Any] = {"phase": cycle.position}
    for j in range(cycle.forces.shape[1]):
        pair = f"pair_{j + 1}"
        table |= {
            f"force_N_{pair}": cycle.forces[:, j],
            f"hertz_pressure_GPa_{pair}": 1e-9 * cycle.hertz_pressure[:, j],
            f"half_width_um_{pair}": 1e6 * cycle.half_width[:, j],
        }
    if speed is not None:
        sliding = np.where(touching, cycle.sliding(speed), np.nan)
        quantities["dry_sliding_speed"] = Quantity(dims, sliding, "m/s", "u1 - u2, negative before C")
        table |= {f"sliding_m_per_s_pair_{j + 1}": sliding[:, j] for j in range(sliding.shape[1])}
    return quantities, {"contacts_dry": table}


def over_torque(found: TorqueCurves) -> Found:
    """Mesh stiffness and transmission error over torque."""
    along = ("torque",)
    quantities = {
        "torque": Quantity(along, found.torque, "N m", "torque of the pinion"),
        "torque_secant_stiffness": Quantity(
            along, found.secant_stiffness, "N/m", "mean force over deflection, dry"
        ),
        "torque_tangent_stiffness": Quantity(along, found.stiffness, "N/m", "mean slope, dry"),
        "torque_transmission_error": Quantity(along, found.transmission_error, "m", "peak to peak, dry"),
        "torque_harmonic_1": Quantity(
            along, found.harmonic_1, "1", "first harmonic of the secant over its mean"
        ),
    }
    table = {
        "pinion_torque_Nm": found.torque,
        "mean_secant_N_per_m": found.secant_stiffness,
        "mean_tangent_N_per_m": found.stiffness,
        "transmission_error_um": 1e6 * found.transmission_error,
        "harmonic_1": found.harmonic_1,
    }
    return quantities, {"torques": table}


def revolution(cycle: MeshCycle) -> Found:
    """Loaded and unloaded transmission error tooth by tooth."""
    along = ("revolution_position",)
    quantities = {
        "revolution_travel": Quantity(
            along, cycle.position, "1", "travel after the first pair is at A, in base pitches"
        ),
        "revolution_transmission_error": Quantity(
            along, cycle.transmission_error, "m", "deflection and gaps"
        ),
        "revolution_unloaded_transmission_error": Quantity(
            along, cycle.unloaded_transmission_error, "m", "way of the pinion until teeth touch, no load"
        ),
        "revolution_secant_stiffness": Quantity(
            along, cycle.secant_stiffness, "N/m", "force over deflection"
        ),
    }
    table = {
        "travel_base_pitches": cycle.position,
        "transmission_error_um": 1e6 * cycle.transmission_error,
        "unloaded_transmission_error_um": 1e6 * cycle.unloaded_transmission_error,
        "secant_stiffness_N_per_m": cycle.secant_stiffness,
    }
    return quantities, {"revolution": table}


def root_stress(found: RootStresses) -> Found:
    """Largest and least stress along both fillets while a tooth passes through the mesh, and their profiles."""
    quantities: dict[str, Quantity] = {}
    tables: dict[str, dict[str, Any]] = {}
    gears = (("pinion", found.stress.pinion), ("wheel", found.stress.wheel))
    for number, (name, gear) in enumerate(gears):
        passage = passing(gear)
        dims = (f"root_passage_{name}",)
        for column, unit, meaning in (
            ("way_base_pitches", "1", "travel since the tooth's pair passed A, in base pitches"),
            ("tension_Pa", "Pa", "largest principal stress along the fillet under the loaded flank"),
            ("tension_tangent_deg", "deg", "where: angle of the fillet's tangent to the tooth's centre line"),
            ("compression_Pa", "Pa", "least principal stress along the other fillet"),
            ("compression_tangent_deg", "deg", "where: angle of the fillet's tangent to the centre line"),
        ):
            quantities[f"root_{column}_{name}"] = Quantity(dims, passage[column], unit, meaning)
        tables[f"root_stress_{name}"] = passage
        tables[f"fillet_stress_{name}"] = _fillet(gear)
        if found.iso is not None:
            section = found.iso.sections[number]
            for symbol, value, unit in (
                ("Y_F", section.Y_F, "1"),
                ("Y_S", section.Y_S, "1"),
                ("Y_B", found.iso.Y_B[number], "1"),
                ("sigma_F0", found.iso.stresses[number], "Pa"),
            ):
                quantities[f"iso6336_3_{symbol}_{name}"] = Quantity(
                    (), value, unit, f"{symbol} of ISO 6336-3"
                )
    return quantities, tables


def passing(gear: GearRootStress) -> dict[str, Any]:
    """Follow one tooth through the mesh: a row for each instant."""
    order = np.argsort(gear.tooth_position, axis=None, kind="stable")

    def tangent(arc: Any) -> Any:
        return np.degrees(np.interp(arc.ravel()[order], gear.line.arc, gear.line.tangent_angle))

    return {
        "way_base_pitches": gear.tooth_position.ravel()[order],
        "tension_Pa": gear.tension_Pa.ravel()[order],
        "tension_tangent_deg": tangent(gear.tension_arc),
        "compression_Pa": gear.compression_Pa.ravel()[order],
        "compression_tangent_deg": tangent(gear.compression_arc),
    }


def _fillet(gear: GearRootStress) -> dict[str, Any]:
    """Along the fillet: stress at the worst instants, amplitude and mean of a passage."""
    tension, compression = gear.greatest_tension, gear.greatest_compression
    at = {peak: int(np.flatnonzero(gear.tooth == peak.tooth)[0]) for peak in (tension, compression)}
    amplitude, mean = gear.fatigue()
    return {
        "arc_mm": 1e3 * gear.line.arc,
        "tangent_deg": np.degrees(gear.line.tangent_angle),
        "loaded_side_Pa": gear.tangential_Pa[tension.row, at[tension], 0],
        "other_side_Pa": gear.tangential_Pa[compression.row, at[compression], 1],
        "loaded_side_amplitude_Pa": amplitude[0],
        "loaded_side_mean_Pa": mean[0],
    }
