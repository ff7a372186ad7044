"""True errors of runs that choose their own models, against runs with all models and a twentieth of the tolerance.

Scenes with ``model = "auto"`` for stiffness and film and an order of the series to be found, at tolerances from 5 % to
0.1 %; references by finite elements and solved films at a twentieth of the least tolerance. Run with
``python benchmarks/studies/tolerance_true_errors.py [part of a scene's name]``.
"""

from __future__ import annotations

import os
import sys
import time
import warnings

import numpy as np

from flankfilm.files.cache import Cache, keep_compiled_code
from flankfilm.scene.reader import validated
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import FILM, MESH, PLAN
from flankfilm.stages.motion import FOURIER

TOLERANCES = (0.05, 0.01, 0.005, 0.001)

ARTICLE = {
    "wants": ["stiffness", "fourier"],
    "pair": {
        "module_mm": 2.0,
        "face_width_mm": 40.0,
        "pinion": {"teeth": 36, "bore_mm": 33.5},
        "wheel": {"teeth": 40, "bore_mm": 37.5},
    },
    "material": {"youngs_modulus_GPa": 200.2, "poisson_ratio": 0.3},
    "operating": {"pinion_torque_Nm": 600.0, "pinion_speed_rpm": 2000.0},
    "lubricant": {"viscosity_Pa_s": 0.075, "pressure_viscosity_per_GPa": 19.6, "density_kg_per_m3": 910.0},
}


def changed(**keys: object) -> dict:
    """The article's scene with other keys, dots written as double underlines."""
    raw = {name: dict(value) if isinstance(value, dict) else value for name, value in ARTICLE.items()}
    for key, value in keys.items():
        section, name = key.split("__")
        raw[section] = raw.get(section, {}) | {name: value}
    return raw


RELIEF = {"amount_um": 20.0, "length_mm": 2.0}
SCENES = {
    "article": changed(),
    "article, pairs independent": changed(stiffness__pairs="independent"),
    "light load, fast, thick oil": changed(
        operating__pinion_torque_Nm=100.0, operating__pinion_speed_rpm=6000.0, lubricant__viscosity_Pa_s=0.3
    ),
    "17/60, shifted, relieved": changed(
        pair__pinion={"teeth": 17, "profile_shift": 0.4, "bore_mm": 12.0, "tip_relief": RELIEF},
        pair__wheel={"teeth": 60, "profile_shift": 0.1, "tip_relief": RELIEF},
        operating__pinion_torque_Nm=150.0,
    ),
    "thin rims, thin oil": changed(
        pair__pinion={"teeth": 36, "bore_mm": 60.0},
        pair__wheel={"teeth": 40, "bore_mm": 68.0},
        lubricant__viscosity_Pa_s=0.01,
    ),
}


def run(raw: dict, tolerance: float, stiffness: str, film: str, order: object) -> tuple[Engine, float]:
    """Engine that has computed the scene, and its CPU seconds."""
    models = {
        "tolerance": tolerance,
        "stiffness": raw.get("stiffness", {}) | {"model": stiffness},
        "film": {"model": film},
        "dynamics": {"fourier_order": order},
    }
    engine = Engine(validated(raw | models), Cache(None))
    began = time.process_time()
    engine[FOURIER]
    return engine, time.process_time() - began


def main(part: str) -> None:
    keep_compiled_code()
    run(ARTICLE, 0.05, "fem", "ehl", 1)
    heads = (
        "tolerance",
        "stiffness",
        "film",
        "order",
        "mean secant",
        "curve",
        "tangent",
        "error ptp",
        "seconds",
    )
    for name, raw in SCENES.items():
        if part not in name:
            continue
        finest, seconds = run(raw, min(TOLERANCES) / 20, "fem", "ehl", 50)
        true, change = finest[MESH], finest[FILM].secant_stiffness_change
        print(f"\n{name}: reference {seconds:.1f} s, film {100 * change:+.3f} %", flush=True)
        print("| " + " | ".join(heads) + " |")
        for tolerance in TOLERANCES:
            engine, seconds = run(raw, tolerance, "auto", "auto", "auto")
            plan, mesh, series = engine[PLAN], engine[MESH], engine[FOURIER].stiffness
            at = 2 * np.pi * true.position[:, None] * np.arange(1, len(series.amplitudes) + 1)
            curve = series.mean + np.cos(at + np.array(series.phases)) @ np.array(series.amplitudes)
            values = (
                mesh.mean_secant_stiffness / true.mean_secant_stiffness - 1,
                np.sqrt(np.mean((curve - true.secant_stiffness) ** 2)) / true.mean_secant_stiffness,
                mesh.mean_stiffness / true.mean_stiffness - 1,
                np.ptp(mesh.transmission_error) / np.ptp(true.transmission_error) - 1,
            )
            columns = " | ".join(f"{100 * value:+.3f} %" for value in values)
            models = f"{plan.stiffness.choice} | {plan.film.choice} | {len(series.amplitudes)}"
            print(f"| {100 * tolerance:g} % | {models} | {columns} | {seconds:.2f} |", flush=True)


if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        main(sys.argv[1] if len(sys.argv) > 1 else "")
