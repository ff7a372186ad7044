"""A plastic wheel near A and E in CalculiX with NLGEOM: all pairs that may touch, corners included.

Run with ``python benchmarks/studies/fem_corners_calculix.py --folder FOLDER`` where ``ccx`` is installed. Pair
and convention of ``fem_moving_contact``: the pinion's bore is turned by D/r_b1 in steps, the wheel's is held, and the
torque follows from the reactions. Beside it ``fem.mesh_cycle`` at the torque found, contacts that stay and that move.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from pathlib import Path

import fem_two_gears as two
import numpy as np
from fem_moving_contact import PLASTIC, reactions
from fem_two_gears_calculix import deck

import fem
from fem.contact.solver import solve_contact
from fem.laws.mesh_setup import MeshSetup
from meshes.annulus import turned

TORQUES = (5.0, 20.0)

LARGE = {"step": "*STEP, INC=400, NLGEOM", "static": "*STATIC\n0.25, 1.", "last": ", FREQUENCY=1000"}
"""Steps of large deflections, of which the last increment is printed."""


def ours(bodies, position, torque, moving):
    """Deflection [m] by ``fem.mesh_cycle``'s solver."""
    given = MeshSetup(bodies.pair, 1, moving_contact=moving).at(np.array([position]))
    found = solve_contact(given, bodies, np.array([torque / bodies.pair.base_radii[0]]), None)
    return float(found.share.transmission_error[0, 0, 0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, required=True, help="where CalculiX works")
    parser.add_argument("--end", choices=("A", "E"), default="E")
    parser.add_argument(
        "--away", type=float, nargs="*", default=(-0.01,), help="base pitches beyond that end"
    )
    parser.add_argument("--h", type=float, default=40e-6, help="edges at the contacts [m]")
    parser.add_argument("--corner", type=float, default=10e-6, help="edges at the corners [m]")
    parser.add_argument("--penalty", type=float, default=1e7, help="N/mm^3")
    given = parser.parse_args()
    pair = PLASTIC.with_backlash(400e-6)
    bodies = fem.compliance(pair, tolerance=1e-3)
    for away in given.away:
        end = 0.0 if given.end == "A" else (pair.points.E - pair.points.A) / pair.base_pitch
        position = (end + (away if given.end == "E" else -away)) % 1.0
        start = float(pair.points.A + position * pair.base_pitch)
        placed = pair.placement(start)
        stand = two.Stand((placed.pinion_angle, placed.wheel_angle), (np.zeros(2), placed.wheel_centre))
        contacts = two.candidates(pair, start, True)
        meshed = two.meshed(pair, stand, contacts, given.corner, given.h, 0.0, 0.2, 1.4, 250e-6, 0.45e-3)
        approaches = [ours(bodies, position, torque, True) for torque in TORQUES]
        folder = given.folder / f"{given.end}{away:+g}"
        folder.mkdir(parents=True, exist_ok=True)
        text, nodes, places = deck(pair, stand, contacts, meshed, approaches, given.penalty, **LARGE)
        (folder / "two.inp").write_text(text, encoding="ascii")
        began = time.perf_counter()
        print("nodes", [len(body.mesh.points) for body in meshed], "pairs", contacts, flush=True)
        subprocess.run(["ccx", "two"], cwd=folder, check=True, capture_output=True)
        pulls = reactions((folder / "two.dat").read_text(), "P_BORE", nodes)
        for approach, pull in zip(approaches, pulls, strict=True):
            at = turned(places, approach / pair.base_radii[0])
            torque = float(np.sum(at[:, 0] * pull[:, 1] - at[:, 1] * pull[:, 0]) * pair.face_width)
            stays, moves = (ours(bodies, position, abs(torque), moving) for moving in (False, True))
            print(
                f"{given.end} {away:+g}: {torque:.4f} N m at D {1e6 * approach:.3f} um; stays {1e6 * stays:.3f}, "
                f"moves {1e6 * moves:.3f}: {100 * (stays / approach - 1):+.2f}, {100 * (moves / approach - 1):+.2f} %",
                flush=True,
            )
        print(f"{time.perf_counter() - began:.0f} s", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
