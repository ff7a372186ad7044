"""A rim on a web in three dimensions by CalculiX, beside the plane model: what the plane leaves out.

Run with ``python benchmarks/studies/fem_blanks_calculix.py FOLDER``; some minutes, requires ccx. Half the face
width of a whole wheel of 30 teeth, m 2, b 20 mm (symmetric about the middle), made of the plane mesh: 15-node wedges
in layers, those beside the web left out. A line load along the whole width at mid-flank of one tooth; the bore is held.
The load is concentrated in both models, so what the web changes is told, the disc's deflection taken off: the
half-plane's part is the same in all. Stresses are means over the elements at the nodes of the fillet, in both.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
from scipy.sparse.linalg import splu

from fem.elasticity.plane_elasticity import PlaneElasticity, nodal_stress_matrix, stiffness_matrix
from fem.elasticity.torsion import step_wind_up
from gears import STEEL, Blank, Gear, GearPair
from meshes import Sizes, gear_mesh, mesh_sector
from meshes.abaqus import number

MODULE, WIDTH = 2e-3, 20e-3
COARSE = Sizes(flank=1.0, fillet=0.4, root=0.6, corner=0.6, top=2.0, rim=2.0, layer_growth=2.0)
LAW = PlaneElasticity.of(STEEL, "strain")
IN_WEB, BESIDE = 1, 4
"""Layers of elements in half the web, and beside it."""


def wheel(rim, web):
    """Mesh of the wheel, its loaded node, direction and fillet's nodes; what the steps add to its wind-up."""
    blank = None if web == 1.0 else Blank(rim * MODULE, web * WIDTH, hub_radius=0.012)
    pair = GearPair(Gear(25), Gear(30, bore_radius=0.008, blank=blank), MODULE, WIDTH)
    profile = pair.teeth_profiles[1]
    sector = mesh_sector(profile, COARSE)
    mesh = gear_mesh(sector)
    ends = np.unique(sector.facets["flank_left"][:, :2])
    place = np.linalg.norm(sector.points[ends], axis=1)
    loaded = ends[np.argmin(np.abs(place - profile.reference_radius))]
    arm = np.hypot(*sector.points[loaded])
    angle = np.arctan2(*sector.points[loaded]) + np.arccos(profile.base_radius / arm)
    inward = -np.array([-np.cos(angle), np.sin(angle)])
    fillet = np.unique(np.concatenate([sector.facets[f"{name}_left"] for name in ("root", "fillet")]))
    nodes = mesh.nodes[0]
    steps = step_wind_up(profile, WIDTH, LAW.shear_modulus)
    return (mesh, nodes[loaded], inward, nodes[fillet]), steps


def plane(mesh, loaded, inward, fillet):
    """Deflection per line load [m per N/m] and greatest stress at the fillet [1/m] of the plane model."""
    held = np.unique(mesh.facets["bore"])
    free = np.setdiff1d(np.arange(2 * len(mesh.points)), np.concatenate([2 * held, 2 * held + 1]))
    force = np.zeros_like(mesh.points)
    force[loaded] = inward
    stiffness = stiffness_matrix(mesh.points, mesh.triangles, LAW, mesh.thickness).tocsc()
    moved = np.zeros(2 * len(mesh.points))
    moved[free] = splu(stiffness[free][:, free]).solve(force.ravel()[free])
    stress = (nodal_stress_matrix(mesh.points, mesh.triangles, LAW, mesh.thickness) @ moved).reshape(-1, 3)
    tensor = stress[fillet][:, [[0, 2], [2, 1]]]
    return float(force.ravel() @ moved), float(np.linalg.eigvalsh(tensor).max())


def solid(mesh, loaded, inward, fillet, folder):
    """Deflection and greatest stress at the fillet over the width, from the middle to the end, by CalculiX."""
    web = float(mesh.thickness.min())
    inside = np.linspace(0.0, 0.5 * web * WIDTH, IN_WEB + 1)
    # layers get thinner towards the end, where the stress changes most
    beside = 1 - (1 - np.linspace(0.0, 1.0, BESIDE + 1)) ** 1.3 if web < 1.0 else np.linspace(0, 1, 2)
    if web == 1.0:
        inside = np.linspace(0.0, 0.5 * WIDTH, IN_WEB + BESIDE + 1)
    levels = inside if web == 1.0 else np.append(inside, inside[-1] + (0.5 * WIDTH - inside[-1]) * beside[1:])
    count, layers = len(mesh.points), len(levels) - 1
    full = mesh.thickness == 1.0
    # node of the plane mesh at level k: k count + node; between levels: (layers + 1) count + k count + node
    elements = []
    for k in range(layers):
        some = mesh.triangles if k < IN_WEB or web == 1.0 else mesh.triangles[full]
        low, high, middle = some + k * count, some + (k + 1) * count, some + (layers + 1 + k) * count
        elements.append(np.hstack([low[:, :3], high[:, :3], low[:, 3:], high[:, 3:], middle[:, :3]]))
    elements = np.concatenate(elements)
    used = np.unique(elements)
    heights = np.concatenate([levels, 0.5 * (levels[1:] + levels[:-1])])
    on_bore = used[np.isin(used % count, np.unique(mesh.facets["bore"]))]
    weight = {}
    for k, height in enumerate(np.diff(levels)):
        for node, share in (
            (k * count + loaded, 1 / 6),
            ((k + 1) * count + loaded, 1 / 6),
            ((layers + 1 + k) * count + loaded, 2 / 3),
        ):
            weight[node] = weight.get(node, 0.0) + share * height
    lines = ["*NODE"]
    for node in used:
        x, y = mesh.points[node % count]
        lines.append(f"{node + 1}, {number(x)}, {number(y)}, {number(heights[node // count])}")
    lines.append("*ELEMENT, TYPE=C3D15, ELSET=GEAR")
    for i, nodes in enumerate(elements + 1, 1):
        text = [str(v) for v in (i, *nodes)]
        lines += [", ".join(text[:9]) + ",", ", ".join(text[9:])]
    for name, nodes in (
        ("BORE", on_bore),
        ("MIDDLE", used[used < count]),
        ("LOADED", np.array(sorted(weight))),
    ):
        lines += [f"*NSET, NSET={name}", *(f"{node + 1}," for node in nodes)]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{number(LAW.E)}, {number(LAW.nu)}"]
    lines += ["*SOLID SECTION, ELSET=GEAR, MATERIAL=STEEL", "*BOUNDARY", "BORE, 1, 3", "MIDDLE, 3, 3"]
    lines += ["*STEP", "*STATIC", "*CLOAD"]
    lines += [f"{n + 1}, {a + 1}, {number(w * inward[a])}" for n, w in weight.items() for a in (0, 1)]
    lines += ["*NODE FILE", "U", "*EL FILE", "S", "*END STEP", ""]
    (folder / "solid.inp").write_text("\n".join(lines), encoding="ascii")
    print(f"  {3 * len(used)} unknowns", flush=True)
    ccx = shutil.which("ccx")
    assert ccx is not None, "this study requires ccx"
    done = subprocess.run([ccx, "solid"], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:]
    assert "*ERROR" not in done.stdout, done.stdout[-2000:]
    moved, stress = fields(folder / "solid.frd", len(heights) * count)
    loads = np.array(sorted(weight))
    share = np.array([weight[node] for node in loads]) / (0.5 * WIDTH)
    deflection = moved[loads][:, :2] @ inward
    greatest = [
        np.linalg.eigvalsh(stress[k * count + fillet][:, [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]).max()
        for k in range(layers + 1)
    ]
    at_levels = [moved[k * count + loaded, :2] @ inward for k in range(layers + 1)]
    return levels, float(share @ deflection), np.array(at_levels), np.array(greatest)


def fields(path, count):
    """Displacements (count, 3) and stresses (count, 6) of a file of CalculiX."""
    found = {"DISP": np.full((count, 3), np.nan), "STRESS": np.full((count, 6), np.nan)}
    field = None
    with path.open(encoding="ascii") as lines:
        for line in lines:
            if line.startswith(" -4"):
                field = found.get(line.split()[1])
            elif line.startswith(" -3"):
                field = None
            elif line.startswith(" -1") and field is not None:
                values = [float(line[i : i + 12]) for i in range(13, len(line.rstrip()), 12)]
                field[int(line[3:13]) - 1] = values[: field.shape[1]]
    return found["DISP"], found["STRESS"]


def main():
    """Print deflections and root stresses of both models."""
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    cases = {"disc": (0.0, 1.0), "rim 1.2 h_t, web 0.3": (2.7, 0.3), "rim 0.6 h_t, web 0.2": (1.35, 0.2)}
    disc = None
    for name, (rim, web) in cases.items():
        parts, steps = wheel(rim, web)
        flat, flat_stress = plane(*parts)
        levels, mean, along, stress = solid(*parts, folder)
        disc = disc or (flat, mean, flat_stress, stress.max())
        print(name)
        both = LAW.E * (flat + steps)
        print(
            f"  deflection times E: plane {LAW.E * flat:.3f}, with steps {both:.3f}, 3-D mean {LAW.E * mean:.3f}"
        )
        print(
            f"  more than the disc: plane {LAW.E * (flat - disc[0]):.3f}, 3-D {LAW.E * (mean - disc[1]):.3f}"
        )
        print("  z/(b/2):       ", " ".join(f"{2 * z / WIDTH:6.3f}" for z in levels))
        print("  3-D over plane:", " ".join(f"{value / flat:6.3f}" for value in along))
        print("  root stress over plane's:", " ".join(f"{value / flat_stress:6.3f}" for value in stress))
        print(
            f"  greatest over the disc's: plane {flat_stress / disc[2]:.3f}, 3-D {stress.max() / disc[3]:.3f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
