"""Page of a verification."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from flankfilm.coupling.mesh.references import relative_to
from flankfilm.coupling.mesh.verification import UNITS
from flankfilm.figures.reading import unit_text
from flankfilm.report import face_parts
from flankfilm.report.page import Fact, Head, Headline, Part, Table, pictures, write_page
from flankfilm.report.run_parts import inputs_of
from flankfilm.report.text import percent, seconds

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling.mesh.verification import Difference, Verification


def write_verification_page(verification: Verification, data: xr.Dataset, folder: Path) -> Path:
    """Write ``report.html`` of a verification and return its path.

    Parameters
    ----------
    verification : Verification
    data : xarray.Dataset
        What ``verify.nc`` holds.
    folder : Path
    """
    whole, pair = verification.references[0], verification.pair
    headlines = [
        Headline(
            relative_to(f"{d.model}: mean mesh stiffness", whole.deflection_reference),
            f"{100 * d.difference:+.1f}",
            f"against finite elements, whose error is {percent(d.reference_error)}",
            "%",
        )
        for d in verification.differences
        if (d.figure, d.reference) == ("mesh, mean", whole.label)
    ]
    tables = tuple(
        _differences(verification, reference.label) for reference in (whole, verification.like_for_like)
    )
    cost = "; ".join(
        f"{c.label} {seconds(c.cost.seconds)}" for c in (*verification.references, *verification.models)
    )
    shared = f"Finite elements {seconds(verification.cost.seconds)} once; then each model: {cost}."
    work = verification.cost.seconds + sum(c.cost.seconds for c in verification.references)
    facts = [
        Fact(f"{pair.pinion.teeth}/{pair.wheel.teeth} teeth, module {1e3 * pair.module:g} mm"),
        Fact(f"pinion: {verification.torque:g} N m"),
        Fact(f"{seconds(work)} of work", "costs"),
    ]
    over = verification.over_face
    parts = [
        Part("curves", "Curves", figures=pictures(data, {"verification": "model"})),
        Part(
            "differences",
            "Differences",
            tables=tables,
            notes=(verification.message,) if verification.message else (),
            unfolded=True,
        ),
        *([] if over is None else [face_parts.beside(over, data)]),
        Part("costs", "Cost", (shared,)),
        inputs_of(data),
    ]
    return write_page(folder, Head(str(data.attrs["title"]) or "Closed forms", facts, headlines), parts)


def _differences(verification: Verification, reference: str) -> Table:
    """Every figure of every model against one reference."""
    rows = tuple(
        (f"{name} [{unit_text(unit)}]", *cells) for name, unit, *cells in compared(verification, reference)
    )
    against = compared_with(verification, reference)
    heads = ("figure", "finite elements", *(model.label for model in verification.models))
    return Table(heads, rows, f"Against {against}")


def compared_with(verification: Verification, reference: str) -> str:
    """Finite elements that models are compared with: the parts left out, and the reference of the deflection."""
    whole = next(elements for elements in verification.references if elements.label == reference)
    return relative_to(
        reference if reference == "finite elements" else f"finite elements {reference}",
        whole.deflection_reference,
    )


def compared(verification: Verification, reference: str) -> Iterator[tuple[str, ...]]:
    """Cells of every figure against one reference: name, unit, by finite elements with its error, by each model."""
    for figure, unit in UNITS.items():
        by_model = {
            d.model: d for d in verification.differences if (d.figure, d.reference) == (figure, reference)
        }
        if by_model:
            first = next(iter(by_model.values()))
            whole = f"{first.reference_value:.4g} ± {100 * first.reference_error:.2g} %"
            yield figure, unit, whole, *(_against(by_model.get(model.label)) for model in verification.models)


def _against(difference: Difference | None) -> str:
    if difference is None:
        return ""
    return f"{difference.value:.4g} ({100 * difference.difference:+.1f} %)"
