"""Sections of the report about the Fourier stiffness, the scaling and the motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm import figures
from flankfilm.figures.reading import read_figure, unit_text
from flankfilm.report.page import Drawing, Headline, Part, Table, picture
from flankfilm.report.text import number, percent

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import MeshSeries, PairOscillator, SpeedSweep


def fourier(stage: MeshSeries, results: xr.Dataset) -> Part:
    """Fourier stiffness with its remainder."""
    series = stage.stiffness
    unit = unit_text(str(results["fourier_mean"].attrs["units"]))
    rows = tuple(
        (str(j), number(a), percent(a / series.mean), f"{np.degrees(phase):.2f}")
        for j, (a, phase) in enumerate(zip(series.amplitudes, series.phases, strict=True), start=1)
    )
    drawn: tuple[Drawing, ...] = ()
    notes: tuple[str, ...] = ("Phases refer to tau = 0, the instant when a pair is at A.",)
    if stage.fit is not None:
        caption = (
            f"Mesh stiffness ({stage.source}) and its Fourier series; right, the harmonics of the samples "
            "over the mean."
        )
        drawn = (picture(figures.fourier, results, caption),)
        notes = (
            *notes,
            f"The series of order {len(series.amplitudes)} leaves out {percent(stage.fit.remainder_rms)} of the "
            f"mean (root mean square; at most {percent(stage.fit.remainder_max)}). A higher "
            "dynamics.fourier_order keeps more.",
            "The tangent stiffness belongs to small vibration about the load, the secant to motion with "
            "separation.",
        )
    heads = ("harmonic", f"amplitude [{unit}]", "over the mean", "phase [deg]")
    return Part(
        "fourier",
        "Fourier stiffness",
        (f"Mean {number(series.mean, 6)}{'' if unit == '-' else ' ' + unit}.",),
        drawn,
        (Table(heads, rows),),
        notes,
    )


def fourier_headline(stage: MeshSeries) -> Headline:
    """First harmonic and what the series leaves out."""
    kappa = stage.amplitude[0] / stage.mean if stage.order else 0.0
    left = "given" if stage.remainder is None else f"remainder {100 * stage.remainder:.2g} % of the mean"
    return Headline("first harmonic over the mean", f"{kappa:.4f}", left)


def scaling(stage: PairOscillator) -> Part:
    """Physical and dimensionless quantities side by side."""
    if stage.scales is None:
        rows = tuple((name, value) for name, _, value in stage.rows())
        return Part("scaling", "Oscillator", tables=(Table(("quantity", "dimensionless"), rows),))
    heads = ("quantity", "physical", "dimensionless")
    return Part("scaling", "Physical and dimensionless", tables=(Table(heads, stage.rows()),))


def sweep(stage: SpeedSweep, results: xr.Dataset) -> Part:
    """Draw the sweeps and portraits."""
    caption = (
        "States at tau = 0, swept up and down; where the two differ, motions coexist. "
        "n-p-q: n mesh periods, p losses of contact, q back-flank contacts."
    )
    drawn = [picture(figures.sweep, results, caption)]
    if stage.portraits:
        caption = "Phase portraits with Poincaré points at tau = 0; dotted, the edges of the backlash."
        drawn.append(picture(figures.portraits, results, caption))
    notes = [
        f"Each state is the exact solution of the piecewise linear oscillator, to {stage.error:.0e} a "
        f"period; {stage.cost.periods:,} periods were followed.",
        "The model takes the same stiffness on the back flank, and the same damping in the backlash.",
        *stage.messages,
    ]
    if stage.grazings.size:
        at = ", ".join(f"{g:.6g}" for g in stage.grazings)
        if (rpm := _speed(stage)) is not None:
            at += " (" + ", ".join(f"{rpm * g:.0f}" for g in stage.grazings) + " rpm)"
        notes.insert(
            0, f"The orbit that never leaves contact touches the edge of the backlash at omega = {at}."
        )
    return Part("motion", "Motion", figures=tuple(drawn), notes=tuple(notes))


def headline(stage: SpeedSweep) -> Headline:
    """Lowest speed at which the orbit that keeps contact touches the edge of the backlash."""
    note = f"by the orbit that never leaves contact; error {stage.error:.0e} a period"
    if not stage.grazings.size:
        return Headline("edge of the backlash touched at", "none in range", note)
    first = float(np.min(stage.grazings))
    if (rpm := _speed(stage)) is None:
        return Headline("edge of the backlash touched at ω", number(first, 6), note)
    return Headline("edge of the backlash touched at", number(rpm * first, 5), note, "rpm")


def _speed(stage: SpeedSweep) -> float | None:
    """Pinion speed at the frequency 1 [rpm]; None for an oscillator in its own units."""
    if stage.speed is None:
        return None
    return float(read_figure(stage, "speed").values[0] / stage.frequency[0])
