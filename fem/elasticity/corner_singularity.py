"""What a sharp corner yields more than a half-plane: Michell's wedge under a force at its apex.

With the interior angle 2 beta of the corner and gamma = pi/2 - beta between load and bisector, at the distance d

    u_r ~ c ln d,   c = [2/pi - cos^2 gamma/(beta + sin(2 beta)/2) - sin^2 gamma/(beta - sin(2 beta)/2)]/E*

(S. P. Timoshenko and J. N. Goodier, Theory of Elasticity, 1970, article 38).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fem.elasticity.plane_elasticity import PlaneElasticity

if TYPE_CHECKING:
    from meshes import SectorMesh

__all__ = ["corner_logarithm", "wedge_logarithms"]


def corner_logarithm(mesh: SectorMesh, law: PlaneElasticity, flank: str = "left") -> tuple[float, float]:
    """Interior angle of the tip corner [rad] and the coefficient c of ln d [m per N/m]."""
    points = mesh.points
    facets = mesh.facets[f"flank_{flank}"]
    last = facets[np.argmax(mesh.parameters[f"flank_{flank}"].max(axis=1))]
    at_end = 1 if flank == "right" else 0  # the outline runs up the right flank and down the left one
    corner = last[at_end]
    beyond = next(
        edge
        for name, edges in mesh.facets.items()
        if name.startswith(("top", "chamfer"))
        for edge in edges
        if corner in edge[:2]
    )
    arms = []
    for edge in (last, beyond):
        other = edge[0] if edge[1] == corner else edge[1]
        slope = -3 * points[corner] + 4 * points[edge[2]] - points[other]
        arms.append(slope / np.linalg.norm(slope))
    angle = float(np.arccos(np.clip(arms[0] @ arms[1], -1.0, 1.0)))
    return angle, wedge_logarithms(angle, law)[0]


def wedge_logarithms(angle: float, law: PlaneElasticity) -> tuple[float, float, float]:
    """Coefficients of ln d for force and displacement along a wedge's flank [m per N/m]: c_nn, c_nt, c_tt.

    A force at the apex moves the wedge by -ln(r)/E* times 1/(beta + sin(2 beta)/2) along the bisector and
    1/(beta - sin(2 beta)/2) across it, a half-plane by 2/pi in either direction. n is the inward normal, t
    the tangent towards the apex.

    Parameters
    ----------
    angle : float
        2 beta, of the material [rad].
    law : PlaneElasticity
    """
    half = 0.5 * angle
    along, across = 1 / (half + 0.5 * np.sin(angle)), 1 / (half - 0.5 * np.sin(angle))
    normal = along * np.sin(half) ** 2 + across * np.cos(half) ** 2
    tangential = along * np.cos(half) ** 2 + across * np.sin(half) ** 2
    mixed = 0.5 * (across - along) * np.sin(angle)
    parts = 2 / np.pi - normal, -mixed, 2 / np.pi - tangential
    c_nn, c_nt, c_tt = (float(part / law.plane_modulus) for part in parts)
    return c_nn, c_nt, c_tt
