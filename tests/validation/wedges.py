"""Plane meshes extruded into 15-node wedges, and their displacements by CalculiX, an independent program."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from base import Array, Integers
from fem.elasticity.plane_elasticity import PlaneElasticity
from meshes.abaqus import number

__all__ = ["CCX", "REQUIRED", "displacements", "heights_of", "line_forces", "wedges"]

CCX = shutil.which("ccx")
REQUIRED = os.environ.get("FLANKFILM_REQUIRE_CCX") == "1"
PATIENCE = 900
"""Seconds for one solution."""


def heights_of(levels: Array) -> Array:
    """Places along the face of the copies of the plane's nodes: at levels, then between them."""
    return np.concatenate([levels, 0.5 * (levels[1:] + levels[:-1])])


def wedges(triangles: Integers, count: int, layers: int) -> Integers:
    """Nodes of the wedges (layers m, 15); node i of the plane is i + k count in copy k of ``heights_of``."""
    elements = []
    for k in range(layers):
        low, high = triangles + k * count, triangles + (k + 1) * count
        middle = triangles[:, :3] + (layers + 1 + k) * count
        elements.append(np.hstack([low[:, :3], high[:, :3], low[:, 3:], high[:, 3:], middle]))
    return np.concatenate(elements)


def line_forces(levels: Array, density: object) -> Array:
    """Nodal forces (copies, ...) of a line load q(z), a callable that takes (n,) and gives (n, ...)."""
    assert callable(density)
    at, weight = np.polynomial.legendre.leggauss(4)
    t, layers = 0.5 * (at + 1), len(levels) - 1
    forces = np.zeros((2 * layers + 1, *density(levels).shape[1:]))
    for k, long in enumerate(np.diff(levels)):
        part = np.moveaxis(0.5 * long * weight * np.moveaxis(density(levels[k] + long * t), 0, -1), -1, 0)
        forces[k] += np.tensordot((1 - t) * (1 - 2 * t), part, 1)
        forces[k + 1] += np.tensordot(t * (2 * t - 1), part, 1)
        forces[layers + 1 + k] += np.tensordot(4 * t * (1 - t), part, 1)
    return forces


def displacements(
    folder: Path,
    name: str,
    points: Array,
    elements: Integers,
    law: PlaneElasticity,
    held: Mapping[str, tuple[Integers, str]],
    loads: tuple[Integers, Array],
) -> Array:
    """Displacements of the loaded nodes (loads, 3) [m].

    Parameters
    ----------
    folder, name
        Of the deck.
    points : (n, 3) array
        [m]
    elements : (m, 15) array of int
    law : PlaneElasticity
        Young's modulus and Poisson's ratio.
    held : mapping
        Nodes and directions such as "1, 3", by the name of their set.
    loads : tuple
        Nodes (k,), and forces (k, 3) [N].
    """
    assert CCX is not None, "FLANKFILM_REQUIRE_CCX=1, but there is no ccx on PATH"
    nodes, forces = loads
    deck = ["*NODE"]
    deck += [f"{node + 1}, {', '.join(map(number, points[node]))}" for node in np.unique(elements)]
    deck.append("*ELEMENT, TYPE=C3D15, ELSET=GEAR")
    for i, corners in enumerate(elements + 1, 1):
        text = [str(v) for v in (i, *corners)]
        deck += [", ".join(text[:9]) + ",", ", ".join(text[9:])]
    for set_name, members in (*((key, members) for key, (members, _) in held.items()), ("LOADED", nodes)):
        deck += [f"*NSET, NSET={set_name}", *(f"{node + 1}," for node in members)]
    deck += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{number(law.E)}, {number(law.nu)}"]
    deck += ["*SOLID SECTION, ELSET=GEAR, MATERIAL=STEEL", "*BOUNDARY"]
    deck += [f"{key}, {directions}" for key, (_, directions) in held.items()]
    deck += ["*STEP", "*STATIC", "*CLOAD"]
    deck += [
        f"{node + 1}, {a + 1}, {number(force[a])}"
        for node, force in zip(nodes, forces, strict=True)
        for a in range(3)
        if force[a]
    ]
    deck += ["*NODE PRINT, NSET=LOADED", "U", "*END STEP", ""]
    (folder / f"{name}.inp").write_text("\n".join(deck), encoding="ascii")
    done = subprocess.run(
        [CCX, name], cwd=folder, capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    assert done.returncode == 0, done.stdout[-2000:]
    assert "*ERROR" not in done.stdout, done.stdout[-2000:]
    moved = {}
    for row in (folder / f"{name}.dat").read_text(encoding="ascii").splitlines():
        parts = row.split()
        if len(parts) == 4 and parts[0].isdigit():
            moved[int(parts[0]) - 1] = [float(part) for part in parts[1:]]
    return np.array([moved[int(node)] for node in nodes])
