"""Where chaotic attractors of the article's scans end, and the saddles that they meet there.

Run it with:   python examples/motion/crises.py
About two minutes. With --all 6.1 (or 6.2, 6.3) every saddle of a scan's diagram is looked at: minutes.
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
    points : int
        Of the stretch of the saddle's unstable manifold.
    """

    section: str
    saddle: str
    at: float
    bounds: tuple[float, float]
    points: int = 500


@dataclass(frozen=True)
class End:
    """A stable motion whose cascade ends in chaos that ends at once.

    Attributes
    ----------
    section, label : str
        Scan and motion.
    first : float
        Where the motion is stable, or has doubled.
    bounds : tuple of float
        Where its chaos lasts, and where motions leave it.
    points : int
        Of the stretch of the saddle's unstable manifold.
    """

    section: str
    label: str
    first: float
    bounds: tuple[float, float]
    points: int = 500


CRISES = (
    Crisis("6.1", "U3-3-1", 0.905, (0.9025, 0.91), 2000),
    Crisis("6.1", "U3-3-1", 1.13, (1.116, 1.13)),
    Crisis("6.3", "U1-1-0", 0.778, (0.770, 0.785)),
)
ENDS = (
    End("6.2", "3-3-0", 0.5215, (0.52276, 0.5228)),
    End("6.2", "4-4-0", 0.6090, (0.61013, 0.6102), 3000),
    End("6.2", "4-2-2", 0.9825, (0.979066, 0.979)),
    End("6.2", "3-1-1", 1.2870, (1.28154, 1.28147), 3000),
    End("6.2", "4-3-0", 1.5890, (1.587074, 1.58705)),
)
SHARP = 1e-7
"""Relative error up to which a crisis has a place; it is the change with twice the points of the manifold."""

PERIODS = 2_000_000
"""Periods after which chaos without an escape counts as lasting."""

LIFE = 3e-4
"""Escapes per period at the value past the end at which saddles are looked for."""


def main(arguments: Sequence[str] | None = None) -> list[str]:
    """Print the crises, or all of one scan; return the lines."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--all", choices=("6.1", "6.2", "6.3"), help="every saddle of a scan's diagram")
    options = parser.parse_args(arguments)
    lines = table_head("scan", "parameter", "saddle", "chaos before it", "motion after it")
    if options.all:
        whole = SCANS[options.all].diagram(max_period=4)
        lines += [
            row(options.all, c) for c in dynamics.boundary_crises(whole, values=100, points=200, periods=60)
        ]
    else:
        lines += [row(place.section, located(place)) for place in CRISES]
        lines += [
            "",
            *table_head("scan", "chaos of", "stays to, leaves from", "saddle", "parameter", "what follows"),
        ]
        lines += [ended(end) for end in ENDS]
    return shown(lines)


def located(place: Crisis) -> dynamics.Crisis:
    """The crisis of a place; its saddle is found by its label."""
    scan = SCANS[place.section]
    # by the index alone: the first of that label is the one beside the chaos
    orbits = dynamics.find_orbits(scan.at(place.at), (period_of(place.saddle),), batches=0).orbits
    saddle = next(orbit for orbit in orbits if orbit.label == place.saddle)
    return dynamics.boundary_crisis(saddle, scan.parameter, place.bounds, points=place.points, periods=90)


def row(section: str, crisis: dynamics.Crisis) -> str:
    """One line of the table."""
    return (
        f"| {section} | {crisis.parameter:.9f} | {crisis.saddle.label} | {crisis.before} | {crisis.after} |"
        if crisis.converged or crisis.error < SHARP
        else f"| {section} | {crisis.message} | | | |"
    )


def ended(end: End) -> str:
    """Where motions begin to leave the chaos of a cascade, and the saddle that it meets there."""
    scan, (inside, _) = SCANS[end.section], end.bounds
    chaos_end = dynamics.chaos_end(scan.oscillator, scan.parameter, chaos(end), end.bounds, periods=PERIODS)
    rates = np.where(chaos_end.escapes > 0, chaos_end.rates, np.inf)
    past = float(chaos_end.values[int(np.argmin(np.abs(np.log(rates / LIFE))))])
    row = f"| {end.section} | {end.label} | {chaos_end.last:.9g} and {chaos_end.first:.9g} |"
    for saddle in dynamics.edge_saddles(scan.at(past), chaos_end.attractor)[:2]:
        low, high = sorted((inside, past))
        crisis = dynamics.boundary_crisis(
            saddle, scan.parameter, (low, high), points=end.points, periods=6 * saddle.periods
        )
        if crisis.converged:
            return f"{row} {saddle.label} | {crisis.parameter:.9f} | {crisis.after} |"
    return f"{row} none that parts the two | | |"


def chaos(end: End) -> np.ndarray:
    """A state of the chaos that a sweep from the stable motion reaches."""
    scan, period = SCANS[end.section], period_of(end.label)
    here = scan.at(end.first)
    orbits = dynamics.find_orbits(here, (period,)).orbits
    start = [o.state for o in orbits if o.stable and o.periods == period and o.label == end.label]
    if not start:  # already doubled
        met = dynamics.multi_sweep(here, scan.parameter, [end.first], seeds=1, starts=12)
        start = [m.states[-1] for m in met.motions[0] if m.periods and m.periods % period == 0]
    values = np.linspace(end.first, end.bounds[0], 401)
    direction = "up" if end.bounds[0] > end.first else "down"
    swept = dynamics.sweep(
        scan.oscillator, scan.parameter, values, direction, initial=start[0], transient=2000
    )
    return np.asarray(swept.states[-1, -1])


if __name__ == "__main__":
    main()
