"""Reported against true errors of mesh cycles with cells along the face, over random pairs.

Pairs of `tests/hard/random_pairs.py`, faces of 4 to 25 modules, steel, axes out of parallel by 2 to 60 um, half of them
crowned, a quarter with end relief, a fifth of unequal width, under full, a tenth or a fiftieth of the load. True: twice
the cells, between walls on a mesh refined once more, of every twentieth with twice the waves and places. One pair of
ten has free ends, the first with a finer mesh, pieces of half the length and elements of 0.7 of it. Figures of arcs are
of the whole base pitch, the greatest load of eight positions. Every pair's figures go to a line of a file as soon as
they are known: a study that was cut off goes on where it stopped. Run from the root with

    PYTHONPATH=. python benchmarks/studies/face_errors.py FILE [pairs] [seed] [seconds]

until it prints the table: how many ratios of reported and true error are between 0.5 and 5, and how many are or have a
true error below a tenth of the tolerance, where care costs nothing. Without a seed it is that of ``tests/seeds.py``.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import fem
import fem.elasticity.free_ends
import fem.influence.gear_face
from base import FlankfilmError
from benchmarks.studies.pair_by_pair import Row, begin, pair_by_pair, quantiles
from gears import Alignment, GearPair, Lead, Material
from gears.sharing.arcs import Arcs
from tests.hard.random_pairs import random_pair
from tests.seeds import SEED

STEEL = Material(206e9, 0.3, 7850.0)

LINE_LOAD = 440e3
"""Greatest load [N per m of face]."""

CELLS, POSITIONS, TOLERANCE = 64, 8, 5e-3

FREE_ENDS_OF, REFINED_OF = 10, 20
"""One pair of so many has free ends, and one is refined in waves and places too."""

FLOOR, SMALL = 1e-5, 0.1
"""Errors below this part of a figure count as it, and part of the tolerance below which a true error is small."""


def drawn(rng: np.random.Generator) -> tuple[GearPair, float, Alignment]:
    """A pair with leads, its torque, and the alignment."""
    while True:
        pair, chance = random_pair(rng), rng.random(9)
        if pair is None:
            continue
        crowning = 30e-6 * chance[0] if chance[1] < 0.5 else 0.0
        width = pair.module * (4.0 + 21.0 * chance[2])
        relief = 20e-6 * chance[3] if chance[4] < 0.25 else 0.0
        lead = Lead(crowning, 0.0, relief, 0.2 * width)
        play = 0.03 * pair.module
        try:
            pinion = replace(pair.pinion, lead=lead, thickness_allowance=play)
            wheel = replace(pair.wheel, thickness_allowance=play)
            if chance[7] < 0.2:
                pinion = replace(pinion, face_width=width * (1.05 + 0.2 * chance[8]))
            pair = replace(pair, pinion=pinion, wheel=wheel, face_width=width, material=STEEL)
        except FlankfilmError:
            continue
        load = LINE_LOAD * (1.0, 0.1, 0.02)[int(3 * chance[5])]
        return pair, load * width * pair.base_radii[0], Alignment(2e-6 * 30.0 ** chance[6])


@contextmanager
def twice_as_fine() -> Iterator[None]:
    """Twice the waves and places; pieces at free ends of half the length, elements there of 0.7 of it."""
    face, half = (
        fem.influence.gear_face,
        partial(fem.elasticity.free_ends.half_face, last=0.5 * fem.elasticity.free_ends.LAST),
    )
    before = face.WAVES, face.PLACES, face.ENDS_SIZES, face.half_face
    face.WAVES, face.PLACES, face.ENDS_SIZES = 2 * before[0], 2 * before[1], before[2].scaled(0.7)
    setattr(face, "half_face", half)  # noqa: B010
    try:
        yield
    finally:
        face.WAVES, face.PLACES, face.ENDS_SIZES, face.half_face = before


CURVES: dict[str, tuple[str, Callable[[Arcs, str], float]]] = {
    "mean tangent": ("stiffness", lambda arcs, name: arcs.mean(name)[0]),
    "least tangent": ("stiffness", lambda arcs, name: arcs.extremes(name)[0][0]),
    "greatest tangent": ("stiffness", lambda arcs, name: arcs.extremes(name)[1][0]),
    "mean secant": ("secant_stiffness", lambda arcs, name: arcs.mean(name)[0]),
    "peak to peak": (
        "transmission_error",
        lambda arcs, name: arcs.extremes(name)[1][0] - arcs.extremes(name)[0][0],
    ),
    "first harmonic": (
        "transmission_error",
        lambda arcs, name: float(np.abs(arcs.harmonics(name, np.array([1]))[0][0])),
    ),
}
"""Figures of arcs: of which curve, and how they follow."""

ERRORS = {
    "mean tangent": "mean_stiffness",
    "least tangent": "least_stiffness",
    "greatest tangent": "greatest_stiffness",
    "mean secant": "mean_secant_stiffness",
    "peak to peak": "transmission_error_range",
}
"""Their names among `MeshCycle.errors`."""


def figures(cycle: fem.MeshCycle, known: Arcs | None = None) -> dict[str, float]:
    """Figures of a cycle with cells, by its arcs where they are known."""
    assert cycle.face is not None
    assert cycle.problem is not None
    arcs = cycle.problem.divided().arcs if known is None else known
    return {
        "face-load factor": cycle.face.greatest_face_load_factor,
        "line load": cycle.face.greatest_line_load,
    } | {figure: float(found(arcs, curve)) for figure, (curve, found) in CURVES.items()}


def reported(cycle: fem.MeshCycle) -> dict[str, float]:
    """Errors that a cycle tells of them, relative."""
    assert cycle.face is not None
    size, off = cycle.transmission_error_harmonics[0], cycle.transmission_error_harmonics_error
    assert off is not None
    found = {figure: float(cycle.errors[name] or 0.0) for figure, name in ERRORS.items()}
    return {
        "face-load factor": cycle.face.error,
        "line load": cycle.face.line_load_error,
        "first harmonic": float(off[0] / size),
    } | found


def one(number: int, seed: int) -> dict[str, Any]:
    """Figures of a pair, their reported errors and the figures twice as fine, as plain numbers."""
    pair, torque, alignment = drawn(np.random.default_rng([seed, number]))
    model = "free-ends" if number % FREE_ENDS_OF == FREE_ENDS_OF - 1 else "walls"
    began = time.process_time()
    bodies = fem.compliance(pair, TOLERANCE)
    given = {"alignment": alignment, "beyond_path": False, "face_model": model, "tolerance": TOLERANCE}

    def cycle(over: fem.PairCompliance, cells: int) -> fem.MeshCycle:
        return fem.mesh_cycle(pair, torque, POSITIONS, over, cells=cells, **given)

    usual = cycle(bodies, CELLS)
    errors = reported(usual)
    assert usual.arcs is not None
    found = figures(usual, usual.arcs.arcs)
    middle = time.process_time()
    refined = number % REFINED_OF == 0 or number == FREE_ENDS_OF - 1
    with twice_as_fine() if refined else nullcontext():
        finer = bodies
        if refined or model == "walls":
            finer = fem.compliance(pair, TOLERANCE, sizes=bodies.sizes, refinements=bodies.refinements + 1)
        true = figures(cycle(finer, 2 * CELLS))
    return {
        "teeth": [pair.pinion.teeth, pair.wheel.teeth],
        "slenderness": pair.face_width / pair.module,
        "misalignment": alignment.in_plane,
        "load": torque / pair.base_radii[0] / pair.face_width,
        "crowning": pair.pinion.lead.crowning,
        "wider": pair.face_widths[0] / pair.face_width,
        "model": model,
        "found": found,
        "errors": errors,
        "refined": refined,
        "true": true,
        "seconds": [middle - began, time.process_time() - middle],
    }


def ratios(row: dict[str, Any]) -> dict[str, tuple[float, bool]]:
    """Reported over true errors by figure, and whether the true one is below a tenth of the tolerance."""
    found = {}
    for name, value in row["found"].items():
        true = abs(value / row["true"][name] - 1.0)
        found[name] = max(row["errors"][name], FLOOR) / max(true, FLOOR), true < SMALL * TOLERANCE
    return found


def show(rows: list[dict[str, Any]]) -> None:
    """Quantiles of the ratios by figure."""
    whole = [row for row in rows if "found" in row]
    print(f"{len(rows) - len(whole)} of {len(rows)} pairs without a solution")
    print(f"{'':31} pairs {'least, 5 %, median, 95 %, largest':^39} within, or small; below, above")
    for model in ("walls", "free-ends"):
        some = [ratios(row) for row in whole if row["model"] == model]
        for name in some[0] if some else ():
            values, small = (np.array([one[name][k] for one in some]) for k in (0, 1))
            print(f"{model:10} {name:20} {len(values):5} {quantiles(values, small)}")


def anew(number: int, seed: int) -> Row:
    """Figures of a pair whose gears nothing was solved for."""
    fem.forget_gears()
    return one(number, seed)


def main(file: Path, pairs: int, seed: int, seconds: float) -> None:
    rows = pair_by_pair(
        file,
        pairs,
        seed,
        seconds,
        anew,
        lambda row: {name: f"{ratio:.2g}{' small' * small}" for name, (ratio, small) in ratios(row).items()},
    )
    if rows is not None:
        show(rows)


if __name__ == "__main__":
    begin(main, 60, SEED)
