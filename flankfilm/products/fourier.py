"""Fourier stiffness: the series of the mesh stiffness that the motion uses."""

from __future__ import annotations

from collections.abc import Iterator, Set
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.coupling.mesh.references import MEANINGS
from flankfilm.figures.reading import Pictures, read
from flankfilm.output import records
from flankfilm.output.model_errors import first_harmonic
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.products.product import Product, section_of, when
from flankfilm.report.page import Headline, Part, Table, pictures, said
from flankfilm.report.run_parts import Work
from flankfilm.report.text import counted, number, percent, plus_minus
from flankfilm.scene import Scene
from flankfilm.scene.needs import MOTIONS
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Stage
from flankfilm.stages.mesh import DRY_CYCLE, PLAN
from flankfilm.stages.motion import FOURIER

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import MeshSeries

PICTURES: Pictures = {"fourier": "fourier_samples"}


def goals(scene: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
    """The series, and beside it in the report the mesh cycle without film."""
    if not wants & {"fourier", *MOTIONS}:
        return
    if "report" in wants and scene.stiffness.model != "given" and scene.pair is not None:
        yield DRY_CYCLE  # a film from the cache asks for none, and stands beside it in the report
    yield FOURIER


def section(stage: MeshSeries, results: xr.Dataset) -> Part:
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
    drawn = pictures(results, PICTURES, source=stage.source)
    unit = "" if mean.unit == "-" else f" {mean.unit}"
    known = "as given" if stage.cycle is None else plus_minus(stage.cycle.mean_error)
    text = f"Mean {number(float(mean.values), 6)}{unit} ({known})."
    heads = ("harmonic", amplitude.named("amplitude"), "over the mean", "error of the ratio", "phase [deg]")
    table = Table(heads, rows)
    return Part("fourier", "Fourier stiffness", (text,), drawn, (table,), tuple(notes))


def headlines(stage: MeshSeries) -> list[Headline]:
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


def _of_series(series: MeshSeries, computed: Computed) -> Work:
    if series.fit is None:
        return Work()
    plan = computed.get(PLAN)
    allowed = None if plan is None else plan.series
    return Work("remainder of the series", allowed, series.remainder, f"order {series.order}")


PRODUCT = Product(
    name="fourier",
    goals=goals,
    variables=when(FOURIER, lambda series: records.series("fourier", series)),
    solved={"fourier": FOURIER},
    headlines=when(FOURIER, headlines),
    pictures=PICTURES,
    sections=section_of(FOURIER, section),
    work={FOURIER.name: _of_series},
)
