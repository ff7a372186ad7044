"""Error against cost: true errors and estimates of every case, and of all solvers together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.figures.panels import plain_ticks
from flankfilm.figures.style import COLOURS, sheet

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from flankfilm.bench.measuring import CaseResult, Row
    from flankfilm.bench.peers import PeerRow

__all__ = ["error_against_cost", "estimates", "overview"]

LEAST = 1e-16
"""Errors below the rounding of one number are drawn here."""

NARROW = 6.0
"""Smallest ratio of the ends of an axis: two of the ticks at 1, 2 and 5 stand in it."""

MARKS = "osD^vP*"
PEER_MARKS = "xX1+"
THEORY = "theory, order"
"""Begins the label of a line with the order that theory has."""

TOO_SMALL = "#f8e6d8"
"""Shade of the half in which estimates are below the error."""

GREY: dict[str, Any] = {"color": "#888888", "linewidth": 1.0}


def error_against_cost(case: CaseResult, peers: Sequence[PeerRow] = ()) -> Figure:
    """Draw a case: a row of panels for each quantity, over processor time and over resolution.

    Filled marks are true errors, open ones the solver's own estimates. The grey dotted line is what the finest
    solution itself is estimated to be off by: true errors near it or below are not known better.
    """
    groups = _groups(case.rows)
    options: dict[str, Any] = {"width": 7.4, "height": 0.9 + 2.6 * len(groups), "sharey": "row"}
    with sheet(None, len(groups), 2, legend=0, **options) as (drawn, panels):
        for over_time, over_size, quantities in zip(panels[::2], panels[1::2], groups, strict=True):
            rows = [r for r in case.rows if r.quantity in quantities and not r.failure]
            for place, name in enumerate(dict.fromkeys(r.series for r in case.rows if r.quantity)):
                series = [r for r in rows if r.series == name]
                _series(over_time, [r.cpu for r in series], series, place, name)
                _series(over_size, [r.size for r in series], series, place)
            _peers(over_time, [p for p in peers if p.quantity in quantities and not p.failure])
            _slope(over_size, rows, case.orders)
            known = [e for q, e in case.finest_estimates.items() if q in quantities and e > 0]
            for axes in (over_time, over_size):
                if known:
                    axes.axhline(max(known), **GREY, linestyle=":")
                axes.set(xscale="log", yscale="log")
                _ticks(axes)
            what = quantities[0] if len(quantities) == 1 else "each mean"
            over_time.set(xlabel="processor time [s]", ylabel=f"relative error [-]\n{what}")
            over_size.set(xlabel=f"{case.size_name} [-]")
        _legend(drawn, panels, any(estimate > 0 for estimate in case.finest_estimates.values()))
    return drawn


def _groups(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    """Quantities that share a row of panels: all where each series has one, else each alone."""
    pairs = {(r.series, r.quantity) for r in rows if r.quantity}
    quantities = tuple(dict.fromkeys(r.quantity for r in rows if r.quantity))
    alone = len(pairs) == len(quantities) == len({series for series, _ in pairs})
    return [quantities] if alone and quantities else [(q,) for q in quantities] or [("",)]


def _series(axes: Axes, at: Sequence[float], rows: Sequence[Row], place: int, label: str = "") -> None:
    look = _look(place)
    axes.plot(at, _drawn(rows, "error"), "-", **look, label=label or None)
    guess = [max(r.estimate, LEAST) if r.estimate > 0 else math.nan for r in rows]
    if np.isfinite(guess).any():
        axes.plot(at, guess, "--", **{**look, "markerfacecolor": "white"})


def _look(place: int) -> dict[str, Any]:
    """Mark and colour of one of several curves; marks are open where colours begin again."""
    mark, colour = MARKS[place % len(MARKS)], COLOURS[place % len(COLOURS)]
    again = {"markerfacecolor": "none"} if place >= min(len(MARKS), len(COLOURS)) else {}
    return {"marker": mark, "color": colour, "markersize": 5, **again}


def _drawn(rows: Sequence[Row | PeerRow], name: str) -> list[float]:
    """Errors of one name in the form that is drawn."""
    return [max(getattr(row, name), LEAST) for row in rows]


def _peers(axes: Axes, peers: Sequence[PeerRow]) -> None:
    for place, name in enumerate(dict.fromkeys(p.peer for p in peers)):
        rows = [p for p in peers if p.peer == name]
        mark, label = PEER_MARKS[place % len(PEER_MARKS)], f"{name} {rows[0].version}"
        look: dict[str, Any] = {"marker": mark, "color": "black", "linewidth": 1.0, "markersize": 6}
        axes.plot([p.cpu for p in rows], _drawn(rows, "error"), "-.", **look, label=label)


def _slope(axes: Axes, rows: Sequence[Row], orders: dict[str, float]) -> None:
    """Draw theory's order below the true errors, over the sizes of the first series that has one."""
    rated = [r for r in rows if r.quantity in orders and math.isfinite(r.size) and r.error > 0]
    series = [r for r in rated if r.series == rated[0].series]
    if len(series) < 2:
        return
    order = orders[series[0].quantity]
    size = np.array([min(r.size for r in series), max(r.size for r in series)])
    coarsest = min(series, key=lambda r: r.size)
    line = 0.4 * coarsest.error * (size / coarsest.size) ** -order
    axes.plot(size, line, **GREY, label=f"{THEORY} {order:g}")


def _ticks(axes: Axes) -> None:
    """Give an axis of less than two decades room, and ticks at 1, 2 and 5 that carry plain numbers."""
    low, high = axes.get_xlim()
    if high > 100.0 * low:
        return
    if high < NARROW * low:
        middle, half = math.sqrt(low * high), math.sqrt(NARROW)
        axes.set_xlim(middle / half, middle * half)
    plain_ticks(axes.xaxis)


def _legend(drawn: Figure, panels: Sequence[Axes], finest: bool) -> None:
    """List the curves row by row, then what lines and marks mean; of these what is drawn alone."""
    from matplotlib.lines import Line2D

    entries: dict[str, Artist] = {}
    for axes in panels:
        handles, labels = axes.get_legend_handles_labels()
        entries |= zip(labels, handles, strict=True)
    orders = {
        label.removeprefix(THEORY): entries.pop(label) for label in [*entries] if label.startswith(THEORY)
    }
    error: dict[str, Any] = {"color": "#444444", "marker": "o", "markersize": 5}
    entries["true error"] = Line2D([], [], **error)
    if any(line.get_markerfacecolor() == "white" for axes in panels for line in axes.lines):
        entries["own estimate"] = Line2D([], [], **error, linestyle="--", markerfacecolor="white")
    if finest:
        entries["estimate of the finest"] = Line2D([], [], **GREY, linestyle=":")
    if orders:
        entries[f"{THEORY}{' and'.join(orders)}"] = next(iter(orders.values()))
    columns = 2 if max(map(len, entries)) > 28 else 3
    labels = [label for column in range(columns) for label in [*entries][column::columns]]
    handles = [entries[label] for label in labels]
    drawn.legend(handles, labels, loc="outside upper left", ncols=columns, handlelength=2.6)


def estimates(cases: Sequence[CaseResult]) -> Figure:
    """Draw estimated over true errors of all cases; above the diagonal an estimate is on the safe side.

    Marks are open, so that those beneath are seen; the shaded half has estimates that are too small.
    """
    with sheet(width=6.2, height=6.0, legend=4) as (drawn, (axes,)):
        values = []
        for place, (solver, own) in enumerate(_by_solver(cases)):
            rows = [r for c in own for r in c.rows if r.estimate > 0]
            error, guess = _drawn(rows, "error"), _drawn(rows, "estimate")
            values += error + guess
            look = {**_look(place), "markerfacecolor": "none"}
            axes.plot(error, guess, linestyle="", **look, label=solver if rows else None)
        span = [0.5 * min(values, default=1e-6), 2.0 * max(values, default=1.0)]
        axes.fill_between(span, span, span[0], color=TOO_SMALL, linewidth=0.0, label="too small", zorder=0)
        for factor, line, name in ((1.0, "-", "estimate = error"), (10.0, ":", "ten times the error")):
            axes.plot(span, [factor * v for v in span], line, **GREY, label=name)
        axes.set(xscale="log", yscale="log", xlim=span, ylim=span, aspect="equal")
        axes.set(xlabel="true relative error [-]", ylabel="estimated relative error [-]")
    return drawn


def _by_solver(cases: Sequence[CaseResult]) -> list[tuple[str, list[CaseResult]]]:
    return [(s, [c for c in cases if c.solver == s]) for s in dict.fromkeys(c.solver for c in cases)]


def overview(cases: Sequence[CaseResult]) -> Figure:
    """Draw true error over processor time of one work of each solver: its first case, series and quantity."""
    with sheet(width=7.4, height=5.2, legend=2) as (drawn, (axes,)):
        for place, (solver, own) in enumerate(_by_solver(cases)):
            rows = [r for r in own[0].rows if not r.failure and np.isfinite(r.error)]
            if not rows:  # what only costs time has no true error
                continue
            rows = [r for r in rows if (r.series, r.quantity) == (rows[0].series, rows[0].quantity)]
            label = f"{solver}: {rows[0].quantity}"
            axes.plot([r.cpu for r in rows], _drawn(rows, "error"), "-", **_look(place), label=label)
        axes.set(xscale="log", yscale="log", xlabel="processor time [s]", ylabel="true relative error [-]")
    return drawn
