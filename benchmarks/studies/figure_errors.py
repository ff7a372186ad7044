"""Reported against true errors of every figure of a mesh cycle, over random pairs.

Pairs of `tests/hard/random_pairs.py` (8 to 200 teeth, thick and thin rims, shifts, racks, tips), some of plastic, whose
contacts move, some with tip relief, friction, or held to the path, under full to light load. True: one refinement more,
64 loads along each flank, arcs of up to degree 128, and a hundredth of the tolerance; what is left of the mesh's error
makes true errors smaller by about a tenth. Root stresses of every fourth pair. Prints a line for each pair, and for
each figure the quantiles of the ratio, with the part of the pairs between 0.5 and 5. Errors below a thousandth of the
tolerance count as that. Run from the root with
``PYTHONPATH=. python benchmarks/studies/figure_errors.py [pairs] [seed ...]``: so many pairs of each seed.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace

import numpy as np

import fem
import fem.pair.compliance
import gears.sharing.events
from base import InputError, SolverError
from fem.pair.pair_fillets import fillets
from fem.stress.tooth_root import root_stress
from gears import LoadSharingError, Material, TipRelief
from gears.sharing.mesh_arcs import ALONE, MeshArcs
from tests.hard.random_pairs import random_pair

STEEL, PLASTIC = Material(206e9, 0.3, 7850.0), Material(3e9, 0.4, 1140.0)

LINE_LOAD, SOFT = 440e3, 0.015
"""Greatest load [N per m of face], and the part of it that a plastic gear bears."""

TOLERANCE, FLOOR = 1e-3, 1e-6

ORDERS = np.array([1, 2, 3])

FIGURES = {
    "mean, tangent": lambda found: found.mean("stiffness"),
    "mean, secant": lambda found: found.mean("secant_stiffness"),
    "transmission error, peak to peak": lambda found: found.range("transmission_error"),
    "least tangent": lambda found: found.extreme("stiffness", greatest=False),
    "greatest tangent": lambda found: found.extreme("stiffness", greatest=True),
    "least secant": lambda found: found.extreme("secant_stiffness", greatest=False),
    "greatest secant": lambda found: found.extreme("secant_stiffness", greatest=True),
    "greatest load share": lambda found: found.greatest_share(),
}

CURVES = {"tangent": "stiffness", "secant": "secant_stiffness", "transmission error": "transmission_error"}


def drawn(rng: np.random.Generator):
    """A pair, its torque, and how it is set up."""
    while True:
        pair, chance = random_pair(rng), rng.random(9)
        if pair is None:
            continue
        # backlash, so that one side of the teeth bears alone
        play = 0.03 * pair.module
        gears = [replace(gear, thickness_allowance=play) for gear in (pair.pinion, pair.wheel)]
        if chance[0] < 0.4:
            form = "linear" if chance[3] < 0.5 else "parabolic"
            relief = TipRelief(5e-6 + 2.5e-5 * chance[1], (0.25 + 0.5 * chance[2]) * pair.module, form)
            gears = [replace(gear, tip_relief=relief) for gear in gears]
        soft = chance[4] < 0.25
        material = ((STEEL, PLASTIC) if chance[5] < 0.5 else PLASTIC) if soft else STEEL
        try:
            pair = replace(pair, pinion=gears[0], wheel=gears[1], material=material)
        except InputError:
            continue
        load = LINE_LOAD * (1.0, 0.1, 0.02)[int(3 * chance[6])] * (SOFT if soft else 1.0)
        friction = 0.08 if chance[7] < 0.2 else 0.0
        options = {"friction": friction, "beyond_path": bool(chance[8] < 0.8)}
        options["moving_contact"] = soft and not friction
        return pair, float(load * pair.face_width * pair.base_radii[0]), options


def solved(pair, torque, options, bodies, tolerance):
    """Cycle under the torque or, where teeth cannot bear it, a part of it; its arcs, on the finer mesh alone."""
    for _ in range(3):
        with suppress(SolverError, LoadSharingError):
            cycle = fem.mesh_cycle(pair, torque, 8, bodies, tolerance=tolerance, **options)
            if cycle.converged and cycle.arcs is not None:
                return cycle
        torque *= 0.2
    return None


def ratios(usual: MeshArcs, best: MeshArcs) -> dict[str, float]:
    """Reported over true errors by figure."""
    found = {}
    for name, figure in FIGURES.items():
        ours, true = figure(usual), figure(best).value
        assert ours.error is not None
        found[name] = _ratio(ours.error, ours.value - true, abs(true))
    for title, name in CURVES.items():
        relative = name != "transmission_error"
        ours, error = usual.amplitudes(name, ORDERS, over_mean=relative)
        true, _ = best.amplitudes(name, ORDERS, over_mean=relative)
        # over the mean, or the range, of which harmonics are parts
        size = 1.0 if relative else best.range(name).value
        assert error is not None
        for place, order in enumerate(ORDERS):
            ratio = _ratio(float(error[place]), float(ours[place] - true[place]), size)
            found[f"harmonic {order}, {title}"] = ratio
    return found


def _ratio(reported: float, true: float, size: float) -> float:
    """Reported over true error of a figure, of which a size is given."""
    return max(reported, FLOOR * size) / max(abs(true), FLOOR * size)


def root_ratios(pair, usual, best) -> dict[str, float]:
    """Reported over true errors of the greatest root stresses by instants and forces: the fillets are the same."""
    roots = fillets(pair, 0.02)
    first, second = (root_stress(pair, cycle, roots) for cycle in (usual, best))
    found = {}
    for gear in ("pinion", "wheel"):
        for kind in ("tension", "compression"):
            peak, true = (getattr(getattr(one, gear), f"greatest_{kind}") for one in (first, second))
            off = peak.stress_Pa / true.stress_Pa - 1
            found[f"root {kind}, {gear}"] = _ratio(peak.forces + peak.sampling, off, 1.0)
    return found


@contextmanager
def long_series() -> Iterator[None]:
    """So many loads along the flanks and nodes on the arcs that their errors are none."""
    before = fem.pair.compliance.SAMPLES, gears.sharing.events.DEGREES
    fem.pair.compliance.SAMPLES, gears.sharing.events.DEGREES = (64,), (8, 16, 32, 64, 128)
    try:
        yield
    finally:
        fem.pair.compliance.SAMPLES, gears.sharing.events.DEGREES = before


def one(pair, torque, options, roots: bool) -> tuple[str, dict[str, float]]:
    """What was computed, or why not; and the ratios."""
    began = time.process_time()
    bodies = fem.compliance(pair, TOLERANCE, tip_edges=True)
    usual = solved(pair, torque, options, bodies, TOLERANCE)
    if usual is None:
        return "no solution", {}
    middle = time.process_time()
    with long_series():
        finer = fem.compliance(
            pair, 1e-5, sizes=bodies.sizes, refinements=bodies.refinements + 1, tip_edges=True
        )
        best = fem.mesh_cycle(pair, usual.torque, 8, finer, tolerance=0.01 * TOLERANCE, **options)
        if best.problem is None:
            return f"no reference, {best.message}", {}
        reference = MeshArcs(best.problem.divided(), ALONE, 1.0, 0.0)
    assert usual.arcs is not None
    found = ratios(usual.arcs, reference)
    if roots and not options["friction"] and pair.contact_ratio < 2:
        best = replace(best, known_arcs=reference, problem=None)
        with suppress(InputError):  # some fillets fold the elements of so coarse a mesh
            found |= root_ratios(pair, usual, best)
    least, most = min(found, key=found.get), max(found, key=found.get)
    return (
        f"{usual.torque:.3g} N m: least {found[least]:.2g} ({least}), most {found[most]:.3g} ({most}); "
        f"{middle - began:.1f} and {time.process_time() - middle:.1f} s"
    ), found


def main(count: int, seeds: list[int]) -> None:
    found, missing = defaultdict(list), 0
    for number in range(count):
        for seed in seeds:
            pair, torque, options = drawn(np.random.default_rng([seed, number]))
            try:
                said, here = one(pair, torque, options, number % 4 == 0)
            except (InputError, SolverError, LoadSharingError) as fault:
                said, here = f"{type(fault).__name__}, {str(fault)[:150]}", {}
            missing += not here
            print(f"{seed}/{number} z {pair.pinion.teeth}/{pair.wheel.teeth}, {said}", flush=True)
            for name, ratio in here.items():
                found[name].append(ratio)
        if number % 10 == 9 or number == count - 1:
            show(found, missing)


def show(found, missing: int) -> None:
    """Quantiles of the ratios by figure."""
    print(f"{missing} pairs without a solution")
    print(f"{'reported over true error':34} pairs   0, 5, 50, 95, 100 %                       0.5 to 5")
    for name, values in found.items():
        columns = " ".join(f"{v:8.2f}" for v in np.percentile(values, [0, 5, 50, 95, 100]))
        inside = np.mean([0.5 <= value <= 5 for value in values])
        print(f"{name:34} {len(values):5} {columns} {100 * inside:8.0f} %", flush=True)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    given = [int(word) for word in sys.argv[1:]]
    main(given[0] if given else 40, given[1:] or [1])
