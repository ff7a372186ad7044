"""Tables of a verification, for the terminal and for CSV files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from flankfilm.coupling.mesh.verification import Curves, Verification
from flankfilm.output.files import provenance, write_csv
from flankfilm.output.records import comparison
from flankfilm.output.variables import identifier, merged

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    import xarray as xr
    from rich.table import Table

    from flankfilm.coupling import FaceLoadModels
    from flankfilm.scene import Scene


def table(verification: Verification, reference: Curves) -> Table:
    """Tabulate every model against one reference: a row for each figure."""
    from flankfilm.figures.reading import unit_text
    from flankfilm.verification.page import compared, compared_with

    name = reference.label
    heads = "figure", "unit", "finite elements", *(model.label for model in verification.models)
    rows = ((figure, unit_text(unit), *cells) for figure, unit, *cells in compared(verification, name))
    return _laid_out(f"against {compared_with(verification, name)}", heads, rows)


def face_table(models: FaceLoadModels) -> Table:
    """Tabulate the load over the face by every model: a row for each."""
    from flankfilm.report.face_parts import models_table

    laid = models_table(models)
    return _laid_out("load over the face", laid.heads, laid.rows)


def _laid_out(title: str, heads: Iterable[str], rows: Iterable[Sequence[str]]) -> Table:
    """Table for the terminal; all but words to the right."""
    from rich import box
    from rich.table import Table

    shown = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD)
    first, *others = heads
    shown.add_column(first, no_wrap=True)
    for head in others:
        shown.add_column(head, justify="left" if head == "unit" else "right")
    for row in rows:
        shown.add_row(*row)
    return shown


def costs(verification: Verification) -> str:
    """What each model cost."""
    each = ", ".join(
        f"{c.label} {1e3 * c.cost.seconds:.1f} ms" for c in (*verification.references, *verification.models)
    )
    return f"finite elements {verification.cost.seconds:.2f} s once, then {each}"


def dataset(verification: Verification, scene: Scene) -> xr.Dataset:
    """Curves of every closed form and of finite elements as one dataset.

    Parameters
    ----------
    verification : Verification
    scene : Scene
        That was verified.
    """
    return merged(
        comparison("verify", verification), {"title": scene.title, **provenance(scene.model_dump_json())}
    )


def _column(name: str, verification: Verification) -> list[Any]:
    """One figure of all differences, in per cent where its name says so."""
    values = [getattr(difference, name.removesuffix("_percent")) for difference in verification.differences]
    return [100 * value for value in values] if name.endswith("_percent") else values


def write_tables(verification: Verification, folder: Path) -> list[Path]:
    """Write curves and differences as CSV files; return these."""
    names = "figure unit reference reference_value reference_error_percent model value difference_percent"
    curves = {
        identifier(c.label): c
        for c in (*verification.references, *verification.models)
        if c.single_stiffness.size
    }
    files: dict[str, dict[str, Any]] = {
        "verify": {name: _column(name, verification) for name in names.split()},
        "verify_one_pair": {
            "travel_from_A_mm": 1e3 * (verification.rho1 - verification.pair.points.A),
            **{f"{name}_N_per_m": curve.single_stiffness for name, curve in curves.items()},
        },
        "verify_mesh": {
            "position": verification.position,
            **{f"{name}_N_per_m": curve.secant_stiffness for name, curve in curves.items()},
            **{
                f"{name}_transmission_error_um": 1e6 * curve.transmission_error
                for name, curve in curves.items()
            },
        },
    }
    if (over := verification.over_face) is not None:
        files["verify_face"] = {
            "model": list(over.model),
            "face_load_factor": over.face_load_factor,
            "face_load_factor_error_percent": 100 * over.face_load_factor_error,
            "pitch_point_factor": over.pitch_point_factor,
            "difference_percent": 100 * over.factor_difference,
            "line_load_difference_percent": 100 * over.line_load_difference,
        }
        files["verify_line_load"] = {
            "face_position_mm": 1e3 * over.face_position,
            **{
                f"{identifier(model)}_N_per_mm": 1e-3 * load
                for model, load in zip(over.model, over.line_load, strict=True)
            },
        }
    paths = []
    for name, content in files.items():
        paths.append(folder / f"{name}.csv")
        write_csv(paths[-1], content)
    return paths
