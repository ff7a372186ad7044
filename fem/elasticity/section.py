"""Section of a prism, straight or twisted, and functions over the face: its stiffness is made of products of both.

The section of a helical gear turns as it moves along the axis, by ``twist`` a metre. In coordinates that turn with it
u = sum U_ip N_i psi_p (v likewise) and w = sum W_iq N_i phi_q, with the triangles' shape functions N and any functions
psi and phi along the face. The derivative along the axis is

    D_z = d_z - twist T,   T(u, v) = (x d_y - y d_x)(u, v) - (-v, u),   T w = (x d_y - y d_x) w ,

and the strains 11, 22, 33, 12, 13, 23 are S0 U + S1 d_z U:

    S0 = (d_x u, d_y v, -twist T w, d_y u + d_x v, d_x w - twist (T u)_1, d_y w - twist (T u)_2) ,
    S1 = (0, 0, w, 0, u, v) .

The energy needs no more of the section than A0 = <S0, C S0>, B = <S0, C S1> and A2 = <S1, C S1>, and no more of the
face than products of its functions f, g and their derivatives:

    A0 <f g> + B <f g'> + B^T <f' g> + A2 <f' g'> .

A spur gear has no twist. There A0, A2 join u and v with themselves and w with itself, B joins u and v with w: cosines
of u, v and sines of w are apart from the others, and half the functions do.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record, unclocked
from fem.elasticity.plane_elasticity import INTEGRATION, PlaneElasticity, physical_gradients
from meshes.triangle import shape

if TYPE_CHECKING:
    from meshes import SectorMesh

__all__ = ["Face", "Section", "section"]


@record
class Section:
    """Integrals over a sector's triangles, per unit thickness of the body; a thinner web is softer in proportion.

    Attributes
    ----------
    mesh : SectorMesh
    law : PlaneElasticity
        In plane strain: constants of the solid.
    twist : float
        Turn of the section along the axis [rad/m], positive for a right hand.
    still, sloped, steep : (m, 6, 3, 6, 3) arrays
        A0 [Pa], B [Pa m] and A2 [Pa m^2]: node and component of the trial function last.
    """

    mesh: SectorMesh
    law: PlaneElasticity
    twist: float
    still: Array
    sloped: Array
    steep: Array

    def elements(self, face: Face, triangles: Integers) -> Array:
        """Stiffness matrices of some triangles (k, 6 n, 6 n), n unknowns a node: pairs (u, v) of each psi, then w."""
        split, n = 2 * face.psi, 2 * face.psi + face.phi
        parts = (
            (slice(0, 2), slice(0, face.psi), slice(0, split)),
            (slice(2, 3), slice(face.psi, None), slice(split, n)),
        )
        still, sloped, steep = (table[triangles] for table in (self.still, self.sloped, self.steep))
        stiffness = np.empty((len(triangles), 6, n, 6, n))
        for component, function, row in parts:
            for other, by, column in parts:
                products = (
                    (still[:, :, component, :, other], face.mass[function, by]),
                    (sloped[:, :, component, :, other], face.mixed[function, by]),
                    (
                        np.moveaxis(sloped[:, :, other, :, component], (1, 2), (3, 4)),
                        face.mixed[by, function].T,
                    ),
                    (steep[:, :, component, :, other], face.stiffness[function, by]),
                )
                shape_ = len(triangles), 6, row.stop - row.start, 6, column.stop - column.start
                stiffness[:, :, row, :, column] = _sum_of_products(products).reshape(shape_)
        return stiffness.reshape(len(triangles), 6 * n, 6 * n)


def _sum_of_products(products: Sequence[tuple[Array, Array]]) -> Array:
    """Sum of tables of the section (k, i, a, j, b) times products over the face (p, q): (k, i, p, a, j, q, b)."""
    tables = [(table, over_face) for table, over_face in products if over_face.any() and table.any()]
    if not tables:
        (table, over_face), *_ = products
        k, i, a, j, b = table.shape
        return np.zeros((k, i, len(over_face), a, j, over_face.shape[1], b))
    section_ = np.stack([table for table, _ in tables], axis=-1)
    over_z = np.stack([over_face for _, over_face in tables])
    return np.asarray(np.einsum("kiajbt,tpq->kipajqb", section_, over_z, optimize=True))


@record
class Face:
    """Products over the face of functions: psi of u and v, then phi of w.

    Attributes
    ----------
    psi, phi : int
        How many there are.
    mass, mixed, stiffness : (psi + phi, psi + phi) arrays
        <f g> [m or -], <f g'> [- or 1/m], <f' g'> [1/m or 1/m^2].
    """

    psi: int
    phi: int
    mass: Array
    mixed: Array
    stiffness: Array

    @classmethod
    def wave(cls, wavenumber: float, twisted: bool = False) -> Face:
        """Waves over the mean of cos^2.

        Without a twist u, v ~ cos k z and w ~ sin k z; u and v alone without a wave. In a twisted solid u, v and w have
        cosine and sine; without a wave each is constant.

        Parameters
        ----------
        wavenumber : float
            k [1/m]
        twisted : bool
        """
        k, unit = float(wavenumber), np.eye(2)
        quarter = k * np.array([[0.0, 1.0], [-1.0, 0.0]])  # (cos, sin)' = k (-sin, cos)
        if twisted and k:
            return cls(2, 2, np.tile(unit, (2, 2)), np.tile(quarter, (2, 2)), np.tile(k**2 * unit, (2, 2)))
        if twisted:
            return cls(1, 1, np.ones((2, 2)), np.zeros((2, 2)), np.zeros((2, 2)))
        count = 1 + bool(k)
        return cls(1, count - 1, *(table[:count, :count] for table in (unit, quarter, k**2 * unit)))


def section(mesh: SectorMesh, law: PlaneElasticity, twist: float = 0.0) -> Section:
    """Integrate over a sector's triangles with scikit-fem's quadrature.

    Parameters
    ----------
    mesh : SectorMesh
    law : PlaneElasticity
        In plane strain: constants of the solid.
    twist : float
        Turn of the section along the axis [rad/m], tan(beta_b)/r_b, positive for a right hand.
    """
    with unclocked():
        from skfem.quadrature import get_quadrature
        from skfem.refdom import RefTri

    (xi, eta), weight = get_quadrature(RefTri, INTEGRATION)
    gradient, determinant = physical_gradients(mesh.points, mesh.triangles, xi, eta)
    scale = determinant * weight * mesh.thickness[:, None]
    values = shape(xi, eta)
    places = np.einsum("qi,mia->mqa", values, mesh.points[mesh.triangles], optimize=True)
    still, sloped = _strains(values, gradient, places, twist)
    lam, mu = law.lame
    hooke = np.diag([2 * mu, 2 * mu, 2 * mu, mu, mu, mu])
    hooke[:3, :3] += lam
    count, unknowns = len(mesh.triangles), 18

    def product(test: Array, trial: Array) -> Array:
        stress = np.einsum("mq,st,mqtu->mqsu", scale, hooke, trial, optimize=True).reshape(
            count, -1, unknowns
        )
        by_test = np.swapaxes(test.reshape(count, -1, unknowns), 1, 2)
        return np.asarray(by_test @ stress).reshape(count, 6, 3, 6, 3)

    return Section(mesh, law, twist, product(still, still), product(still, sloped), product(sloped, sloped))


def _strains(values: Array, gradient: Array, places: Array, twist: float) -> tuple[Array, Array]:
    """S0 and S1 (m, q, 6, 18) of shape functions (q, 6), their gradients (m, q, 6, 2) and places (m, q, 2)."""
    still, sloped = np.zeros((2, *gradient.shape[:2], 6, 6, 3))
    d_x, d_y = gradient[..., 0], gradient[..., 1]
    turned = -twist * (places[..., :1] * d_y - places[..., 1:] * d_x)
    still[:, :, 0, :, 0], still[:, :, 1, :, 1] = d_x, d_y
    still[:, :, 3, :, 0], still[:, :, 3, :, 1] = d_y, d_x
    still[:, :, 2, :, 2] = turned
    still[:, :, 4, :, 2], still[:, :, 5, :, 2] = d_x, d_y
    still[:, :, 4, :, 0], still[:, :, 5, :, 1] = turned, turned
    # -twist (-J): J(u, v) = (-v, u)
    still[:, :, 4, :, 1], still[:, :, 5, :, 0] = -twist * values, twist * values
    sloped[:, :, 2, :, 2] = sloped[:, :, 4, :, 0] = sloped[:, :, 5, :, 1] = values
    return still.reshape(*still.shape[:3], 18), sloped.reshape(*sloped.shape[:3], 18)
