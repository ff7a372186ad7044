r"""Stress along a fillet of a twisted solid: a helicoid without load, so that three strains give all of it.

The helix through a point of the section has the tangent (twist J r, 1), with J(x, y) = (-y, x). With t the tangent of
the fillet in the section, n its normal there, p = twist t . J r and q = twist n . J r, the surface is spanned by t and

.. math:: b = \frac{(q n, 1)}{g}, \qquad g = \sqrt{1 + q^2} ,

at right angles. Derivatives along the fillet, d_s, and along the helix, D_h = d_z + twist J of what turns with the
section, give those along b, D_b = (D_h - p d_s)/g, so that displacements U = (u, v, w) on the surface alone make

.. math:: \epsilon_t = t \cdot d_s U, \quad \epsilon_b = b \cdot D_b U, \quad
   \gamma = t \cdot D_b U + b \cdot d_s U ,

and sigma_t = E* (eps_t + nu eps_b), sigma_b = E* (eps_b + nu eps_t), tau = G gamma as on the fillets of a prism
(``fem.elasticity.fillet_strain``). These are sums of values at a place, and of their derivatives by z.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.elasticity.fillet_strain import SIDES, FilletStrain, fillet_strains

if TYPE_CHECKING:
    from scipy.sparse import csr_array

    from fem.elasticity.fillet import FilletLine
    from fem.elasticity.plane_elasticity import PlaneElasticity
    from gears import ToothProfile
    from meshes import SectorMesh

__all__ = ["ACROSS", "ALONG", "SHEAR", "HelixFillet", "helix_fillets", "principal"]

ALONG, ACROSS, SHEAR = 0, 1, 2
"""sigma_t, sigma_b and tau."""


@record
class HelixFillet:
    """Matrices from nodal displacements of a sector to the stress at the samples of one of its fillets.

    Attributes
    ----------
    still : (3 samples, 3 nodes) sparse matrix
        sigma_t at all samples, then sigma_b, then tau, by u, v, w of each node [Pa/m].
    sloped : (3 samples, 3 nodes) sparse matrix
        By their derivatives along the axis [Pa].
    """

    still: csr_array
    sloped: csr_array

    def stress(self, moved: Array, slope: Array) -> Array:
        """Stress (3, samples, n) of displacements (nodes, 3, n) and of their derivatives along the axis."""
        columns = moved.shape[-1]
        stress = self.still @ moved.reshape(-1, columns) + self.sloped @ slope.reshape(-1, columns)
        return np.asarray(stress).reshape(3, -1, columns)


def helix_fillets(
    mesh: SectorMesh, profile: ToothProfile, line: FilletLine, law: PlaneElasticity, twist: float
) -> tuple[HelixFillet, ...]:
    """Recovery on both fillets of a tooth, that under the loaded flank first.

    Parameters
    ----------
    mesh : meshes.SectorMesh
    profile : gears.ToothProfile
        Of the transverse section.
    line : FilletLine
    law : PlaneElasticity
        In plane strain: constants of the solid.
    twist : float
        Turn of the section along the axis [rad/m], positive for a right hand.
    """
    strains = fillet_strains(mesh, profile, line)
    return tuple(
        _of_side(strain, line.side(side == "left"), law, twist)
        for strain, side in zip(strains, SIDES, strict=True)
    )


def _of_side(
    strain: FilletStrain, along_line: tuple[Array, Array, Array], law: PlaneElasticity, twist: float
) -> HelixFillet:
    """Stress along one fillet, of its points, tangents and normals."""
    from scipy.sparse import csr_array, vstack

    points, tangents, normals = along_line
    turned = np.stack([-points[:, 1], points[:, 0]], axis=1)
    p, q = (twist * np.sum(each * turned, axis=1) for each in (tangents, normals))
    size, none = np.sqrt(1.0 + q**2), np.zeros_like(q)
    t = np.stack([*tangents.T, none])
    b = np.stack([q * normals[:, 0], q * normals[:, 1], none + 1.0]) / size

    def across(d: Array) -> tuple[csr_array, csr_array]:
        """D . D_b U by values, where d . J U is (-J d) . U, and by derivatives along the axis."""
        back = twist * np.stack([d[1], -d[0], none])
        still = _along(strain.value, back / size) - _along(strain.slope, p * d / size)
        return still, _along(strain.value, d / size)

    drawn = csr_array(strain.along @ _in_plane(strain.value.shape[1]))
    stretched, lean = across(b), across(t)
    e, nu, g = law.plane_modulus, law.nu, law.shear_modulus
    still = (
        e * (drawn + nu * stretched[0]),
        e * (stretched[0] + nu * drawn),
        g * (lean[0] + _along(strain.slope, b)),
    )
    sloped = e * nu * stretched[1], e * stretched[1], g * lean[1]
    return HelixFillet(csr_array(vstack(still)), csr_array(vstack(sloped)))


def _along(of_node: csr_array, direction: Array) -> csr_array:
    """Component along a direction (3, samples) of what a matrix (samples, nodes) makes of u, v and w."""
    from scipy.sparse import csr_array, diags_array, kron

    parts = (diags_array(direction[a]) @ kron(of_node, np.eye(3)[a : a + 1], format="csr") for a in range(3))
    return csr_array(sum(parts))


def _in_plane(nodes: int) -> csr_array:
    """Matrix (2 nodes, 3 nodes) that takes u and v of u, v, w."""
    from scipy.sparse import csr_array, eye_array, kron

    return csr_array(kron(eye_array(nodes), np.eye(3)[:2], format="csr"))


def principal(along: Array, across: Array, shear: Array) -> tuple[Array, Array]:
    """Larger and smaller principal stress of a free surface by sigma_t, sigma_b and tau."""
    middle, radius = 0.5 * (along + across), np.hypot(0.5 * (along - across), shear)
    return np.asarray(middle + radius), np.asarray(middle - radius)
