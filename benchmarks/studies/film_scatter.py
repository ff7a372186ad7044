"""What films change of the mesh stiffness, foreseen and solved: what ``film.model = "auto"`` relies on.

Random pairs (those of ``closed_form_scatter.py``), oils and speeds. Run with
``python benchmarks/studies/film_scatter.py [scenes] [seed]``.
"""

from __future__ import annotations

import sys
import time
import warnings

import numpy as np
from closed_form_scatter import ordinary

from base import InputError, SolverError
from flankfilm.files.cache import Cache, keep_compiled_code
from flankfilm.plan.film_choice import foreseen_change
from flankfilm.scene.reader import validated
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import DRY_CYCLE, FILM


def lubricated(random: np.random.Generator) -> dict:
    """Keys of a scene with a random pair, oil and speed."""
    raw = ordinary(random)
    raw["operating"]["pinion_speed_rpm"] = float(np.exp(random.uniform(np.log(100), np.log(10_000))))
    raw["lubricant"] = {
        "viscosity_Pa_s": float(np.exp(random.uniform(np.log(0.005), np.log(0.3)))),
        "pressure_viscosity_per_GPa": float(random.uniform(12, 24)),
        "density_kg_per_m3": 870.0,
    }
    return raw


def engine(raw: dict, film: str) -> Engine:
    """Engine of a scene with a film model, teeth by finite elements."""
    scene = validated(raw | {"film": {"model": film}, "tolerance": 0.01})
    return Engine(scene, Cache(None))


def main(count: int, seed: int) -> None:
    keep_compiled_code()
    random = np.random.default_rng(seed)
    rows, seconds = [], []
    while len(rows) < count:
        raw = lubricated(random)
        try:
            solved, formula = engine(raw, "ehl"), engine(raw, "dowson")
            began = time.process_time()
            foreseen = foreseen_change(solved.scene).mean
            middle = time.process_time()
            solved[DRY_CYCLE], formula[DRY_CYCLE]
            start = time.process_time()
            by_films = solved[FILM]
            seconds.append((middle - began, time.process_time() - start))
            rows.append(
                (
                    foreseen,
                    by_films.secant_stiffness_change,
                    by_films.stiffness_change,
                    formula[FILM].secant_stiffness_change,
                )
            )
        except (InputError, SolverError, ValueError) as fault:
            print(f"left out: {' '.join(str(fault).split())[:100]}")
    foreseen, secant, tangent, formula_secant = np.array(rows).T
    span = f"{100 * secant.min():.2g} to {100 * secant.max():.2g} %"
    print(f"{count} scenes, seed {seed}: change of the mean secant stiffness {span}")
    for name, values in (
        ("films solved over foreseen, secant", secant / foreseen),
        ("films solved over foreseen, tangent", tangent / foreseen),
        ("films solved less formula, over foreseen", np.abs(secant - formula_secant) / np.abs(foreseen)),
    ):
        columns = " ".join(f"{v:7.2f}" for v in np.percentile(values, [0, 5, 50, 95, 100]))
        print(f"{name:44} 0, 5, 50, 95, 100 %: {columns}")
    probe, films = np.median(seconds, axis=0)
    print(f"CPU, medians: foreseeing {1e3 * probe:.0f} ms, solved films {1e3 * films:.0f} ms")


if __name__ == "__main__":
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        main(int(sys.argv[1]) if len(sys.argv) > 1 else 40, int(sys.argv[2]) if len(sys.argv) > 2 else 1)
