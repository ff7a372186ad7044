"""Root stress over the face by three-dimensional elements of a whole pinion: misaligned, crowned, loaded at an end.

Run with ``python benchmarks/studies/face_root_three_dimensions.py`` (65 s of processor time, 1 GB).

The solid is that of ``face_three_dimensions``, with edges of 0.05 modules on the loaded fillet. Its displacement under
the line loads that `fem.mesh_cycle` finds with a pair at C gives the stress by Hooke's law in three dimensions at the
edges' Gauss points, all nine slopes by the elements' own functions: nothing of ``fem.elasticity.fillet_strain``,
``fem.influence.fillet_waves`` or ``fem.influence.fillet_ends`` is used, and no surface is taken to be free. Compared is
the greatest tension along the fillet at places of the face.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import replace

import numpy as np
from face_three_dimensions import CELLS, FULL, PAIR, Solid, means, near_C, pieces, quadratic
from two_gear_meshes import MIRROR, Focus

import fem
from fem.stress.face_fillets import root_influences
from gears import Alignment, Lead

FILLET = 0.05
PLACES = np.array(
    [-0.5, -0.49, -0.475, -0.45, -0.4, -0.3, -0.15, 0.0, 0.15, 0.3, 0.4, 0.45, 0.475, 0.49, 0.5]
)
"""Over the face width."""

CASES = {
    "straight and aligned": (0.0, 0.0, 1.0),
    "20 um out of parallel": (0.0, 20e-6, 1.0),
    "20 um, a tenth of the load": (0.0, 20e-6, 0.1),
    "crowned by 15 um": (15e-6, 0.0, 1.0),
    "crowned by 15 um, a tenth of the load": (15e-6, 0.0, 0.1),
}

GAUSS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)
CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])


def triangle(place):
    """Six functions of a second-order triangle at a reference place, and their slopes (6, 2)."""
    x, y = place
    area, rise = np.array([1 - x - y, x, y]), np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    pairs = ((0, 1), (1, 2), (2, 0))
    value = [*(a * (2 * a - 1) for a in area), *(4 * area[i] * area[j] for i, j in pairs)]
    slope = [*((4 * a - 1) * r for a, r in zip(area, rise, strict=True))]
    slope += [4 * (area[i] * rise[j] + area[j] * rise[i]) for i, j in pairs]
    return np.array(value), np.array(slope)


def on_fillet(solid):
    """Element nodes, values and slopes of their functions, and the tangent, at Gauss points of the loaded fillet."""
    points, nodes = solid.whole.points, solid.whole.nodes[0]
    edges = np.concatenate([nodes[solid.fine.facets[name]] for name in ("root_left", "fillet_left")])
    found = []
    for a, b, _ in edges:
        here = np.flatnonzero(np.isin(solid.whole.triangles[:, :3], [a, b]).sum(axis=1) == 2)
        assert len(here) == 1
        six = solid.whole.triangles[here[0]]
        first, last = (CORNERS[int(np.flatnonzero(six[:3] == end)[0])] for end in (a, b))
        for s in GAUSS:
            value, slope = triangle(first + s * (last - first))
            turn = points[six].T @ slope
            along = turn @ (last - first)
            found.append((six, value, slope @ np.linalg.inv(turn), along / np.linalg.norm(along)))
    return found


def along_z(ends, z):
    """Functions of half the face and their derivatives at a place from mid-face (n,)."""
    value, slope = np.zeros((2, 2 * len(ends) - 1))
    k = int(np.clip(np.searchsorted(ends, z) - 1, 0, len(ends) - 2))
    long = ends[k + 1] - ends[k]
    t = (z - ends[k]) / long
    value[2 * k : 2 * k + 3] = quadratic(np.array([t]))[0]
    slope[2 * k : 2 * k + 3] = np.array([4 * t - 3, 4 - 8 * t, 4 * t - 1]) / long
    return value, slope


def tensions(solid, ends, halves, z):
    """Greatest tension along the fillet (places, loads) of displacements (even and odd) (3, nodes, n, loads)."""
    place, loads = np.full(solid.mesh.doflocs.shape[1], -1), halves[0].shape[-1]
    place[solid.free] = np.arange(len(solid.free))
    found = np.zeros((len(z), loads))
    for six, value, slope, tangent in on_fillet(solid):
        at = place[solid.unknown[six]]
        held = at < 0
        for k, where in enumerate(z):
            f, rise = along_z(ends, abs(where))
            side = np.sign(where) if where else 1.0
            strain = np.zeros((3, 3, loads))
            for moved, odd in zip(halves, (False, True), strict=True):
                local = moved[:, at] * np.where(held, 0.0, 1.0)[:, None, None]
                in_plane, across = (side, 1.0) if odd else (1.0, side)
                sign = np.array([in_plane, in_plane, across])[:, None, None]
                strain[:, :2] += sign * np.einsum("aipl,ij,p->ajl", local, slope, f)
                strain[:, 2] += side * sign[:, 0] * np.einsum("aipl,i,p->al", local, value, rise)
            strain = 0.5 * (strain + strain.swapaxes(0, 1))
            stress = 2 * solid.mu * strain + solid.lam * np.trace(strain) * np.eye(3)[..., None]
            found[k] = np.maximum(found[k], np.einsum("a,abl,b->l", tangent, stress[:2, :2], tangent))
    return found


def loads_at_C(bodies):
    """Line load on the cells (cells,) of every case with a pair at C [N/m]."""
    positions, row = near_C()
    for crowning, across, part in CASES.values():
        pair = replace(PAIR, pinion=replace(PAIR.pinion, lead=Lead(crowning)))
        torque, own = part * FULL * pair.face_width * pair.base_radii[0], replace(bodies, pair=pair)
        tilted = Alignment(across)
        cycle = fem.mesh_cycle(pair, torque, positions, own, beyond_path=False, alignment=tilted, cells=CELLS)
        yield cycle.line_load[row].sum(axis=0)


def compare(half_width):
    """Print the greatest tension over the face by both, and their differences."""
    began = time.process_time()
    loads = [*loads_at_C(fem.compliance(PAIR, 0.002)), np.eye(CELLS)[0] * FULL]
    names = [*CASES, "the end cell alone"]
    half, b, rho = 0.5 * PAIR.face_width, PAIR.face_width, PAIR.points.C
    ends, q = pieces(half), np.array(loads).T
    profile, m = PAIR.teeth_profiles[0], PAIR.module
    foci = [Focus(point * MIRROR, FILLET * m, 0.1 * m) for point in profile.fillet(np.linspace(0.1, 0.9, 5))]
    solid = Solid(profile, rho, half_width, foci)
    print(f"{solid.mesh.doflocs.shape[1]} nodes of the section", flush=True)
    over = means(ends, np.linspace(0.0, half, CELLS // 2 + 1)) * b / CELLS
    near, far = q[CELLS // 2 :], q[: CELLS // 2][::-1]
    halves = [
        solid.moved(ends, even, True, over @ (0.5 * (near + far if even else near - far)))
        for even in (True, False)
    ]
    z = PLACES * b
    true = tensions(solid, ends, halves, z)
    print(f"{time.process_time() - began:.0f} s of processor time", flush=True)
    roots = fem.fillets(PAIR, 0.003)
    for model in ("free-ends", "walls"):
        fillets = root_influences(roots, PAIR, model)[0]
        print(f"{model}; places over the face width {PLACES}")
        for k, name in enumerate(names):
            ours = fillets.tangential(0, np.array([rho]), q[:, k][None], z)[0, :, 0].max(axis=-1)
            most = true[:, k].max()
            off, apart = 100 * (ours - true[:, k]) / most, 100 * (ours.max() / most - 1)
            print(f"{name:40} 3-D {1e-6 * most:7.1f} here {1e-6 * ours.max():7.1f} MPa {apart:+.2f} %")
            print(
                f"    3-D {np.round(1e-6 * true[:, k], 1)}; off [% of the greatest] {np.round(off, 2)}",
                flush=True,
            )


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--pressure", type=float, default=0.22)
    compare(1e-3 * parser.parse_args().pressure)
