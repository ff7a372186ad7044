"""Studies over random pairs: rows of a file, to which a study that was cut off goes on, and ratios in a table."""

from __future__ import annotations

import json
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from base import Array, Booleans, FlankfilmError

__all__ = ["Row", "begin", "pair_by_pair", "quantiles"]

Row = dict[str, Any]
"""What a study keeps of a pair: its number and seed, and its figures or its fault."""


def begin(study: Callable[[Path, int, int, float], None], pairs: int, seed: int) -> None:
    """Call a study with the words of its command: FILE [pairs] [seed] [seconds]."""
    warnings.simplefilter("ignore")
    file, *given = sys.argv[1:]
    asked = [float(word) for word in given]
    chosen = int(asked[1]) if len(asked) > 1 else seed
    study(Path(file), int(asked[0]) if asked else pairs, chosen, asked[2] if len(asked) > 2 else np.inf)


def pair_by_pair(
    file: Path,
    pairs: int,
    seed: int,
    seconds: float,
    figures: Callable[[int, int], Row],
    said: Callable[[Row], object],
) -> list[Row] | None:
    """Rows of all pairs, each in the file as soon as it is known; None where the time was over before.

    Parameters
    ----------
    file : Path
        A line a pair; those that are there are not computed again.
    pairs, seed : int
    seconds : float
        After which no further pair begins [s].
    figures : callable
        Of a number and a seed.
    said : callable
        What is printed of figures.
    """
    began = time.monotonic()
    rows = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []
    known = {(row["seed"], row["number"]) for row in rows}
    for number in range(pairs):
        if (seed, number) in known:
            continue
        if time.monotonic() - began > seconds:
            print(f"{len(rows)} of {pairs} pairs: run it again to go on")
            return None
        try:
            row = figures(number, seed)
        except FlankfilmError as fault:
            row = {"fault": f"{type(fault).__name__}: {fault}"[:300]}
        row |= {"seed": seed, "number": number}
        rows.append(row)
        with file.open("a") as kept:
            kept.write(json.dumps(row) + "\n")
        about = [row.get(name) for name in ("teeth", "overlap", "model") if name in row]
        print(number, *about, row.get("fault") or said(row), row.get("seconds"), flush=True)
    return rows


def quantiles(ratios: Array, small: Booleans) -> str:
    """Columns of ratios of reported and true errors: quantiles, shares between .5 and 5, and those outside.

    Parameters
    ----------
    ratios : (pairs,) array
    small : (pairs,) array of bool
        Where a true error is so small that care costs nothing.
    """
    columns = " ".join(f"{v:7.2f}" for v in np.percentile(ratios, [0, 5, 50, 95, 100]))
    inside = (ratios >= 0.5) & (ratios <= 5.0)
    harmless = small & (ratios > 5.0)
    shares = f"{100 * inside.mean():4.0f} % {100 * (inside | harmless).mean():4.0f} %"
    return f"{columns} {shares} {np.sum(ratios < 0.5):4} {np.sum((ratios > 5.0) & ~small):4}"
