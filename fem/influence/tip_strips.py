"""Answer of a tooth's tip to forces on strips of its flank, along the flank's normal and along its tangent.

By finite elements: half-plane plus regular part, which knows the free edge beyond the corner. Near the corner
only the wedge is seen, whose answer is the same at every scale but for c_ab ln(scale), c_ab the tensor of
``fem.elasticity.corner_singularity.wedge_logarithms``.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.elasticity.corner_singularity import corner_logarithm, wedge_logarithms
from fem.elasticity.line_load import FlankPoints, flank_points, joined, line_loads
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.influence.gear_compliance import hub_windup
from fem.influence.strip_contact import flat_kernels

if TYPE_CHECKING:
    from fem.elasticity.ring import Ring
    from gears import ToothProfile

__all__ = ["RATIO", "REACH", "RESOLVED", "TipStrips", "gain_beside", "sharp_layout", "tip_strips"]

FIRST_EDGE, RATIO, REACH, RESOLVED = 1e-4, 1.25, 0.5, 0.01
"""End of the strip at the corner, ratio of successive widths, total width, and the distance from the corner
below which the finite elements are not asked (all in modules of arc length)."""

GAINING = 0.5
"""Distance from a corner over the length of the element there from which on a refinement gains all of its order."""

FARTHER = 6
"""Strips by which pairs are moved out to see what is linear in the distance from the corner."""


@record
class TipStrips:
    """Answer of a tooth's tip to unit line loads spread over strips of its flank [m per N/m].

    Attributes
    ----------
    distance, width : (n,) arrays
        Arc length from the corner to the middles of the strips, and their widths [m].
    rho : (n,) array
        Curvature radii of the middles [m].
    kernel : (n, n) array
        Displacement of strip i along the inward normal by a load on strip j along its normal; symmetric but
        for strips of unequal width.
    mixed : (n, n) array
        Displacement of strip i along the inward normal by a load on strip j along the tangent, towards the
        tip. By Maxwell and Betti its transpose is the displacement along the tangent by a normal load.
    tangential : (n, n) array
        Displacement of strip i along the tangent by a load on strip j along it.
    law : PlaneElasticity
        Of the tooth.
    length : float
        Unit of length of the logarithms, the module [m].
    base_radius : float
        [m]
    hub_windup : float
        Part of the kernels that is the body's turning, times the levers over the base radius [m per N/m].
    """

    distance: Array
    width: Array
    rho: Array
    kernel: Array
    mixed: Array
    tangential: Array
    law: PlaneElasticity
    length: float
    base_radius: float
    hub_windup: float

    def scaled(self, module: float, law: PlaneElasticity) -> TipStrips:
        """Give the tip of a gear in modules and E* its size [m] and modulus."""
        modulus = law.plane_modulus
        return TipStrips(
            self.distance * module,
            self.width * module,
            self.rho * module,
            self.kernel / modulus,
            self.mixed / modulus,
            self.tangential / modulus,
            law,
            module,
            self.base_radius * module,
            self.hub_windup / modulus,
        )

    def towards(self, before: TipStrips, edge: float, gain: float) -> TipStrips:
        """Strips that differ as those on the mesh before would, had the last refinement reduced errors by its gain.

        Parameters
        ----------
        before : TipStrips
            On the mesh before the last refinement.
        edge : float
            Length of the element at the corner [m].
        gain : float
            Of a refinement, far from the corner; beside it ``gain_beside`` holds.
        """
        # nearer than that the elements are not asked
        farther = np.maximum(np.maximum(self.distance[:, None], self.distance), RESOLVED * self.length)
        more = gain / gain_beside(farther / edge, gain)
        return replace(
            self,
            kernel=self.kernel + more * (before.kernel - self.kernel),
            mixed=self.mixed + more * (before.mixed - self.mixed),
            tangential=self.tangential + more * (before.tangential - self.tangential),
        )

    def leaning(self, angle: Array) -> Array:
        """Kernels for forces and displacements that lean from the inward normals away from the tip.

        K_ij = cos a_i cos a_j K^nn_ij - cos a_i sin a_j K^nt_ij - sin a_i cos a_j K^nt_ji + sin a_i sin a_j K^tt_ij.

        Parameters
        ----------
        angle : (contacts, n) array
            Of every strip [rad].

        Returns
        -------
        (contacts, n, n) array
            [m per N/m]
        """
        cos, sin = np.cos(angle), np.sin(angle)
        # one factor of every product is taken over rows, the other over columns
        by_normal = self.kernel * cos[:, None, :] - self.mixed * sin[:, None, :]
        by_tangent = self.tangential * sin[:, None, :] - self.mixed.T * cos[:, None, :]
        return np.asarray(cos[:, :, None] * by_normal + sin[:, :, None] * by_tangent)

    def lever(self, angle: Array) -> Array:
        """Levers of leaning forces about the gear's own axis, over the base radius; angles (..., n) [rad]."""
        return np.asarray(np.cos(angle) - np.sin(angle) * self.rho / self.base_radius)

    def on(self, distance: Array, width: Array) -> TipStrips:
        """Other strips of the same tip: the regular parts are smooth in the logarithms of both distances."""
        from scipy.interpolate import RectBivariateSpline

        flat = flat_kernels(self.distance, self.width, self.law, self.length)
        other = flat_kernels(distance, width, self.law, self.length)
        known, asked = np.log(self.distance), np.log(np.minimum(distance, self.distance[-1]))
        kernel, mixed, tangential = (
            RectBivariateSpline(known, known, whole - half_plane, s=0)(asked, asked) + anew
            for whole, half_plane, anew in zip(
                (self.kernel, self.mixed, self.tangential), flat, other, strict=True
            )
        )
        rho = np.interp(np.log(distance), known, self.rho)
        return replace(
            self, distance=distance, width=width, rho=rho, kernel=kernel, mixed=mixed, tangential=tangential
        )


def gain_beside(edges: Array, gain: float) -> Array:
    """By how much a refinement reduces the error of a displacement at a load beside a tip corner.

    Parameters
    ----------
    edges : array
        Distance from the corner over the length of the element there.
    gain : float
        Far from the corner. Well within an element's length of it the displacement grows as a logarithm, of which each
        refinement shows a further part: half of what is still wrong, or less.
    """
    return np.asarray(0.5 + (gain - 0.5) * np.minimum(1.0, edges / GAINING))


def sharp_layout(module: float) -> tuple[Array, Array]:
    """Distances of strip middles from a sharp corner and their widths [m], in geometric progression."""
    count = int(np.ceil(np.log(REACH / FIRST_EDGE) / np.log(RATIO))) + 1
    edges = np.concatenate([[0.0], FIRST_EDGE * module * RATIO ** np.arange(count)])
    return 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)


def tip_strips(ring: Ring, profile: ToothProfile, flank: str = "left") -> TipStrips:
    """Load the middles of strips near the tip corner, and take the displacements there.

    The strips' widths are in geometric progression. Two strips nearer to the corner than the elements
    resolve see the wedge and the tooth's turn: their regular part follows from resolved strips in the same ratio.
    """
    m, law = profile.module, ring.law
    distance, width = sharp_layout(m)
    count = len(distance)
    rho = np.sqrt(profile.flank_rho[1] ** 2 - 2 * profile.base_radius * distance)
    solved = int(np.searchsorted(distance, RESOLVED * m))
    normal = flank_points(ring.mesh, rho, flank)
    nn, nt, tn, tt = _regular(ring, normal, normal.towards_tip(), solved)
    angle, _ = corner_logarithm(ring.mesh, law, flank)
    c_nn, c_nt, c_tt = wedge_logarithms(angle, law)
    upper = np.triu(np.ones((count, count), dtype=bool))
    regular = (
        _scaled(nn, c_nn, solved),
        np.where(upper, _scaled(nt, c_nt, solved), _scaled(tn, c_nt, solved)),
        _scaled(tt, c_tt, solved),
    )
    flat = flat_kernels(distance, width, law, m)
    kernel, mixed, tangential = (part + half_plane for part, half_plane in zip(regular, flat, strict=True))
    turned = hub_windup(profile, law)
    return TipStrips(distance, width, rho, kernel, mixed, tangential, law, m, profile.base_radius, turned)


def _scaled(part: Array, logarithm: float, solved: int) -> Array:
    """Regular part of all pairs of strips from that of pairs (points, loads from ``solved`` on).

    Of two strips the one farther from the corner is loaded. Two strips that are both nearer than the first
    load are moved out together, to that load, and to another one farther out: the two differ by the wedge's
    logarithm and from the tooth's contribution, linear in the distances, which is taken off.
    """
    first, second = np.indices((len(part), len(part)))
    larger, smaller = np.maximum(first, second), np.minimum(first, second)
    shift = np.maximum(solved - larger, 0)
    near = part[smaller + shift, larger + shift - solved]
    more = np.where(shift > 0, FARTHER, 0)
    far = part[smaller + shift + more, larger + shift + more - solved]
    linear = (far - near - logarithm * np.log(RATIO) * more) / (RATIO**FARTHER - 1)
    return np.asarray(near - logarithm * np.log(RATIO) * shift - linear * (1 - RATIO ** -shift.astype(float)))


def _regular(ring: Ring, normal: FlankPoints, tangent: FlankPoints, solved: int) -> tuple[Array, ...]:
    """Regular parts at all points by loads from ``solved`` on (points, loads): nn, nt, tn and tt.

    The first letter is the direction of the displacement, the second that of the load.
    """
    loaded = slice(solved, None)
    positions, law, m = normal.points, ring.law, ring.mesh.module
    gap = np.linalg.norm(positions[:, None] - positions[None, loaded], axis=2)
    place = np.arange(len(positions))
    on_load = place[:, None] == place[loaded]
    log = -2 / (np.pi * law.plane_modulus) * np.log(np.where(on_load, m, gap) / m)
    step = (1 - law.plane_poisson) / (2 * law.plane_modulus) * np.sign(place[loaded] - place[:, None])
    constant = (1 + law.plane_poisson) / (np.pi * law.plane_modulus)
    loads = line_loads(ring, joined(normal.part(loaded), tangent.part(loaded)))
    points = joined(normal, tangent)
    moved = loads.on_tooth(0, points) + loads.singular(points)
    (nn, nt), (tn, tt) = (np.hsplit(rows, 2) for rows in np.vsplit(moved, 2))
    by_normal, by_tangent = np.split(loads.regular_at_load(), 2)
    # at the load itself the displacement along the load is an energy, which converges faster
    nn = np.where(on_load, by_normal, nn - log + constant)
    tt = np.where(on_load, by_tangent, tt - log)
    return nn, nt - step, tn + step, tt
