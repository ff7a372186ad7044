"""Where chaotic attractors of the article's scans end, and the saddles that they meet there.

Run it with:   python examples/motion/crises.py
About a minute. With --all 6.1 (or 6.2, 6.3) every saddle of a scan's diagram is looked at: minutes.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scans import SCANS, period_of, shown, table_head

import dynamics


@dataclass(frozen=True)
class Crisis:
    """A saddle and a range in which the chaotic attractor beside it ends.

    Attributes
    ----------
    section : str
        "6.1" to "6.3".
    saddle : str
        Its label.
    at : float
        A value at which the saddle is looked for.
    bounds : tuple of float
        On one side of the crisis each.
    """

    section: str
    saddle: str
    at: float
    bounds: tuple[float, float]


@dataclass(frozen=True)
class End:
    """A stable motion from which a sweep runs into chaos that ends at once.

    Attributes
    ----------
    section, label : str
        Scan and motion.
    first, last : float
        Where the sweep begins and ends.
    """

    section: str
    label: str
    first: float
    last: float


CRISES = (
    Crisis("6.1", "U3-3-1", 0.905, (0.9025, 0.91)),
    Crisis("6.1", "U3-3-1", 1.13, (1.116, 1.13)),
    Crisis("6.3", "U1-1-0", 0.778, (0.770, 0.785)),
)
ENDS = (
    End("6.2", "3-3-0", 0.5215, 0.5235),
    End("6.2", "4-4-0", 0.6090, 0.6110),
    End("6.2", "4-2-2", 0.9825, 0.9775),
    End("6.2", "3-1-1", 1.2870, 1.2805),
    End("6.2", "4-3-0", 1.5890, 1.5870),
)


def main(arguments: Sequence[str] | None = None) -> list[str]:
    """Print the crises, or all of one scan; return the lines."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--all", choices=("6.1", "6.2", "6.3"), help="every saddle of a scan's diagram")
    given = parser.parse_args(arguments)
    lines = table_head("scan", "parameter", "saddle", "chaos before it", "motion after it")
    if given.all:
        whole = SCANS[given.all].diagram(max_period=4)
        lines += [
            row(given.all, c) for c in dynamics.boundary_crises(whole, values=100, points=200, periods=60)
        ]
    else:
        lines += [row(place.section, located(place)) for place in CRISES]
        lines += ["", *table_head("scan", "motion", "sweep", "chaos ends between")]
        lines += [ended(end) for end in ENDS]
    return shown(lines)


def located(place: Crisis) -> dynamics.Crisis:
    """The crisis of a place; its saddle is found by its label."""
    scan = SCANS[place.section]
    orbits = dynamics.find_orbits(scan.at(place.at), (period_of(place.saddle),)).orbits
    saddle = next(orbit for orbit in orbits if orbit.label == place.saddle)
    return dynamics.boundary_crisis(saddle, scan.parameter, place.bounds, points=500, periods=90)


def row(section: str, crisis: dynamics.Crisis) -> str:
    """One line of the table."""
    return (
        f"| {section} | {crisis.parameter:.9f} | {crisis.saddle.label} | {crisis.before} | {crisis.after} |"
        if crisis.converged
        else f"| {section} | {crisis.message} | | | |"
    )


def ended(end: End, steps: int = 81, growth: float = 2.5) -> str:
    """Where the motion of a sweep comes to fill `growth` times as many cells as before, or becomes periodic."""
    scan = SCANS[end.section]
    period, here = period_of(end.label), scan.at(end.first)
    orbits = dynamics.find_orbits(here, (period,)).orbits
    start = [o.state for o in orbits if o.stable and o.periods == period and o.label == end.label]
    if not start:  # already doubled
        met = dynamics.multi_sweep(here, scan.parameter, [end.first], seeds=1, starts=12)
        start = [m.states[-1] for m in met.motions[0] if m.periods and m.periods % period == 0]
    values = np.linspace(end.first, end.last, steps)
    direction = "up" if end.last > end.first else "down"
    found = dynamics.sweep(
        scan.oscillator, scan.parameter, values, direction, initial=start[0], transient=4000, keep=256
    )
    size = _cells(found.states)
    gone = [
        k
        for k in range(1, steps)
        if size[k] > growth * size[k - 1] or (found.labels[k - 1] == "aperiodic" and found.periods[k] > 0)
    ]
    if not gone:
        return f"| {end.section} | {end.label} | {end.first:g} to {end.last:g} | not seen |"
    k = gone[0]
    return (
        f"| {end.section} | {end.label} | {end.first:g} to {end.last:g} | "
        f"{values[k - 1]:.6g} and {values[k]:.6g}: {found.labels[k - 1]}, then {found.labels[k]} |"
    )


def _cells(states: np.ndarray, side: int = 20) -> np.ndarray:
    """Cells of a grid over all motions that each motion passes; states (values, kept, 2)."""
    low, high = states.min(axis=(0, 1)), states.max(axis=(0, 1))
    place = np.minimum(((states - low) / (high - low) * side).astype(int), side - 1)
    return np.array([len(np.unique(p, axis=0)) for p in place])


if __name__ == "__main__":
    main()
