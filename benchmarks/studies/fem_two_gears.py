"""Two whole gears in frictionless contact, every contact resolved by its elements: what the tip edges really take.

Run with ``python benchmarks/studies/fem_two_gears.py`` (three minutes; ``--quick``: the pitch point alone).

Nothing of ``fem.compliance``, ``fem.laws.tip_contact`` or ``fem.mesh_cycle`` is used, only the stiffness matrix of
curved second-order triangles. Both annuli are meshed whole, with edges of a few micrometres at the contacts and at the
tip corners, which may be sharp or rounded. Where teeth i of both gears may touch, one pressure p_j acts on each
element edge of the tooth whose tip is near (the mortar side); the other flank is the exact involute, whose
distance from a point is known in closed form: the normals of an involute touch its base circle. With the gaps
G_j = integral of g over edge j, l_j = dG_j/dphi by the pinion's turn phi and the compliance C of both gears,

    G + C p + l phi >= 0,  p >= 0,  p . (G + C p + l phi) = 0,  -l . p = T/b,

solved by an active set. Rows named "deformed" repeat this with gaps, normals and places of the deformed and turned
gears until nothing changes; in the others all of them are those of the unloaded gears. The approach is D = phi r_b1.
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu
from two_gear_meshes import MIRROR, Focus, sector

import fem
from fem.elasticity.plane_elasticity import PlaneElasticity, stiffness_matrix
from gears import Gear, GearPair
from gears.tooth.rotation import turned
from meshes import Sizes, gear_mesh

PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04)
TORQUE = 600.0
GAUSS, WEIGHT = np.polynomial.legendre.leggauss(6)
GAUSS, WEIGHT = 0.5 + 0.5 * GAUSS, 0.5 * WEIGHT
MEAN = 10
NEAR = 60e-6
"""Edges with a wider gap [m] cannot touch: the gears approach by half of it."""


# ------------------------------------------------------------------ one gear


class Body:
    """A gear held on its bore: displacements of chosen nodes by nodal forces (per face width), tooth 0 along +y."""

    def __init__(self, profile, material, plain, fine):
        self.profile, self.fine = profile, fine
        mesh = gear_mesh(plain, range(-(profile.teeth // 2), profile.teeth - profile.teeth // 2), fine)
        self.mesh, self.size = mesh, 2 * len(mesh.points)
        stiffness = stiffness_matrix(mesh.points, mesh.triangles, PlaneElasticity.of(material, "strain"))
        free = np.ones(len(mesh.points), dtype=bool)
        free[np.unique(mesh.facets["bore"])] = False
        self.free = np.flatnonzero(np.repeat(free, 2))
        inner = csc_array(stiffness[self.free][:, self.free])
        symmetric = {"SymmetricMode": True}
        self.factor = splu(inner, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=symmetric)

    def turn(self, tooth):
        """Angle of a tooth in the gear [rad]."""
        return tooth * self.profile.pitch_angle

    def edges(self, tooth, name):
        """Edges (node numbers of the whole gear) of a tooth's boundary, the parameters of their ends, the curve."""
        mesh = self.fine[tooth]
        return self.mesh.nodes[tooth][mesh.facets[name]], mesh.parameters[name], mesh.curves[name]

    def on_flank(self, tooth, arc):
        """Nodes (n, 3), places on the edge (n,), and whether the flank exists at arc lengths (n,)."""
        nodes, ends, _ = self.edges(tooth, "flank_left")  # run from the tip down: arcs fall
        order = np.argsort(ends[:, 1])
        which = order[np.clip(np.searchsorted(ends[order, 1], arc, side="right") - 1, 0, len(order) - 1)]
        t = (arc - ends[which, 0]) / (ends[which, 1] - ends[which, 0])
        return nodes[which], t, (t >= -1e-9) & (t <= 1 + 1e-9)

    def solve(self, forces):
        """Displacements (2 nodes, loads) by forces of the same shape (sparse)."""
        out = np.zeros(forces.shape)
        out[self.free] = self.factor.solve(forces[self.free].toarray())
        return out


def shape(t):
    return np.stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)], axis=-1)


def slope(t):
    return np.stack([4 * t - 3, 4 * t - 1, 4 - 8 * t], axis=-1)


# ------------------------------------------------------------------ contact of two teeth


@dataclass
class Strips:
    """Gauss points (n, q) on element edges of the mortar gear's tooth, and what they face."""

    mortar: int  # 0 the pinion, 1 the wheel
    teeth: tuple[int, int]
    nodes: np.ndarray  # (n, 3) of the mortar gear
    places: np.ndarray  # (n, q, 2) exact, in the mortar gear's frame
    areas: np.ndarray  # (n, q)


def strips_of(body, mortar, teeth):
    nodes, places, areas = [], [], []
    for name in ("flank_left", "round_left"):
        if name not in body.fine[teeth[mortar]].facets:
            continue
        edges, ends, curve = body.edges(teeth[mortar], name)
        t = ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * GAUSS
        exact = np.asarray(curve.at(t.ravel()))
        along = np.einsum("qk,nka->nqa", slope(GAUSS), body.mesh.points[edges])
        nodes.append(edges)
        places.append(turned(exact, body.turn(teeth[mortar])).reshape(*t.shape, 2))
        areas.append(np.linalg.norm(along, axis=2) * WEIGHT)
    return Strips(mortar, teeth, *(np.concatenate(part) for part in (nodes, places, areas)))


@dataclass
class Stand:
    """Angles and axes of both gears; the pinion turned by phi beyond the unloaded position."""

    angles: tuple[float, float]
    centres: tuple[np.ndarray, np.ndarray]

    def turned_by(self, phi):
        """Turn the pinion on."""
        return Stand((self.angles[0] + phi, self.angles[1]), self.centres)

    def out(self, gear, points):
        """Points of a gear in the common frame."""
        return turned(points.reshape(-1, 2), self.angles[gear]).reshape(points.shape) + self.centres[gear]

    def into(self, gear, points):
        """Points of the common frame in a gear's own."""
        return turned((points - self.centres[gear]).reshape(-1, 2), -self.angles[gear]).reshape(points.shape)


@dataclass
class Faced:
    """Where Gauss points stand against the other flank; vectors in the common frame."""

    gap: np.ndarray  # (n, q)
    normal: np.ndarray  # (n, q, 2) outward from the other flank
    nodes: np.ndarray  # (n, q, 3) of the other flank
    weights: np.ndarray  # (n, q, 3)
    rate: np.ndarray  # (n, q) change of the gap with phi


def face(bodies, strips, stand, moved):
    """Gaps of strips against the involute of the other gear, both displaced by ``moved`` (nodes, 2) in own frames."""
    mortar, other = strips.mortar, 1 - strips.mortar
    body, profile = bodies[other], bodies[other].profile
    tooth = strips.teeth[other]
    u = np.einsum("qk,nka->nqa", shape(GAUSS), moved[mortar][strips.nodes])
    there = stand.out(mortar, strips.places + u)
    local = turned(stand.into(other, there).reshape(-1, 2), -body.turn(tooth))
    back = np.zeros_like(local)
    for _ in range(4):
        at = (local - back) * MIRROR
        line = np.sqrt(np.sum(at**2, axis=1) - profile.base_radius**2)
        angle = np.arctan2(at[:, 0], at[:, 1]) - np.arctan2(line, profile.base_radius)
        rho = profile.base_radius * (profile.base_half_angle - angle)
        nodes, t, exists = body.on_flank(tooth, rho**2 / (2 * profile.base_radius))
        weights = shape(t)
        back = turned(np.einsum("nk,nka->na", weights, moved[other][nodes]), -body.turn(tooth))
    n = strips.places.shape[:2]
    gap = np.where(exists, line - rho, 1.0).reshape(n)
    # relief is missing from the gaps: the meshes are those of involutes
    tip = bodies[mortar].profile
    gap = gap + profile.relief(rho).reshape(n)
    gap += tip.relief(np.sqrt(np.maximum(np.sum(strips.places**2, axis=2) - tip.base_radius**2, 0.0)))
    # the deformed flank's normal: material on the left of the edge's run, so outward is the run turned clockwise
    outward = turned(profile.normal(rho) * MIRROR, body.turn(tooth))
    along = np.stack([-outward[:, 1], outward[:, 0]], axis=1)
    stretch = np.linalg.norm(
        np.einsum("nk,nka->na", slope(t), body.mesh.points[nodes]), axis=1, keepdims=True
    )
    along = along + np.einsum("nk,nka->na", slope(t), moved[other][nodes]) / stretch
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    outward = turned(np.stack([along[:, 1], -along[:, 0]], axis=1), stand.angles[other]).reshape(*n, 2)
    # turning the pinion moves the mortar's point, or the other flank's (the pinion's axis is the origin)
    arm = np.stack([-there[..., 1], there[..., 0]], axis=-1)
    rate = np.einsum("nqa,nqa->nq", arm, outward) * (1 if mortar == 0 else -1)
    return Faced(gap, outward, nodes.reshape(*n, 3), weights.reshape(*n, 3), rate)


def own_normals(bodies, strips, faced, stand):
    """Press along the normals of the tip's own flank instead: what a corner's law in its own frame does."""
    body, tooth = bodies[strips.mortar], strips.teeth[strips.mortar]
    rho = np.sqrt(np.maximum(np.sum(strips.places**2, axis=2) - body.profile.base_radius**2, 0.0))
    own = turned(
        (body.profile.normal(rho) * MIRROR).reshape(-1, 2), body.turn(tooth) + stand.angles[strips.mortar]
    )
    return replace(faced, normal=-own.reshape(faced.normal.shape))


def forces_of(bodies, all_strips, faced, stand):
    """Nodal forces on both gears, in their frames, by a unit pressure on each strip: two sparse matrices."""
    out = []
    for gear, body in enumerate(bodies):
        rows, columns, values, start = [], [], [], 0
        for strips, f in zip(all_strips, faced, strict=True):
            normal = turned(f.normal.reshape(-1, 2), -stand.angles[gear]).reshape(f.normal.shape)
            if gear == strips.mortar:
                lumps = np.einsum("nq,qk,nqa->nka", strips.areas, shape(GAUSS), normal)[:, None]
                nodes = strips.nodes[:, None]
            else:
                lumps = -np.einsum("nq,nqk,nqa->nqka", strips.areas, f.weights, normal)
                nodes = f.nodes
            unknown = 2 * nodes[..., None] + np.arange(2)
            column = start + np.arange(len(lumps))[:, None, None, None]
            rows.append(unknown.ravel())
            columns.append(np.broadcast_to(column, unknown.shape).ravel())
            values.append(np.broadcast_to(lumps, unknown.shape).ravel())
            start += len(lumps)
        parts = (np.concatenate(part) for part in (values, rows, columns))
        data, row, column = parts
        out.append(csc_array((data, (row, column)), shape=(body.size, start)))
    return out


def active_set(compliance, gap, rate, moment):
    """Pressures and turn: G + C p + l phi >= 0, p >= 0, complementary, -l . p = moment."""
    active = gap < np.quantile(gap, 0.5)
    for _ in range(200):
        a = np.flatnonzero(active)
        matrix = np.zeros((len(a) + 1, len(a) + 1))
        matrix[:-1, :-1], matrix[:-1, -1], matrix[-1, :-1] = compliance[np.ix_(a, a)], rate[a], rate[a]
        scale = np.append(np.full(len(a), np.sqrt(compliance[0, 0])), np.abs(rate).max())
        scale = 1 / np.where(scale > 0, scale, 1.0)
        solved = scale * np.linalg.solve(scale[:, None] * matrix * scale, scale * np.append(-gap[a], -moment))
        p, phi = np.zeros(len(gap)), solved[-1]
        p[a] = solved[:-1]
        slack = gap + compliance @ p + rate * phi
        wrong = (active & (p < 0)) | (~active & (slack < -1e-9 * np.abs(gap).max()))
        if not wrong.any():
            return p, phi
        active = active ^ wrong
    raise RuntimeError("the active set does not settle")


@dataclass
class Result:
    """Approach, forces by pair and what they cost."""

    approach: float  # m
    per_mm: dict[int, float]  # N/mm by pair
    unknowns: int
    changes: list[float]


def solve(
    pair, position, h_corner, h_path, radius, beyond, updated, growth=0.15, coarse=1.0, own=False,
    torque=TORQUE, near=NEAR, half=0.16e-3,
):  # fmt: skip
    """Both gears at a position (travel from A in base pitches), one result.

    Gaps wider than ``near`` [m] cannot close; elements have the edges ``h_path`` over twice ``half`` [m].
    """
    start = pair.points.A + position * pair.base_pitch
    placed = pair.placement(float(start))
    stand = Stand((placed.pinion_angle, placed.wheel_angle), (np.zeros(2), placed.wheel_centre))
    contacts = candidates(pair, start, beyond)
    bodies = meshed(pair, stand, contacts, h_corner, h_path, radius, growth, coarse, near, half)
    moved, phi, changes = [np.zeros((body.size // 2, 2)) for body in bodies], 0.0, []
    all_strips = [strips_of(bodies[mortar], mortar, teeth) for _, mortar, teeth, _ in contacts]
    for _ in range(12 if updated else 1):
        here = stand.turned_by(phi)
        faced = [face(bodies, strips, here, moved) for strips in all_strips]
        if own:  # contacts outside the path alone
            outside = [not pair.points.A <= rho1 <= pair.points.E for *_, rho1 in contacts]
            turned_to = [own_normals(bodies, *both, here) for both in zip(all_strips, faced, strict=True)]
            faced = [o if out else f for o, out, f in zip(turned_to, outside, faced, strict=True)]
        kept = [np.all(f.gap < near, axis=1) & np.all(f.gap > -2 * near, axis=1) for f in faced]
        some = [
            replace(s, nodes=s.nodes[k], places=s.places[k], areas=s.areas[k])
            for s, k in zip(all_strips, kept, strict=True)
        ]
        faced = [
            Faced(f.gap[k], f.normal[k], f.nodes[k], f.weights[k], f.rate[k])
            for f, k in zip(faced, kept, strict=True)
        ]
        loads = forces_of(bodies, some, faced, here)
        answers = [body.solve(load) for body, load in zip(bodies, loads, strict=True)]
        compliance = sum(load.T @ answer for load, answer in zip(loads, answers, strict=True))
        weak = np.concatenate([(s.areas * f.gap).sum(axis=1) for s, f in zip(some, faced, strict=True)])
        rate = np.concatenate([(s.areas * f.rate).sum(axis=1) for s, f in zip(some, faced, strict=True)])
        # the gaps hold the displacements so far: take them out, the solution brings all of them
        held = sum(load.T @ u.ravel() for load, u in zip(loads, moved, strict=True))
        p, turn = active_set(
            0.5 * (compliance + compliance.T), weak - held - rate * phi, rate, torque / pair.face_width
        )
        changes.append((turn - phi) * pair.base_radii[0])
        phi, moved = turn, [(answer @ p).reshape(-1, 2) for answer in answers]
        if abs(changes[-1]) < 2e-10:
            break
    per_mm, first = {}, 0
    for (offset, *_), s, f in zip(contacts, some, faced, strict=True):
        push = np.einsum("n,nq,nqa->a", p[first : first + len(s.areas)], s.areas, f.normal)
        per_mm[offset] = float(np.linalg.norm(push)) / 1e3
        first += len(s.areas)
    return Result(phi * pair.base_radii[0], per_mm, sum(len(body.free) for body in bodies), changes)


def candidates(pair, start, beyond):
    """Pairs of teeth that may touch: offset, mortar gear (whose tip is near), teeth, place on the line of action."""
    found = []
    for offset in range(-2, 4):
        rho1 = start + offset * pair.base_pitch
        outside = max(pair.points.A - rho1, rho1 - pair.points.E)
        if outside <= 0 or (beyond and outside < 0.6 * pair.base_pitch):
            found.append((offset, 1 if rho1 < pair.points.C else 0, (offset, -offset), rho1))
    return found


def meshed(
    pair, stand, contacts, h_corner, h_path, radius, growth, coarse, near=NEAR, half=0.16e-3
):  # half: more than a half-width under the whole load
    """Mesh and factorise both gears, fine where they may touch."""
    foci = ({}, {})
    profiles = pair.teeth_profiles
    for _, mortar, teeth, rho1 in contacts:
        other = 1 - mortar
        for gear in (0, 1):
            foci[gear].setdefault(teeth[gear], [])
        if pair.points.A <= rho1 <= pair.points.E:
            for gear, rho in enumerate((rho1, pair.line_of_action - rho1)):
                point = profiles[gear].involute(rho) * MIRROR
                foci[gear][teeth[gear]].append(Focus(point, h_path, half))
        # the corner stands close to the other flank near A and E too
        tip = profiles[mortar].involute(profiles[mortar].flank_rho[1]) * MIRROR
        at = stand.into(other, stand.out(mortar, turned(tip, teeth[mortar] * profiles[mortar].pitch_angle)))
        at = turned(at, -teeth[other] * profiles[other].pitch_angle) * MIRROR
        profile = profiles[other]
        line = np.sqrt(at @ at - profile.base_radius**2)
        angle = np.arctan2(at[0], at[1]) - np.arctan2(line, profile.base_radius)
        rho = profile.base_radius * (profile.base_half_angle - angle)
        if line - rho < near:
            foci[mortar][teeth[mortar]].append(Focus(tip, h_corner, 0.0 if radius == 0 else 2 * radius))
            foci[other][teeth[other]].append(Focus(profile.involute(rho) * MIRROR, h_corner, 8 * h_corner))
    sizes = Sizes(*(coarse * np.array([0.35, 0.25, 0.35, 0.35, 0.35, 0.8])))
    bodies = []
    for gear in (0, 1):
        fine = {
            tooth: sector(profiles[gear], sizes, places, radius, growth)
            for tooth, places in foci[gear].items()
        }
        bodies.append(Body(profiles[gear], pair.materials[gear], sector(profiles[gear], sizes), fine))
    return bodies


# ------------------------------------------------------------------ tables


def ours(pair, position, beyond, bodies):
    """``fem.mesh_cycle`` at the position: approach and the forces of its pairs."""
    n = 1000
    cycle = fem.mesh_cycle(pair, TORQUE, n, bodies, beyond_path=beyond)

    def at(values):
        return float(np.interp(position, cycle.position, values))

    forces = {int(o): at(cycle.forces[:, i]) / pair.face_width / 1e3 for i, o in enumerate(cycle.pair_offset)}
    return at(cycle.transmission_error), forces


def line(label, pair, approach, per_mm, note=""):
    stiffness = pair.normal_force(TORQUE) / pair.face_width / approach / 1e9
    forces = " ".join(f"{per_mm.get(o, 0.0):7.2f}" for o in (-1, 0, 1, 2))
    print(
        f"{label:42s} {stiffness:8.4f} {1e6 * approach:9.4f}  {forces} {sum(per_mm.values()):8.2f}  {note}",
        flush=True,
    )


def run(label, pair, position, **options):
    settings = {"h_corner": 3e-6, "h_path": 8e-6, "radius": 0.0, "beyond": True, "updated": False} | options
    began = time.process_time()
    result = solve(pair, position, **settings)
    note = f"{result.unknowns} unknowns, {time.process_time() - began:.0f} s"
    if settings["updated"]:
        note += f", {len(result.changes)} updates, last {1e9 * result.changes[-1]:.2g} nm"
    line(label, pair, result.approach, result.per_mm, note)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="the pitch point alone")
    quick = parser.parse_args().quick
    pair = PAIR
    C = (pair.points.C - pair.points.A) / pair.base_pitch
    places = {"C": C, ".75": 0.75, ".95": 0.95, ".25": 0.25, ".10": 0.1}
    print(f"{'':42s} {'N/mm um':>8s} {'D um':>9s}  {'N/mm on pairs -1, 0, 1, 2':>31s} {'sum':>8s}")
    for h in (30e-6, 10e-6, 3e-6, 1e-6):
        run(f"C, sharp, corner {1e6 * h:g} um", pair, C, h_corner=h)
    run("C, sharp, 3 um, contacts 4 um", pair, C, h_path=4e-6)
    run("C, sharp, 3 um, slower growth", pair, C, growth=0.1)
    run("C, sharp, 3 um, finer annuli", pair, C, coarse=0.6)
    for radius in (20e-6, 50e-6):
        for h in (10e-6, 3e-6):
            run(f"C, rounded {1e6 * radius:g} um, corner {1e6 * h:g} um", pair, C, h_corner=h, radius=radius)
    run("C, sharp, 3 um, deformed geometry", pair, C, updated=True)
    for name in ("C", ".75", ".95"):
        run(f"{name}, sharp, 3 um, tip's own normal", pair, places[name], own=True)
    if quick:
        return 0
    bodies = fem.compliance(pair, tolerance=1e-4)
    for beyond in (False, True):
        for name, position in places.items():
            where = f"{name}, {'edges free' if beyond else 'held to A..E'}"
            approach, forces = ours(pair, position, beyond, bodies)
            line(f"{where}: fem.mesh_cycle", pair, approach, forces)
            run(f"{where}: two gears, deformed", pair, position, beyond=beyond, updated=True)
    positions = (np.arange(MEAN) + 0.5) / MEAN
    cycle = fem.mesh_cycle(pair, TORQUE, MEAN, bodies)
    found = [solve(pair, position, 3e-6, 8e-6, 0.0, True, False).approach for position in positions]
    for label, approach in (("fem.mesh_cycle", cycle.transmission_error), ("two gears", np.array(found))):
        stiffness = cycle.force / pair.face_width / approach / 1e9
        spread = 1e6 * np.ptp(approach)
        print(
            f"mean of {MEAN} positions, edges free: {label:16s} {stiffness.mean():.4f} N/mm um, {spread:.3f} um p-p"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
