"""Sections of the report about the Fourier stiffness, the scaling, the motion, and every branch of motions."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from base.units import factor
from flankfilm.coupling.mesh.references import MEANINGS
from flankfilm.figures.motion import scale
from flankfilm.figures.reading import read, read_figure
from flankfilm.output.model_errors import first_harmonic
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.text import counted, number, percent, plus_minus

if TYPE_CHECKING:
    import xarray as xr

    from dynamics.branches.branch import Stretch
    from flankfilm.coupling import FilmDamping, MeshSeries, SpeedDiagram, SpeedSweep
    from flankfilm.coupling.speeds.jump_errors import Jump

LONGEST = 40
"""Maximum number of stable ranges listed; the data files hold all."""

COEXISTS = 1.1
"""Ratio of forces above which the sweeps have another motion than the one from rest, or a resonance near it."""

NEGLIGIBLE = 0.01
"""Part of an error below which its source is not named."""


def fourier(stage: MeshSeries, results: xr.Dataset) -> Part:
    """Fourier stiffness with its remainder."""
    series = stage.stiffness
    of_gears = "pair_face_width" in results and stage.fit is not None
    mean, amplitude = (read(results, f"fourier_{name}", per_face=of_gears) for name in ("mean", "amplitude"))
    over = np.divide(series.amplitudes, series.mean)
    unsaid = "as given" if stage.cycle is None else "unknown"
    errors = stage.harmonic_error
    off = [unsaid] * len(over) if errors is None else [f"± {percent(error)}" for error in errors]
    rows = tuple(
        (str(j), number(a), percent(part), error, f"{np.degrees(phase):.2f}")
        for j, (a, part, error, phase) in enumerate(
            zip(amplitude.values, over, off, series.phases, strict=True), start=1
        )
    )
    notes = [said("phases")]
    if stage.fit is not None:
        rms, largest = percent(stage.fit.remainder_rms), percent(stage.fit.remainder_max)
        series_note = said("series", order=len(series.amplitudes), rms=rms, largest=largest)
        measured = said("measured_against", what=MEANINGS[stage.reference or "bore"])
        notes += [measured, series_note, said("tangent_or_secant")]
    drawn = pictures(results, *(["fourier"] if stage.fit else []), source=stage.source)
    unit = "" if mean.unit == "-" else f" {mean.unit}"
    known = "as given" if stage.cycle is None else plus_minus(stage.cycle.mean_error)
    text = f"Mean {number(float(mean.values), 6)}{unit} ({known})."
    heads = ("harmonic", amplitude.named("amplitude"), "over the mean", "error of the ratio", "phase [deg]")
    table = Table(heads, rows)
    return Part("fourier", "Fourier stiffness", (text,), drawn, (table,), tuple(notes))


def fourier_headlines(stage: MeshSeries) -> list[Headline]:
    """First harmonic, and the remainder of the series."""
    kappa = stage.amplitude[0] / stage.mean if stage.order else 0.0
    if stage.remainder is None:
        return [Headline("stiffness, first harmonic over the mean", f"{kappa:.4f}", "as given")]
    errors = stage.harmonic_error
    known = None if errors is None or not len(errors) else float(errors[0])
    remainder = f"remainder after {counted(stage.order, 'harmonic')}: {percent(stage.remainder)} of the mean"
    if stage.left_out is not None and stage.left_out.motion is not None:
        remainder += f" and up to {percent(float(stage.left_out.motion[stage.order]))} of the motion"
    off = Uncertainty(known, first_harmonic(stage), size=1.0)
    return [Headline("stiffness, first harmonic over the mean", f"{kappa:.4f}", remainder, uncertainty=off)]


def film_damping(stage: FilmDamping, _: xr.Dataset) -> Part:
    """Damping of the films, its frequency, and other damping."""
    rows = (
        ("damping ratio of the films", number(stage.damping_ratio), f"± {percent(stage.error)}"),
        ("damping of the mesh by the films [N s/m]", number(stage.damping), f"± {percent(stage.error)}"),
        ("change of the mean tangent stiffness by the films [%]", number(100.0 * stage.stiffness_change), ""),
        (
            "natural frequency, at which the damping is taken [Hz]",
            number(stage.natural_frequency / (2.0 * np.pi)),
            "",
        ),
    )
    notes = (said("film_damping"), f"{stage.message[:1].upper()}{stage.message[1:]}.")
    return Part(
        "film-damping",
        "Damping by the films",
        tables=(Table(("quantity", "value", "error"), rows),),
        notes=notes,
    )


def sweep(stage: SpeedSweep, results: xr.Dataset) -> Part:
    """Draw the sweeps and portraits."""
    drawn = pictures(results, "resonance", "sweep", *(["portraits"] if stage.portraits else []))
    notes = []
    if stage.grazings.size:
        at = "omega = " + ", ".join(f"{g:.6g}" for g in stage.grazings)
        if (rpm := _speed(stage)) is not None:
            at = ", ".join(f"{rpm * g:.0f}" for g in stage.grazings) + f" rpm ({at})"
        notes.append(said("grazing", at=at))
    periods = counted(stage.cost.periods, "period")
    notes += [said("exact", stage=stage, periods=periods), *_swept(stage), said("same_law"), *stage.messages]
    return Part("motion", "Motion", figures=drawn, tables=(_worst(stage, results),), notes=tuple(notes))


def _worst(stage: SpeedSweep, results: xr.Dataset) -> Table:
    """Maximum force, vibration and time without contact of either sweep, each with its speed."""
    force, length, rpm = scale(results, "force"), scale(results, "length"), _speed(stage)

    def cells(values: Array, unit: float) -> tuple[str, str]:
        if not np.isfinite(values).any():
            return "-", "-"
        most = int(np.nanargmax(values))
        at = float(stage.frequency[most]) * (rpm or 1.0)
        return number(unit * float(values[most])), number(at, 5)

    rows = tuple(
        (
            direction,
            *cells(stage.force_factor[direction], float(force.values)),
            *cells(stage.spread[direction], float(length.values)),
            *cells(stage.separated[direction], 100.0),
        )
        for direction in stage.force_factor
    )
    at = "at ω" if rpm is None else "at [rpm]"
    named = force.named("maximum force" if force.unit == "N" else "maximum force over the mean")
    vibration = length.named("displacement, root mean square")
    heads = ("sweep", named, at, vibration, at, "maximum time without contact [%]", at)
    error = percent(stage.sampling_error)
    return Table(
        heads, rows, f"At the speeds swept; force and displacement ± {error} by the samples of a period."
    )


def _swept(stage: SpeedSweep) -> list[str]:
    """Effect of the omitted harmonics on the sweep; nothing for a given series."""
    if stage.longer_order is None or stage.force_change is None or stage.spread_change is None:
        return []
    force, spread = (
        np.concatenate(list(change.values())) for change in (stage.force_change, stage.spread_change)
    )
    same, repeating = np.isfinite(spread), ~np.isnan(spread)
    other, rest = int(np.sum(repeating & ~same)), int(np.sum(~repeating))
    notes = [
        said(
            "truncated_motions",
            order=stage.longer_order,
            count=int(same.sum()),
            all=len(spread),
            force=percent(_largest(force[same])),
            spread=percent(_largest(spread[same])),
            unknown=said("truncated_unknown", other=other, rest=rest) if other + rest else "",
        )
    ]
    if stage.grazing_error is not None and stage.grazing_error.size:
        worst = percent(float(stage.grazing_error.max()))
        notes.append(said("truncated_grazing", order=stage.longer_order, worst=worst))
    return notes


def _largest(changes: Array) -> float | None:
    known = changes[np.isfinite(changes)]
    return float(known.max()) if known.size else None


def sweep_headlines(stage: SpeedSweep) -> list[Headline]:
    """Lowest speed at which contact is lost, and the maximum force of the sweeps."""
    rpm = _speed(stage)
    name, unit = "contact first lost at", "" if rpm is None else "rpm"
    if stage.least_grazing is None:
        return [Headline(name, "none in range", "for the orbit that never leaves contact"), *_greatest(stage)]
    budget = stage.grazing_budget
    exact = set(budget) == {"flow"}
    note = "exact to rounding for the stiffness as given" if exact else ""
    off = None if exact else Uncertainty(_finite(stage.least_grazing_error))
    if budget.get("truncation", 0.0) > NEGLIGIBLE * (stage.least_grazing_error or 0.0):
        note = f"{percent(budget['truncation'])} of it by harmonics that the series omits"
    value = number((rpm or 1.0) * stage.least_grazing, 5 if rpm else 6)
    return [Headline(name if rpm else f"{name} ω", value, note, unit, off), *_greatest(stage)]


def _greatest(stage: SpeedSweep) -> list[Headline]:
    """Maximum force of the sweeps over the mean one."""
    factors = np.array([*stage.force_factor.values()])
    if not np.isfinite(factors).any():
        return []
    at = float(stage.frequency[int(np.nanargmax(np.nanmax(factors, axis=0)))])
    rpm = _speed(stage)
    speed = f"ω = {at:.4g}" if rpm is None else f"{rpm * at:.0f} rpm"
    note, error = f"at {speed}, of the speeds swept", stage.greatest_factor_error
    if stage.force_change is not None and error is not None:
        omitted = percent(error - stage.sampling_error)
        note += f"; {omitted} of the error by harmonics that the series omits"
    off = Uncertainty(_finite(error))
    return [Headline("maximum force over the mean force", f"{np.nanmax(factors):.3g}", note, "", off)]


def _finite(error: float | None) -> float | None:
    """Error where it is known."""
    return None if error is None or not np.isfinite(error) else float(error)


def operating_headlines(stage: SpeedSweep) -> list[Headline]:
    """Dynamic factor at the operating speed, and that of the sweeps near it where motions coexist."""
    factor, at, rpm = stage.operating_force_factor, stage.operating_frequency, _speed(stage)
    if rpm is None or not np.isfinite(factor):
        return []
    note = f"at {rpm * at:.0f} rpm, settled from rest"
    name, beside = "dynamic factor at the operating speed", np.searchsorted(stage.frequency, at)
    if 0 < beside < len(stage.frequency):
        met = np.array([*stage.force_factor.values()])[:, beside - 1 : beside + 1]
        if np.nanmax(met, initial=0.0) > COEXISTS * factor:
            note += f"; the sweeps reach {np.nanmax(met):.3g} near that speed"
    return [Headline(name, f"{factor:.4g}", note, "", Uncertainty(stage.sampling_error))]


def _speed(stage: SpeedSweep) -> float | None:
    """Pinion speed at the frequency 1 [rpm]; None for an oscillator in its own units."""
    if stage.speed is None:
        return None
    return float(read_figure(stage, "speed").values[0] / stage.frequency[0])


def diagram_headlines(stage: SpeedDiagram) -> list[Headline]:
    """Jump speeds."""
    more = f"{stage.longer_order} harmonics have {len(stage.missed)} more" if stage.missed else ""
    if not stage.jumps:
        return [Headline("jump speeds", "none in range", more or "on the branches that were found")]
    at = ", ".join(f"{_shown(stage, j.frequency, 5)} {'up' if j.rising else 'down'}" for j in stage.jumps[:6])
    rest = f" and {len(stage.jumps) - 6} more" if len(stage.jumps) > 6 else ""
    worst = max((j for j in stage.jumps if j.budget), key=lambda j: j.error, default=None)
    off, note = Uncertainty(_finite(worst.error)) if worst else None, ""
    if worst and not np.isfinite(worst.error):
        lost = sum(not np.isfinite(j.error) for j in stage.jumps)
        note = f"error of {lost} unknown: {stage.longer_order} harmonics have no such jump"
    elif worst and worst.budget["truncation"] > 0.5 * worst.error:
        note = f"{percent(worst.budget['truncation'])} of it by harmonics that the series omits"
    note = "; ".join(filter(None, (note, more)))
    if len(stage.jumps) > 1 and off is not None:
        note = "; ".join(filter(None, ("of the jump with the largest error", note)))
    return [Headline("jump speeds", at + rest, note, "rpm" if stage.speed_of_one else "", off)]


def diagram(stage: SpeedDiagram, results: xr.Dataset) -> Part:
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
    drawn, message = pictures(results, "diagram"), stage.diagram.message
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
