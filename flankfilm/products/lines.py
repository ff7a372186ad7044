"""Load along the lines of contact of a helical pair: line load, pressure, axial force, centre of the load."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Unpack

import fem
from flankfilm.output.uncertainty import uncertainty
from flankfilm.output.variables import of_record
from flankfilm.products.output import Held, Named, Take, figure_of_kind, holds_error, output_of
from flankfilm.products.product import CurveTable, Product, ranked
from flankfilm.report import line_parts
from flankfilm.report.page import Headline, Part
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import DRY_CYCLE

if TYPE_CHECKING:
    import xarray as xr

SPUR = "{}; nan of spur pairs"


def _of(cycle: Any) -> fem.LineLoads | None:
    """Lines of contact of a mesh cycle; None of spur pairs, and of closed forms."""
    return None if cycle is None or cycle.contact is None else cycle.contact.lines


def variables(computed: Computed) -> Iterator[xr.Dataset]:
    """Line loads of the mesh cycle."""
    if (loads := _of(computed.get(DRY_CYCLE))) is not None:
        yield of_record("dry_lines", loads)


def headlines(computed: Computed) -> Iterator[Headline]:
    """Line-load factor, maximum line load and axial force."""
    if (loads := _of(computed.get(DRY_CYCLE))) is not None:
        yield from ranked(line_parts.headlines(loads), 1)


def sections(computed: Computed, results: xr.Dataset) -> Iterator[Part]:
    """Maps of the flanks, the centre of the load and the factor over the mesh cycle."""
    cycle = computed.get(DRY_CYCLE)
    if cycle is not None and cycle.contact is not None and cycle.contact.lines is not None:
        yield line_parts.lines(cycle.contact.lines, results, cycle.contact.beyond_path)


def _output(name: str, figure: str, take: Take = float, said: str = SPUR, **held: Unpack[Held]) -> Named:
    """Figure of the lines of contact."""

    def value(engine: Engine) -> Any:
        loads = _of(engine[DRY_CYCLE])
        return None if loads is None else take(getattr(loads, figure))

    def error(engine: Engine) -> float | None:
        loads = _of(engine[DRY_CYCLE])
        return None if loads is None else uncertainty(loads, figure).numerical

    known = take is float and holds_error(fem.LineLoads, figure)
    about = figure_of_kind(fem.LineLoads, figure)
    return output_of(name, about, "stiffness", value, said, error if known else None, **held)


def _travel(centre: Any) -> float:
    return float(centre.max() - centre.min())


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    return (
        _output("line_load_factor", "greatest_line_load_factor", error_output="line_load_factor_error"),
        _output("line_load_factor_error", "error"),
        _output("greatest_line_load_on_lines", "greatest_line_load", error_output="line_load_on_lines_error"),
        _output("line_load_on_lines_error", "line_load_error"),
        _output(
            "load_centre_travel",
            "load_centre",
            _travel,
            "travel of the centre of the load along the face over the mesh cycle; nan of spur pairs",
        ),
    )


PRODUCT = Product(
    name="load along the lines of contact",
    variables=variables,
    tables={
        "line_loads_dry": CurveTable(
            "dry_lines", "line_load", ("z", "travel", "length", "line_load", "hertz_pressure", "gap")
        ),
        "lines_over_cycle": CurveTable(
            "dry_lines",
            "load_centre",
            ("load_centre", "tilting_moment", "whole_length", "maximum_line_load", "line_load_factor"),
        ),
        "shafts_under_lines": CurveTable(
            "dry_lines",
            "shaft_deflection",
            (
                "shaft_transmission_error",
                "tilt_transmission_error",
                "shaft_deflection",
                "shaft_misalignment",
            ),
        ),
    },
    headlines=headlines,
    pictures=line_parts.PICTURES,
    sections=sections,
    outputs=outputs,
)
