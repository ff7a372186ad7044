"""From the scene to the jump speed: true error, estimate and cost of every stage against the tolerance asked for.

Three scenes at tolerances from 5 to 0.05 %, their models to be decided, against finite elements and solved films at a
quarter of the least tolerance with a series of 50 harmonics. A jump is held against the nearest of the reference in
which the motion ends the same way, as the speed rises or as it falls. Processor time of one thread, from nothing; gears
that the process holds are forgotten before each run. Run with
``python benchmarks/studies/end_to_end.py [part of a name [tolerance ...]]``.
"""

from __future__ import annotations

import os
import sys
import time
import warnings
from collections import Counter
from typing import Any

import numpy as np

import fem
from flankfilm.files.cache import Cache, keep_compiled_code
from flankfilm.products.diagram import DIAGRAM
from flankfilm.scene.reader import validated
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import FILM, MESH, PLAN
from flankfilm.stages.motion import FOURIER

TOLERANCES = (0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005)

STEEL = {"youngs_modulus_GPa": 206.0, "poisson_ratio": 0.3}
OIL = {"viscosity_Pa_s": 0.075, "pressure_viscosity_per_GPa": 19.6, "density_kg_per_m3": 910.0}
RELIEF = {"amount_um": 20.0, "length_mm": 2.0}


def scene(
    pinion: dict[str, Any],
    wheel: dict[str, Any],
    torque: float,
    rpm: float,
    between: tuple[float, float],
    wheel_material: dict[str, float] = STEEL,
    width: float = 40.0,
) -> dict[str, Any]:
    """Scene of a pair of module 2 mm with a diagram of its first resonance."""
    return {
        "wants": ["stiffness", "film", "fourier", "diagram"],
        "pair": {
            "module_mm": 2.0,
            "face_width_mm": width,
            "backlash_um": 50.0,
            "pinion": pinion,
            "wheel": wheel,
        },
        "material": {"pinion": STEEL, "wheel": wheel_material},
        "operating": {"pinion_torque_Nm": torque, "pinion_speed_rpm": rpm},
        "lubricant": OIL,
        "dynamics": {
            "damping_ratio": 0.05,
            "error_amplitude_um": 5.0,
            "diagram": {"frequency": between, "max_period": 1, "searches": 3},
        },
    }


SCENES = {
    "article's pair": scene(
        {"teeth": 36, "bore_mm": 33.5}, {"teeth": 40, "bore_mm": 37.5}, 600.0, 2000.0, (0.5, 1.2)
    ),
    "17/60, shifted and relieved": scene(
        {"teeth": 17, "profile_shift": 0.4, "bore_mm": 12.0, "tip_relief": RELIEF},
        {"teeth": 60, "profile_shift": 0.1, "tip_relief": RELIEF},
        150.0,
        3000.0,
        (0.5, 1.2),
    ),
    "wheel of PA66": scene(
        {"teeth": 17},
        {"teeth": 51},
        8.0,
        1500.0,
        (0.5, 1.2),
        {"youngs_modulus_GPa": 3.0, "poisson_ratio": 0.4, "density_kg_per_m3": 1140.0},
        20.0,
    ),
}

PARTS = {
    "bodies": "elements",
    "dry cycle": "contact",
    "film": "film",
    "curve series": "series",
    "fourier": "series",
    "branches": "motion",
    "diagram": "motion",
}
"""Stages whose cost has a column; the rest is added up."""


def run(raw: dict[str, Any], tolerance: float, model: str, order: object) -> tuple[Engine, float]:
    """Engine that has computed the scene, and its processor time [s]."""
    models = {
        "tolerance": tolerance,
        "stiffness": {"model": model},
        "film": {"model": "ehl" if model == "fem" else model},
        "dynamics": raw["dynamics"] | {"fourier_order": order},
    }
    fem.forget_gears()
    engine = Engine(validated(raw | models), Cache(None))
    began = time.process_time()
    engine[DIAGRAM]
    return engine, time.process_time() - began


def shares(engine: Engine, seconds: float) -> list[str]:
    """Processor time of each part, in proportion to the stages' times [s]."""
    spent = Counter(dict.fromkeys((*PARTS.values(), "rest"), 0.0))
    for name, stage in engine.runs.items():
        spent[PARTS.get(name, "rest")] += stage.seconds
    whole = sum(spent.values())
    return [f"{seconds * part / whole:.2f}" for part in spent.values()]


def errors(found: Engine, true: Engine) -> list[str]:
    """True error and, after a stroke, its estimate, in per cent: mean secant, peak to peak, least film, jumps."""
    mesh, known = found[MESH], true[MESH]
    shown = []
    for name in ("mean_secant_stiffness", "transmission_error_range"):
        off = getattr(mesh, name) / getattr(known, name) - 1
        shown.append(f"{100 * abs(off):.3g} / {100 * mesh.errors[name]:.2g}")
    film, exact = (engine[FILM] if engine[PLAN].film.choice == "ehl" else None for engine in (found, true))
    shown.append(
        "by formula"
        if film is None or exact is None
        else f"{100 * abs(film.thinnest_film / exact.thinnest_film - 1):.3g} / {100 * film.film.error:.2g}"
    )
    return [*shown, *jump_errors(found, true)]


def jump_errors(found: Engine, true: Engine) -> list[str]:
    """Jumps that were found, and named as missed, of those there are; the worst of each direction with its estimate."""
    diagram, known = found[DIAGRAM], true[DIAGRAM]
    shown = [f"{len(diagram.jumps)} + {len(diagram.missed)} of {len(known.jumps)}"]
    for rising in (True, False):
        there = np.array([known.speed_of_one * j.frequency for j in known.jumps if j.rising is rising])
        offs = [
            (float(np.min(np.abs(diagram.speed_of_one * j.frequency / there - 1), initial=np.inf)), j.error)
            for j in diagram.jumps
            if j.rising is rising
        ]
        if not offs:
            shown.append("none")
            continue
        off, error = max(offs)
        beyond = sum(o > e for o, e in offs)
        shown.append(f"{100 * off:.3g} / {100 * error:.2g}" + (f" ({beyond} beyond)" if beyond else ""))
    return shown


def main(part: str, tolerances: tuple[float, ...]) -> None:
    """Print a table for each scene."""
    keep_compiled_code()
    heads = (
        "tolerance | models | mean secant | peak to peak | least film | jumps | jump up | jump down | seconds",
        " | ".join((*dict.fromkeys(PARTS.values()), "rest")),
    )
    for name, raw in SCENES.items():
        if part not in name:
            continue
        run(raw, 0.05, "auto", "auto")  # loads the kernels
        true, seconds = run(raw, 0.25 * min(TOLERANCES), "fem", 50)
        print(f"\n{name} (reference {seconds:.1f} s)\n| {' | '.join(heads)} |", flush=True)
        for tolerance in tolerances:
            engine, seconds = run(raw, tolerance, "auto", "auto")
            plan, order = engine[PLAN], len(engine[FOURIER].stiffness.amplitudes)
            tried = "".join(f"{number}, " for number, _ in engine[FOURIER].tried)
            models = f"{plan.stiffness.choice}, {plan.film.choice}, {tried}{order}"
            cells = [f"{100 * tolerance:g} %", models, *errors(engine, true), f"{seconds:.1f}"]
            print(f"| {' | '.join([*cells, *shares(engine, seconds)])} |", flush=True)


if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        main(sys.argv[1] if len(sys.argv) > 1 else "", tuple(map(float, sys.argv[2:])) or TOLERANCES)
