"""How far the closed forms are from finite elements over ordinary pairs: what ``stiffness.model = "auto"`` relies on.

Random pairs of the ranges in `ordinary`, the same for the same seed. For each, the mesh stiffness over the cycle by
every closed form and by finite elements with the same rule for the pairs in contact. Run with
``python benchmarks/studies/closed_form_scatter.py [pairs] [seed]``.
"""

from __future__ import annotations

import sys
import time
import warnings

import numpy as np

from base import InputError, SolverError
from flankfilm.coupling.mesh.single_pairs import CLOSED_FORMS
from flankfilm.files.cache import Cache
from flankfilm.scene import Scene
from flankfilm.scene.reader import validated
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import DRY_CYCLE


def ordinary(random: np.random.Generator) -> dict:
    """Keys of a scene with an ordinary pair of steel gears."""
    z1 = int(random.integers(17, 61))
    z2 = min(round(z1 * np.exp(random.uniform(0, np.log(4)))), 150)
    x1 = random.uniform(0.0, 0.5)
    shifts = (x1, random.uniform(-x1, 0.3))
    module, width = 2.0, random.uniform(10, 30)  # stiffness per face width knows no size
    load = np.exp(random.uniform(np.log(20), np.log(300)))  # force over face width and module [N/mm2]
    root = [0.5 * module * (z + 2 * x - 2.5) for z, x in zip((z1, z2), shifts, strict=True)]
    bores = [2 * r * random.uniform(0.2, 0.7) for r in root]
    base_radius = 0.5e-3 * module * z1 * np.cos(np.radians(20))
    return {
        "wants": ["stiffness"],
        "pair": {
            "module_mm": module,
            "face_width_mm": width * module,
            "pinion": {"teeth": z1, "profile_shift": shifts[0], "bore_mm": bores[0]},
            "wheel": {"teeth": z2, "profile_shift": shifts[1], "bore_mm": bores[1]},
        },
        "material": {"youngs_modulus_GPa": 206.0, "poisson_ratio": 0.3},
        "operating": {"pinion_torque_Nm": load * module * width * module * base_radius},
        "stiffness": {},
    }


def curve(raw: dict, model: str, pairs: str) -> tuple[np.ndarray, float]:
    """Secant stiffness over the cycle and the CPU time of everything [N/m, s]."""
    scene: Scene = validated(raw | {"stiffness": {"model": model, "pairs": pairs}})
    began = time.process_time()
    cycle = Engine(scene, Cache(None))[DRY_CYCLE]
    took = time.process_time() - began
    return cycle.secant_stiffness.reshape(120, -1).mean(axis=1), took


def main(count: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    keys = [(model, pairs) for pairs in ("coupled", "independent") for model in CLOSED_FORMS]
    root_mean_square: dict = {key: [] for key in keys}
    mean: dict = {key: [] for key in keys}
    seconds: dict = {key: [] for key in (*keys, ("fem", "coupled"), ("fem", "independent"))}
    while len(mean[keys[0]]) < count:
        raw = ordinary(random)
        try:
            reference = {pairs: curve(raw, "fem", pairs) for pairs in ("coupled", "independent")}
            forms = {key: curve(raw, *key) for key in keys}
        except (InputError, SolverError, ValueError) as fault:
            print(f"left out: {' '.join(str(fault).split())[:100]}")
            continue
        for pairs, (_, took) in reference.items():
            seconds["fem", pairs].append(took)
        for key, (k, took) in forms.items():
            whole = reference[key[1]][0]
            mean[key].append(k.mean() / whole.mean() - 1)
            root_mean_square[key].append(np.sqrt(np.mean((k - whole) ** 2)) / whole.mean())
            seconds[key].append(took)
    print(
        f"{count} pairs, seed {seed}; difference of the mean, and of the curve (root mean square), over the mean"
    )
    heads = ("mean: 0", "5", "50", "95", "100 %", "rms: 50", "95", "100 %", "CPU")
    print(f"{'model, pairs':34}" + "".join(f"{head:>9}" for head in heads))
    for key in keys:
        m = 100 * np.percentile(mean[key], [0, 5, 50, 95, 100])
        r = 100 * np.percentile(root_mean_square[key], [50, 95, 100])
        columns = "".join(f"{v:+9.1f}" for v in m) + "".join(f"{v:9.1f}" for v in r)
        print(f"{', '.join(key):34} {columns} {1e3 * np.median(seconds[key]):6.1f} ms")
    for pairs in ("coupled", "independent"):
        print(f"{f'fem, {pairs}':34}{1e3 * np.median(seconds['fem', pairs]):79.1f} ms")


if __name__ == "__main__":
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        main(int(sys.argv[1]) if len(sys.argv) > 1 else 100, int(sys.argv[2]) if len(sys.argv) > 2 else 1)
