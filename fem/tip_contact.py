"""Contact of a tip edge with the other gear's flank, outside the path of contact.

Before A the wheel's tip corner meets the pinion's flank, after E the pinion's corner the wheel's flank. The
contact starts at the corner, or where its rounding is nearest, and spreads along the flank. Its pressure is
solved for on strips of that flank (``fem.strip_contact``): the body with the corner answers with its
finite-element displacements (half-plane plus regular part, which knows the free edge beyond the corner), the
other one as a half-plane plus its flexibility ``own``. The unloaded gap is exact (``fem.tip_geometry``).

A rounding is a change of the gap only: the few micrometres of material that it takes off the corner are left
in the elastic answer, as Hertz leaves curved bodies half-planes. Strips are then finest about the start of
the arc; the regular part there is interpolated between the sharp corner's strips, since it is smooth in the
logarithms of both distances.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fem.elasticity import PlaneElasticity
from fem.flexibility import corner_logarithm
from fem.line_load import FlankPoints, flank_points, line_loads
from fem.strip_contact import flat_kernel, from_the_corner, from_the_nearest
from fem.tip_geometry import TipRound, tip_round, unloaded_gap

if TYPE_CHECKING:
    from fem.ring import Ring
    from gears import GearPair, ToothProfile

__all__ = ["EdgeLaw", "TipStrips", "edge_laws", "nearest_gap", "tip_strips"]

Array = NDArray[np.float64]

FIRST_EDGE, RATIO, REACH, RESOLVED = 1e-4, 1.25, 0.5, 0.01
"""End of the strip at the corner, ratio of successive widths, total width, and the distance from the corner
below which the finite elements are not asked (all in modules of arc length)."""

ARC_STRIP, ARC_FINE, ARC_REACH = 0.02, 0.25, 0.7
"""On a rounding: width of the strips, the length that is covered by them, and the length covered at all (in
radii of the rounding)."""

Removed = Callable[[Array], Array]
"""Material missing from a flank at curvature radii [m]."""


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
    law : PlaneElasticity
        Of the tooth.
    """

    distance: Array
    width: Array
    rho: Array
    kernel: Array
    law: PlaneElasticity


def sharp_layout(module: float) -> tuple[Array, Array]:
    """Distances of strip middles from a sharp corner and their widths [m], in geometric progression."""
    count = int(np.ceil(np.log(REACH / FIRST_EDGE) / np.log(RATIO))) + 1
    edges = np.concatenate([[0.0], FIRST_EDGE * module * RATIO ** np.arange(count)])
    return 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)


def round_layout(module: float, rounding: TipRound) -> tuple[Array, Array]:
    """Distances from the sharp corner and widths [m] of strips that are finest at the rounding's start."""
    fine, start = ARC_STRIP * rounding.radius, rounding.start
    grown = fine * np.cumsum(RATIO ** np.arange(1, 200))
    plain = fine * np.arange(int(ARC_FINE / ARC_STRIP) + 1)
    onto_arc = np.concatenate([plain, plain[-1] + grown])
    onto_flank = np.concatenate([plain[1:4], plain[3] + grown])
    lowest = max(0.05 * start, start - ARC_REACH * rounding.radius)
    below = start - onto_arc[start - onto_arc > lowest]
    above = start + onto_flank[start + onto_flank < REACH * module]
    edges = np.concatenate([below[::-1], above])
    return 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)


def tip_strips(ring: Ring, profile: ToothProfile, flank: str = "left") -> TipStrips:
    """Load the middles of strips near the tip corner, and take the displacements there.

    The strips' widths are in geometric progression. Two strips nearer to the corner than the elements
    resolve see only the wedge, whose answer is the same at every scale but for c ln(scale): their regular
    part is that of two resolved strips in the same ratio.
    """
    m = profile.module
    distance, width = sharp_layout(m)
    count = len(distance)
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
    return TipStrips(distance, width, rho, regular + flat_kernel(distance, width, ring.law, m), ring.law)


def _flat(at: FlankPoints, source: FlankPoints, law: PlaneElasticity, length: float) -> Array:
    """Displace a flat edge at points (rows) by unit loads (columns)."""
    gap = np.linalg.norm(at.points[:, None] - source.points[None, :], axis=2)
    gap = np.where(gap > 0, gap, length)
    flat: Array = -2 / (np.pi * law.plane_modulus) * (np.log(gap / length) + 0.5 * (1 + law.plane_poisson))
    return flat


@dataclass(frozen=True, eq=False)
class _Tip:
    """Strips of a tip with its rounding: places for the gaps, and the answer of the tooth."""

    distance: Array
    width: Array
    rho: Array
    along: Array
    out: Array
    unrounded_rho: Array  # where relief and deviations are read


def _surface(profile: ToothProfile, distance: Array, width: Array, rounding: TipRound) -> _Tip:
    nominal = np.sqrt(profile.flank_rho[1] ** 2 - 2 * profile.base_radius * distance)
    on_arc = distance < rounding.start
    along, out = np.zeros_like(distance), np.zeros_like(distance)
    along[on_arc], out[on_arc] = rounding.offset(distance[on_arc])
    return _Tip(distance, width, np.where(on_arc, rounding.rho, nominal), along, out, nominal)


def _rounded_kernel(strips: TipStrips, tip: _Tip, length: float) -> Array:
    """Answer of the tooth on other strips than those that were solved for."""
    from scipy.interpolate import RectBivariateSpline

    regular = strips.kernel - flat_kernel(strips.distance, strips.width, strips.law, length)
    known, asked = np.log(strips.distance), np.log(np.minimum(tip.distance, strips.distance[-1]))
    smooth = RectBivariateSpline(known, known, regular, s=0)(asked, asked)
    return np.asarray(smooth + flat_kernel(tip.distance, tip.width, strips.law, length))


@dataclass(frozen=True, eq=False)
class EdgeLaw:
    """Approach against force of tip-edge contacts, one row per contact.

    Attributes
    ----------
    force : (n, k) array
        Growing forces [N], the first one zero.
    approach : (n, k) array
        Approach of the gears [m] without the flank's ``own`` part and without other teeth; at zero force the
        gap where the tip is nearest.
    where : (n,) array
        Curvature radius at which the other gear's flank is touched [m].
    """

    force: Array
    approach: Array
    where: Array


def _nothing(rho: Array) -> Array:
    return np.zeros_like(rho)


def _gaps(
    pair: GearPair, corner: int, rho1: Array, tip: _Tip, missing: tuple[Removed, Removed]
) -> tuple[Array, Array]:
    """Unloaded gaps of the strips and where they would close, (contacts, strips) [m]."""
    radii = pair.base_radii if corner == 1 else pair.base_radii[::-1]
    place = rho1 if corner == 1 else pair.line_of_action - rho1
    gaps, touched = unloaded_gap(radii, pair.line_of_action, place, tip.rho, tip.along, tip.out)
    gaps = gaps + missing[corner](tip.unrounded_rho)
    return gaps + missing[1 - corner](touched), touched


def _at_corner(profile: ToothProfile, rounding: TipRound) -> _Tip:
    return _surface(profile, np.array([rounding.start]), np.zeros(1), rounding)


def nearest_gap(
    pair: GearPair,
    corner: int,
    rho1: Array,
    rounding: TipRound | None = None,
    removed: tuple[Removed, Removed] | None = None,
) -> Array:
    """Gap of tip edges where they are nearest to the other flank (n,) [m]; arguments as ``edge_laws``."""
    profile = pair.teeth_profiles[corner]
    rounding = rounding or tip_round(profile, 0.0)
    missing = removed or (_nothing, _nothing)
    sharp = rounding.radius == 0.0
    layout = sharp_layout(profile.module) if sharp else round_layout(profile.module, rounding)
    tip = _at_corner(profile, rounding) if sharp else _surface(profile, *layout, rounding)
    gaps, _ = _gaps(pair, corner, rho1, tip, missing)
    if sharp and removed is not None:
        more, _ = _gaps(pair, corner, rho1, _surface(profile, *layout, rounding), missing)
        return np.asarray(more.min(axis=1))
    return np.asarray(gaps.min(axis=1))


def edge_laws(
    pair: GearPair,
    strips: TipStrips,
    corner: int,
    rho1: Array,
    other: PlaneElasticity,
    rounding: TipRound | None = None,
    removed: tuple[Removed, Removed] | None = None,
) -> EdgeLaw:
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
    rounding : TipRound, optional
        Of the corner; sharp unless given.
    removed : (function, function), optional
        Material missing from the flanks of pinion and wheel; none unless given.
    """
    profile = pair.teeth_profiles[corner]
    rounding = rounding or tip_round(profile, 0.0)
    missing = removed or (_nothing, _nothing)
    end, where = _gaps(pair, corner, rho1, _at_corner(profile, rounding), missing)
    sharp = rounding.radius == 0.0
    layout = (strips.distance, strips.width) if sharp else round_layout(pair.module, rounding)
    tip = _surface(profile, *layout, rounding)
    gaps, _ = _gaps(pair, corner, rho1, tip, missing)
    own = strips.kernel if sharp else _rounded_kernel(strips, tip, pair.module)
    kernel = own + flat_kernel(tip.distance, tip.width, other, pair.module)
    if sharp and removed is None:
        force, approach = from_the_corner(kernel, gaps, end[:, 0])
    else:
        force, approach = from_the_nearest(kernel, gaps)
    return EdgeLaw(force * pair.face_width, approach, where[:, 0])
