"""Sections of the report about the Fourier stiffness, the scaling, the motion, and every branch of motions."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from base.units import factor
from flankfilm.coupling.references import MEANINGS
from flankfilm.figures.reading import read_figure, unit_text
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    import xarray as xr

    from dynamics.branch import Stretch
    from flankfilm.coupling import MeshSeries, PairOscillator, SpeedDiagram, SpeedSweep
    from flankfilm.coupling.jumps import Jump

LONGEST = 40
"""Stable ranges listed; the data files hold all."""


def fourier(stage: MeshSeries, results: xr.Dataset) -> Part:
    """Fourier stiffness with its remainder."""
    series = stage.stiffness
    unit = unit_text(str(results["fourier_mean"].attrs["units"]))
    rows = tuple(
        (str(j), number(a), percent(a / series.mean), f"{np.degrees(phase):.2f}")
        for j, (a, phase) in enumerate(zip(series.amplitudes, series.phases, strict=True), start=1)
    )
    notes = [said("phases")]
    if stage.fit is not None:
        rms, largest = percent(stage.fit.remainder_rms), percent(stage.fit.remainder_max)
        series_note = said("series", order=len(series.amplitudes), rms=rms, largest=largest)
        measured = said("measured_against", what=MEANINGS[stage.reference or "bore"])
        notes += [measured, series_note, said("tangent_or_secant")]
    drawn = pictures(results, *(["fourier"] if stage.fit else []), source=stage.source)
    mean = f"Mean {number(series.mean, 6)}{'' if unit == '-' else ' ' + unit}."
    table = Table(("harmonic", f"amplitude [{unit}]", "over the mean", "phase [deg]"), rows)
    return Part("fourier", "Fourier stiffness", (mean,), drawn, (table,), tuple(notes))


def fourier_headlines(stage: MeshSeries) -> list[Headline]:
    """First harmonic and what the series leaves out."""
    kappa = stage.amplitude[0] / stage.mean if stage.order else 0.0
    left = "given" if stage.remainder is None else f"remainder {100 * stage.remainder:.2g} % of the mean"
    if stage.left_out is not None and stage.left_out.motion is not None:
        motion = percent(float(stage.left_out.motion[stage.order]))
        left += f"; order {stage.order} leaves out up to {motion} of the motion"
    return [Headline("first harmonic over the mean", f"{kappa:.4f}", left)]


def scaling(stage: PairOscillator, _: xr.Dataset) -> Part:
    """Physical and dimensionless quantities side by side; dimensionless ones alone where there are no scales."""
    if stage.scales is None:
        table = Table(("quantity", "dimensionless"), tuple((name, value) for name, _, value in stage.rows()))
        return Part("scaling", "Oscillator", tables=(table,))
    table = Table(("quantity", "physical", "dimensionless"), stage.rows())
    return Part("scaling", "Physical and dimensionless", tables=(table,))


def sweep(stage: SpeedSweep, results: xr.Dataset) -> Part:
    """Draw the sweeps and portraits."""
    drawn = pictures(results, "sweep", *(["portraits"] if stage.portraits else []))
    notes = []
    if stage.grazings.size:
        at = ", ".join(f"{g:.6g}" for g in stage.grazings)
        if (rpm := _speed(stage)) is not None:
            at += " (" + ", ".join(f"{rpm * g:.0f}" for g in stage.grazings) + " rpm)"
        notes.append(said("grazing", at=at))
    notes += [said("exact", stage=stage), said("same_law"), *stage.messages]
    return Part("motion", "Motion", figures=drawn, notes=tuple(notes))


def sweep_headlines(stage: SpeedSweep) -> list[Headline]:
    """Lowest speed at which the orbit that keeps contact touches the edge of the backlash."""
    note = f"by the orbit that never leaves contact; error {stage.error:.0e} a period"
    if stage.least_grazing is None:
        return [Headline("edge of the backlash touched at", "none in range", note)]
    if (rpm := _speed(stage)) is None:
        return [Headline("edge of the backlash touched at ω", number(stage.least_grazing, 6), note)]
    return [Headline("edge of the backlash touched at", number(rpm * stage.least_grazing, 5), note, "rpm")]


def _speed(stage: SpeedSweep) -> float | None:
    """Pinion speed at the frequency 1 [rpm]; None for an oscillator in its own units."""
    if stage.speed is None:
        return None
    return float(read_figure(stage, "speed").values[0] / stage.frequency[0])


def diagram_headlines(stage: SpeedDiagram) -> list[Headline]:
    """Jump speeds."""
    if not stage.jumps:
        return [Headline("jump speeds", "none in range")]
    at = ", ".join(f"{_shown(stage, j.frequency)} {'up' if j.rising else 'down'}" for j in stage.jumps[:6])
    more = f" and {len(stage.jumps) - 6} more" if len(stage.jumps) > 6 else ""
    worst = max((j for j in stage.jumps if j.budget), key=lambda j: j.error, default=None)
    note = f"error up to {percent(worst.error)}" if worst else ""
    if worst and worst.budget["series"] > 0.5 * worst.error:
        note += f", {percent(worst.budget['series'])} of it by harmonics that the series leaves out"
    return [Headline("jump speeds", at + more, note, "rpm" if stage.speed_of_one else "")]


def diagram(stage: SpeedDiagram, results: xr.Dataset) -> Part:
    """Draw the diagram and list ranges, jumps and what they depend on."""
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
        **{source: partial(_share, source) for source in ("stiffness", "series", "flow")},
    }
    variants: dict[str, Callable[[tuple[str, tuple[float, ...]]], str]] = {
        "stiffness, mean over the scene's": lambda law: law[0],
        f"jumps of period 1 at [{unit}]": lambda law: (
            ", ".join(_shown(stage, f) for f in law[1]) or "none in range"
        ),
    }
    tables = [Table.of(stage.stable[:LONGEST], ranges)]
    tables += [Table.of(stage.jumps, jumps)] if stage.jumps else []
    tables += [Table.of(stage.variants.items(), variants)] if stage.variants else []
    drawn, message = pictures(results, "diagram"), stage.diagram.message
    return Part("diagram", "Branches and jumps", (message,), drawn, tuple(tables), tuple(_notes(stage)))


def _share(source: str, jump: Jump) -> str:
    """Part of the error of a jump's speed; empty where it has no budget."""
    return percent(jump.budget[source]) if jump.budget else ""


def _notes(stage: SpeedDiagram) -> list[str]:
    separated, back = (_ranges(stage, one) for one in (stage.separated, stage.back_contact))
    none = "" if stage.jumps else "Jump speeds: none in range."
    notes = [said("contact_lost", separated=separated, back=back, jumps=none)]
    if stage.force_factor.size:
        i = int(np.argmax(stage.force_factor))
        curves = (stage.force_frequency, stage.force_factor, stage.force_factor_iso6336)
        value, force, standard = (float(curve[i]) for curve in curves)
        beside = said("standard_force", standard=standard) if np.isfinite(standard) else ""
        at = _shown(stage, value)
        notes.append(said("greatest_force", force=force, at=at, standard=beside))
    if any(j.budget for j in stage.jumps):
        second = ", ".join(f"{100 * j.second:+.2g} %" for j in stage.jumps)
        notes.append(said("jump_budget", second=second))
    notes += [f"Not followed: {text}." for text in stage.diagram.left_out[:8]]
    branches = enumerate(stage.diagram.branches)
    return notes + [f"Branch {i} of period {b.periods}: {b.message}." for i, b in branches if not b.converged]


def _shown(stage: SpeedDiagram, frequency: float) -> str:
    return number(frequency * (stage.speed_of_one / factor("rpm") if stage.speed_of_one else 1.0), 6)


def _ranges(stage: SpeedDiagram, ranges: tuple[tuple[float, float], ...]) -> str:
    if not ranges:
        return "nowhere in range"
    unit = " rpm" if stage.speed_of_one else ""
    return "at " + ", ".join(f"{_shown(stage, a)} to {_shown(stage, b)}" for a, b in ranges) + unit


def _event(stretch: Stretch, value: float) -> str:
    """Kind of special point at one end of a stretch, empty at an end of the range."""
    return next((p.kind for p in stretch.limits if p.parameter == value), "")
