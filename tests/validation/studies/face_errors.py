"""Reported against true errors of mesh cycles with cells along the face, over random pairs.

Pairs of `tests/hard/random_pairs.py`, faces of 4 to 25 modules, steel, axes out of parallel by 2 to 60 um, half of them
crowned and a quarter with end relief, under full, a tenth or a fiftieth of the load. True: twice the cells; of every
tenth pair also twice the waves and places, one refinement more, and at free ends pieces of half the length and elements
of 0.7 of it. One pair of twenty has free ends, the others walls. Every pair's figures go to a line of a file as soon
as they are known: a study that was cut off goes on where it stopped. Run from the root with

    PYTHONPATH=. python tests/validation/studies/face_errors.py FILE [pairs] [seed] [seconds]

until it prints the table. Without a seed it is that of ``tests/seeds.py``.
"""

from __future__ import annotations

import json
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import fem
import fem.free_ends
import fem.gear_face
from base import FlankfilmError
from gears import Alignment, GearPair, Lead, Material
from tests.hard.random_pairs import random_pair
from tests.seeds import SEED

STEEL = Material(206e9, 0.3, 7850.0)

LINE_LOAD = 440e3
"""Greatest load [N per m of face]."""

CELLS, POSITIONS, TOLERANCE = 64, 8, 5e-3

FREE_ENDS_OF, REFINED_OF = 20, 10
"""One pair of so many has free ends, and one of so many is refined in all."""

FLOOR = 1e-5
"""Errors below this part of a figure count as it."""


def drawn(rng: np.random.Generator) -> tuple[GearPair, float, Alignment]:
    """A pair with leads, its torque, and the alignment."""
    while True:
        pair, chance = random_pair(rng), rng.random(8)
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
            pair = replace(pair, pinion=pinion, wheel=wheel, face_width=width, material=STEEL)
        except FlankfilmError:
            continue
        load = LINE_LOAD * (1.0, 0.1, 0.02)[int(3 * chance[5])]
        return pair, load * width * pair.base_radii[0], Alignment(2e-6 * 30.0 ** chance[6])


@contextmanager
def twice_as_fine() -> Iterator[None]:
    """Twice the waves and places; pieces at free ends of half the length, elements there of 0.7 of it."""
    ends, face = fem.free_ends, fem.gear_face
    before = face.WAVES, face.PLACES, face.ENDS_SIZES, ends.LAST
    face.WAVES, face.PLACES, ends.LAST = 2 * before[0], 2 * before[1], before[3] / 2
    face.ENDS_SIZES = before[2].scaled(0.7)
    try:
        yield
    finally:
        face.WAVES, face.PLACES, face.ENDS_SIZES, ends.LAST = before


def figures(cycle: fem.MeshCycle) -> dict[str, float]:
    """Figures of a cycle with cells."""
    assert cycle.face is not None
    return {
        "face-load factor": cycle.face.greatest_face_load_factor,
        "line load": cycle.face.greatest_line_load,
        "mean tangent": float(cycle.stiffness.mean()),
        "mean secant": float(cycle.secant_stiffness.mean()),
        "transmission error": float(np.ptp(cycle.transmission_error)),
    }


def one(number: int, seed: int) -> dict[str, Any]:
    """Figures of a pair, their reported errors and the figures twice as fine, as plain numbers."""
    pair, torque, alignment = drawn(np.random.default_rng([seed, number]))
    model = "free-ends" if number % FREE_ENDS_OF == FREE_ENDS_OF - 1 else "walls"
    began = time.process_time()
    bodies = fem.compliance(pair, TOLERANCE)
    given = {"alignment": alignment, "beyond_path": False, "face_model": model}

    def cycle(over: fem.Compliance, cells: int, **more: str) -> fem.MeshCycle:
        return fem.mesh_cycle(pair, torque, POSITIONS, over, cells=cells, **(given | more))

    usual = cycle(bodies, CELLS)
    middle = time.process_time()
    if refined := number % REFINED_OF == 0:
        with twice_as_fine():
            finer = fem.compliance(pair, TOLERANCE, sizes=bodies.sizes, refinements=bodies.refinements + 1)
            best = cycle(finer, 2 * CELLS)
    else:
        best = cycle(bodies, 2 * CELLS)
    assert usual.face is not None
    return {
        "teeth": [pair.pinion.teeth, pair.wheel.teeth],
        "slenderness": pair.face_width / pair.module,
        "model": model,
        "found": figures(usual),
        "errors": {"face": usual.face.error, "cycle": usual.error},
        "refined": refined,
        "true": figures(best),
        "seconds": [middle - began, time.process_time() - middle],
    }


def ratios(row: dict[str, Any]) -> dict[str, float]:
    """Reported over true errors by figure."""
    found = {}
    for name, value in row["found"].items():
        over_face = name in ("face-load factor", "line load")
        reported = row["errors"]["face" if over_face else "cycle"]
        true = abs(value / row["true"][name] - 1.0)
        found[name] = max(reported, FLOOR) / max(true, FLOOR)
    return found


def show(rows: list[dict[str, Any]]) -> None:
    """Quantiles of the ratios by figure."""
    whole = [row for row in rows if "found" in row]
    print(f"{len(rows) - len(whole)} of {len(rows)} pairs without a solution")
    for model in ("walls", "free-ends"):
        some = [ratios(row) for row in whole if row["model"] == model]
        for name in some[0] if some else ():
            values = np.array([one[name] for one in some])
            columns = " ".join(f"{v:7.2f}" for v in np.percentile(values, [0, 5, 50, 95, 100]))
            inside = np.mean((values >= 0.5) & (values <= 5.0))
            print(f"{model:10} {name:20} {len(values):4} {columns} {100 * inside:5.0f} % between 0.5 and 5")


def main(file: Path, pairs: int, seed: int, seconds: float) -> None:
    began = time.monotonic()
    rows = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []
    known = {(row["seed"], row["number"]) for row in rows}
    for number in range(pairs):
        if (seed, number) in known:
            continue
        if time.monotonic() - began > seconds:
            print(f"{len(rows)} of {pairs} pairs: run it again to go on")
            return
        fem.forget_gears()
        try:
            row = one(number, seed)
        except FlankfilmError as fault:
            row = {"fault": f"{type(fault).__name__}: {fault}"[:300]}
        row |= {"seed": seed, "number": number}
        rows.append(row)
        with file.open("a") as kept:
            kept.write(json.dumps(row) + "\n")
        said = (
            {name: f"{ratio:.2g}" for name, ratio in ratios(row).items()} if "found" in row else row["fault"]
        )
        print(number, row.get("teeth"), row.get("model"), said, row.get("seconds"), flush=True)
    show(rows)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    words = sys.argv[1:]
    given = [float(word) for word in words[1:]]
    chosen = int(given[1]) if len(given) > 1 else SEED
    main(Path(words[0]), int(given[0]) if given else 60, chosen, given[2] if len(given) > 2 else np.inf)
