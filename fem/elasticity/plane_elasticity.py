"""Plane elasticity on curved second-order triangles: constants, stiffness matrix, strain at points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Faults, Integers, unclocked
from meshes.triangle import NODES, shape_gradients

if TYPE_CHECKING:
    from scipy.sparse import bsr_array, csc_array
    from skfem import MeshTri2

    from gears import GearPair, Material

__all__ = [
    "MIRROR",
    "PlaneElasticity",
    "check_plane",
    "element_matrices",
    "nodal_stress_matrix",
    "reduced_modulus",
    "stiffness_matrix",
]


def check_plane(faults: Faults, plane: str) -> None:
    """Note a plane that is neither strain nor stress."""
    faults.choice("plane", plane, ("strain", "stress"), "wide gears are nearer plane strain")


@dataclass(frozen=True)
class PlaneElasticity:
    """Constants of an isotropic body in plane strain or plane stress.

    Attributes
    ----------
    plane : {"strain", "stress"}
    E : float
        Young's modulus [Pa]
    nu : float
        Poisson's ratio [-]
    """

    plane: str
    E: float
    nu: float

    def __post_init__(self) -> None:
        """Refuse an unknown plane."""
        faults = Faults()
        check_plane(faults, self.plane)
        faults.raise_if_any()

    @classmethod
    def of(cls, material: Material, plane: str) -> PlaneElasticity:
        """Constants of a ``gears.Material``."""
        return cls(plane, float(material.youngs_modulus), float(material.poisson_ratio))

    @property
    def plane_modulus(self) -> float:
        """E* [Pa]: E/(1 - nu^2) in plane strain, E in plane stress."""
        return self.E / (1 - self.nu**2) if self.plane == "strain" else self.E

    @property
    def plane_poisson(self) -> float:
        """nu* [-]: nu/(1 - nu) in plane strain, nu in plane stress."""
        return self.nu / (1 - self.nu) if self.plane == "strain" else self.nu

    @property
    def shear_modulus(self) -> float:
        """G = E/(2(1 + nu)) [Pa]."""
        return self.E / (2 * (1 + self.nu))

    @property
    def lame(self) -> tuple[float, float]:
        """Lame's constants (lambda, mu) of the plane law sigma = lambda tr(eps) 1 + 2 mu eps [Pa]."""
        mu = self.shear_modulus
        return self.plane_modulus * self.plane_poisson / (1 - self.plane_poisson**2), mu

    def out_of_plane_stress(self, trace: Array) -> Array:
        """Give sigma_zz [Pa] of sigma_xx + sigma_yy (...): nu times it in plane strain, else 0."""
        return self.nu * trace if self.plane == "strain" else np.zeros_like(trace)


def reduced_modulus(pair: GearPair, plane: str) -> float:
    """E' of both gears [Pa]: 2/(1/E1* + 1/E2*)."""
    return 2 / sum(1 / PlaneElasticity.of(material, plane).plane_modulus for material in pair.materials)


MIRROR: Array = np.array([-1.0, 1.0])
"""To the other flank of a tooth along +y."""

INTEGRATION = 4
"""Order of the quadrature: exact for the stiffness of straight elements with room for curved ones."""


def physical_gradients(points: Array, triangles: Integers, xi: Array, eta: Array) -> tuple[Array, Array]:
    """Gradients (m, q, 6, 2) in space and Jacobian determinants (m, q) at reference points (q,)."""
    reference = np.moveaxis(shape_gradients(xi, eta), 0, 1)  # (6, q, 2)
    corners = points[triangles].swapaxes(1, 2).reshape(-1, 6)
    jacobian = (corners @ reference.reshape(6, -1)).reshape(len(triangles), 2, -1, 2)
    (x_xi, x_eta), (y_xi, y_eta) = np.moveaxis(jacobian, (1, 3), (0, 1))
    determinant = x_xi * y_eta - x_eta * y_xi
    by_xi, by_eta = np.moveaxis(reference, (1, 2), (1, 0))[:, None]  # (1, q, 6)
    gradient = np.empty((*determinant.shape, 6, 2))
    scaled = [(derivative / determinant)[..., None] for derivative in (x_xi, x_eta, y_xi, y_eta)]
    gradient[..., 0] = by_xi * scaled[3] - by_eta * scaled[2]
    gradient[..., 1] = by_eta * scaled[0] - by_xi * scaled[1]
    return gradient, determinant


def element_matrices(points: Array, triangles: Integers, law: PlaneElasticity) -> Array:
    """Stiffness matrices (m, 12, 12) per unit thickness [Pa] of isoparametric P2 triangles.

    scikit-fem's quadrature. Its own form of the law gives the same matrix to rounding, but in ten times the time, since
    strains are made for every pair of unknowns (470 against 34 ms for 15552 triangles; ``tests/fem/test_elasticity.py``
    compares the matrices). Unknown 2 i + a of a triangle is component a of its node i.

    K_(ia)(jb) = integral of lambda d_a N_i d_b N_j + mu (d_b N_i d_a N_j + delta_ab grad N_i . grad N_j).

    Parameters
    ----------
    points : (n, 2) array
        [m]
    triangles : (m, 6) array
    law : PlaneElasticity
    """
    with unclocked():
        from skfem.quadrature import get_quadrature
        from skfem.refdom import RefTri

    (xi, eta), weight = get_quadrature(RefTri, INTEGRATION)
    gradient, determinant = physical_gradients(points, triangles, xi, eta)
    slopes = np.moveaxis(gradient.reshape(*gradient.shape[:2], 12), 1, 2)
    # all products d_a N_i d_b N_j at once; the law combines them
    products = (slopes * (determinant * weight)[:, None, :]) @ slopes.swapaxes(1, 2)
    products = products.reshape(-1, 6, 2, 6, 2)
    lam, mu = law.lame
    element = lam * products + mu * products.swapaxes(2, 4)
    along = mu * (products[:, :, 0, :, 0] + products[:, :, 1, :, 1])
    element[:, :, 0, :, 0] += along
    element[:, :, 1, :, 1] += along
    return np.asarray(element.reshape(-1, 12, 12))


def stiffness_matrix(
    points: Array, triangles: Integers, law: PlaneElasticity, thickness: Array | float = 1.0
) -> csc_array:
    """Stiffness matrix per unit face width [Pa], assembled of ``element_matrices``; unknown 2 i + a for node i.

    Parameters
    ----------
    points : (n, 2) array
        [m]
    triangles : (m, 6) array
    law : PlaneElasticity
    thickness : float or (m,) array
        Of the triangles, over the face width.

    Returns
    -------
    scipy.sparse.csc_array, (2n, 2n)
    """
    with unclocked():
        from scipy.sparse import coo_array

    element = element_matrices(points, triangles, law) * np.reshape(thickness, (-1, 1, 1))
    unknown = (2 * triangles[:, :, None] + np.arange(2)).reshape(len(triangles), 12)
    rows, columns = np.repeat(unknown, 12, axis=1).ravel(), np.tile(unknown, 12).ravel()
    size = 2 * len(points)
    return coo_array((element.ravel(), (rows, columns)), shape=(size, size)).tocsc()


def curved_mesh(points: Array, triangles: Integers) -> MeshTri2:
    """Hand the triangles to scikit-fem with their middles where they are, on the exact curves.

    The triangles keep their corners' order (``sort_t=False``), since ours gives the middles' order too.
    """
    from skfem import MeshTri2

    return MeshTri2(np.ascontiguousarray(points.T), np.ascontiguousarray(triangles.T))


def nodal_stress_matrix(
    points: Array, triangles: Integers, law: PlaneElasticity, thickness: Array
) -> bsr_array:
    """Matrix (3n, 2n) from displacements to sigma_xx, sigma_yy, tau_xy at the nodes, averaged over elements.

    Row 3 i + c is component c at node i. Where elements of different thickness (m,) meet, the thinnest alone count:
    their stress is the largest. One law holds for all elements, so that the slopes are averaged and the law is applied
    to their means: a sixth of the numbers to assemble.
    """
    from scipy.sparse import bsr_array, coo_array

    lam, mu = law.lame
    gradient, _ = physical_gradients(points, triangles, NODES[:, 0], NODES[:, 1])
    least = np.full(len(points), np.inf)
    np.minimum.at(least, triangles.ravel(), np.repeat(thickness, 6))
    counts = thickness[:, None] == least[triangles]
    share = counts / np.bincount(triangles[counts], minlength=len(points))[triangles]
    rows, columns = np.repeat(triangles, 6, axis=1).ravel(), np.tile(triangles, 6).ravel()
    shape, shared = (len(points), len(points)), gradient * share[:, :, None, None]
    by_x, by_y = (
        coo_array((shared[..., axis].ravel(), (rows, columns)), shape=shape).tocsr() for axis in (0, 1)
    )
    dx, dy = by_x.data, by_y.data
    components = ((lam + 2 * mu) * dx, lam * dy), (lam * dx, (lam + 2 * mu) * dy), (mu * dy, mu * dx)
    blocks = np.stack([np.stack(row, axis=-1) for row in components], axis=1)
    return bsr_array((blocks, by_x.indices, by_x.indptr), shape=(3 * len(points), 2 * len(points)))
