"""Every branch of motions over the speed, with stable ranges and jumps."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from base import Figure
from base.units import factor
from flankfilm import coupling
from flankfilm.figures.reading import Pictures
from flankfilm.output.branches import branch_tables
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.products.output import Named, in_result, output_of
from flankfilm.products.product import CurveTable, Product, ranked, section_of, wanting, when
from flankfilm.products.sweep import finite
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.run_parts import Work
from flankfilm.report.text import counted, number, percent
from flankfilm.scene.sections.section import required
from flankfilm.stages.computed import Computed
from flankfilm.stages.drives import DRIVE, moving
from flankfilm.stages.engine import Engine, stage
from flankfilm.stages.motion import BRANCHES, FOURIER, SCALING, by_jumps, dynamics_of, ranged
from gears.closed_form.record import STANDARD

if TYPE_CHECKING:
    import xarray as xr

    from dynamics.branches.branch import Stretch
    from flankfilm.coupling.speeds.jump_errors import Jump
    from flankfilm.coupling.speeds.jumps import SpeedDiagram

LONGEST = 40
"""Maximum number of stable ranges listed; the data files hold all."""

PICTURES: Pictures = {"diagram": "diagram_branch"}


@stage(
    "diagram",
    "every branch of motions",
    "dynamics",
    FOURIER,
    SCALING,
    BRANCHES,
    DRIVE,
    kept="dynamics flankfilm gears",
)
def DIAGRAM(run: Engine) -> coupling.SpeedDiagram:
    """Every branch of motions over the scene's range, with the jumps."""
    if by_jumps(run):
        return run[BRANCHES].diagram
    asked = required(dynamics_of(run).diagram, "dynamics.diagram", "the diagram", "add the range")
    return coupling.jump_speeds(moving(run), **ranged(asked))


def section(stage: SpeedDiagram, results: xr.Dataset) -> Part:
    """Draw the diagram; list ranges, jumps and their dependence on the stiffness."""
    unit = "rpm" if stage.speed_of_one else "-"
    ranges: dict[str, Callable[[Stretch], str]] = {
        "stable motion": lambda s: s.label,
        f"from [{unit}]": lambda s: _shown(stage, s.low),
        f"to [{unit}]": lambda s: _shown(stage, s.high),
        "begins": lambda s: _event(s, s.low),
        "ends": lambda s: _event(s, s.high),
    }
    jumps: dict[str, Callable[[Jump], str]] = {
        f"jump at [{unit}]": lambda j: _shown(stage, j.frequency),
        "speed": lambda j: "up" if j.rising else "down",
        "from": lambda j: j.label,
        "error": lambda j: percent(j.error) if j.budget else "",
        **{source: partial(_share, source) for source in ("stiffness", "truncation", "flow")},
        f"by {stage.longer_order} harmonics": lambda j: _longer(stage, j),
    }
    variants: dict[str, Callable[[tuple[str, tuple[float, ...]]], str]] = {
        "mean stiffness over that of the scene": lambda law: law[0],
        f"jumps of period 1 at [{unit}]": lambda law: (
            ", ".join(_shown(stage, f) for f in law[1]) or "none in range"
        ),
    }
    tables = [Table.of(stage.stable[:LONGEST], ranges)]
    tables += [Table.of(stage.jumps, jumps)] if stage.jumps else []
    tables += [Table.of(stage.variants.items(), variants)] if stage.variants else []
    drawn, message = pictures(results, PICTURES), stage.diagram.message
    return Part("diagram", "Branches and jumps", (message,), drawn, tuple(tables), tuple(_notes(stage)))


def _share(source: str, jump: Jump) -> str:
    """Part of the error of a jump's speed; empty where it has no budget."""
    return percent(jump.budget[source]) if jump.budget else ""


def _longer(stage: SpeedDiagram, jump: Jump) -> str:
    """Speed of a jump with the longer series; empty for a given series."""
    if jump.longer is None:
        return ""
    return _shown(stage, jump.longer) if np.isfinite(jump.longer) else "no such jump"


def _notes(stage: SpeedDiagram) -> list[str]:
    separated, back = (_ranges(stage, ranges) for ranges in (stage.separated, stage.back_contact))
    none = "" if stage.jumps else "Jump speeds: none in range."
    notes = [said("contact_lost", separated=separated, back=back, jumps=none)]
    if stage.force_factor.size:
        i = int(np.argmax(stage.force_factor))
        curves = (stage.force_frequency, stage.force_factor, stage.force_factor_iso6336)
        value, force, standard = (float(curve[i]) for curve in curves)
        beside = said("standard_force", standard=standard) if np.isfinite(standard) else ""
        at = _shown(stage, value) + (" rpm" if stage.speed_of_one else "")
        notes.append(said("greatest_force", force=force, at=at, standard=beside))
    notes += _truncated(stage)
    notes += [f"Not followed: {text}." for text in stage.diagram.left_out[:8]]
    branches = enumerate(stage.diagram.branches)
    return notes + [f"Branch {i} of period {b.periods}: {b.message}." for i, b in branches if not b.converged]


def _truncated(stage: SpeedDiagram) -> list[str]:
    """Effect of the omitted harmonics on the figures of motion; nothing for a given series."""
    if stage.longer_order is None:
        return []
    notes = [said("jump_budget", order=stage.longer_order)] if stage.jumps else []
    if stage.missed:
        jumps = ", ".join(
            f"{_shown(stage, j.frequency)} {'up' if j.rising else 'down'} (beside others over {percent(j.width)})"
            for j in stage.missed
        )
        notes.append(said("missed_jumps", order=stage.longer_order, jumps=jumps))
    changed = {name: percent(change) for name, change in stage.truncation.items()}
    notes.append(said("truncated_ranges", order=stage.longer_order, **changed))
    if stage.with_longer is not None and not stage.with_longer.converged:
        notes.append(said("longer_unsure", order=stage.longer_order, why=stage.with_longer.message))
    return notes


def _shown(stage: SpeedDiagram, frequency: float, digits: int = 6) -> str:
    return number(frequency * (stage.speed_of_one / factor("rpm") if stage.speed_of_one else 1.0), digits)


def _ranges(stage: SpeedDiagram, ranges: tuple[tuple[float, float], ...]) -> str:
    if not ranges:
        return "nowhere in range"
    unit = " rpm" if stage.speed_of_one else ""
    return "at " + ", ".join(f"{_shown(stage, a)} to {_shown(stage, b)}" for a, b in ranges) + unit


def _event(stretch: Stretch, value: float) -> str:
    """Kind of special point at one end of a stretch, empty at an end of the range."""
    return next((p.kind for p in stretch.limits if p.parameter == value), "")


def headlines(stage: SpeedDiagram) -> list[Headline]:
    """Jump speeds."""
    more = f"{stage.longer_order} harmonics have {len(stage.missed)} more" if stage.missed else ""
    if not stage.jumps:
        return [Headline("jump speeds", "none in range", more or "on the branches that were found")]
    at = ", ".join(f"{_shown(stage, j.frequency, 5)} {'up' if j.rising else 'down'}" for j in stage.jumps[:6])
    rest = f" and {len(stage.jumps) - 6} more" if len(stage.jumps) > 6 else ""
    worst = max((j for j in stage.jumps if j.budget), key=lambda j: j.error, default=None)
    off, note = Uncertainty(finite(worst.error)) if worst else None, ""
    if worst and not np.isfinite(worst.error):
        lost = sum(not np.isfinite(j.error) for j in stage.jumps)
        note = f"error of {lost} unknown: {stage.longer_order} harmonics have no such jump"
    elif worst and worst.budget["truncation"] > 0.5 * worst.error:
        note = f"{percent(worst.budget['truncation'])} of it by harmonics that the series omits"
    note = "; ".join(filter(None, (note, more)))
    if len(stage.jumps) > 1 and off is not None:
        note = "; ".join(filter(None, ("of the jump with the largest error", note)))
    return [Headline("jump speeds", at + rest, note, "rpm" if stage.speed_of_one else "", off)]


def _of_diagram(diagram: SpeedDiagram, _: Computed) -> Work:
    return Work("special points", None, diagram.error, counted(diagram.branches, "branch", "branches"))


def _first(rising: bool, curve: str) -> Callable[[SpeedDiagram], float | None]:
    """Figure of the first jump that a rising, or a falling, speed reaches; None where no motion ends."""

    def of(diagram: SpeedDiagram) -> float | None:
        values = getattr(diagram, curve)
        met = [at for at, jump in enumerate(diagram.jumps) if jump.rising is rising]
        return None if values is None or not met else float(values[met[0] if rising else met[-1]])

    return of


def _jumps() -> list[Named]:
    ways = {"rising": ("least", "rises"), "falling": ("greatest", "falls")}
    shown = {
        "jump_speed": (
            "rad/s",
            "rpm",
            "{} pinion speed at which a motion ends as the speed {}; nan without one",
        ),
        "jump_frequency": ("1", "", "{} frequency at which a motion ends as it {}; nan without one"),
        "jump_error": ("1", "", "estimated relative error of the {} speed at which a motion ends as it {}"),
    }
    return [
        output_of(
            f"{curve}_{way}",
            Figure(unit, meaning.format(*words), shown=shown_in),
            "diagram",
            in_result(DIAGRAM, _first(way == "rising", curve)),
            error_output="" if curve == "jump_error" else f"jump_error_{way}",
        )
        for (way, words), (curve, (unit, shown_in, meaning)) in product(ways.items(), shown.items())
    ]


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    return (
        *_jumps(),
        output_of(
            "greatest_K_v",
            Figure(
                "1",
                "maximum dynamic factor K_v by ISO 6336-1, method B, over the diagram's range",
                no_error=STANDARD,
            ),
            "diagram",
            in_result(
                DIAGRAM,
                lambda diagram: (
                    np.nanmax(diagram.force_factor_iso6336)
                    if np.isfinite(diagram.force_factor_iso6336).any()
                    else None
                ),
            ),
        ),
    )


PRODUCT = Product(
    name="diagram",
    goals=wanting("diagram", DIAGRAM),
    variables=when(DIAGRAM, branch_tables),
    solved=dict.fromkeys(("diagram", "return", "special", "jump", "missed", "stable", "force"), DIAGRAM),
    tables={
        "diagram": CurveTable("diagram", "frequency", axis="point"),
        "diagram_returns": CurveTable("return", "frequency", axis="point"),
        "special_points": CurveTable("special", "frequency", axis="point"),
        "jumps": CurveTable("jump", "frequency", axis="jump"),
        "missed_jumps": CurveTable("missed", "frequency", axis="jump"),
        "stable_motions": CurveTable("stable", "motion", axis="range"),
        "force_over_speed": CurveTable("force", "factor", axis="force"),
    },
    headlines=when(DIAGRAM, lambda stage: ranked(headlines(stage), 2)),
    pictures=PICTURES,
    sections=section_of(DIAGRAM, section),
    work={DIAGRAM.name: _of_diagram},
    outputs=outputs,
)
