"""Third-order strain energy of a gear under a load on a flank: what large displacements add to linear elasticity.

The energy of an elastic body whose displacements u solve the linear problem is, to the third order in u, the linear one
plus the third-order part of its energy density at the linear solution (the solution is stationary, so that its own
change does not count). With the linear stress sigma and strain eps, rotation omega and Lame's lambda and mu:

- a linear law between Green's strain and the second stress of Piola and Kirchhoff (St. Venant and Kirchhoff; what
  finite-element programs make of Young's modulus and Poisson's ratio under large displacements),
  w_3 = sigma : (grad u^T grad u)/2, in the plane (sigma : eps^2 + omega^2 tr sigma)/2;
- a linear law between logarithmic strain and its stress (Hencky) adds -lambda tr(eps) tr(eps^2) - 2 mu tr(eps^3).

The two bracket no material, but their difference shows what Young's modulus and Poisson's ratio leave open at this
order. Near a contact the energy grows as 1/a with the half-width a of Hertz's pressure. In a half-plane it is

    W_3 = w^3/(E*^2 a) [c_0 + nu* c_1 + nu*^2 c_2]

by integrals of Hertz's stress alone; the rest hardly depends on a.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers
from fem.elasticity import flamant
from fem.elasticity.plane_elasticity import PlaneElasticity, physical_gradients
from meshes.triangle import shape

if TYPE_CHECKING:
    from fem.elasticity.line_load import LineLoads
    from fem.elasticity.ring import Ring

__all__ = ["densities", "half_plane", "hertz_rotation", "large_strain", "third_order"]

Strain = tuple[Array, Array, Array]

NOMINAL = 0.15
"""Half-width of the pressure in modules with which a gear's energy is integrated."""

NEIGHBOURS = 1
"""Sectors on either side of the loaded one whose energy counts."""

DEEPEST = 5
"""Most halvings of an element's edges for the integration near the load."""


def densities(strain: Strain, rotation: Array, law: PlaneElasticity) -> Array:
    """Third-order densities (3, ...): St. Venant and Kirchhoff's energy [Pa], tr(eps) tr(eps^2), tr(eps)^3.

    Parameters
    ----------
    strain : (array, array, array)
        eps_xx, eps_yy, eps_xy of the linear solution.
    rotation : array
        omega, anticlockwise [rad].
    law : PlaneElasticity
    """
    lam, mu = law.lame
    trace = strain[0] + strain[1]
    mixed = trace * (strain[0] ** 2 + strain[1] ** 2 + 2 * strain[2] ** 2)
    ones = trace**3
    pull = 2 * (lam + mu) * trace
    return np.stack([0.5 * (lam * mixed + mu * (3 * mixed - ones) + rotation**2 * pull), mixed, ones])


def large_strain(parts: Array, law: PlaneElasticity) -> Array:
    """What Hencky's law adds to the energy of St. Venant and Kirchhoff's, of parts (3, ...) as of ``densities``.

    tr(eps^3) in the plane is tr(eps) (3 tr(eps^2) - tr(eps)^2)/2; across it there is no strain in plane strain, and
    -nu/(1 - nu) tr(eps) in plane stress.
    """
    _, mixed, ones = parts
    across = 0.0 if law.plane == "strain" else -law.nu / (1 - law.nu)
    mu = law.shear_modulus
    lam = 2 * mu * law.nu / (1 - 2 * law.nu)
    cubes = 0.5 * (3 * mixed - ones) + across**3 * ones
    return np.asarray(-lam * (1 + across) * (mixed + across**2 * ones) - 2 * mu * cubes)


def hertz_rotation(
    points: Array, centre: Array, inward: Array, half_width: float, peak: float, law: PlaneElasticity
) -> Array:
    """Rotation (n,) of a half-plane under a Hertz pressure [rad], anticlockwise; zero far away.

    The conjugate of the trace of ``flamant.hertz_stress``: omega = 2 p (x - n)/(E* a) in McEwen's coordinates.
    """
    away = points - centre
    side = np.array([-inward[1], inward[0]])
    x, z = away @ side, np.maximum(away @ inward, 0.0)
    s = half_width**2 - x**2 + z**2
    root = np.hypot(s, 2 * x * z)
    n = np.sqrt(np.maximum(0.5 * (root - s), 0.0)) * np.sign(x)
    return np.asarray(2 * peak / (law.plane_modulus * half_width) * (x - n))


def _pressed(
    points: Array, place: tuple[Array, Array], half_width: float, law: PlaneElasticity
) -> tuple[Strain, Array]:
    """Strain and rotation of a half-plane by a unit load as Hertz's pressure, at points (..., 2)."""
    peak, flat, shape_ = 2 / (np.pi * half_width), points.reshape(-1, 2), points.shape[:-1]
    stress = flamant.hertz_stress(flat, *place, half_width, peak)
    mean = law.plane_poisson * (stress[:, 0, 0] + stress[:, 1, 1])
    parts = stress[:, 0, 0], stress[:, 1, 1], stress[:, 0, 1]
    x, y, xy = ((1 + law.plane_poisson) * part for part in parts)
    whole = ((part / law.plane_modulus).reshape(shape_) for part in (x - mean, y - mean, xy))
    turn = hertz_rotation(flat, *place, half_width, peak, law)
    return tuple(whole), turn.reshape(shape_)  # type: ignore[return-value]


def _strained(slopes: Array) -> tuple[Strain, Array]:
    """Strain and rotation of slopes (..., direction, component, loads)."""
    xx, yx, xy, yy = slopes[..., 0, 0, :], slopes[..., 0, 1, :], slopes[..., 1, 0, :], slopes[..., 1, 1, :]
    return (xx, yy, 0.5 * (xy + yx)), 0.5 * (yx - xy)


def third_order(loads: LineLoads, half_width: float = NOMINAL) -> Array:
    """Third-order integrals (3, loads) per unit load cubed and face width, less those of the half-plane.

    Parameters
    ----------
    loads : LineLoads
        Normal to the flank of tooth 0, each by itself.
    half_width : float
        Of the pressure [modules].

    Returns
    -------
    (3, loads) array
        Of ``densities``: an energy [m^3/N^2], two of the strain [m^5/N^3].
    """
    ring, half_width = loads.ring, half_width * loads.ring.mesh.module
    mesh, law, count = ring.mesh, ring.law, len(loads.at.rho)
    xi, eta, weight = _quadrature(0)
    gradient, area = physical_gradients(mesh.points, mesh.triangles, xi, eta)
    area *= mesh.thickness[:, None]
    total = np.zeros((3, count))
    for tooth in range(-NEIGHBOURS, NEIGHBOURS + 1):
        moved = _displacements(loads, tooth)
        strain, turn = _strained(_slopes(gradient, moved, mesh.triangles))
        if tooth:
            total += np.einsum("kmql,mq->kl", densities(strain, turn, law), area * weight)
            continue
        points = _points(mesh.points[mesh.triangles], xi, eta)
        for i in range(count):
            place = loads.at.points[i], loads.at.inward[i]
            own, own_turn = _pressed(points, place, half_width, law)
            sums = strain[0][..., i] + own[0], strain[1][..., i] + own[1], strain[2][..., i] + own[2]
            level = _level(ring, place[0], half_width)
            wide = np.where((level == 0)[:, None], area * weight, 0.0)
            total[:, i] += np.sum(densities(sums, turn[..., i] + own_turn, law) * wide, axis=(1, 2))
            total[:, i] += _near(ring, moved[..., i : i + 1], place, half_width, level)
    return total - half_plane(law)[:, None] / half_width


def _slopes(gradient: Array, moved: Array, triangles: Integers) -> Array:
    """Slopes (m, q, direction, component, loads) of displacements (nodes, 2, loads)."""
    local = moved[triangles].reshape(len(triangles), 1, 6, -1)
    return np.asarray((gradient.swapaxes(-1, -2) @ local).reshape(*gradient.shape[:2], 2, 2, -1))


def _level(ring: Ring, place: Array, half_width: float) -> Integers:
    """How often the edges of each triangle are halved for the integration, near a load at a place."""
    mesh = ring.mesh
    corners = mesh.points[mesh.triangles[:, :3]]
    size = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    away = np.linalg.norm(mesh.points[mesh.triangles] - place, axis=2).min(axis=1)
    wished = np.log2(size / (np.maximum(away - 0.3 * size, 0.0) + half_width))
    level: Integers = np.clip(np.ceil(wished), 0, DEEPEST).astype(np.int64)
    return level


def _near(ring: Ring, moved: Array, place: tuple[Array, Array], half_width: float, level: Integers) -> Array:
    """Integrals (3,) over the triangles that are divided for the integration, displaced (nodes, 2, 1)."""
    mesh, total = ring.mesh, np.zeros(3)
    for depth in range(1, DEEPEST + 1):
        triangles = mesh.triangles[level == depth]
        if not len(triangles):
            continue
        xi, eta, weight = _quadrature(depth)
        gradient, area = physical_gradients(mesh.points, triangles, xi, eta)
        area *= mesh.thickness[level == depth, None]
        strain, turn = _strained(_slopes(gradient, moved, triangles))
        own, own_turn = _pressed(_points(mesh.points[triangles], xi, eta), place, half_width, ring.law)
        sums = strain[0][..., 0] + own[0], strain[1][..., 0] + own[1], strain[2][..., 0] + own[2]
        total += np.sum(densities(sums, turn[..., 0] + own_turn, ring.law) * area * weight, axis=(1, 2))
    return total


def _displacements(loads: LineLoads, tooth: int) -> Array:
    """Displacements (nodes, 2, loads) of a sector, on the loaded one the regular part."""
    ring = loads.ring
    moved = np.zeros((ring.mesh.unknowns, len(loads.at.rho)))
    moved[ring.inner] = loads.inner(tooth)
    moved[ring.cut] = ring.polar @ ring.interfaces(loads.cut_force, tooth)
    if tooth == 0:
        for unknowns in (ring.cut, ring.hub):
            moved[unknowns] -= _singular(loads, unknowns)
    return moved.reshape(-1, 2, len(loads.at.rho))


def _singular(loads: LineLoads, unknowns: Integers) -> Array:
    """Displacement by Flamant's half-plane (unknowns, loads)."""
    ring, at = loads.ring, loads.at
    points = ring.mesh.points[unknowns[::2] // 2]
    moved = [
        flamant.displacement(points, point, inward, ring.law, ring.mesh.module).ravel()
        for point, inward in zip(at.points, at.inward, strict=True)
    ]
    return np.stack(moved, axis=1)


def half_plane(law: PlaneElasticity) -> Array:
    """Third-order integrals (3,) over a half-plane under Hertz's pressure, times a, per unit load cubed.

    In elliptic coordinates x + i z = a cosh(mu - i theta) Hertz's stress of maximum pressure p has
    tr sigma = -2 p sin(theta) e^-mu, E* omega = 2 p cos(theta) e^-mu and the largest shear
    p sinh(mu) sin(theta) e^-mu/|sinh(mu - i theta)|. In units of p^3 a^2/45 the integrals of (tr sigma)^3,
    tr sigma sigma : sigma and E*^2 omega^2 tr sigma are -192, -128 and -64.
    """
    nu = law.plane_poisson
    of_trace, of_square, of_rotation = np.array([-192.0, -128.0, -64.0]) / 45 * (2 / np.pi) ** 3
    ones = (1 - nu) ** 3 * of_trace  # in units of 1/E*^3, like what follows
    mixed = (1 - nu) * ((1 + nu) ** 2 * of_square - 2 * nu * of_trace)
    lam, mu = (constant / law.plane_modulus for constant in law.lame)
    stiff = 0.5 * (lam * mixed + mu * (3 * mixed - ones) + of_rotation)
    return np.array([stiff, mixed / law.plane_modulus, ones / law.plane_modulus]) / law.plane_modulus**2


@lru_cache(maxsize=DEEPEST + 1)
def _quadrature(depth: int) -> tuple[Array, Array, Array]:
    """Points and weights on the reference triangle, its edges halved some times."""
    corners = np.array([[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]])
    for _ in range(depth):
        first, second, third = corners.swapaxes(0, 1)
        a, b, c = 0.5 * (first + second), 0.5 * (second + third), 0.5 * (third + first)
        parts = (first, a, c), (a, second, b), (c, b, third), (a, b, c)
        corners = np.concatenate([np.stack(part, axis=1) for part in parts])
    inside = np.array([[4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6  # exact to the second order
    points = np.einsum("qk,nkx->nqx", inside, corners).reshape(-1, 2)
    return points[:, 0], points[:, 1], np.full(len(points), 0.5 / len(points))


def _points(nodes: Array, xi: Array, eta: Array) -> Array:
    """Places (m, q, 2) of reference points in triangles with nodes (m, 6, 2)."""
    return np.asarray(np.einsum("qi,mix->mqx", shape(xi, eta), nodes))
