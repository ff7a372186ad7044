"""Quantiles of the outputs of a sampled study: what a share of the drawn rows stays below."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from base import Array
from flankfilm.output.files import write_csv

if TYPE_CHECKING:
    import xarray as xr

QUANTILES = "quantiles.csv"
"""File of the quantiles."""

SHARES = (0.01, 0.05, 0.5, 0.95, 0.99)
"""Shares of the rows that stay below a quantile."""

FEWEST = 16
"""Rows below which a sampled study has no quantiles."""


class OutputQuantiles(NamedTuple):
    """Quantiles of one output.

    Attributes
    ----------
    name : str
    rows : int
        Rows that have the output.
    values : ndarray
        At `SHARES`.
    changes : ndarray
        What half as many rows, the first ones, change of them.
    """

    name: str
    rows: int
    values: Array
    changes: Array


def quantiles(data: xr.Dataset, outputs: Sequence[str]) -> Iterator[OutputQuantiles]:
    """Quantiles of outputs over the rows that have them, straight between ordered rows.

    The first half of a Sobol sequence is one itself, so that half as many rows give an estimate of the error by
    sampling. It contains no error of the rows, nor one of the distribution that was drawn.

    Parameters
    ----------
    data : xarray.Dataset
        What ``study.nc`` holds.
    outputs : sequence of str

    Examples
    --------
    >>> import xarray as xr
    >>> data = xr.Dataset({"S_H": ("row", np.linspace(1.0, 2.0, 101))})
    >>> next(quantiles(data, ["S_H"])).values.round(3)
    array([1.01, 1.05, 1.5 , 1.95, 1.99])
    """
    for name in outputs:
        known = np.asarray(data[name].values, dtype=np.float64)
        half = known[: len(known) // 2]
        known, half = known[np.isfinite(known)], half[np.isfinite(half)]
        if len(half) < FEWEST // 2:
            continue
        values = np.quantile(known, SHARES)
        yield OutputQuantiles(name, len(known), values, np.abs(np.quantile(half, SHARES) - values))


def sampled(design: str, rows: int) -> bool:
    """Whether a study draws rows, and enough of them."""
    return design in ("latin-hypercube", "sobol") and rows >= FEWEST


def write_quantiles(folder: Path, data: xr.Dataset, outputs: Sequence[str]) -> Path:
    """Write ``quantiles.csv``: a line for each output, quantiles and what half as many rows change of them."""
    summaries = list(quantiles(data, outputs))
    columns: dict[str, Array] = {
        "output": np.array([output.name for output in summaries], dtype=np.object_),
        "rows": np.array([output.rows for output in summaries]),
    }
    for place, share in enumerate(SHARES):
        name = f"quantile_{100 * share:g}_percent"
        columns[name] = np.array([output.values[place] for output in summaries])
        columns[f"{name}_change_with_half_the_rows"] = np.array(
            [output.changes[place] for output in summaries]
        )
    write_csv(folder / QUANTILES, columns)
    return folder / QUANTILES
