"""Section of the report about every branch of motions, jumps and forces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base.units import factor
from flankfilm import figures
from flankfilm.report.page import Headline, Part, Table, picture
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    import xarray as xr

    from dynamics.labelling import Stretch
    from flankfilm.coupling import SpeedDiagram

LONGEST = 40
"""Stable ranges listed; the data files hold all."""


def headline(stage: SpeedDiagram) -> Headline:
    """Jump speeds."""
    if not stage.jumps:
        return Headline("jump speeds", "none in range", "")
    unit = "rpm" if stage.speed_of_one else ""
    at = [f"{_speed(stage, j.frequency)} {'up' if j.rising else 'down'}" for j in stage.jumps[:6]]
    more = f" and {len(stage.jumps) - 6} more" if len(stage.jumps) > 6 else ""
    errors = [j.error for j in stage.jumps if j.budget]
    return Headline(
        "jump speeds",
        ", ".join(at) + more,
        f"error up to {percent(max(errors))}" if errors else "",
        unit,
    )


def diagram(stage: SpeedDiagram, results: xr.Dataset) -> Part:
    """Draw the diagram and list ranges, jumps and what they depend on."""
    found, unit = stage.diagram, "rpm" if stage.speed_of_one else "-"
    tables = [
        Table(
            ("stable motion", f"from [{unit}]", f"to [{unit}]", "begins", "ends"),
            tuple(
                (s.label, _speed(stage, s.low), _speed(stage, s.high), _event(s, s.low), _event(s, s.high))
                for s in stage.stable[:LONGEST]
            ),
        )
    ]
    if stage.jumps:
        rows = tuple(
            (
                _speed(stage, j.frequency), "up" if j.rising else "down", j.label,
                percent(j.error) if j.budget else "", *(
                    percent(j.budget[name]) if j.budget else "" for name in ("stiffness", "series", "flow")
                ),
            )
            for j in stage.jumps
        )  # fmt: skip
        heads = (f"jump at [{unit}]", "speed", "from", "error", "stiffness", "series", "flow")
        tables.append(Table(heads, rows))
    if stage.variants:
        rows = tuple(
            (name, ", ".join(_speed(stage, f) for f in jumps) or "none in range")
            for name, jumps in stage.variants.items()
        )
        tables.append(Table(("stiffness, mean over the scene's", f"jumps of period 1 at [{unit}]"), rows))
    drawn = picture(
        figures.diagram,
        results,
        "Every branch of periodic motions found: stable solid, unstable dashed, special points marked; the "
        "greatest force of stable motions of periods 1 and 2 over the mean force.",
    )
    return Part(
        "diagram", "Branches and jumps", (found.message,), (drawn,), tuple(tables), tuple(_notes(stage))
    )


def _notes(stage: SpeedDiagram) -> list[str]:
    notes = [
        f"Contact is lost by a stable motion {_ranges(stage, stage.separated)}; the back flank is touched "
        f"{_ranges(stage, stage.back_contact)}. {'' if stage.jumps else 'Jump speeds: none in range.'}"
    ]
    if stage.force_factor.size:
        i = int(np.argmax(stage.force_factor))
        value, force, standard = (
            float(curve[i])
            for curve in (stage.force_frequency, stage.force_factor, stage.force_factor_iso6336)
        )
        beside = (
            f"; ISO 6336-1, method B, has K_v = {standard:.3g} there (pitch deviation: the error's peak-to-peak "
            "value, profile deviation 0)"
            if np.isfinite(standard)
            else ""
        )
        notes.append(
            f"Greatest force: {force:.3g} times the mean force at {_speed(stage, value)}{beside}. It holds the "
            "variation of the stiffness under the mean load too, which K_v does not."
        )
    if any(j.budget for j in stage.jumps):
        second = ", ".join(f"{100 * j.second:+.2g} %" for j in stage.jumps)
        notes.append(
            "The error budget carries the errors of the stages through the exact derivatives of the jump: mean "
            "stiffness by finite elements and film, harmonics that the series leaves out, and the flow. The first "
            f"of those harmonics alone would move the jumps by {second}, to first order."
        )
    notes += [f"Not followed: {text}." for text in stage.diagram.left_out[:8]]
    ended = [
        f"Branch {i} of period {b.periods}: {b.message}."
        for i, b in enumerate(stage.diagram.branches)
        if not b.converged
    ]
    return [*notes, *ended]


def _speed(stage: SpeedDiagram, frequency: float) -> str:
    return number(frequency * (stage.speed_of_one / factor("rpm") if stage.speed_of_one else 1.0), 6)


def _ranges(stage: SpeedDiagram, ranges: tuple[tuple[float, float], ...]) -> str:
    if not ranges:
        return "nowhere in range"
    unit = " rpm" if stage.speed_of_one else ""
    return "at " + ", ".join(f"{_speed(stage, a)} to {_speed(stage, b)}" for a, b in ranges) + unit


def _event(stretch: Stretch, value: float) -> str:
    """Kind of special point at one end of a stretch, empty at an end of the range."""
    at = [p.kind for p in stretch.limits if p.parameter == value]
    return at[0] if at else ""
