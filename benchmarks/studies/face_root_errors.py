"""Reported against true errors of the greatest root stresses over the face, over random pairs.

Pairs of ``face_errors.py``; every third has free ends. True: twice the cells, waves and places of loads along face and
flank, a mesh of the bodies refined once more, fillets of half the edge length in the plane and along the face; of free
ends pieces of half the length, elements of 0.7 of it. Every pair's figures go to a line of a file as soon as they are
known: a study that was cut off goes on where it stopped. Run from the root with

    PYTHONPATH=. python benchmarks/studies/face_root_errors.py FILE [pairs] [seed] [seconds]

until it prints the table. Without a seed it is that of ``tests/seeds.py``.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import fem
import fem.influence.fillet_ends as ends
import fem.influence.fillet_waves as waves
import fem.pair.pair_fillets as plane
from benchmarks.studies import face_errors
from benchmarks.studies.pair_by_pair import begin, pair_by_pair
from tests.seeds import SEED

FREE_ENDS_OF = 3
"""One pair of so many has free ends."""

STRESSES = ("greatest_tension_Pa", "greatest_compression_Pa")

FLOOR = 1e-5
"""Errors below this part of a figure count as it."""


@contextmanager
def finer_fillets() -> Iterator[None]:
    """Twice the waves and places along face and flank; meshes and pieces of fillets over the face finer."""
    shape, before = plane.LoadedShape, (waves.PLACES, ends.PLACES, ends.SIZES)
    mesh, solved, half = shape.mesh, shape.solved, ends.half_face
    edge, last = 0.5 * plane.COARSEST, 0.5 * ends.LAST
    waves.PLACES, ends.PLACES = 24, 14
    ends.SIZES = ends.SIZES.scaled(0.7)
    changed: dict[tuple[Any, str], Any] = {
        (shape, "mesh"): lambda self: mesh(self, edge),
        (shape, "solved"): lambda self, gears, asked=edge: solved(self, gears, asked),
        (ends, "half_face"): lambda width, module, *_: half(width, module, last, 2.0),
    }
    for (where, name), what in changed.items():
        setattr(where, name, what)
    try:
        with face_errors.twice_as_fine():
            yield
    finally:
        waves.PLACES, ends.PLACES, ends.SIZES = before
        shape.mesh, shape.solved, ends.half_face = mesh, solved, half  # type: ignore[method-assign]


def stresses(found: fem.RootStress) -> dict[str, list[float]]:
    """Greatest stresses of both gears, what is told of them in all, and by what varies along the face."""
    values = {}
    for name in ("pinion", "wheel"):
        gear = getattr(found, name)
        for stress in STRESSES:
            kind = stress.split("_")[1]
            told = gear.errors[stress], getattr(gear.face, f"{kind}_error")
            values[f"{kind}, {name}"] = [getattr(gear, stress), *told]
        values[f"over even, {name}"] = [gear.face.over_even, gear.face.tension_error, gear.face.tension_error]
    return values


def one(number: int, seed: int) -> dict[str, Any]:
    """Stresses of a pair with their errors, and the same twice as fine, as plain numbers."""
    pair, torque, alignment = face_errors.drawn(np.random.default_rng([seed, number]))
    model = "free-ends" if number % FREE_ENDS_OF == FREE_ENDS_OF - 1 else "walls"
    tolerance, cells = face_errors.TOLERANCE, face_errors.CELLS
    cycle = partial(
        fem.mesh_cycle,
        pair,
        torque,
        face_errors.POSITIONS,
        alignment=alignment,
        beyond_path=False,
        face_model=model,
        tolerance=tolerance,
    )
    fem.forget_gears()
    began = time.process_time()
    bodies, roots = fem.compliance(pair, tolerance), fem.fillets(pair, tolerance)
    found = stresses(fem.root_stress(pair, cycle(compliance=bodies, cells=cells), roots))
    middle = time.process_time()
    fem.forget_gears()
    with finer_fillets():
        meshed = fem.compliance(pair, tolerance, sizes=bodies.sizes, refinements=bodies.refinements + 1)
        fine = cycle(compliance=meshed, cells=2 * cells)
        best = fem.root_stress(pair, fine, fem.fillets(pair, fillet_edge=roots.fillet_edge))
    fem.forget_gears()
    return {
        "teeth": [pair.pinion.teeth, pair.wheel.teeth],
        "slenderness": pair.face_width / pair.module,
        "misalignment": alignment.in_plane,
        "load": torque / pair.base_radii[0] / pair.face_width,
        "crowning": pair.pinion.lead.crowning,
        "wider": pair.face_widths[0] / pair.face_width,
        "model": model,
        "found": found,
        "true": {name: value for name, (value, *_) in stresses(best).items()},
        "seconds": [middle - began, time.process_time() - middle],
    }


def ratios(row: dict[str, Any]) -> dict[str, float]:
    """Reported over true errors by figure."""
    return {
        name: max(told, FLOOR) / max(abs(value / row["true"][name] - 1.0), FLOOR)
        for name, (value, told, _) in row["found"].items()
    }


def show(rows: list[dict[str, Any]]) -> None:
    """Greatest errors and quantiles of the ratios by figure."""
    whole = [row for row in rows if "found" in row]
    print(f"{len(rows) - len(whole)} of {len(rows)} pairs without a solution")
    for model in ("walls", "free-ends"):
        some = [row for row in whole if row["model"] == model]
        for name in some[0]["found"] if some else ():
            values = np.array([ratios(row)[name] for row in some])
            true = [abs(row["found"][name][0] / row["true"][name] - 1.0) for row in some]
            told = [row["found"][name][1] for row in some]
            columns = " ".join(f"{v:6.2f}" for v in np.percentile(values, [0, 50, 100]))
            print(
                f"{model:10} {name:20} {len(some):3} pairs, least, median, largest ratio {columns};", end=""
            )
            print(f" true at most {100 * max(true):.2f} %, told at most {100 * max(told):.2f} %")


def main(file: Path, pairs: int, seed: int, seconds: float) -> None:
    rows = pair_by_pair(
        file,
        pairs,
        seed,
        seconds,
        one,
        lambda row: {name: f"{ratio:.2g}" for name, ratio in ratios(row).items()},
    )
    if rows is not None:
        show(rows)


if __name__ == "__main__":
    begin(main, 60, SEED)
