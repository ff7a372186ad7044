"""Every number of the article's section 6 against ours.

Run it with:   python examples/motion/table.py
It prints the tables of docs/validation/article_motion.md; about half a minute.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from crises import CRISES, located
from events import EVENTS, WINDOWS, Event
from scans import SCANS, shown, table_head

import dynamics


def main(arguments: Sequence[str] | None = None) -> list[str]:
    """Print the tables of the scans named, or of all; return the lines."""
    wanted = list(sys.argv[1:] if arguments is None else arguments) or sorted(SCANS)
    lines = table_head("scan", "event", "printed", "ours", "multiplier where printed", "verdict")
    diagrams = {name: SCANS[name].diagram() for name in wanted if name != "6.4"}
    for event in EVENTS:
        if event.section in wanted:
            lines.append(row(event, diagrams.get(event.section)))
    lines += ["", *table_head("scan", "stable motion named", "where", "ours")]
    for name, diagram in diagrams.items():
        for label, place in WINDOWS[name]:
            stretches = [s for s in diagram.stretches(stable=True) if s.label == label]
            ranges = "; ".join(f"{s.low:.6g} to {s.high:.6g}" for s in stretches) or "not stable anywhere"
            lines.append(f"| {name} | {label} | {place} | {ranges} |")
    return shown(lines)


def row(event: Event, diagram: dynamics.Diagram | None) -> str:
    """One line of the table."""
    head = f"| {event.section} | {event.name} | {event.printed} |"
    if diagram is None:
        return f"{head} | | not reproduced: the article gives D alone, and the rest is not identified |"
    if event.kind == "crisis":
        places = [place for place in CRISES if place.section == event.section]
        ours = f"{located(places[0]).parameter:.7f}" if places else ""
        return f"{head} {ours} | | not reproduced: {event.tracked} |"
    points = [p for p in diagram.special(event.kind) if p.label.removeprefix("U") in event.labels]
    point = min(points, key=lambda p: abs(p.parameter - event.value), default=None)
    if point is None or abs(point.parameter - event.value) > 0.02 * event.value:
        place = f"nearest {point.parameter:.7g}" if point is not None else "none"
        return f"{head} {place} | | not reproduced: {event.tracked} |"
    off = event.value - point.parameter
    units = abs(off) / event.unit
    if units <= 1.0:
        verdict = "reproduced"
    elif units <= 5.0:
        verdict = f"reproduced but for {units:.1f} units of the last digit"
    else:
        verdict = f"printed late by {off:.1e}" if off > 0.0 else f"not reproduced: printed {-off:.1e} early"
    tracked = f" ({event.tracked})" if event.tracked else ""
    return f"{head} {point.parameter:.10f} | {_multiplier(event, point, diagram)} | {verdict}{tracked} |"


def _multiplier(event: Event, point: dynamics.SpecialPoint, diagram: dynamics.Diagram) -> str:
    """Multiplier of the orbit at the printed value: 1 or -1 had the value been exact."""
    if point.kind == "grazing":
        return ""
    here = diagram.oscillator.with_parameter(diagram.parameter, event.value)
    orbit = dynamics.find_orbit(here, point.state, point.periods)
    near = orbit.converged and abs(orbit.state - point.state).max() < 0.05
    return f"{orbit.multipliers[0]:.8f}" if near else "no orbit there"


if __name__ == "__main__":
    main()
