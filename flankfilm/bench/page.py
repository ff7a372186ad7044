"""The report of a measurement: one page with every figure and table."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any

from flankfilm.bench import pictures as figures
from flankfilm.bench.machine import busy
from flankfilm.bench.measuring import CaseResult
from flankfilm.bench.peers import PeerRow
from flankfilm.bench.run import Bench
from flankfilm.bench.tables import HEADS, clock, known_ratios, number, summaries, summary_cells
from flankfilm.figures.style import to_svg
from flankfilm.output.files import write_text
from flankfilm.report.page import Drawing, Fact, Head, Headline, Part, Table, render

LEAD = (
    "Processor time and relative error of every solver on this machine: true errors against the finest solution, "
    "beside the solvers' own estimates."
)


def write_page(bench: Bench, folder: Path) -> list[Path]:
    """Write every figure as SVG, and ``report.html``; return the files."""
    paths = []
    compared = [case for case in bench.cases if case.finest]
    drawn = {"overview": figures.overview(compared), "estimates": figures.estimates(compared)}
    of_case = {case.key: figures.error_against_cost(case, _of(case, bench.peers)) for case in compared}
    svg = {name: to_svg(figure, name) for name, figure in (drawn | of_case).items()}
    for name, text in svg.items():
        paths.append(folder / f"{name}.svg")
        write_text(paths[-1], text)
    parts = [
        _overview(bench, svg),
        *(_case(case, svg[case.key], _of(case, bench.peers)) for case in compared),
        *(_work(case) for case in bench.cases if not case.finest),
        _first_calls(bench),
        *([_peers(bench.peers)] if bench.peers else []),
        _machine(bench),
    ]
    paths.append(folder / "report.html")
    write_text(paths[-1], render(Head("Error against cost", [Fact(LEAD)], _headlines(bench)), parts))
    return paths


Columns = Mapping[str, Callable[[Any], str]]
"""Head of a column to the text of its cell."""


def _table(records: Sequence[Any], columns: Columns) -> Table:
    return Table(
        tuple(columns), tuple(tuple(text(record) for text in columns.values()) for record in records)
    )


def _number(value: float) -> str:
    return _whole(number(value))


def _clock(seconds: float) -> str:
    return _whole(clock(seconds))


def _size(case: CaseResult) -> Columns:
    return {case.size_name: lambda row: f"{row.size:.5g}" if math.isfinite(row.size) else ""}


TIMES: Columns = {
    "time": lambda row: _clock(row.cpu),
    "median": lambda row: _clock(row.median),
    "wall": lambda row: _clock(row.wall),
    "runs": lambda row: str(row.repeats),
}


def _whole(text: str) -> str:
    """Text of one number and unit that is not broken between lines."""
    return text.replace("-", "\u2011").replace(" ", "\u00a0")


def _overview(bench: Bench, svg: Mapping[str, str]) -> Part:
    text = (
        "The works differ; what can be compared is how fast errors fall. A tenth of the error costs the factor in the "
        "table, from a straight line through the levels that none of the others beats. Estimate over true error: above "
        "1 the estimate was on the safe side; only levels whose true error is at least three times the estimate of the "
        "finest solution count."
    )
    drawings = (
        Drawing(svg["overview"], "True error over processor time, one work of each solver."),
        Drawing(svg["estimates"], "Estimated over true errors: above the line, the safe side."),
    )
    return Part("overview", "All solvers", (text,), drawings, (_summary(bench),))


def _summary(bench: Bench) -> Table:
    rows = []
    for summary in summaries(bench.cases):
        *words, error, time, gain, ratio = summary_cells(summary)
        spans = (" to ".join(_whole(end) for end in text.split(" to ")) for text in (error, time))
        rows.append((*words, *spans, _whole(gain), _whole(ratio)))
    return Table(HEADS, tuple(rows))


def _of(case: CaseResult, peers: Sequence[PeerRow]) -> list[PeerRow]:
    return [peer for peer in peers if peer.case == case.key]


def _headlines(bench: Bench) -> list[Headline]:
    ratios = [ratio for case in bench.cases for ratio in known_ratios(case, case.rows)]
    rows = [row for case in bench.cases for row in case.rows]
    failures = sum(bool(row.failure) for row in rows)
    entries = [
        Headline("measured", f"{len(bench.cases)} works", f"{len(rows)} rows in {bench.seconds:.0f} s"),
        Headline("machine", bench.machine.processor, f"{bench.machine.cores} cores"),
    ]
    if ratios:
        safe = sum(ratio >= 0.9 for ratio in ratios)
        note = f"median {median(ratios):.2g}, minimum {min(ratios):.2g}"
        entries.append(Headline("estimates of 0.9 times the error or more", f"{safe} of {len(ratios)}", note))
    if failures:
        entries.append(Headline("levels without figures", str(failures), "reasons in the tables"))
    return entries


def _case(case: CaseResult, svg: str, peers: Sequence[PeerRow]) -> Part:
    finest = ", ".join(
        f"{quantity}: {number(e) if math.isfinite(e) else 'unknown'}"
        for quantity, e in case.finest_estimates.items()
    )
    against = f"True errors against {case.finest}; its own estimated error: {finest}."
    columns: Columns = {
        "series": lambda row: row.series,
        "level": lambda row: row.level,
        **_size(case),
        **TIMES,
        "of": lambda row: row.failure or row.quantity,
        "true": lambda row: _number(row.error),
        "estimate": lambda row: _number(row.estimate),
    }
    caption = "Filled: true error. Open: the solver's own estimate."
    if peers:
        caption += " Black: other programs."
    drawing = Drawing(svg, caption)
    return Part(case.key, case.title, (case.work, against), (drawing,), (_table(case.rows, columns),))


def _work(case: CaseResult) -> Part:
    """Work whose time alone is measured."""
    columns: Columns = {
        "work": lambda row: row.series,
        **_size(case),
        **TIMES,
        "remark": lambda row: row.failure,
    }
    return Part(case.key, case.title, (case.work,), tables=(_table(case.rows, columns),))


def _first_calls(bench: Bench) -> Part:
    text = (
        "Processor time of the coarsest work of all cases of a solver in a separate process. A first call holds the "
        "start of Python, imports, and what the cases need beforehand; the first of all also compiles the kernels, "
        "which are then kept on disk. No time above holds any of this."
    )
    if bench.quick:
        text += " A quick run does not compile from nothing."
    columns: Columns = {
        "solver": lambda call: str(call.solver),
        "again": lambda call: _clock(call.again),
        "first call": lambda call: _clock(call.kept),
        "before it": lambda call: _clock(call.kept - call.again),
        "nothing kept": lambda call: _clock(call.nothing_kept),
        "compilation": lambda call: _clock(call.nothing_kept - call.kept),
        "remark": lambda call: str(call.failure),
    }
    tables = (_table(bench.first_calls, columns),)
    return Part("first-calls", "First calls and compilation", (text,), tables=tables)


def _peers(peers: Sequence[PeerRow]) -> Part:
    text = (
        "The same work by other programs in a separate environment; their processor time without imports and "
        "first calls."
    )
    columns: Columns = {
        "program": lambda peer: f"{peer.peer} {peer.version}".strip(),
        "setting": lambda peer: str(peer.level),
        "work": lambda peer: str(peer.case),
        "time": lambda peer: _clock(peer.cpu),
        "first call": lambda peer: _clock(peer.first),
        "true error": lambda peer: _number(peer.error),
        "remark": lambda peer: str(peer.failure or peer.note),
    }
    return Part("peers", "Other programs", (text,), tables=(_table(peers, columns),))


def _machine(bench: Bench) -> Part:
    cells = (*bench.machine.described(), ("load when it ended", busy(bench.load_after)))
    text = f"Minimum of {bench.repeat} or more runs of each level; {'quick' if bench.quick else 'complete'}."
    return Part("machine", "Machine and versions", (text,), tables=(Table(("", ""), cells),))
