"""Load over the face by three-dimensional elements of whole gears: misaligned and crowned pairs.

Run with ``python benchmarks/studies/face_three_dimensions.py FILE`` (both gears: four minutes of processor time,
2.1 GB; what was solved is kept in FILE.npz and used again). ``--pressure``: half-width of the strip of pressure [mm].

Nothing of ``fem.elasticity.prism``, ``fem.elasticity.free_ends`` or ``fem.influence.gear_face`` is used. The annulus of
either gear is meshed whole, with edges of 0.05 mm at the pitch point, and extruded: second-order triangles times
second-order pieces of half the face, 0.15 mm long at the free end, half as long again from one to the next, and at most
2 mm. With c the elasticity tensor, d_z on the section the identity, and Z the products along the face,

    K_ac = sum over j, l of c_ajcl S_jl (x) Z_jl,   S_jl = Int d_j N d_l N,

the integrals by scikit-fem. Loads are strips of the pressure p ~ 1/(a^2 - s^2)^(1/2), which is what more load adds to
Hertz's, observed by their own work. Conjugate gradients solve for all nodal loads along the face at once, for loads
that are equal and such that are opposite on the other half. Of the plane the approach D(q) of a single pair is taken
(`fem.single_pair_stiffness`, which has tests of its own), and the section's own plane strain c is taken out,

    C q + (D(q) - c q) + gap - D >= 0,  q >= 0 ,

which is definite where the strip is at least as wide as the contact.
"""

from __future__ import annotations

import argparse
import resource
import time
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.linalg import eigh
from scipy.sparse import block_array
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementTriP2, MeshTri, MeshTri2
from two_gear_meshes import MIRROR, Focus, sector

import fem
from gears import Alignment, Gear, GearPair, Lead, Material
from meshes import Sizes, gear_mesh

STEEL = Material(206e9, 0.3, 7850.0)
PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04, material=STEEL)
FULL = 443.4e3
"""Line load [N/m]."""

PLAIN = Sizes(flank=1.2, fillet=0.4, root=0.8, top=1.2, corner=0.6, rim=1.6, growth=1.0, layer_growth=1.6)
FINE = replace(PLAIN, flank=0.5, top=0.6, corner=0.3)
EDGE, GROWTH = 0.05e-3, 0.5
LAST, LONGER, LONGEST = 0.15e-3, 1.5, 2e-3
RESIDUAL, MOST = 1e-6, 120
CELLS = 64


# ------------------------------------------------------------------ the section


def second_order(points, six):
    """The section's triangles for scikit-fem, and its unknown at each node."""
    corners = np.unique(six[:, :3])
    number = np.full(len(points), -1)
    number[corners] = np.arange(len(corners))
    mesh = MeshTri2.from_mesh(MeshTri(points[corners].T, number[six[:, :3]].T))
    count = len(corners)
    low, high = np.sort(mesh.facets, axis=0)
    keys = low * count + high
    order = np.argsort(keys)
    unknown = number.copy()
    for k, (a, b) in enumerate(((0, 1), (1, 2), (2, 0))):
        ends = np.sort(number[six[:, [a, b]]], axis=1)
        facet = order[np.searchsorted(keys[order], ends[:, 0] * count + ends[:, 1])]
        mesh.doflocs[:, count + facet] = points[six[:, 3 + k]].T
        unknown[six[:, 3 + k]] = count + facet
    return mesh, unknown


def integrals(mesh):
    """S_jl of scalar functions on the section, j and l of x, y, z."""
    basis = Basis(mesh, ElementTriP2(), intorder=6)
    found = {}
    for j in range(3):
        for k in range(3):
            form = BilinearForm(lambda u, v, _, j=j, k=k: slope(v, j) * slope(u, k))
            found[j, k] = form.assemble(basis).tocsr()
    return found, basis


def slope(field, axis):
    return field.grad[axis] if axis < 2 else field.value


# ------------------------------------------------------------------ along the face


def pieces(half):
    lengths = [LAST]
    while sum(lengths) < half:
        lengths.append(min(lengths[-1] * LONGER, LONGEST))
    return half * np.concatenate([[0.0], np.cumsum(lengths[::-1])]) / sum(lengths)


def quadratic(t):
    return np.stack([(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)], axis=-1)


def along_face(ends):
    """Products <f g>, <f' g'> and <f' g> of the pieces' functions, nodes from mid-face to the end."""
    t, weight = np.polynomial.legendre.leggauss(4)
    t, weight = 0.5 + 0.5 * t, 0.5 * weight
    value = quadratic(t)
    rise = np.stack([4 * t - 3, 4 - 8 * t, 4 * t - 1], axis=-1)
    size = 2 * len(ends) - 1
    mass, stiff, mixed = np.zeros((3, size, size))
    for k, (low, high) in enumerate(pairwise(ends)):
        at, long = slice(2 * k, 2 * k + 3), high - low
        mass[at, at] += long * (value.T * weight) @ value
        stiff[at, at] += (rise.T * weight) @ rise / long
        mixed[at, at] += (rise.T * weight) @ value
    return mass, stiff, mixed


def means(ends, edges):
    """Mean of every function over cells between edges: (n, cells)."""
    t, weight = np.polynomial.legendre.leggauss(4)
    found = np.zeros((2 * len(ends) - 1, len(edges) - 1))
    for low, high in pairwise(np.unique(np.concatenate([ends, edges]))):
        middle = 0.5 * (low + high)
        piece, cell = np.searchsorted(ends, middle) - 1, np.searchsorted(edges, middle) - 1
        z = (middle + 0.5 * (high - low) * t - ends[piece]) / (ends[piece + 1] - ends[piece])
        part = 0.5 * (high - low) / (edges[cell + 1] - edges[cell])
        found[2 * piece : 2 * piece + 3, cell] += part * weight @ quadratic(z)
    return found


# ------------------------------------------------------------------ the solid


class Solid:
    """One gear; loads along the left flank of tooth 0 at C, unknowns (component, node, node along the face)."""

    def __init__(self, profile, rho, half_width, foci=()):
        plain, width = sector(profile, PLAIN), 1.2 * half_width
        focus = Focus(profile.involute(rho) * MIRROR, EDGE, width)
        fine = sector(profile, FINE, [focus, *foci], growth=GROWTH)
        z = profile.teeth
        self.whole, self.fine = gear_mesh(plain, range(-(z // 2), z - z // 2), {0: fine}), fine
        whole = self.whole
        self.mesh, unknown = second_order(whole.points, whole.triangles)
        self.unknown = unknown
        self.S, basis = integrals(self.mesh)
        held = unknown[np.unique(whole.facets["bore"])]
        self.free = np.setdiff1d(np.arange(basis.N), held)
        self.S = {key: one[self.free][:, self.free].tocsr() for key, one in self.S.items()}
        E, nu = STEEL.youngs_modulus, STEEL.poisson_ratio
        self.lam, self.mu = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))
        self.load = self._strip(fine, whole.nodes[0], unknown, profile, rho, half_width, basis.N)

    def _strip(self, fine, nodes, unknown, profile, rho, half_width, size):
        """Work of a strip of pressure of unit force (2, free nodes), along the flank's normal at its middle."""
        inward = -profile.normal(rho) * MIRROR
        middle = rho**2 / (2 * profile.base_radius)
        edges, ends = fine.facets["flank_left"], fine.parameters["flank_left"]
        t, weight = np.polynomial.legendre.leggauss(12)
        found = np.zeros(size)
        for (a, b, c), (first, last) in zip(nodes[edges], ends, strict=True):
            places = np.clip((np.sort([first, last]) - middle) / half_width, -1.0, 1.0)
            low, high = np.arcsin(places)
            angle = 0.5 * (low + high) + 0.5 * (high - low) * t
            s = middle + half_width * np.sin(angle)
            part = 0.5 * (high - low) * weight / np.pi
            shape = quadratic((s - first) / (last - first))
            for node, column in zip((a, c, b), shape.T, strict=True):
                found[unknown[node]] += np.sum(part * column)
        print(f"strip's force {found.sum():.5f}")
        return inward[:, None] * found[self.free] / found.sum()

    def plane_strain(self):
        """Displacement by the strip without anything along the face [m per N/m]."""
        factor = splu(self._in_plane(0.0), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        return float(self.load.ravel() @ factor.solve(self.load.ravel()))

    def _in_plane(self, wave):
        lam, mu, S = self.lam, self.mu, self.S
        more = mu * wave * S[2, 2]
        first = (lam + 2 * mu) * S[0, 0] + mu * S[1, 1] + more
        last = (lam + 2 * mu) * S[1, 1] + mu * S[0, 0] + more
        mixed = lam * S[0, 1] + mu * S[1, 0]
        return block_array([[first, mixed], [mixed.T, last]], format="csc")

    def along(self, ends, even, free):
        """Displacements (n, n) of the strip's places by strips, of nodal loads along half the face [m/N]."""
        n = 2 * len(ends) - 1
        some = slice(0 if even else 1, n)
        moved = self.moved(ends, even, free, np.eye(n)[:, some])
        answer = sum(np.einsum("i,ipq->pq", self.load[a], moved[a]) for a in range(2))[some]
        found = np.zeros((n, n))
        found[some, some] = 0.5 * (answer + answer.T)
        return found

    def moved(self, ends, even, free, loads):
        """Displacements (3, free nodes, n, loads) by strips, of nodal loads along half the face (n, loads)."""
        mass, stiff, mixed = along_face(ends)
        n = len(mass)
        kept = [np.arange(0 if even else 1, n)] * 2 + [np.arange(1 if even else 0, n if free else n - 1)]
        products = {(0, 0): mass, (1, 1): stiff, (1, 0): mixed, (0, 1): mixed.T}
        terms = []
        for a in range(3):
            for c in range(3):
                for j in range(3):
                    for k in range(3):
                        part = self.lam * (a == j) * (c == k)
                        part += self.mu * ((a == c) * (j == k) + (a == k) * (j == c))
                        if part:
                            over = products[int(j == 2), int(k == 2)][np.ix_(kept[a], kept[c])]
                            terms.append((a, c, part * self.S[j, k], over))
        right = [np.zeros((len(self.free), len(k), loads.shape[1])) for k in kept]
        for a in range(2):
            right[a][:] = self.load[a][:, None, None] * loads[kept[a]]
        solved = conjugate_gradients(lambda u: applied(terms, u), self._nearly(mass, stiff, kept), right)
        found = np.zeros((3, len(self.free), n, loads.shape[1]))
        for own, one, some in zip(found, solved, kept, strict=True):
            own[:, some] = one
        return found

    def _nearly(self, mass, stiff, kept):
        """What solves the same equations without the terms between w and the others."""
        options = {"permc_spec": "MMD_AT_PLUS_A", "options": {"SymmetricMode": True}}
        parts = []
        for some in (kept[0], kept[2]):
            parts.append(eigh(stiff[np.ix_(some, some)], mass[np.ix_(some, some)]))
        both = [splu(self._in_plane(max(wave, 0.0)), **options) for wave in parts[0][0]]
        lam, mu, S = self.lam, self.mu, self.S
        laplace = S[0, 0] + S[1, 1]
        shear = [mu * laplace + (lam + 2 * mu) * max(wave, 0.0) * S[2, 2] for wave in parts[1][0]]
        across = [splu(one.tocsc(), **options) for one in shear]

        def solve(rest):
            one = np.einsum("pm,aipr->mair", parts[0][1], np.stack(rest[:2]))
            for m, factor in enumerate(both):
                one[m] = factor.solve(one[m].reshape(-1, one.shape[-1])).reshape(one[m].shape)
            plane = np.einsum("pm,mair->aipr", parts[0][1], one)
            other = np.einsum("pm,ipr->mir", parts[1][1], rest[2])
            for m, factor in enumerate(across):
                other[m] = factor.solve(other[m])
            return [plane[0], plane[1], np.einsum("pm,mir->ipr", parts[1][1], other)]

        return solve


def applied(terms, u):
    found = [np.zeros_like(one) for one in u]
    for a, c, section, over in terms:
        moved = np.einsum("pq,iqr->ipr", over, u[c], optimize=True)
        found[a] += (section @ moved.reshape(len(moved), -1)).reshape(found[a].shape)
    return found


def conjugate_gradients(apply, nearly, right):
    """Solve for all right-hand sides at once."""

    def dot(x, y):
        return sum(np.einsum("ipr,ipr->r", a, b) for a, b in zip(x, y, strict=True))

    u = [np.zeros_like(one) for one in right]
    rest, first = right, None
    step = nearly(rest)
    work = dot(rest, step)
    first = work.copy()
    for turn in range(MOST):
        pulled = apply(step)
        part = work / dot(step, pulled)
        u = [a + part * b for a, b in zip(u, step, strict=True)]
        rest = [a - part * b for a, b in zip(rest, pulled, strict=True)]
        new = nearly(rest)
        after = dot(rest, new)
        if np.all(after <= RESIDUAL**2 * first):
            print(f"{turn + 1} steps", flush=True)
            return u
        step = [a + after / work * b for a, b in zip(new, step, strict=True)]
        work = after
    raise RuntimeError(f"no solution after {MOST} steps: {np.sqrt(np.max(after / first)):.1e}")


# ------------------------------------------------------------------ contact


def solved(file, half_width):
    """Compliances by nodal loads of both gears (gear, even or odd, n, n), c of plane strain; kept in a file."""
    ends = pieces(0.5 * PAIR.face_width)
    kept = dict(np.load(file)) if file.exists() else {}
    rho = PAIR.points.C, PAIR.line_of_action - PAIR.points.C
    for gear, profile in enumerate(PAIR.teeth_profiles):
        if f"plane {gear}" in kept:
            continue
        began = time.process_time()
        solid = Solid(profile, rho[gear], half_width)
        print(
            f"gear {gear}: {solid.mesh.doflocs.shape[1]} nodes of the section, {2 * len(ends) - 1} along half the face"
        )
        for even in (True, False):
            kept[f"{'even' if even else 'odd'} {gear}"] = solid.along(ends, even, True)
        kept[f"plane {gear}"] = np.array(solid.plane_strain())
        most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(f"{time.process_time() - began:.0f} s of processor time, {most:.0f} MB at most", flush=True)
        np.savez(file, **kept)
    both = [sum(kept[f"{name} {gear}"] for gear in (0, 1)) for name in ("even", "odd")]
    return ends, both, float(kept["plane 0"] + kept["plane 1"])


def over_cells(ends, both, edges):
    """Compliance between cells of the whole face, whose edges on half of it are given from mid-face [m/N]."""
    over = means(ends, edges)
    even, odd = (over.T @ one @ over for one in both)
    same, other = 0.5 * (even + odd), 0.5 * (even - odd)
    return np.block([[same[::-1, ::-1], other[::-1]], [other[:, ::-1], same]])


def contact(matrix, width, gap, mean, plane, law, total):
    """Line loads q (cells,) and approach: a Newton iteration with an active set."""
    approach, slope = law
    q, active = np.full(len(width), mean), np.ones(len(width), dtype=bool)
    by_load = matrix * width - plane * np.eye(len(width))
    for _ in range(200):
        some = np.flatnonzero(active)
        jacobian = by_load[np.ix_(some, some)] + np.diag(slope(q[some]))
        rest = by_load[np.ix_(some, some)] @ q[some] + approach(q[some]) + gap[some]
        both = np.linalg.solve(jacobian, np.stack([np.ones(len(some)), rest], axis=1))
        D = (total - width[some] @ (q[some] - both[:, 1])) / (width[some] @ both[:, 0])
        new = q[some] - both[:, 1] + both[:, 0] * D
        let_go = new <= 0.0
        moved = np.abs(np.where(let_go, 0.0, new) - q[some]).max()
        q[some] = np.where(let_go, 0.0, new)
        active[some[let_go]] = False
        if not let_go.any() and moved < 1e-10 * mean:
            open_ = by_load @ q + gap - D
            back = ~active & (open_ < 0.0)
            if not back.any():
                return q, D, width[some] @ both[:, 0]
            active |= back
            q[back] = 1e-3 * mean
    raise RuntimeError("no contact was found")


def plane_law():
    """D(q) of a single pair in the plane at C and its slope: linear but for q ln q."""
    loads = np.array([0.1, 1.0]) * FULL
    b = PAIR.face_width
    found = [q * b / float(fem.single_pair_stiffness(PAIR, q * b, PAIR.points.C)[0]) for q in loads]
    a, b = np.linalg.solve(np.stack([loads, -loads * np.log(loads)], axis=1), found)
    return (
        lambda q: q * (a - b * np.log(np.maximum(q, 1e-9))),
        lambda q: a - b * np.log(np.maximum(q, 1e-9)) - b,
    )


def near_C(count=40):
    """Number of positions, a little more than so many, of which one stands at C; and that one."""
    place = (PAIR.points.C - PAIR.points.A) / PAIR.base_pitch
    best = min(range(count, 2 * count), key=lambda n: abs((np.floor(place * n) + 0.5) / n - place))
    return best, int(np.floor(place * best))


CASES = {
    "20 um out of parallel": (0.0, 20e-6, 1.0),
    "20 um, a tenth of the load": (0.0, 20e-6, 0.1),
    "crowned by 15 um": (15e-6, 0.0, 1.0),
    "crowned by 15 um, a tenth of the load": (15e-6, 0.0, 0.1),
    "straight and aligned": (0.0, 0.0, 1.0),
}


def compare(file, half_width, cells):
    """Print a row for each case: factor, root mean square of the line load's difference over the mean, tangent."""
    ends, both, plane = solved(file, half_width)
    law, half, b = plane_law(), 0.5 * PAIR.face_width, PAIR.face_width
    positions, row = near_C()
    bodies = fem.compliance(PAIR, 0.002)
    edges = np.linspace(0.0, half, cells // 2 + 1)
    width = np.full(cells, b / cells)
    z = (np.arange(cells) + 0.5) / cells * b - half
    matrix = over_cells(ends, both, edges)
    print(f"{'':40}   factor: 3-D   here  apart    told   line load   tangent: 3-D   here")
    for name, (crowning, across, part) in CASES.items():
        gap = crowning * (2 * z / b) ** 2 + across * z / b
        mean = part * FULL
        q, _, tangent = contact(matrix, width, gap - gap.min(), mean, plane, law, mean * b)
        pair = replace(PAIR, pinion=replace(PAIR.pinion, lead=Lead(crowning)))
        torque = mean * b * pair.base_radii[0]
        own, tilted = replace(bodies, pair=pair), Alignment(across)
        cycle = fem.mesh_cycle(pair, torque, positions, own, beyond_path=False, alignment=tilted, cells=cells)
        assert cycle.face is not None
        ours, k = cycle.face.line_load[row].sum(axis=0), float(cycle.face.face_load_factor[row])
        true, off = q.max() / mean, np.sqrt(np.mean((ours - q) ** 2)) / mean
        here, unit = float(cycle.stiffness[row]), 1e-9 / b
        print(
            f"{name:40} {true:13.4f} {k:7.4f} {100 * (k / true - 1):+5.2f} % {100 * cycle.face.error:5.2f} % "
            f"{100 * off:9.2f} % {unit * tangent:14.3f} {unit * here:6.3f}",
            flush=True,
        )


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("file", type=Path)
    parser.add_argument("--pressure", type=float, default=0.22)
    parser.add_argument("--cells", type=int, default=CELLS)
    chosen = parser.parse_args()
    compare(chosen.file.with_suffix(".npz"), 1e-3 * chosen.pressure, chosen.cells)
