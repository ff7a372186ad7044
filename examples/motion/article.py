"""A scan of the article's section 6 with all its figures.

Run it with:   python examples/motion/article.py 6.1 --out out/motion
Minutes at full size; --small takes seconds and shows the same things coarsely. Figures are vector files (svg or pdf)
unless png is asked for.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import drawing
import numpy as np
from matplotlib.figure import Figure
from scans import SCANS, Scan, shown

import dynamics


@dataclass(frozen=True)
class Size:
    """How much work: values swept, periods of the exponents, starts along each side of the basins, and so on.

    `cells` along each side of the basins are where their boundaries are looked for, `levels` the halvings of those
    that a boundary passes.
    """

    values: int
    periods: int
    starts: int
    searches: int
    max_period: int
    basins: int
    cells: int
    levels: int


SMALL, FULL = Size(41, 200, 24, 3, 2, 2, 16, 2), Size(401, 1000, 80, 9, 8, 20, 64, 3)


def main(arguments: Sequence[str] | None = None) -> list[Path]:
    """Draw the scan that the command line names; return the files."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("scan", choices=sorted(SCANS))
    parser.add_argument("--out", type=Path, default=Path("out/motion"))
    parser.add_argument("--format", choices=("svg", "pdf", "png"), default="svg", help="of the figures")
    parser.add_argument("--small", action="store_true", help="seconds instead of minutes")
    options = parser.parse_args(arguments)
    folder = options.out / options.scan
    folder.mkdir(parents=True, exist_ok=True)
    files, lines = draw(SCANS[options.scan], folder, SMALL if options.small else FULL, options.format)
    (folder / "summary.txt").write_text("\n".join(shown(lines)) + "\n", encoding="utf-8")
    return [*files, folder / "summary.txt"]


def draw(scan: Scan, folder: Path, size: Size, ending: str) -> tuple[list[Path], list[str]]:
    """Compute and draw everything of a scan; return the files and what was found, in words."""
    osc, parameter = scan.oscillator, scan.parameter
    symbol = "mesh frequency" if parameter == "frequency" else "error amplitude"
    values = np.linspace(*scan.bounds, size.values)
    files, lines = [], []

    def keep(figure: Figure, name: str) -> None:
        files.append(drawing.save(figure, folder, name, ending))

    longest = min(scan.max_period, size.max_period)
    for k, bounds in enumerate((scan.bounds, *scan.zooms)):
        met = dynamics.multi_sweep(
            osc, parameter, np.linspace(*bounds, size.values), seeds=2 * size.searches, max_period=16
        )
        swept = min(size.values, 100)
        diagram = scan.diagram(bounds, searches=size.searches, swept=swept, max_period=longest)
        keep(drawing.diagram_figure(diagram, met, symbol), "diagram" if k == 0 else f"zoom_{bounds[0]:g}")
        lines += [f"{bounds[0]:g} to {bounds[1]:g}: {diagram.message}", met.message, *diagram.left_out]
        if k == 0:
            motions, missing = named_motions(scan, diagram)
            keep(drawing.portrait_figure(motions, osc.half_backlash), "portraits")
            lines += [f"{label}: no stable stretch in the diagram" for label in missing]
    sweeps = [dynamics.sweep(osc, parameter, values, direction) for direction in ("up", "down")]
    keep(drawing.exponent_figure(exponent_spectra(scan, sweeps, size.periods), symbol), "exponents")
    for value in scan.basins[: size.basins]:
        figure, line = basins(scan, value, size)
        lines.append(line)
        keep(figure, f"basins_{value:g}")
    return files, lines


def exponent_spectra(
    scan: Scan, sweeps: Sequence[dynamics.SweepResult], periods: int
) -> list[tuple[str, np.ndarray]]:
    """Rows value, both exponents and the larger one's standard error along each sweep, with its direction."""
    spectra = []
    for sweep in sweeps:
        rows = []
        for value, states in zip(sweep.values, sweep.states, strict=True):
            if not np.all(np.abs(states) < 1e6):
                continue  # motion without bound
            here = scan.at(float(value))
            spectrum = dynamics.lyapunov_exponents(here, periods, state=states[-1], transient=0)
            rows.append((value, *spectrum.exponents, spectrum.standard_error))
        spectra.append((sweep.direction, np.array(rows)))
    return spectra


def named_motions(
    scan: Scan, diagram: dynamics.Diagram
) -> tuple[list[tuple[str, dynamics.Trajectory]], list[str]]:
    """One motion for each label that the article names, from its widest stable stretch; labels without one."""
    motions, missing = [], []
    for label in scan.named:
        stretches = [s for s in diagram.stretches(stable=True) if s.label == label]
        if not stretches:
            missing.append(label)
            continue
        widest = max(stretches, key=lambda s: s.high - s.low)
        here = scan.at(widest.value)
        title = f"{label} at {widest.value:.5g} ({widest.low:.5g} to {widest.high:.5g})"
        motions.append((title, dynamics.trajectory(here, widest.state, widest.periods)))
    here = scan.at(scan.chaos)
    settled = dynamics.sweep(here, scan.parameter, [scan.chaos], transient=5000)
    motion = dynamics.trajectory(here, settled.states[0, -1], 400)
    motions.append((f"{settled.labels[0]} at {scan.chaos:g}", motion))
    return motions, missing


def basins(scan: Scan, value: float, size: Size) -> tuple[Figure, str]:
    """Basins at a value, their boundary's dimension, unstable orbits and the stable manifolds of the saddles."""
    here = scan.at(value)
    (x0, x1), (v0, v1) = scan.box
    result = dynamics.basins(here, (x0, x1, size.starts), (v0, v1, size.starts), limit=scan.patience)
    known = [a for a in result.attractors if a.orbit is not None and a.share > 0.0]
    periods = sorted({1, 2, *(a.orbit.periods for a in known if a.orbit is not None)})
    orbits = [o for o in dynamics.find_orbits(here, periods).orbits if not o.stable]
    direct = [o for o in orbits if not np.iscomplexobj(o.multipliers) and o.multipliers[0] > 1.0][:4]
    smooth = len(known) == len(result.attractors) > 1  # else the manifolds fill the plane
    length = 60.0 if smooth else 12.0
    manifolds = [dynamics.manifold(o, "stable", scan.box, length=length, max_points=6000) for o in direct]
    drawn = [(o.label, dynamics.period_map(here, o.state, o.periods).states) for o in orbits]
    shares = ", ".join(
        f"{a.label} {100 * a.share:.2f} +- {100 * a.share_error:.2f} %" for a in result.attractors
    )
    text = f"basins at {value:g}: {shares}; unstable: {', '.join(o.label for o in orbits) or 'none found'}"
    title = f"{scan.parameter} = {value:g}"
    if known and sum(a.share > 0.0 for a in result.attractors) > 1:
        edge = dynamics.basin_boundary(
            here, known, scan.box, cells=size.cells, levels=size.levels, limit=scan.patience
        )
        low, high = (edge.dimension + sign * 1.96 * edge.dimension_error for sign in (-1, 1))
        title += f"; boundary dimension {edge.dimension:.2f} ({low:.2f} to {high:.2f})"
        text += f"; {edge.message}"
    return drawing.basin_figure(result, drawn, manifolds, title), text


if __name__ == "__main__":
    main()
