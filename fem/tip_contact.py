"""Contact of a tip edge with the other gear's flank, outside the path of contact.

Before A the wheel's tip corner meets the pinion's flank, after E the pinion's corner the wheel's flank. The
contact starts at the corner and spreads inwards along the corner's own flank. Its pressure is solved for on
strips of that flank: the body with the corner answers with its finite-element displacements (half-plane plus
regular part, which knows the free edge beyond the corner), the other one as a half-plane plus its flexibility
``own``. The unloaded gap is exact: both involutes at the given rotation, measured as rotation times base
radius. Friction and the small angle between the flanks' normals (and with it the change of the lever arm)
are left out.

For a contact that covers the first k strips and whose pressure vanishes on the last of them,
K_k p + g_k = D, p_k = 0, sum(p) = F, so x = K_k^-1 1 and y = K_k^-1 g give D = y_k/x_k and F = sum(D x - y):
one point of the law D(F) for each k, without iteration.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fem.elasticity import PlaneElasticity
from fem.flexibility import corner_logarithm
from fem.line_load import FlankPoints, flank_points, line_loads

if TYPE_CHECKING:
    from fem.ring import Ring
    from gears import GearPair, ToothProfile

__all__ = ["EdgeLaw", "TipStrips", "edge_laws", "lever_ratio", "tip_strips", "unloaded_gap"]

Array = NDArray[np.float64]

FIRST_EDGE, RATIO, REACH, RESOLVED = 1e-4, 1.25, 0.5, 0.01
"""End of the strip at the corner, ratio of successive widths, total width, and the distance from the corner
below which the finite elements are not asked (all in modules of arc length)."""


@dataclass(frozen=True, eq=False)
class TipStrips:
    """Answer of a tooth's tip to pressure on strips of its flank.

    Attributes
    ----------
    distance, width : (n,) arrays
        Arc length from the corner to the middles of the strips, and their widths [m].
    rho : (n,) array
        Curvature radii of the middles [m].
    kernel : (n, n) array
        Normal displacement of strip i by a unit line load spread over strip j [m per N/m].
    """

    distance: Array
    width: Array
    rho: Array
    kernel: Array


def flat_kernel(distance: Array, width: Array, law: PlaneElasticity, length: float) -> Array:
    """Displace a half-plane's edge, at strip middles, by unit loads spread over strips.

    The mean over strip j of -2/(pi E*) [ln(|x|/length) + (1 + nu*)/2].
    """
    offset = distance[:, None] - distance[None, :]

    def integral(x: Array) -> Array:
        size = np.abs(x)
        return np.asarray(x * (np.log(np.maximum(size, 1e-300) / length) - 1.0))

    mean = (integral(offset + 0.5 * width) - integral(offset - 0.5 * width)) / width
    kernel: Array = -2 / (np.pi * law.plane_modulus) * (mean + 0.5 * (1 + law.plane_poisson))
    return kernel


def tip_strips(ring: Ring, profile: ToothProfile, flank: str = "left") -> TipStrips:
    """Load the middles of strips near the tip corner, and take the displacements there.

    The strips' widths are in geometric progression. Two strips nearer to the corner than the elements
    resolve see only the wedge, whose answer is the same at every scale but for c ln(scale): their regular
    part is that of two resolved strips in the same ratio.
    """
    m = profile.module
    count = int(np.ceil(np.log(REACH / FIRST_EDGE) / np.log(RATIO))) + 1
    edges = np.concatenate([[0.0], FIRST_EDGE * m * RATIO ** np.arange(count)])
    distance, width = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    rho = np.sqrt(profile.flank_rho[1] ** 2 - 2 * profile.base_radius * distance)
    at = flank_points(ring.mesh, rho, flank)
    solved = int(np.searchsorted(distance, RESOLVED * m))
    source = at.part(slice(solved, None))
    loads = line_loads(ring, source)
    regular = np.zeros((count, count))
    regular[:, solved:] = loads.on_tooth(0, at) + loads.singular(at) - _flat(at, source, ring.law, m)
    regular[np.arange(solved, count), np.arange(solved, count)] = loads.regular_at_load()
    larger, smaller = (
        np.maximum.outer(np.arange(count), np.arange(count)),
        np.minimum.outer(np.arange(count), np.arange(count)),
    )
    _, logarithm = corner_logarithm(ring.mesh, ring.law, flank)
    shift = np.maximum(solved - larger, 0)
    regular = regular[smaller + shift, larger + shift] - logarithm * np.log(RATIO) * shift
    return TipStrips(distance, width, rho, regular + flat_kernel(distance, width, ring.law, m))


def _flat(at: FlankPoints, source: FlankPoints, law: PlaneElasticity, length: float) -> Array:
    """Displace a flat edge at points (rows) by unit loads (columns)."""
    gap = np.linalg.norm(at.points[:, None] - source.points[None, :], axis=2)
    gap = np.where(gap > 0, gap, length)
    flat: Array = -2 / (np.pi * law.plane_modulus) * (np.log(gap / length) + 0.5 * (1 + law.plane_poisson))
    return flat


def unloaded_gap(
    base_radii: tuple[float, float], line: float, rho1: Array, rho2: Array
) -> tuple[Array, Array]:
    """Gap between the flank of gear 1 and points of the flank of gear 2, and where it would close.

    The gears stand so that their (unlimited) involutes touch at ``rho1`` of the line of action.

    Parameters
    ----------
    base_radii : (float, float)
        r_b1, r_b2 [m]
    line : float
        rho1 + rho2 on the line of action [m].
    rho1 : (n,) array
        Positions [m].
    rho2 : (k,) array
        Curvature radii of the points on flank 2 [m].

    Returns
    -------
    gap : (n, k) array
        Rotation of gear 1 until its flank meets the point, times r_b1 [m].
    where : (n, k) array
        Curvature radius of flank 1 there [m].
    """
    r1, r2 = base_radii
    # line of action along x, gear 1's tangent point at the origin, axes at (0, -r1) and (line, r2)
    turn = (rho2[None, :] - (line - rho1[:, None])) / r2
    c, s = np.cos(turn), np.sin(turn)
    x = line + r2 * s - rho2 * c
    y = r2 - r2 * c - rho2 * s + r1
    where = np.sqrt(np.maximum(x**2 + y**2 - r1**2, 0.0))
    flank = (where - rho1[:, None]) / r1 + np.arctan2(r1, where)
    return r1 * (flank - np.arctan2(y, x)), where


def lever_ratio(pair: GearPair, rho2: Array, rho1: Array) -> Array:
    """Lever about the pinion's axis of the normal to the wheel's flank at ``rho2``, over r_b1.

    Parameters
    ----------
    rho2 : (n,) array
        Curvature radii of the wheel's flank [m].
    rho1 : (n,) array
        Positions: where the unlimited involutes touch on the line of action [m].
    """
    r1, r2 = pair.base_radii
    turn = (rho2 - (pair.line_of_action - rho1)) / r2
    return np.asarray(((r1 + r2) * np.cos(turn) - pair.line_of_action * np.sin(turn) - r2) / r1)


@dataclass(frozen=True, eq=False)
class EdgeLaw:
    """Approach against force of tip-edge contacts, one row per contact.

    Attributes
    ----------
    force : (n, k) array
        Growing forces [N], the first one zero.
    approach : (n, k) array
        Approach of the gears [m] without the flank's ``own`` part and without other teeth; at zero force the
        gap at the corner.
    where : (n,) array
        Curvature radius at which the other gear's flank is touched [m].
    """

    force: Array
    approach: Array
    where: Array


def edge_laws(pair: GearPair, strips: TipStrips, corner: int, rho1: Array, other: PlaneElasticity) -> EdgeLaw:
    """Laws of the contacts at positions ``rho1`` outside the path of contact.

    Parameters
    ----------
    pair : gears.GearPair
    strips : TipStrips
        Of the gear whose corner touches.
    corner : {0, 1}
        That gear: 1 (the wheel) before A, 0 (the pinion) after E.
    rho1 : (n,) array
        Positions by rho1 of the unlimited involutes [m].
    other : PlaneElasticity
        Of the gear whose flank is touched.
    """
    line = pair.line_of_action
    radii = pair.base_radii if corner == 1 else pair.base_radii[::-1]
    place = rho1 if corner == 1 else line - rho1
    gaps, touched = unloaded_gap(radii, line, place, strips.rho)
    profile = pair.teeth_profiles[corner]
    gaps = gaps + profile.relief(strips.rho)
    end = np.array([profile.flank_rho[1]])
    at_corner, where = unloaded_gap(radii, line, place, end)
    first = at_corner[:, 0] + profile.relief(end)[0]
    flank = pair.teeth_profiles[1 - corner]
    gaps = gaps + flank.relief(touched)
    first = first + flank.relief(where[:, 0])
    kernel = strips.kernel + flat_kernel(strips.distance, strips.width, other, pair.module)
    if profile.tip_relief is None and flank.tip_relief is None:
        force, approach = _from_the_corner(kernel, gaps, first)
    else:
        force, approach = _from_the_nearest(kernel, gaps)
    return EdgeLaw(force * pair.face_width, approach, where[:, 0])


def _from_the_corner(kernel: Array, gaps: Array, first: Array) -> tuple[Array, Array]:
    """Line load [N/m] and approach, (contacts, strips): the contact spreads inwards from the corner."""
    forces, approaches = [np.zeros(len(gaps))], [first]
    ones = np.ones(gaps.shape[1])
    for k in range(2, len(ones) + 1):
        both = np.linalg.solve(kernel[:k, :k], np.column_stack([ones[:k], gaps[:, :k].T]))
        x, y = both[:, 0], both[:, 1:]
        approach = y[-1] / x[-1]
        forces.append(approach * x.sum() - y.sum(axis=0))
        approaches.append(approach)
    return np.array(forces).T, np.array(approaches).T


def _from_the_nearest(kernel: Array, gaps: Array) -> tuple[Array, Array]:
    """As ``_from_the_corner`` for any gaps: with tip relief the corner need not be nearest.

    From the nearest strip on, the approach grows until the next strip closes, and so on: each closing is a
    point of the law. Strips that have closed stay closed.
    """
    contacts, strips = gaps.shape
    closed = np.arange(strips) == gaps.argmin(axis=1)[:, None]
    rows = np.arange(contacts)
    force, approach = [np.zeros(contacts)], [gaps.min(axis=1)]
    for _ in range(strips - 1):
        both = closed[:, :, None] & closed[:, None, :]
        sides = np.stack([closed.astype(float), np.where(closed, gaps, 0.0)], axis=2)
        x, y = np.moveaxis(
            np.linalg.solve(np.where(both, kernel, np.eye(strips) * kernel[0, 0]), sides), 2, 0
        )
        x, y = np.where(closed, x, 0.0), np.where(closed, y, 0.0)
        nearing = np.where(
            closed, 0.0, 1.0 - x @ kernel
        )  # a strip that moves as fast as the rest never closes
        closing = np.where(
            nearing > 1e-9, (gaps - y @ kernel) / np.where(nearing > 1e-9, nearing, 1.0), np.inf
        )
        # two strips that close together make one step of the law, not a vertical one
        closing = np.maximum(closing, approach[-1][:, None] + 1e-12)
        following = closing.argmin(axis=1)
        level = closing[rows, following]
        more = np.isfinite(level)  # else the same strips go on bearing
        level = np.where(more, level, 2 * approach[-1] - approach[0] + 1e-9)
        closed = closed | ((np.arange(strips) == following[:, None]) & more[:, None])
        force.append(np.maximum(level * x.sum(axis=1) - y.sum(axis=1), force[-1] * (1 + 1e-12)))
        approach.append(level)
    return np.array(force).T, np.array(approach).T
