"""A bifurcation diagram as tables: points of branches, special points, jumps, stable motions, forces."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array
from base.results import EXACT, ITSELF
from flankfilm.output.variables import figure_of, of_quantities
from gears.closed_form.record import STANDARD

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import SpeedDiagram
    from flankfilm.coupling.speeds.jump_errors import Jump
    from flankfilm.coupling.speeds.truncation import MissedJump

SOURCES = ("stiffness", "truncation", "flow")

ROUNDING = "rounding of the exact flow; errors of the stiffness stand with the jumps"

LONGER = "not estimated: of the longer series that the truncation of jumps is measured with"

COLUMNS: Mapping[str, tuple[str, str]] = {
    "branch": ("i8", "branch of periodic motions"),
    "periods": ("i8", "whole mesh periods after tau = 0, of an orbit of several periods"),
    "return_displacement": ("f8", "displacement at the start of that period"),
    "return_velocity": ("f8", "velocity at the start of that period"),
    "kind": ("U16", "kind of special point"),
    "motion": ("U24", "motion n-p-q"),
    "frequency": ("f8", "mesh frequency over natural frequency"),
    "from_frequency": ("f8", "lowest mesh frequency over natural frequency"),
    "to_frequency": ("f8", "highest mesh frequency over natural frequency"),
    "displacement": ("f8", "displacement at tau = 0"),
    "velocity": ("f8", "velocity at tau = 0"),
    "stable": ("i8", "1 where stable"),
    "direction": ("U8", "speed at which the motion ends: rising or falling"),
    "jump_motion": ("U24", "motion n-p-q that ends"),
    "longer_frequency": ("f8", "the same jump's frequency with the longer series; nan where it has none"),
    "missed_motion": ("U24", "motion n-p-q that ends, with the longer series alone"),
    "width": ("f8", "relative distance to the next fold of the same branch"),
    "error": ("f8", "relative error of the jump's speed; infinite where it is unknown"),
    **{f"error_by_{source}": ("f8", f"part of the relative error: {source}") for source in SOURCES},
    "factor": ("f8", "maximum force over mean force"),
    "factor_iso6336": ("f8", "K_v after ISO 6336-1, method B"),
}
"""Type and meaning of the columns; all numbers are pure."""

REASONS: Mapping[str, str] = {
    **dict.fromkeys(("branch", "stable", "periods"), EXACT),
    **dict.fromkeys(("error", *(f"error_by_{source}" for source in SOURCES)), ITSELF),
    "longer_frequency": LONGER,
    "factor_iso6336": STANDARD,
}
"""Why columns have no separate error, where their table's reason is another one."""


@dataclass(frozen=True)
class Columns:
    """Makes tables of motions.

    Attributes
    ----------
    speed_of_one : float or None
        Pinion speed of frequency 1 [rad/s], which stands beside every frequency; none without it.
    across : str
        What the frequency is, of motions over another parameter.
    """

    speed_of_one: float | None = None
    across: str = ""

    def table(
        self, prefix: str, axis: str, names: str, rows: Iterable[tuple[Any, ...]], no_error: str = ROUNDING
    ) -> xr.Dataset:
        """Variables of a table with named columns, along an axis."""
        columns = {name: COLUMNS.get(f"{prefix}_{name}", COLUMNS[name]) for name in names.split()}
        held = np.array(list(rows), dtype=[(name, kind) for name, (kind, _) in columns.items()])
        figures = [
            figure_of(
                name,
                "" if kind.startswith("U") else "1",
                self.across if self.across and name == "frequency" else meaning,
                axis,
                held[name],
                no_error=REASONS.get(f"{prefix}_{name}", REASONS.get(name, no_error)),
            )
            for name, (kind, meaning) in columns.items()
        ]
        if self.speed_of_one is not None and "frequency" in columns:
            speed = self.speed_of_one * held["frequency"]
            speeds = figure_of("speed", "rad/s", "pinion speed", axis, speed, shown="rpm", no_error=no_error)
            figures.insert(0, speeds)
        return of_quantities(
            prefix, figures, dict.fromkeys(("frequency", "speed"), "error") if prefix == "jump" else None
        )


def diagram_tables(
    points: Array, further: Array, special: Iterable[tuple[Any, ...]], **columns: Any
) -> list[xr.Dataset]:
    """Variables of branches.

    Parameters
    ----------
    points : (n, 5) array
        As of `dynamics.Diagram.columns`.
    further : (n, 6) array
        As of `dynamics.attraction.returns.returns`.
    special : iterable of tuple
        Branch, kind, parameter, motion and displacement of special points.
    columns
        As of `Columns`.
    """
    table = Columns(**columns).table
    names = "frequency displacement velocity stable"
    return [
        table("diagram", "point", f"branch {names}", map(tuple, points.tolist())),
        table("return", "point", f"branch periods {names}", map(tuple, further.tolist())),
        table("special", "point", "branch kind frequency motion displacement", special),
    ]


def branch_tables(diagram: SpeedDiagram) -> list[xr.Dataset]:
    """Variables of a diagram, table by table, the pinion's speed beside every frequency where it has one."""
    from dynamics.attraction.returns import returns  # which loads all of branches

    table = Columns(diagram.speed_of_one).table
    whole, special = diagram.diagram, (row[:5] for row in diagram.diagram.table())
    stable = ((stretch.label, stretch.low, stretch.high) for stretch in diagram.stable)
    forces = zip(diagram.force_frequency, diagram.force_factor, diagram.force_factor_iso6336, strict=True)
    errors = " ".join(f"error_by_{source}" for source in SOURCES)
    return [
        *diagram_tables(whole.columns(), returns(whole), special, speed_of_one=diagram.speed_of_one),
        table(
            "jump",
            "jump",
            f"frequency direction motion longer_frequency error {errors}",
            map(_jump, diagram.jumps),
        ),
        table("missed", "jump", "frequency direction motion width", map(_missed, diagram.missed), LONGER),
        table("stable", "range", "motion from_frequency to_frequency", stable),
        table("force", "force", "frequency factor factor_iso6336", forces),
        *_truncated(diagram),
    ]


def _truncated(diagram: SpeedDiagram) -> list[xr.Dataset]:
    """What the longer series changes of whole figures; nothing for a given series."""
    if diagram.longer_order is None:
        return []
    meant = "largest relative change of the ranges of stable motions that {} by the longer series"
    changes = [
        figure_of(
            "longer_order", "1", "harmonics of the longer series", "", diagram.longer_order, no_error=EXACT
        ),
        figure_of(
            "separated_error",
            "1",
            meant.format("lose contact"),
            "",
            diagram.truncation["separated"],
            no_error=ITSELF,
        ),
        figure_of(
            "back_contact_error",
            "1",
            meant.format("touch the back flank"),
            "",
            diagram.truncation["back_contact"],
            no_error=ITSELF,
        ),
        figure_of(
            "greatest_force",
            "1",
            "maximum force of a stable motion over the mean force",
            "",
            diagram.greatest_force,
        ),
        figure_of(
            "greatest_force_error",
            "1",
            "relative change of the maximum force by the longer series; infinite where it is unknown",
            "",
            diagram.truncation["greatest_force"],
            no_error=ITSELF,
        ),
    ]
    return [of_quantities("diagram", changes, {"greatest_force": "greatest_force_error"})]


def _jump(jump: Jump) -> tuple[Any, ...]:
    """Row of a jump; its errors are nan for an oscillator in its own units."""
    parts = [jump.budget.get(source, np.nan) for source in SOURCES]
    direction, error = "rising" if jump.rising else "falling", jump.error if jump.budget else np.nan
    longer = np.nan if jump.longer is None else jump.longer
    return jump.frequency, direction, jump.label, longer, error, *parts


def _missed(jump: MissedJump) -> tuple[Any, ...]:
    """Row of a jump that the longer series has alone."""
    return jump.frequency, "rising" if jump.rising else "falling", jump.label, jump.width
