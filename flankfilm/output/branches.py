"""A bifurcation diagram as tables: points of branches, special points, jumps, stable motions, forces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from base import Array, Integers, quantity, record

if TYPE_CHECKING:
    from collections.abc import Mapping

    from flankfilm.coupling import SpeedDiagram

__all__ = ["Forces", "Jumps", "Points", "SpecialPoints", "StableMotions", "branch_tables"]

Texts = NDArray[np.str_]

FREQUENCY = "mesh frequency over natural frequency"
SPEED = "pinion speed"
SOURCES = ("stiffness", "series", "flow")


@record
class Points:
    """Points of all branches of periodic motions."""

    speed: Array | None = quantity("rad/s", SPEED, "point", shown="rpm")
    branch: Integers = quantity("1", "branch of periodic motions", "point")
    frequency: Array = quantity("1", FREQUENCY, "point")
    displacement: Array = quantity("1", "displacement at tau = 0", "point")
    velocity: Array = quantity("1", "velocity at tau = 0", "point")
    stable: Integers = quantity("1", "1 where stable", "point")


@record
class SpecialPoints:
    """Saddle nodes, period doublings and grazings."""

    speed: Array | None = quantity("rad/s", SPEED, "point", shown="rpm")
    branch: Integers = quantity("1", "branch of periodic motions", "point")
    kind: Texts = quantity("", "kind of special point", "point")
    frequency: Array = quantity("1", FREQUENCY, "point")
    motion: Texts = quantity("", "motion n-p-q", "point")
    displacement: Array = quantity("1", "displacement at tau = 0", "point")


@record
class Jumps:
    """Where stable motions end in a saddle node."""

    speed: Array | None = quantity("rad/s", SPEED, "jump", shown="rpm")
    frequency: Array = quantity("1", FREQUENCY, "jump")
    direction: Texts = quantity("", "speed at which the motion ends: rising or falling", "jump")
    motion: Texts = quantity("", "motion n-p-q that ends", "jump")
    second_harmonic: Array = quantity(
        "1", "relative change of the speed by the first harmonic that the series leaves out", "jump"
    )
    error: Array = quantity("1", "relative error of the jump's speed", "jump")
    error_by: Mapping[str, Array] = quantity("1", "part of the relative error", "jump")


@record
class StableMotions:
    """Ranges of stable motions."""

    motion: Texts = quantity("", "motion n-p-q", "range")
    from_frequency: Array = quantity("1", "least mesh frequency over natural frequency", "range")
    to_frequency: Array = quantity("1", "greatest mesh frequency over natural frequency", "range")


@record
class Forces:
    """Greatest force of stable motions of periods 1 and 2."""

    speed: Array | None = quantity("rad/s", SPEED, "force", shown="rpm")
    frequency: Array = quantity("1", FREQUENCY, "force")
    factor: Array = quantity("1", "greatest force over mean force", "force")
    factor_iso6336: Array = quantity("1", "K_v after ISO 6336-1, method B", "force")


def branch_tables(found: SpeedDiagram) -> dict[str, object]:
    """Records of a diagram by the prefix of their variables."""
    points, special, jumps = np.asarray(found.diagram, dtype=np.float64), found.diagram.table(), found.jumps

    def speed(frequency: Array) -> Array | None:
        return None if found.speed_of_one is None else found.speed_of_one * frequency

    at = np.array([row[2] for row in special], dtype=np.float64)
    jumping = np.array([jump.frequency for jump in jumps])
    return {
        "diagram": Points(
            speed=speed(points[:, 1]),
            branch=points[:, 0].astype(np.int64),
            frequency=points[:, 1],
            displacement=points[:, 2],
            velocity=points[:, 3],
            stable=points[:, 4].astype(np.int64),
        ),
        "special": SpecialPoints(
            speed=speed(at),
            branch=np.array([row[0] for row in special], dtype=np.int64),
            kind=np.array([row[1] for row in special], dtype="U16"),
            frequency=at,
            motion=np.array([row[3] for row in special], dtype="U24"),
            displacement=np.array([row[4] for row in special], dtype=np.float64),
        ),
        "jump": Jumps(
            speed=speed(jumping),
            frequency=jumping,
            direction=np.array(["rising" if jump.rising else "falling" for jump in jumps], dtype="U8"),
            motion=np.array([jump.label for jump in jumps], dtype="U24"),
            second_harmonic=np.array([jump.second for jump in jumps]),
            error=np.array([jump.error if jump.budget else np.nan for jump in jumps]),
            error_by={name: np.array([jump.budget.get(name, np.nan) for jump in jumps]) for name in SOURCES},
        ),
        "stable": StableMotions(
            np.array([stretch.label for stretch in found.stable], dtype="U24"),
            np.array([stretch.low for stretch in found.stable]),
            np.array([stretch.high for stretch in found.stable]),
        ),
        "force": Forces(
            speed(found.force_frequency),
            found.force_frequency,
            found.force_factor,
            found.force_factor_iso6336,
        ),
    }
