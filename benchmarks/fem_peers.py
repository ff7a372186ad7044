"""Mesh stiffness of one pair by open programs, against the converged answer of the finite elements here.

Run with ``python benchmarks/fem_peers.py --folder FOLDER``: it makes an environment of its own in FOLDER (minutes,
needs the network; a second run uses it again), installs the peer there, and asks it for the stiffness at 40
midpoints of equal intervals of one base pitch. Nothing is installed into the environment that runs this script.
Seconds are CPU time without imports, the mean of three runs after a first one.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
import venv
from pathlib import Path

import numpy as np

import fem
from gears import Gear, GearPair, closed_form

POSITIONS, TORQUE = 40, 600.0
PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04)
ROSS = ("ross-rotordynamics", "plotly<6")

# runs in the peer's environment; module, face width, teeth and bores come as JSON on standard input
ASK_ROSS = """
import json, sys, time
import numpy as np
from ross.gear_element import GearElementTVMS, Mesh
from ross.materials import Material
import ross
given = json.load(sys.stdin)
steel = Material(name="steel", rho=7850, E=206e9, Poisson=0.3)
gears = [
    GearElementTVMS(n=0, material=steel, width=given["width"], bore_diameter=2 * bore, module=given["module"],
                    n_teeth=teeth, pr_angle=np.pi / 9)
    for teeth, bore in zip(given["teeth"], given["bores"])
]
mesh = Mesh(*gears)
angles = 2 * np.pi / given["teeth"][0] * (np.arange(given["positions"]) + 0.5) / given["positions"]
runs = []
for _ in range(4):
    began = time.process_time()
    stiffness = [float(mesh.get_variable_stiffness(angle)) for angle in angles]
    runs.append(time.process_time() - began)
print(json.dumps({"version": ross.__version__, "stiffness": stiffness, "seconds": sum(runs[1:]) / 3}))
"""


def environment(folder, packages):
    """Python of an environment in the folder that holds the packages."""
    python = folder / "bin" / "python"
    if not python.exists():
        venv.create(folder, with_pip=True)
    command = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *packages]
    subprocess.run(command, check=True)
    return python


def ask_ross(folder):
    python = environment(folder / "ross", ROSS)
    given = {
        "width": PAIR.face_width,
        "module": PAIR.module,
        "teeth": [profile.teeth for profile in PAIR.teeth_profiles],
        "bores": [profile.bore_radius for profile in PAIR.teeth_profiles],
        "positions": POSITIONS,
    }
    done = subprocess.run(
        [str(python), "-I", "-W", "ignore", "-c", ASK_ROSS],
        input=json.dumps(given),
        capture_output=True,
        text=True,
        check=True,
    )
    answer = next(
        line for line in done.stdout.splitlines() if line.startswith('{"version"')
    )  # it prints its own too
    return json.loads(answer)


def timed(call):
    call()
    began = time.process_time()
    for _ in range(3):
        result = call()
    return result, (time.process_time() - began) / 3


def line(name, stiffness, seconds, reference):
    per_mm = np.asarray(stiffness) / PAIR.face_width / 1e9
    error = per_mm.mean() / reference - 1
    low, high = per_mm.min(), per_mm.max()
    print(
        f"{name:58s} {per_mm.mean():7.2f} {low:7.2f} {high:7.2f} {1e3 * seconds:8.1f} {100 * error:+7.2f} %"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, required=True, help="where the peers' environments are made")
    folder = parser.parse_args().folder
    finest = fem.compliance(PAIR, refinements=2)
    reference = fem.mesh_cycle(PAIR, TORQUE, POSITIONS, finest, beyond_path=False).secant_stiffness
    mean = reference.mean() / PAIR.face_width / 1e9
    print(f"{'N/(mm um)':58s} {'mean':>7s} {'least':>7s} {'most':>7s} {'CPU ms':>8s} {'mean':>9s}")
    line("fem, contact held to the path, finer mesh (reference)", reference, finest.cost.seconds, mean)
    held, seconds = timed(lambda: fem.mesh_cycle(PAIR, TORQUE, POSITIONS, beyond_path=False).secant_stiffness)
    line("fem, contact held to the path, tolerance 0.1 %", held, seconds, mean)
    free, seconds = timed(lambda: fem.mesh_cycle(PAIR, TORQUE, POSITIONS).secant_stiffness)
    line("fem, tip edges free to touch (default)", free, seconds, mean)
    at = (np.arange(POSITIONS) + 0.5) / POSITIONS * PAIR.base_pitch
    last = int(np.ceil(PAIR.contact_ratio))
    places = PAIR.points.A + at[:, None] + np.arange(last) * PAIR.base_pitch
    inside = places <= PAIR.points.E
    path = PAIR.path_at(np.minimum(places, PAIR.points.E).ravel())
    forms = {
        "ishikawa": lambda: closed_form.ishikawa(PAIR, path),
        "potential_energy": lambda: closed_form.potential_energy(PAIR, path),
        "weber_banaschek": lambda: closed_form.weber_banaschek(PAIR, path, PAIR.normal_force(TORQUE)),
    }
    for name, form in forms.items():
        single, seconds = timed(lambda form=form: np.asarray(form()).reshape(inside.shape))
        line(
            f"gears.closed_form.{name}, independent pairs",
            np.where(inside, single, 0).sum(axis=1),
            seconds,
            mean,
        )
    ross = ask_ross(folder)
    line(f"ross-rotordynamics {ross['version']}, GearElementTVMS", ross["stiffness"], ross["seconds"], mean)
    return 0


if __name__ == "__main__":
    sys.exit(main())
