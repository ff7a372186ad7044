"""A scan of the article's section 6 with all its figures.

Run it with:   python examples/motion/article.py 6.1 --out out/motion
Minutes at full size; --small takes seconds and shows the same things coarsely.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import drawing
import numpy as np
from scans import SCANS, Scan

import dynamics


@dataclass(frozen=True)
class Size:
    """How much work: values swept, periods of the exponents, starts along each side of the basins, and so on."""

    values: int
    periods: int
    starts: int
    searches: int
    max_period: int
    basins: int


SMALL, FULL = Size(41, 200, 24, 3, 2, 2), Size(801, 4000, 200, 9, 8, 20)


def main(arguments: Sequence[str] | None = None) -> list[Path]:
    """Draw the scan that the command line names; return the files."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("scan", choices=sorted(SCANS))
    parser.add_argument("--out", type=Path, default=Path("out/motion"))
    parser.add_argument("--small", action="store_true", help="seconds instead of minutes")
    given = parser.parse_args(arguments)
    folder = given.out / given.scan
    folder.mkdir(parents=True, exist_ok=True)
    files, told = draw(SCANS[given.scan], folder, SMALL if given.small else FULL)
    (folder / "summary.txt").write_text("\n".join(told) + "\n", encoding="utf-8")
    print("\n".join(told))
    return [*files, folder / "summary.txt"]


def draw(scan: Scan, folder: Path, size: Size) -> tuple[list[Path], list[str]]:
    """Compute and draw everything of a scan; return the files and what was found, in words."""
    osc, parameter = scan.oscillator, scan.parameter
    symbol = "mesh frequency" if parameter == "frequency" else "error amplitude"
    values = np.linspace(*scan.bounds, size.values)
    sweeps = [dynamics.sweep(osc, parameter, values, direction) for direction in ("up", "down")]
    diagram = dynamics.diagram(
        osc, parameter, scan.bounds, searches=size.searches, max_period=min(scan.max_period, size.max_period)
    )
    told = [diagram.message, *diagram.left_out]
    files = [drawing.save(drawing.diagram_figure(diagram, sweeps, symbol), folder, "diagram")]
    exponents, errors = exponent_spectra(scan, sweeps, size.periods)
    files.append(
        drawing.save(drawing.exponent_figure(values, exponents, errors, symbol), folder, "exponents")
    )
    motions, missing = named_motions(scan, diagram)
    told += [f"{label}: no stable stretch in the diagram" for label in missing]
    files.append(drawing.save(drawing.portrait_figure(motions, osc.half_backlash), folder, "portraits"))
    for value in scan.basins[: size.basins]:
        figure, lines = basins(scan, value, size.starts)
        told += lines
        files.append(drawing.save(figure, folder, f"basins_{value:g}"))
    return files, told


def exponent_spectra(
    scan: Scan, sweeps: Sequence[dynamics.SweepResult], periods: int
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Largest exponents and their standard errors along both sweeps."""
    exponents, errors = {}, {}
    for sweep in sweeps:
        rows = []
        for value, states in zip(sweep.values, sweep.states, strict=True):
            here = scan.oscillator.with_parameter(scan.parameter, float(value))
            found = dynamics.lyapunov_exponents(here, periods, state=states[-1], transient=0)
            rows.append((found.exponents[0], found.standard_error))
        exponents[sweep.direction], errors[sweep.direction] = np.array(rows).T
    return exponents, errors


def named_motions(
    scan: Scan, diagram: dynamics.Diagram
) -> tuple[list[tuple[str, dynamics.Trajectory]], list[str]]:
    """One motion for each label that the article names, from its widest stable stretch; labels without one."""
    motions, missing = [], []
    for label in scan.named:
        found = [s for s in diagram.stretches(stable=True) if s.label == label]
        if not found:
            missing.append(label)
            continue
        widest = max(found, key=lambda s: s.high - s.low)
        here = scan.oscillator.with_parameter(scan.parameter, widest.value)
        title = f"{label} at {widest.value:.5g} ({widest.low:.5g} to {widest.high:.5g})"
        motions.append((title, dynamics.trajectory(here, widest.state, widest.periods)))
    here = scan.oscillator.with_parameter(scan.parameter, scan.chaos)
    settled = dynamics.sweep(here, scan.parameter, [scan.chaos], transient=5000)
    motion = dynamics.trajectory(here, settled.states[0, -1], 400)
    motions.append((f"{settled.labels[0]} at {scan.chaos:g}", motion))
    return motions, missing


def basins(scan: Scan, value: float, starts: int) -> tuple[object, list[str]]:
    """Basins at a value with unstable orbits and the stable manifolds of those of least period."""
    here = scan.oscillator.with_parameter(scan.parameter, value)
    (x0, x1), (v0, v1) = scan.box
    result = dynamics.basins(here, (x0, x1, starts), (v0, v1, starts), limit=scan.patience)
    periods = sorted({1, 2, *(a.orbit.periods for a in result.attractors if a.orbit is not None)})
    orbits = [o for o in dynamics.find_orbits(here, periods).orbits if not o.stable]
    saddles = [o for o in orbits if not np.iscomplexobj(o.multipliers) and abs(o.multipliers[1]) < 1.0]
    direct = [o for o in saddles if o.multipliers[0].real > 1.0][:4]
    manifolds = [dynamics.manifold(o, "stable", scan.box, length=40.0, max_points=3000) for o in direct]
    drawn = [(o.label, dynamics.period_map(here, o.state, o.periods).states) for o in orbits]
    shares = ", ".join(
        f"{a.label} {100 * a.share:.2f} +- {100 * a.share_error:.2f} %" for a in result.attractors
    )
    told = f"basins at {value:g}: {shares}; unstable: {', '.join(o.label for o in orbits) or 'none found'}"
    return drawing.basin_figure(result, drawn, manifolds, f"{scan.parameter} = {value:g}"), [told]


if __name__ == "__main__":
    main()
