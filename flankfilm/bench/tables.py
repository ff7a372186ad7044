"""A measurement as tables: for the terminal, as CSV, and as one JSON file that can be read back."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter

from flankfilm.bench.measuring import CaseResult, Row, gain
from flankfilm.bench.run import Bench
from flankfilm.output.files import write_csv, write_text

if TYPE_CHECKING:
    from rich.table import Table


ROUNDING = 1e-14
"""True errors below this are rounding, which no estimate is about."""


@dataclass(frozen=True)
class Summary:
    """One quantity along one series.

    Attributes
    ----------
    title, series, quantity : str
        What it is of.
    errors, seconds : (float, float)
        True error and processor time of the coarsest and of the finest level.
    gain : float
        Factor of processor time for a tenth of the error; NaN where too few levels can be compared.
    ratios : (float, float)
        Minimum and maximum estimated over true error; NaN where there is no estimate.
    """

    title: str
    series: str
    quantity: str
    errors: tuple[float, float]
    seconds: tuple[float, float]
    gain: float
    ratios: tuple[float, float]


def summaries(cases: Sequence[CaseResult]) -> Iterator[Summary]:
    """Sum up every quantity along every series.

    Ratios are of levels whose true error the finest solution resolves: where it is at least three times what
    that one is itself estimated to be off by.
    """
    for case in cases:
        for series in dict.fromkeys(row.series for row in case.rows):
            rows = [row for row in case.rows if row.series == series]
            for quantity in dict.fromkeys(row.quantity for row in rows if row.quantity):
                quantity_rows = tuple(row for row in rows if row.quantity == quantity)
                ratios = list(known_ratios(case, quantity_rows))
                yield Summary(
                    case.title,
                    series,
                    quantity,
                    (quantity_rows[0].error, quantity_rows[-1].error),
                    (quantity_rows[0].cpu, quantity_rows[-1].cpu),
                    gain(quantity_rows),
                    (min(ratios, default=math.nan), max(ratios, default=math.nan)),
                )


def known_ratios(case: CaseResult, rows: Sequence[Row]) -> Iterator[float]:
    """Estimated over true errors, where the finest solution resolves the latter."""
    for row in rows:
        floor = case.finest_estimates.get(row.quantity, math.nan)
        floor = max(3.0 * floor, ROUNDING) if math.isfinite(floor) else ROUNDING
        if row.error > floor and math.isfinite(row.estimate):
            yield row.estimate / row.error


HEADS = ("work", "by", "error of", "true error", "time", "a tenth costs", "estimate / true")


def summary_cells(summary: Summary) -> tuple[str, ...]:
    """Text of a summary under `HEADS`."""

    def span(text: Callable[[float], str], ends: tuple[float, float]) -> str:
        return " to ".join(dict.fromkeys(map(text, ends[:1] if alone else ends)))

    alone = summary.errors[0] == summary.errors[1] and summary.seconds[0] == summary.seconds[1]
    return (
        summary.title,
        summary.series,
        summary.quantity,
        span(number, summary.errors),
        span(clock, summary.seconds),
        "" if math.isnan(summary.gain) else f"x {summary.gain:.2g}",
        "" if math.isnan(summary.ratios[0]) else span(_ratio, summary.ratios),
    )


def _ratio(value: float) -> str:
    return f"{value:.0f}" if value >= 10.0 else f"{value:.2g}"


def number(value: float) -> str:
    """Error in two digits; a dash where there is none."""
    return f"{value:.1e}" if math.isfinite(value) else "-"


def clock(seconds: float) -> str:
    """Time in the unit that suits it."""
    if not math.isfinite(seconds):
        return "-"
    for factor, unit in ((1e6, "µs"), (1e3, "ms")):
        if factor * seconds < 1000.0:
            return f"{factor * seconds:.3g} {unit}"
    return f"{seconds:.3g} s"


def terminal(bench: Bench) -> Table:
    """Tabulate the summaries for the terminal."""
    from rich import box
    from rich.table import Table

    title = f"processor time on {bench.machine.processor}, minimum of {bench.repeat} or more"
    shown = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD)
    for place, head in enumerate(HEADS):
        shown.add_column(head, justify="left" if place < 3 else "right", no_wrap=place >= 3)
    for summary in summaries(bench.cases):
        shown.add_row(*summary_cells(summary))
    return shown


def remarks(bench: Bench) -> list[str]:
    """Lines for the terminal on everything that has no figures, each once."""
    lines = [f"{peer.peer}: {peer.failure}" for peer in bench.peers if peer.failure]
    lines += [f"first call of {call.solver}: {call.failure}" for call in bench.first_calls if call.failure]
    for case in bench.cases:
        lines += [
            f"{case.title}, {row.series}, {row.level}: {row.failure}" for row in case.rows if row.failure
        ]
    return list(dict.fromkeys(lines))


def write_tables(bench: Bench, folder: Path) -> list[Path]:
    """Write ``bench.json`` with everything, and CSV files of rows, first calls and peers."""
    tables: dict[str, Sequence[Any]] = {
        "error_against_cost": [row for case in bench.cases for row in case.rows],
        "first_calls": bench.first_calls,
        "peers": bench.peers,
    }
    paths = [folder / "bench.json"]
    # JSON has no NaN: null stands for it
    write_text(paths[0], TypeAdapter(Bench).dump_json(bench, indent=1).decode() + "\n")
    for name, records in tables.items():
        if records:
            paths.append(folder / f"{name}.csv")
            columns = {_with_unit(f): [getattr(r, f) for r in records] for f in vars(records[0])}
            write_csv(paths[-1], columns)
    return paths


def _with_unit(name: str) -> str:
    timed = ("cpu", "wall", "median", "first", "kept", "nothing_kept", "again")
    return f"{name}_s" if name in timed else name


def read_bench(path: Path) -> Bench:
    """Read a ``bench.json`` back."""

    def with_nan(held: dict[str, Any]) -> dict[str, Any]:
        return {name: math.nan if value is None else value for name, value in held.items()}

    text = path.read_text(encoding="utf-8")
    return TypeAdapter(Bench).validate_python(json.loads(text, object_hook=with_nan))
