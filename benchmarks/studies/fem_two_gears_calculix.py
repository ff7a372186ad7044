"""The two gears of ``fem_two_gears`` at the pitch point in CalculiX: the same meshes, penalty contact.

Run with ``python benchmarks/studies/fem_two_gears_calculix.py --folder FOLDER`` where ``ccx`` is installed; one
or two minutes a row. The pinion's bore is turned by D/r_b1, with the approach D that the two-gear model found, the
wheel's bore is held; the torque follows from the reactions. Surface-to-surface contact of CalculiX, linear penalty.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import fem_two_gears as two
import numpy as np

from gears.tooth.rotation import turned
from meshes.abaqus import mesh_text, number

MM = 1e3
"""The deck is in mm, N, MPa: CalculiX's contact has tolerances in plain numbers."""
PREFIX = ("P_", "W_")
ROWS = (  # approach [m], smallest edge [m], penalty [N/mm^3], edges free
    (29.845e-6, 10e-6, 1e8, False),
    (28.40e-6, 30e-6, 1e8, True),
    (28.40e-6, 10e-6, 1e8, True),
    (28.40e-6, 3e-6, 1e8, True),
)


def deck(
    pair,
    stand,
    contacts,
    bodies,
    approaches,
    penalty,
    step="*STEP, INC=200",
    static="*STATIC\n0.5, 1.",
    last="",
):
    """Text of the deck that turns the pinion by each approach in turn; numbers and places (mm) of its bore's nodes."""
    starts, meshes, node = [], [], 1
    for gear, body in enumerate(bodies):
        mesh = replace(body.mesh, points=MM * stand.out(gear, body.mesh.points))
        starts.append(node)
        meshes.append(mesh)
        node += len(mesh.points)
    text = ["*HEADING", "two gears, mm N MPa", mesh_text(dict(zip(PREFIX, meshes, strict=True))).rstrip()]
    for prefix, material in zip(PREFIX, pair.materials, strict=True):
        text += [f"*MATERIAL, NAME={prefix}MATERIAL", "*ELASTIC"]
        text += [f"{number(1e-6 * material.youngs_modulus)}, {number(material.poisson_ratio)}"]
        text += [f"*SOLID SECTION, ELSET={prefix}GEAR, MATERIAL={prefix}MATERIAL", "1."]
    text += [
        "*SURFACE INTERACTION, NAME=FLANKS",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{penalty:g}, 1.e-3",
    ]
    for _, mortar, teeth, _ in contacts:
        names = [
            f"{prefix}FLANK_LEFT_{tooth if tooth >= 0 else f'MINUS_{-tooth}'}"
            for prefix, tooth in zip(PREFIX, teeth, strict=True)
        ]
        text += [
            "*CONTACT PAIR, INTERACTION=FLANKS, TYPE=SURFACE TO SURFACE",
            f"{names[mortar]}, {names[1 - mortar]}",
        ]
    text += ["*BOUNDARY", "W_BORE, 1, 2"]
    bore = np.unique(meshes[0].facets["bore"])
    places = meshes[0].points[bore]
    for approach in approaches:
        moves = turned(places, approach / pair.base_radii[0]) - places
        text += [step, static, "*BOUNDARY"]
        for n, move in zip(bore + starts[0], moves, strict=True):
            text += [f"{n}, {i + 1}, {i + 1}, {number(move[i])}" for i in (0, 1)]
        text += [f"*NODE PRINT, NSET=P_BORE{last}", "RF", "*END STEP"]
    return "\n".join([*text, ""]), bore + starts[0], places


def torque(printed, nodes, places):
    """Moment [N m per mm of face] of the last reactions printed."""
    forces = {}
    for row in printed.split("forces (fx,fy,fz) for set P_BORE")[-1].splitlines():
        parts = row.split()
        if len(parts) == 4 and parts[0].isdigit():
            forces[int(parts[0])] = [float(part) for part in parts[1:3]]
    pull = np.array([forces[int(n)] for n in nodes])
    return float(np.sum(places[:, 0] * pull[:, 1] - places[:, 1] * pull[:, 0])) / MM


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, required=True, help="where CalculiX works")
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    pair = two.PAIR
    placed = pair.placement(float(pair.points.C))
    stand = two.Stand((placed.pinion_angle, placed.wheel_angle), (np.zeros(2), placed.wheel_centre))
    for approach, edge, penalty, free in ROWS:
        began = time.perf_counter()
        contacts = two.candidates(pair, pair.points.C, free)
        bodies = two.meshed(pair, stand, contacts, edge, 8e-6, 0.0, 0.15, 1.0)
        text, nodes, places = deck(pair, stand, contacts, bodies, (approach,), penalty)
        (folder / "two.inp").write_text(text, encoding="ascii")
        subprocess.run(["ccx", "two"], cwd=folder, check=True, capture_output=True)
        moment = torque((folder / "two.dat").read_text(), nodes, places) * MM * pair.face_width
        stiffness = moment / pair.base_radii[0] / pair.face_width / approach / 1e9
        where = "edges free" if free else "held to A..E"
        print(
            f"C, {where}, smallest edge {1e6 * edge:g} um, D {1e6 * approach:.3f} um: "
            f"{moment:.2f} N m, {stiffness:.4f} N/mm um, {time.perf_counter() - began:.0f} s",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
