"""What a run writes as data: one netCDF file with everything, one CSV for each curve."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.output.convergence import with_convergence
from flankfilm.output.files import provenance, write_csv, write_netcdf
from flankfilm.output.geometry import geometry_columns
from flankfilm.output.tables import column_errors, columns, uncertainties
from flankfilm.output.variables import joined, merged, with_tolerance
from flankfilm.plan.decisions import decisions
from flankfilm.products.catalogue import PRODUCTS
from flankfilm.stages.computed import Computed

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.stages.failures import Failure


def not_computed(failures: Sequence[Failure]) -> dict[str, str]:
    """Attribute that says which parts of a scene could not be computed, and why."""
    return {"not_computed_json": json.dumps([failure.plain() for failure in failures])}


def results_dataset(computed: Computed) -> xr.Dataset:
    """Give everything that a run found as one dataset: what ``results.nc`` holds and figures are drawn from.

    Parts that could not be computed have no variables, and the dataset says why.
    """
    scene = computed.scene
    attributes = {
        "title": scene.title,
        "decisions_json": json.dumps([decision.plain() for decision in decisions(computed.values)]),
        **not_computed(computed.failures),
        **provenance(scene.model_dump_json()),
    }
    whole = merged((part for product in PRODUCTS for part in product.variables(computed)), attributes)
    solved = {prefix: computed.get(stage) for product in PRODUCTS for prefix, stage in product.solved.items()}
    return with_tolerance(with_convergence(whole, solved), scene.tolerance)


def results_tables(data: xr.Dataset) -> dict[str, dict[str, Any]]:
    """Columns of the CSV files by name: one table for each curve."""
    tables = {
        file: columns(data, table.prefix, table.names, table.axis)
        for product in PRODUCTS
        for file, table in product.tables.items()
        if joined(table.prefix, table.about) in data.variables
    }
    said = [
        row
        for product in PRODUCTS
        for file, table in product.tables.items()
        if file in tables
        for row in column_errors(data, file, table.prefix, table.names, table.axis)
    ]
    if said:
        tables["columns"] = {
            head: np.array([row[head] for row in said], dtype=np.object_) for head in said[0]
        }
    errors: dict[str, Any] = uncertainties(data)
    if errors["variable"].size:
        tables["uncertainties"] = errors
    return {"geometry": geometry_columns(data), **tables} if "dimensions_span" in data else tables


def write_data(folder: Path, data: xr.Dataset) -> list[Path]:
    """Write ``results.nc`` and the CSV files; return what was written."""
    write_netcdf(folder / "results.nc", data)
    files = [folder / "results.nc"]
    for name, table in results_tables(data).items():
        files.append(folder / "csv" / f"{name}.csv")
        write_csv(files[-1], table)
    return files
