"""What a run writes of the bifurcation diagram."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from base.units import factor
from flankfilm.dataset import Quantity

if TYPE_CHECKING:
    from flankfilm.coupling import SpeedDiagram


def diagram_quantities(stage: SpeedDiagram) -> dict[str, Quantity]:
    """Variables of the diagram."""
    points = np.asarray(stage.diagram)
    special = stage.diagram.table()
    along, at, jump = ("diagram_point",), ("special_point",), ("jump",)
    unit = _rpm_per_frequency(stage)
    scale = {} if unit is None else {"rpm_per_frequency": Quantity((), unit, "rpm", "speed of frequency 1")}
    return {
        **scale,
        "diagram_branch": Quantity(along, points[:, 0].astype(np.int64), "1", "branch of periodic motions"),
        "diagram_frequency": Quantity(along, points[:, 1], "1", "mesh over natural frequency"),
        "diagram_displacement": Quantity(along, points[:, 2], "1", "displacement at tau = 0"),
        "diagram_velocity": Quantity(along, points[:, 3], "1", "velocity at tau = 0"),
        "diagram_stable": Quantity(along, points[:, 4].astype(np.int8), "1", "1 where stable"),
        "special_frequency": Quantity(at, [row[2] for row in special], "1", "mesh over natural frequency"),
        "special_displacement": Quantity(at, [row[4] for row in special], "1", "displacement at tau = 0"),
        "special_kind": Quantity(
            at, np.asarray([r[1] for r in special], dtype="U16"), "1", "kind of special point"
        ),
        "special_motion": Quantity(at, np.asarray([r[3] for r in special], dtype="U24"), "1", "motion n-p-q"),
        "jump_frequency": Quantity(
            jump, [j.frequency for j in stage.jumps], "1", "where a stable motion ends in a saddle node"
        ),
        "jump_error": Quantity(
            jump, [j.error if j.budget else np.nan for j in stage.jumps], "1", "relative error of its speed"
        ),
        "force_frequency": Quantity(("force",), stage.force_frequency, "1", "mesh over natural frequency"),
        "force_factor": Quantity(
            ("force",), stage.force_factor, "1", "greatest force of a stable motion over the mean force"
        ),
        "force_factor_iso6336": Quantity(
            ("force",), stage.force_factor_iso6336, "1", "K_v after ISO 6336-1, method B"
        ),
    }


def _rpm_per_frequency(stage: SpeedDiagram) -> float | None:
    return None if stage.speed_of_one is None else stage.speed_of_one / factor("rpm")


def diagram_tables(stage: SpeedDiagram) -> dict[str, dict[str, Any]]:
    """Columns of the CSV files."""
    points, special = np.asarray(stage.diagram), stage.diagram.table()
    unit = _rpm_per_frequency(stage)

    def speed(frequency: Any) -> dict[str, Any]:
        return {} if unit is None else {"speed_rpm": unit * np.asarray(frequency, dtype=np.float64)}

    kinds, values = [r[1] for r in special], [r[2] for r in special]
    jumps = [j.frequency for j in stage.jumps]
    return {
        "diagram": speed(points[:, 1])
        | {"branch": points[:, 0].astype(np.int64), "frequency": points[:, 1]}
        | {"displacement": points[:, 2], "velocity": points[:, 3], "stable": points[:, 4].astype(np.int64)},
        "special_points": speed(values)
        | {"branch": [r[0] for r in special], "kind": kinds, "frequency": values}
        | {"motion": [r[3] for r in special], "displacement": [r[4] for r in special]},
        "jumps": speed(jumps)
        | {"frequency": jumps, "speed": ["rising" if j.rising else "falling" for j in stage.jumps]}
        | {"motion": [j.label for j in stage.jumps], "second_harmonic": [j.second for j in stage.jumps]}
        | {
            f"error_{name}": [j.budget.get(name, np.nan) for j in stage.jumps]
            for name in ("stiffness", "series", "flow")
        },
        "stable_motions": {
            "motion": [s.label for s in stage.stable],
            "from_frequency": [s.low for s in stage.stable],
            "to_frequency": [s.high for s in stage.stable],
        },
        "force_over_speed": speed(stage.force_frequency)
        | {"frequency": stage.force_frequency, "force_over_mean": stage.force_factor}
        | {"K_v_iso6336": stage.force_factor_iso6336},
    }
