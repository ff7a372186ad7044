"""One pair of teeth whose contact moves under load: CalculiX with NLGEOM, and the energies of the first-order law.

Run with ``python benchmarks/studies/fem_moving_contact.py --folder FOLDER --what PW`` where ``ccx`` is
installed; ten minutes a letter. P: the pinion's bore is turned by D/r_b1, the wheel's is held; W: the wheel's is
turned back by D/r_b2, the pinion's is held; L: as P with small displacements. The torque follows from the reactions.
The change of the secant is taken against Hertz's pressure where the undeformed teeth touch, on the same meshes and
at the torque found. ``--what parts`` needs no CalculiX: it integrates all parts of the law on the fine mesh that
resolves the pressure, by other formulas than ``fem.elasticity.nonlinear_energy``.
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
from fem_two_gears_calculix import MM, PREFIX
from two_gear_meshes import MIRROR, Focus, sector

from fem.elasticity.plane_elasticity import PlaneElasticity, physical_gradients, reduced_modulus
from gears import Gear, GearPair, Material
from meshes import Sizes
from meshes.abaqus import mesh_text, number
from meshes.annulus import turned

STEEL = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0)
PA66 = Material(youngs_modulus=3e9, poisson_ratio=0.4, density=1140.0)
PLASTIC = GearPair(Gear(17), Gear(51), 2e-3, 20e-3, material=(STEEL, PA66))
CASES = {  # pair, torques [N m], half of the finely meshed part [m]
    "plastic": (PLASTIC, (5.0, 20.0, 40.0), 0.9e-3),
    "article": (two.PAIR, (600.0,), 0.3e-3),
}
SIZES = Sizes(0.5, 0.25, 0.4, 0.5, 0.5, 1.0)


def meshed(pair, rho1, h, half, refine=1.0):
    """Both gears whole, tooth 0 with edges h about the contact."""
    sizes, bodies = SIZES.scaled(refine), []
    for gear, rho in enumerate((rho1, pair.line_of_action - rho1)):
        profile = pair.teeth_profiles[gear]
        focus = Focus(profile.involute(rho) * MIRROR, h, half)
        teeth = {0: sector(profile, sizes, [focus], 0.0, 0.2)}
        bodies.append(two.Body(profile, pair.materials[gear], sector(profile, sizes), teeth))
    return bodies


# ------------------------------------------------------------------ contact that stays


class Held:
    """Hertz's pressure on one gear where the undeformed teeth touch, along the line of action: the linear solution."""

    def __init__(self, body, rho, load, half_width):
        profile = body.profile
        edges, ends, curve = body.edges(0, "flank_left")
        middle = rho**2 / (2 * profile.base_radius)
        near = (ends.min(axis=1) < middle + half_width) & (ends.max(axis=1) > middle - half_width)
        edges, ends = edges[near], ends[near]
        length = ends[:, 1:] - ends[:, :1]
        # the part of each edge under the pressure, in the parameter of the edge
        limits = np.clip((middle + half_width * np.array([-1, 1]) - ends[:, :1]) / length, 0, 1)
        low, high = limits.min(axis=1, keepdims=True), limits.max(axis=1, keepdims=True)
        gauss, weight = np.polynomial.legendre.leggauss(12)
        t = low + (high - low) * 0.5 * (1 + gauss)
        x = ends[:, :1] + length * t - middle
        part = np.sqrt(np.maximum(1 - (x / half_width) ** 2, 0)) * weight * (high - low) * np.abs(length)
        part /= part.sum()
        self.inward = -profile.normal(rho) * MIRROR
        shapes = two.shape(t)
        forces = np.zeros((body.size // 2, 2))
        lumps = load * part[..., None, None] * shapes[..., None] * self.inward
        np.add.at(forces, edges[:, None, :].repeat(t.shape[1], 1).ravel(), lumps.reshape(-1, 2))
        moved = np.zeros(body.size)
        moved[body.free] = body.factor.solve(forces.ravel()[body.free])
        self.u = moved.reshape(-1, 2)
        self.moved = np.einsum("nq,nqk,nka->a", part, shapes, self.u[edges])
        slopes = np.einsum("nqk,nka->nqa", two.slope(t), self.u[edges]) / length[..., None]
        self.rate = np.einsum("nq,nqa->a", part, slopes)  # along the flank towards the tip
        along = np.subtract(*curve.at(middle * np.array([1.001, 0.999])))
        self.tip = along / np.linalg.norm(along)

    def third_order(self, body, law):
        """Third-order energies per face width: St. Venant and Kirchhoff, what neo-Hooke and Hencky add."""
        from skfem.quadrature import get_quadrature
        from skfem.refdom import RefTri

        (xi, eta), weight = get_quadrature(RefTri, 6)
        gradient, area = physical_gradients(body.mesh.points, body.mesh.triangles, xi, eta)
        slope = np.einsum("mia,mqib->mqab", self.u[body.mesh.triangles], gradient)
        strain = 0.5 * (slope + slope.swapaxes(-1, -2))
        lam, mu = law.lame
        square = strain @ strain
        p1, p2, p3 = (np.trace(power, axis1=-2, axis2=-1) for power in (strain, square, square @ strain))
        stress = 2 * mu * strain + lam * p1[..., None, None] * np.eye(2)
        green = 0.5 * np.einsum("mqab,mqka,mqkb->mq", stress, slope, slope)
        bulk = lam + 2 * mu / 3
        hooke = mu * (-4 / 3 * p3 + 4 / 27 * p1**3) + 0.5 * bulk * (p1**3 - 2 * p1 * p2)
        hencky = -lam * p1 * p2 - 2 * mu * p3
        return np.array([np.sum(f * area * weight) for f in (green, hooke, hencky)])


def held(pair, bodies, rho1, force):
    """Deflection D under a force [N], and both gears' solutions."""
    load, rhos = force / pair.face_width, (rho1, pair.line_of_action - rho1)
    radius = rhos[0] * rhos[1] / sum(rhos)
    a = np.sqrt(8 * load * radius / (np.pi * reduced_modulus(pair, "strain")))
    gears = [Held(body, rho, load, a) for body, rho in zip(bodies, rhos, strict=True)]
    approach = sum(float(gear.moved @ gear.inward) for gear in gears) + a**2 / (8 * radius)
    return approach, gears


def parts(pair, bodies, rho1, force):
    """Parts of the first-order change of the secant [%]."""
    approach, gears = held(pair, bodies, rho1, force)
    load, rhos = force / pair.face_width, (rho1, pair.line_of_action - rho1)
    radius = rhos[0] * rhos[1] / sum(rhos)
    along = [float(gear.moved @ gear.tip) for gear in gears]
    # the normal of the curved flank turns towards the tip: outwards
    tilt = [float(gear.rate @ gear.inward) - t / rho for gear, t, rho in zip(gears, along, rhos, strict=True)]
    laws = [PlaneElasticity.of(material, "strain") for material in pair.materials]
    strained = sum(g.third_order(b, law) for g, b, law in zip(gears, bodies, laws, strict=True)) / load
    roll = [2 * tau / load * rho / base for tau, rho, base in zip(tilt, rhos, pair.base_radii, strict=True)]
    percent = 300 / approach
    return {
        "own normals": percent * 0.5 * radius * (tilt[0] - tilt[1]) ** 2,
        "along the flanks": percent
        * sum(t * tau + 0.5 * t**2 / rho for t, tau, rho in zip(along, tilt, rhos, strict=True)),
        "strained gears": percent * strained[0],
        "neo-Hooke adds": percent * strained[1],
        "Hencky adds": percent * strained[2],
        "roll, pinion turned": -150 * load * roll[0],
        "roll, wheel turned": -100 * load * (roll[1] + 0.5 * roll[0]),
    }


# ------------------------------------------------------------------ CalculiX


def deck(pair, stand, bodies, approaches, penalty, fixed, large, material):
    """Text of the deck that turns one gear by each approach in turn; nodes and places (mm) of both bores."""
    starts, meshes, node = [], [], 1
    for gear, body in enumerate(bodies):
        mesh = replace(body.mesh, points=MM * stand.out(gear, body.mesh.points))
        starts.append(node)
        meshes.append(mesh)
        node += len(mesh.points)
    text = ["*HEADING", "two gears, mm N MPa", mesh_text(dict(zip(PREFIX, meshes, strict=True))).rstrip()]
    for prefix, one in zip(PREFIX, pair.materials, strict=True):
        E, nu = 1e-6 * one.youngs_modulus, one.poisson_ratio
        text += [f"*MATERIAL, NAME={prefix}MATERIAL"]
        if material == "neo-hooke" and one is not STEEL:
            text += [
                "*HYPERELASTIC, NEO HOOKE",
                f"{number(E / 4 / (1 + nu))}, {number(6 * (1 - 2 * nu) / E)}",
            ]
        else:
            text += ["*ELASTIC", f"{number(E)}, {number(nu)}"]
        text += [f"*SOLID SECTION, ELSET={prefix}GEAR, MATERIAL={prefix}MATERIAL", "1."]
    text += [
        "*SURFACE INTERACTION, NAME=FLANKS",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{penalty:g}, 1.e-3",
        "*CONTACT PAIR, INTERACTION=FLANKS, TYPE=SURFACE TO SURFACE",
        "W_FLANK_LEFT_0, P_FLANK_LEFT_0",
        "*BOUNDARY",
        f"{PREFIX[fixed]}BORE, 1, 2",
    ]
    bores = [np.unique(mesh.facets["bore"]) for mesh in meshes]
    places = [mesh.points[bore] - MM * c for mesh, bore, c in zip(meshes, bores, stand.centres, strict=True)]
    nodes = [bore + start for bore, start in zip(bores, starts, strict=True)]
    moving = 1 - fixed
    for approach in approaches:
        moves = turned(places[moving], approach / pair.base_radii[moving]) - places[moving]
        text += ["*STEP, INC=400" + (", NLGEOM" if large else ""), "*STATIC", "0.25, 1.", "*BOUNDARY"]
        for n, move in zip(nodes[moving], moves, strict=True):
            text += [f"{n}, {i + 1}, {i + 1}, {number(move[i])}" for i in (0, 1)]
        for prefix in PREFIX:
            text += [f"*NODE PRINT, NSET={prefix}BORE, FREQUENCY=1000", "RF"]
        text += ["*END STEP"]
    return "\n".join([*text, ""]), nodes, places


def reactions(printed, name, nodes):
    """Reactions (steps, nodes, 2) of a set."""
    found = []
    for part in printed.split(f"forces (fx,fy,fz) for set {name}")[1:]:
        forces = {}
        for row in part.split("forces (fx")[0].splitlines():
            cells = row.split()
            if len(cells) == 4 and cells[0].isdigit():
                forces[int(cells[0])] = [float(cell) for cell in cells[1:3]]
        found.append([forces[int(n)] for n in nodes])
    return np.array(found)


def run(folder, pair, stand, bodies, approaches, penalty, fixed, large, material):
    """Torques on both axes [N m], (2, steps)."""
    folder.mkdir(parents=True, exist_ok=True)
    text, nodes, places = deck(pair, stand, bodies, approaches, penalty, fixed, large, material)
    (folder / "two.inp").write_text(text, encoding="ascii")
    subprocess.run(["ccx", "two"], cwd=folder, check=True, capture_output=True)
    printed, torques = (folder / "two.dat").read_text(), []
    for gear in (0, 1):
        pulls = reactions(printed, f"{PREFIX[gear]}BORE", nodes[gear])
        for approach, pull in zip(approaches, pulls, strict=True):
            angle = approach / pair.base_radii[gear] if large and gear != fixed else 0.0
            at = turned(places[gear], angle)
            torques.append(np.sum(at[:, 0] * pull[:, 1] - at[:, 1] * pull[:, 0]) * pair.face_width)
    return np.reshape(torques, (2, -1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, required=True, help="where CalculiX works")
    parser.add_argument("--what", default="parts", help="parts, or letters of P, W, L")
    parser.add_argument("--pair", choices=CASES, default="plastic")
    parser.add_argument("--position", type=float, default=0.8, help="base pitches after A")
    parser.add_argument("--h", type=float, default=40e-6, help="edges at the contact [m]")
    parser.add_argument("--refine", type=float, default=1.0, help="factor of all other edges")
    parser.add_argument("--penalty", type=float, default=1e7, help="N/mm^3")
    parser.add_argument("--material", choices=("elastic", "neo-hooke"), default="elastic")
    given = parser.parse_args()
    pair, loads, half = CASES[given.pair]
    rho1 = float(pair.points.A + given.position * pair.base_pitch)
    placed = pair.placement(rho1)
    stand = two.Stand((placed.pinion_angle, placed.wheel_angle), (np.zeros(2), placed.wheel_centre))
    bodies = meshed(pair, rho1, given.h, half, given.refine)
    print("nodes", [len(body.mesh.points) for body in bodies], flush=True)

    def linear(torque):
        return held(pair, bodies, rho1, torque / pair.base_radii[0])[0]

    if given.what == "parts":
        for torque in loads:
            found = parts(pair, bodies, rho1, torque / pair.base_radii[0])
            print(f"{torque:g} N m:", ", ".join(f"{name} {value:+.3f}" for name, value in found.items()), "%")
        return 0
    approaches, ratio = [linear(torque) for torque in loads], pair.pinion.teeth / pair.wheel.teeth
    for letter in given.what:
        began, fixed = time.perf_counter(), 0 if letter == "W" else 1
        case = (approaches, given.penalty, fixed, letter != "L", given.material)
        for approach, first, second in zip(
            approaches, *run(given.folder / letter, pair, stand, bodies, *case), strict=True
        ):
            change = 100 * (linear(abs(first)) / approach - 1)
            torques = f"{first:.4f} N m, wheel's over the ratio {second * ratio:.4f}"
            print(f"{letter}: D {1e6 * approach:.3f} um, {torques}, secant {change:+.3f} %", flush=True)
        print(f"{time.perf_counter() - began:.0f} s", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
