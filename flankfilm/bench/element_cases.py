"""Case of the elements: linear, straight and curved quadratic and cubic ones on the same triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.bench.case import Answer, Levels, case, level, over, value
from flankfilm.bench.examples import example_pair

if TYPE_CHECKING:
    from base import Array, Integers
    from meshes import SectorMesh


ORDERS = {"P1": 1.0, "P2 straight": 1.0, "P2 curved": 2.0, "P3 curved": 3.0}
"""Of the error, by the kind of element; the finest solution is of the last."""


@case("Kinds of elements", "unknowns of the sector")
def elements(quick: bool) -> Levels:
    """Work of a smooth load on one tooth by the kind of element and by refinement.

    Pinion of the pair 36/40, one sector held on its cuts: work of a smooth body force in the outer part of the tooth,
    whose error is the square of the energy norm's. Meshes at hand; assembly, factorisation and solution are timed.
    """
    from meshes import mesh_sector

    profile = example_pair().teeth_profiles[0]
    levels = (0, 1) if quick else (0, 1, 2)
    finest = levels[-1] + 1
    sectors = [mesh_sector(profile, refinements=times) for times in (*levels, finest)]

    def solve(kinds: tuple[str, ...], times: int) -> tuple[tuple[str, ...], float, int]:
        return kinds, *sector_energy(sectors[times], kinds[-1])

    def energy(solution: tuple[tuple[str, ...], float, int]) -> Answer:
        kinds, work, unknowns = solution
        return Answer(unknowns, {f"energy, {kind}": value(work) for kind in kinds})

    kinds, label = tuple(ORDERS), "refined {} times".format
    return Levels(
        tuple(over(levels, label, solve, energy, (kind,), name=kind) for kind in kinds),
        level(f"{kinds[-1]}, {label(finest)}", solve, energy, kinds, finest),
        {f"energy, {kind}": order for kind, order in ORDERS.items()},
    )


def sector_energy(mesh: SectorMesh, kind: str) -> tuple[float, int]:
    """Work of a smooth body force in the outer part of one tooth whose bore and cuts are held, and its unknowns."""
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import splu
    from skfem import Basis, ElementTriP1, ElementTriP2, ElementTriP3, ElementVector, LinearForm
    from skfem.models.elasticity import linear_elasticity

    from fem.elasticity.plane_elasticity import PlaneElasticity

    grid = _grid(mesh, straight=kind in ("P1", "P2 straight"))
    element = {"P1": ElementTriP1, "P3 curved": ElementTriP3}.get(kind, ElementTriP2)()
    basis = Basis(grid, ElementVector(element), intorder=6)
    law = PlaneElasticity("strain", 206e9, 0.3)
    matrix = csc_array(linear_elasticity(*law.lame).assemble(basis))
    radius = np.linalg.norm(mesh.points, axis=1).max()

    @LinearForm  # type: ignore[untyped-decorator, unused-ignore]
    def pull(v: Any, w: Any) -> Any:
        """Body force in the outer part of the tooth, smooth across elements."""
        x, y = w.x
        return np.exp(-(x**2 + (y - radius + 1.2 * mesh.module) ** 2) / (0.5 * mesh.module) ** 2) * v[0]

    force = pull.assemble(basis)
    free = np.setdiff1d(np.arange(matrix.shape[0]), _held(basis, grid, mesh))
    factor = splu(
        csc_array(matrix[free][:, free]),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    return float(force[free] @ factor.solve(force[free])), len(free)


def _grid(mesh: SectorMesh, straight: bool) -> Any:
    """One tooth as a mesh of scikit-fem, its sides straight or curved."""
    from skfem import MeshTri1

    from fem.elasticity.plane_elasticity import curved_mesh
    from meshes import gear_mesh

    whole = gear_mesh(mesh, teeth=[0])
    if not straight:
        return curved_mesh(whole.points, _in_ascending_order(whole.triangles))
    corners, local = np.unique(whole.triangles[:, :3], return_inverse=True)
    flat = whole.points[corners].T
    return MeshTri1(np.ascontiguousarray(flat), np.ascontiguousarray(local.reshape(-1, 3).T), sort_t=False)


def _in_ascending_order(triangles: Integers) -> Integers:
    """The same triangles with ascending corners: cubic elements need a common direction of each edge."""
    order = np.argsort(triangles[:, :3], axis=1)
    middle = np.array([0, 3, 5, 4])  # of the corners whose numbers add up to 1, 2, 3
    sides = middle[order + np.roll(order, -1, axis=1)]
    return np.take_along_axis(triangles, np.concatenate([order, sides], axis=1), axis=1)


def _held(basis: Any, grid: Any, mesh: SectorMesh) -> Integers:
    """Unknowns on the bore and on both cuts."""
    half = np.pi / mesh.teeth
    bore = np.linalg.norm(mesh.points, axis=1).min()

    def on(condition: Any) -> Integers:
        unknowns: Integers = basis.get_dofs(
            facets=grid.facets_satisfying(condition, boundaries_only=True)
        ).all()
        return unknowns

    def at_bore(x: Array) -> Any:
        return np.hypot(*x) < bore + 0.02 * mesh.module

    def at_cuts(x: Array) -> Any:
        return np.abs(np.abs(np.arctan2(x[0], x[1])) - half) < 1e-3 * half

    return np.union1d(on(at_bore), on(at_cuts))
