"""Tables of a verification, for the terminal and for CSV files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.dataset import write_csv
from flankfilm.verify.compare import UNITS, Difference, Verification
from flankfilm.verify.models import Curves

if TYPE_CHECKING:
    from rich.table import Table


def table(found: Verification, reference: Curves) -> Table:
    """Tabulate every model against one reference: a row for each figure."""
    from rich import box
    from rich.table import Table

    models = [model.label for model in found.models]
    told = reference.label
    shown = Table(
        title=f"against finite elements, {told}" if reference.left_out else f"against {told}",
        title_justify="left",
        box=box.SIMPLE_HEAD,
    )
    shown.add_column("figure", no_wrap=True)
    shown.add_column("unit")
    shown.add_column("finite elements", justify="right")
    for label in models:
        shown.add_column(label, justify="right")
    for figure, unit in UNITS.items():
        by_model = {d.model: d for d in found.differences if (d.figure, d.reference) == (figure, told)}
        if not by_model:
            continue
        first = next(iter(by_model.values()))
        shown.add_row(
            figure,
            unit,
            f"{first.reference_value:.4g} ± {100 * first.reference_error:.2g} %",
            *(_cell(by_model.get(label)) for label in models),
        )
    return shown


def _cell(difference: Difference | None) -> str:
    if difference is None:
        return ""
    return f"{difference.value:.4g} ({100 * difference.difference:+.1f} %)"


def costs(found: Verification) -> str:
    """Tell what each model cost."""
    told = [f"finite elements {found.compliance_seconds:.2f} s once, then"]
    told.append(", ".join(f"{c.label} {1e3 * c.seconds:.1f} ms" for c in (*found.references, *found.models)))
    return " ".join(told)


def write_verification(found: Verification, folder: Path) -> list[Path]:
    """Write the differences and the curves as CSV, and the figure; return the files."""
    from flankfilm.figures.style import save
    from flankfilm.figures.verification import verification

    picture = folder / "verify.svg"
    save(verification(found), picture)
    return [*_write_tables(found, folder), picture]


def _write_tables(found: Verification, folder: Path) -> list[Path]:
    names = ("figure", "unit", "reference", "reference_value", "reference_error_percent", "model", "value")
    columns: dict[str, Any] = {
        name: [getattr(d, name) for d in found.differences] for name in names if not name.endswith("percent")
    }
    columns["reference_error_percent"] = [100 * d.reference_error for d in found.differences]
    columns["difference_percent"] = [100 * d.difference for d in found.differences]
    ordered = {name: columns[name] for name in (*names, "difference_percent")}
    all_curves = [c for c in (*found.references, *found.models) if c.single.size]
    files = {
        "verify": ordered,
        "verify_one_pair": {
            "travel_from_A_mm": 1e3 * (found.rho1 - found.pair.points.A),
            **{f"{_identifier(c.label)}_N_per_m": c.single for c in all_curves},
        },
        "verify_mesh": {
            "phase": found.phase,
            **{f"{_identifier(c.label)}_N_per_m": c.secant for c in all_curves},
            **{
                f"{_identifier(c.label)}_transmission_error_um": 1e6 * np.asarray(c.transmission_error)
                for c in all_curves
            },
        },
    }
    paths = []
    for name, content in files.items():
        paths.append(folder / f"{name}.csv")
        write_csv(paths[-1], content)
    return paths


def _identifier(label: str) -> str:
    words = "".join(c if c.isalnum() else " " for c in label.lower()).split()
    return "_".join(words)
