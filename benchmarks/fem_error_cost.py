"""Error against cost of the finite elements: order of elements, meshes, tolerances, mesh cycles.

Run with ``python benchmarks/fem_error_cost.py``; about a minute. CPU seconds of one thread; the first call pays for
imports and is left out. The reference is the mesh refined three times.
"""

from __future__ import annotations

import sys
import time

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu
from skfem import Basis, ElementTriP1, ElementTriP2, ElementTriP3, ElementVector, LinearForm, MeshTri1
from skfem.models.elasticity import linear_elasticity

import fem
from fem.elasticity import PlaneElasticity, _curved_mesh
from gears import Gear, GearPair
from meshes import gear_mesh, mesh_sector

PAIRS = {
    "article pair 36/40": GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04),
    "undercut limit 17/43": GearPair(Gear(17), Gear(43), 2e-3, 0.04),
    "large wheel 20/1000": GearPair(Gear(20), Gear(1000), 2e-3, 0.04),
}
LAW = PlaneElasticity("strain", 206e9, 0.3)


def timed(call):
    began = time.process_time()
    result = call()
    return result, time.process_time() - began


def in_ascending_order(triangles):
    """The same triangles with ascending corners: cubic elements need a common direction of each edge."""
    order = np.argsort(triangles[:, :3], axis=1)
    middle = np.array([0, 3, 5, 4])  # of the corners whose numbers add up to 1, 2, 3
    sides = middle[order + np.roll(order, -1, axis=1)]
    return np.take_along_axis(triangles, np.concatenate([order, sides], axis=1), axis=1)


def sector_energy(mesh, kind):
    """Work of a unit shear in the outer part of one tooth whose bore and cuts are held.

    A smooth load, so that elements of any order can be compared on the same triangles: the error of a work is
    the square of the energy norm's. Returns work, unknowns, and seconds of assembly and of the rest.
    """
    whole = gear_mesh(mesh, teeth=[0])
    element = {"P1": ElementTriP1, "P3 curved": ElementTriP3}.get(kind, ElementTriP2)()
    began = time.process_time()
    if kind in ("P1", "P2 straight"):
        corners, local = np.unique(whole.triangles[:, :3], return_inverse=True)
        flat = whole.points[corners].T
        grid = MeshTri1(
            np.ascontiguousarray(flat), np.ascontiguousarray(local.reshape(-1, 3).T), sort_t=False
        )
    else:
        grid = _curved_mesh(whole.points, in_ascending_order(whole.triangles))
    basis = Basis(grid, ElementVector(element), intorder=6)
    matrix = csc_array(linear_elasticity(*LAW.lame).assemble(basis))
    radius = np.linalg.norm(whole.points, axis=1).max()
    module = mesh.module

    def on(condition):
        return basis.get_dofs(facets=grid.facets_satisfying(condition, boundaries_only=True)).all()

    half = np.pi / mesh.teeth
    bore = np.linalg.norm(whole.points, axis=1).min()
    held = np.union1d(
        on(lambda x: np.hypot(*x) < bore + 0.02 * module),
        on(lambda x: np.abs(np.abs(np.arctan2(x[0], x[1])) - half) < 1e-3 * half),
    )

    # body force in the outer part of the tooth, smooth across elements
    @LinearForm
    def pull(v, w):
        x, y = w.x
        return np.exp(-(x**2 + (y - radius + 1.2 * module) ** 2) / (0.5 * module) ** 2) * v[0]

    force = pull.assemble(basis)
    assembled = time.process_time()
    free = np.setdiff1d(np.arange(matrix.shape[0]), held)
    factor = splu(
        csc_array(matrix[free][:, free]),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    factored = time.process_time()
    moved = factor.solve(force[free])
    done = time.process_time()
    return float(force[free] @ moved), len(free), assembled - began, factored - assembled, done - factored


def orders():
    """P1, P2 on straight and on curved sides and P3 on the same triangles."""
    profile = PAIRS["article pair 36/40"].teeth_profiles[0]
    meshes = [timed(lambda n=n: mesh_sector(profile, refinements=n)) for n in range(3)]
    finest = mesh_sector(profile, refinements=3)
    reference = sector_energy(finest, "P3 curved")[0]
    print("work of a smooth body force on one tooth, article's pinion; reference: P3 curved, refined 3 times")
    names = ("elements", "refined", "unknowns", "mesh", "assemble", "factor", "solve", "error", "order")
    print("{:12s} {:>8s} {:>9s} {:>7s} {:>9s} {:>7s} {:>7s} {:>9s} {:>6s}".format(*names))
    for kind in ("P1", "P2 straight", "P2 curved", "P3 curved"):
        before = None
        for level, (mesh, meshing) in enumerate(meshes):
            work, unknowns, *seconds = sector_energy(mesh, kind)
            error = abs(work / reference - 1)
            order = "" if before is None else f"{np.log2(before / error):6.1f}"
            print(
                f"{kind:12s} {level:8d} {unknowns:9d} {meshing:7.3f} {seconds[0]:9.3f} {seconds[1]:7.3f} "
                f"{seconds[2]:7.3f} {error:9.1e} {order:>6s}"
            )
            before = error


def figures(pair, bodies):
    rho1 = np.linspace(pair.points.A, pair.points.E, 41)[1:-1]
    k = fem.single_pair_stiffness(pair, pair.normal_force(300.0), rho1, bodies)
    cycle = fem.mesh_cycle(pair, 300.0, 40, bodies, beyond_path=False)
    return k, np.ptp(cycle.transmission_error)


def tolerances():
    """What a tolerance costs and what it gives."""
    print("\nflank compliance of both gears by tolerance; true errors against the mesh refined three times")
    names = ("pair", "tolerance", "unknowns", "annuli", "seconds", "estimate", "k error", "TE error")
    print("{:22s} {:>9s} {:>9s} {:>10s} {:>8s} {:>9s} {:>9s} {:>9s}".format(*names))
    for name, pair in PAIRS.items():
        exact_k, exact_te = figures(pair, fem.compliance(pair, 1e-5, refinements=3))
        for tolerance in (1e-3, 1e-4, 2e-5):
            bodies, seconds = timed(lambda p=pair, t=tolerance: fem.compliance(p, t))
            k, te = figures(pair, bodies)
            print(
                f"{name:22s} {tolerance:9.0e} {bodies.cost.unknowns:9d} {bodies.cost.counts['annulus_unknowns']:10d} "
                f"{seconds:8.3f} {bodies.error:9.1e} {np.max(np.abs(k / exact_k - 1)):9.1e} "
                f"{abs(te / exact_te - 1):9.1e}"
            )


def cycles():
    """Whole cycles from nothing, and further torques."""
    pair = PAIRS["article pair 36/40"]
    runs = [timed(lambda: fem.mesh_cycle(pair, 600.0)) for _ in range(5)]
    cycle, seconds = min(runs, key=lambda run: run[1])
    parts = ", ".join(f"{stage} {value:.3f}" for stage, value in cycle.cost.parts.items())
    print(f"\nwhole cycle of 40 positions from nothing at 0.1 %: {seconds:.3f} s (least of 5); {parts}")
    bodies = fem.compliance(pair)
    for beyond in (False, True):
        cycle, seconds = timed(lambda b=beyond: fem.mesh_cycle(pair, 500.0, 40, bodies, beyond_path=b))
        steps = cycle.cost.iterations
        print(f"a further torque, tip edges {beyond}: {1e3 * seconds:.1f} ms, {steps} Newton steps")


def main():
    fem.mesh_cycle(next(iter(PAIRS.values())), 100.0)
    orders()
    tolerances()
    cycles()
    return 0


if __name__ == "__main__":
    sys.exit(main())
