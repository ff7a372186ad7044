"""Contact of a tip edge with the other gear's flank, outside the path of contact.

Before A the wheel's tip corner meets the pinion's flank, after E the pinion's corner the wheel's flank. The
contact starts at the corner, or where its rounding is nearest, and spreads along the flank. Its pressure is
solved for on strips of that flank (``fem.influence.strip_contact``): the body with the corner answers with its
finite-element displacements (``fem.influence.tip_strips``), the other one as a half-plane plus its compliance ``own``.
The unloaded gap is exact (``fem.laws.tip_geometry``). Without friction the force on a strip stands on the flank
that is touched, so it leans from the normal of the corner's own flank by the angle at which the flanks open,
some hundredths of a radian, away from the tip.

A rounding is a change of the gap only: the few micrometres of material that it takes off the corner are left
in the elastic answer, as Hertz leaves curved bodies half-planes. Strips are then finest about the start of
the arc; the regular part there is interpolated between the sharp corner's strips, since it is smooth in the
logarithms of both distances.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, record
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.influence.strip_contact import (
    begun,
    by_the_far_end,
    closings,
    flat_kernel,
    from_the_corner,
    smoothed,
)
from fem.influence.tip_strips import RATIO, REACH, TipStrips, sharp_layout
from fem.laws.tip_geometry import TipRound, lever_ratio, opening, tip_round, unloaded_gap

if TYPE_CHECKING:
    from gears import GearPair, ToothProfile

__all__ = [
    "EdgeLaw",
    "StripsOfContact",
    "edge_laws",
    "edge_lever",
    "nearest_gap",
    "rounded_law",
    "strip_law",
    "strips_of",
]

ARC_STRIP, ARC_FINE, ARC_REACH = 0.02, 0.25, 0.7
"""On a rounding: width of the strips, the length that is covered by them, and the length covered at all (in
radii of the rounding)."""

Removed = Callable[[Array], Array]
"""Material missing from a flank at curvature radii [m]."""


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


@record
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


@record
class EdgeLaw:
    """Approach against force of tip-edge contacts, one row per contact.

    Attributes
    ----------
    force : (n, k) array
        Growing forces along the normal of the touched flank where the tip touches first, with the torque of all strips
        [N]; the first one zero.
    approach : (n, k) array
        By how much a turn brings the flanks nearer along that normal [m], without the touched flank's ``own`` part,
        without the rotation of the tip's own body on its hub, and without other teeth; at zero force the gap.
    largest : (n,) array
        Force [N] up to which the law holds: over all strips, or until strips farther in would let it fall.
        Beyond it goes on straight.
    touched_rho : (n,) array
        Curvature radius at which the other gear's flank is touched [m].
    smooth : (n,) boolean array
        Whether the strips close one after the other from the corner, so that the law is smooth.
    """

    force: Array
    approach: Array
    touched_rho: Array
    largest: Array
    smooth: Booleans


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


def _lever_ratios(pair: GearPair, corner: int, touched_rho: Array, rho1: Array, turned: int) -> Array:
    """Levers of normals of the flank at ``touched_rho`` (n, k) about the turned gear's axis, over its base radius."""
    return (
        lever_ratio(pair, touched_rho, rho1[:, None], corner)
        if corner == turned
        else np.ones_like(touched_rho)
    )


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
    tips = [] if sharp and removed is None else [_surface(profile, *layout, rounding)]
    tips += [_at_corner(profile, rounding)] if sharp else []
    least = [_gaps(pair, corner, rho1, tip, missing)[0].min(axis=1) for tip in tips]
    return np.asarray(np.min(least, axis=0))


def _touching(
    pair: GearPair,
    corner: int,
    rho1: Array,
    tip: _Tip,
    missing: tuple[Removed, Removed],
    lever: Array,
    turned: int = 0,
) -> Array:
    """Approach at which each strip by itself would touch (contacts, strips) [m]; ``lever`` as of ``strip_law``."""
    gaps, touched = _gaps(pair, corner, rho1, tip, missing)
    return np.asarray(gaps / (_lever_ratios(pair, corner, touched, rho1, turned) / lever[:, None]))


def edge_laws(
    pair: GearPair,
    strips: TipStrips,
    corner: int,
    rho1: Array,
    other: PlaneElasticity,
    removed: tuple[Removed, Removed] | None = None,
    turned: int = 0,
) -> EdgeLaw:
    """Laws of the contacts of a sharp corner at positions ``rho1`` outside the path of contact.

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
    removed : (function, function), optional
        Material missing from the flanks of pinion and wheel; none unless given.
    turned : {0, 1}
        Which gear turns: the pinion, or the wheel with the pinion where it is.
    """
    profile = pair.teeth_profiles[corner]
    sharp, missing = tip_round(profile, 0.0), removed or (_nothing, _nothing)
    at_corner = _at_corner(profile, sharp)
    _, touched_rho = _gaps(pair, corner, rho1, at_corner, missing)
    lever = _lever_ratios(pair, corner, touched_rho, rho1, turned)[:, 0]
    if removed is None:
        force, approach = begun(*strip_law(pair, strips, corner, rho1, other, lever, turned=turned))
        smooth = np.ones(len(rho1), dtype=bool)
    else:
        tip = _surface(profile, strips.distance, strips.width, sharp)
        force, approach, order = closings(
            *_strips(pair, strips, corner, rho1, other, tip, missing, lever, turned)
        )
        force = force * pair.face_width
        # the corner is nearer than the middle of its strip
        first = _touching(pair, corner, rho1, at_corner, missing, lever, turned)[:, 0]
        approach[:, 0] = np.minimum(approach[:, 0], first)
        smooth = np.all(order == np.arange(order.shape[1]), axis=1)
        force[smooth], approach[smooth] = begun(force[smooth], smoothed(force, approach)[smooth])
    force, approach, largest = _growing(force, approach)
    return EdgeLaw(force, approach, touched_rho[:, 0], largest, smooth)


def edge_lever(pair: GearPair, corner: int, rho1: Array, rounding: TipRound, turned: int = 0) -> Array:
    """Lever of the touched flank's normal about the turned gear's axis, over its base radius, at tip edges (n,)."""
    tip = _at_corner(pair.teeth_profiles[corner], rounding)
    _, touched = _gaps(pair, corner, rho1, tip, (_nothing, _nothing))
    return _lever_ratios(pair, corner, touched, rho1, turned)[:, 0]


def strip_law(
    pair: GearPair,
    strips: TipStrips,
    corner: int,
    rho1: Array,
    other: PlaneElasticity,
    lever: Array,
    removed: tuple[Removed, Removed] | None = None,
    turned: int = 0,
) -> tuple[Array, Array]:
    """Force [N] and approach [m] (n, k) of contacts that spread from a sharp corner inwards, strip by strip.

    Both along the contact's normal, whose lever about the turned gear's axis over its base radius is ``lever`` (n,);
    other arguments as for ``edge_laws``. On the path it is the law of contacts that bear at the corner; the first
    points, whose strips would have to pull there, mean nothing.
    """
    profile = pair.teeth_profiles[corner]
    sharp, missing = tip_round(profile, 0.0), removed or (_nothing, _nothing)
    first = _touching(pair, corner, rho1, _at_corner(profile, sharp), missing, lever, turned)[:, 0]
    tip = _surface(profile, strips.distance, strips.width, sharp)
    kernel, gaps, lever_ratios = _strips(pair, strips, corner, rho1, other, tip, missing, lever, turned)
    force, approach = from_the_corner(kernel, gaps, first, lever_ratios)
    return force * pair.face_width, smoothed(force, approach)


def rounded_law(
    pair: GearPair,
    strips: TipStrips,
    corner: int,
    rho1: Array,
    other: PlaneElasticity,
    lever: Array,
    rounding: TipRound,
    removed: tuple[Removed, Removed] | None = None,
    turned: int = 0,
) -> tuple[Array, Array]:
    """As ``strip_law`` for contacts on the path near a rounding, onto which they spread.

    Points are the instants at which strips close away from the tip; nan for strips nearer to it than the contact.
    """
    tip = _surface(pair.teeth_profiles[corner], *round_layout(pair.module, rounding), rounding)
    answer = strips.on(tip.distance, tip.width)
    missing = removed or (_nothing, _nothing)
    kernel, gaps, lever_ratios = _strips(pair, answer, corner, rho1, other, tip, missing, lever, turned)
    force, approach = by_the_far_end(kernel, gaps, lever_ratios)
    lower = smoothed(force, approach)
    return force * pair.face_width, np.where(np.isfinite(lower), lower, approach)


def _strips(
    pair: GearPair,
    strips: TipStrips,
    corner: int,
    rho1: Array,
    other: PlaneElasticity,
    tip: _Tip,
    missing: tuple[Removed, Removed],
    lever: Array,
    turned: int = 0,
) -> tuple[Array, Array, Array]:
    """Kernel (n, k, k) of both bodies [m per N/m], gaps [m], levers over the contact's (n, k) of strips at a tip."""
    gaps, touched = _gaps(pair, corner, rho1, tip, missing)
    angle = _lean(pair, corner, rho1, tip, touched)
    own = strips.lever(angle)
    hub = strips.hub_windup * own[:, :, None] * own[:, None, :]
    kernel = strips.leaning(angle) - hub + flat_kernel(tip.distance, tip.width, other, pair.module)
    return kernel, gaps, _lever_ratios(pair, corner, touched, rho1, turned) / lever[:, None]


def _lean(pair: GearPair, corner: int, rho1: Array, tip: _Tip, touched: Array) -> Array:
    """Angles (n, k) by which forces on the touched flank lean from the normals of the corner's flank [rad]."""
    place = rho1 if corner == 1 else pair.line_of_action - rho1
    radii = pair.base_radii if corner == 1 else pair.base_radii[::-1]
    return opening(radii, pair.line_of_action, place, touched, tip.unrounded_rho)


@record
class StripsOfContact:
    """Strips of one contact at a tip (k,): those of ``edge_laws``.

    Attributes
    ----------
    distance, width : (k,) arrays
        From the sharp corner to the middles, and widths [m].
    touched : (k,) array
        Curvature radii of the other gear's flank [m].
    lean : (k,) array
        Angles of the forces from the inward normals of the corner's flank, away from the tip [rad].
    gaps, lever_ratios : (k,) arrays
        Gaps [m], and levers about the pinion's axis over its base radius.
    kernel : (k, k) array
        Of both bodies, without the turn on the hub [m per N/m].
    """

    distance: Array
    width: Array
    touched: Array
    lean: Array
    gaps: Array
    lever_ratios: Array
    kernel: Array


def strips_of(
    pair: GearPair,
    strips: TipStrips,
    corner: int,
    rho1: float,
    other: PlaneElasticity,
    layout: tuple[Array, Array] | None = None,
    rounding: TipRound | None = None,
) -> StripsOfContact:
    """Strips of one contact at ``rho1``; distances and widths of a ``layout``, or those that suit the rounding.

    Other arguments as for ``edge_laws``; flanks without relief.
    """
    profile, at = pair.teeth_profiles[corner], np.array([rho1])
    rounding = rounding or tip_round(profile, 0.0)
    tip = _surface(profile, *(layout or round_layout(pair.module, rounding)), rounding)
    answer, missing = strips.on(tip.distance, tip.width), (_nothing, _nothing)
    kernel, gaps, lever_ratios = _strips(pair, answer, corner, at, other, tip, missing, np.ones(1))
    _, touched = _gaps(pair, corner, at, tip, missing)
    lean = _lean(pair, corner, at, tip, touched)[0]
    return StripsOfContact(tip.distance, tip.width, touched[0], lean, gaps[0], lever_ratios[0], kernel[0])


def _growing(force: Array, approach: Array) -> tuple[Array, Array, Array]:
    """Laws up to where force or approach first fall, straight from there on; and that force."""
    grow = (np.diff(force) > 0) & (np.diff(approach) > 0)
    # near the corner, where the first strip is wider than the next, a fall is an artefact of unequal strips;
    # where strips would pull, the law has ended
    half = force.shape[1] // 2
    grow[:, :half] = force[:, 1 : half + 1] > 0.0
    last = np.logical_and.accumulate(grow, axis=1).sum(axis=1)[:, None]
    beyond = np.maximum(np.arange(force.shape[1]) - last, 0)

    def straight(values: Array) -> Array:
        end, before = (np.take_along_axis(values, at, axis=1) for at in (last, last - 1))
        return np.where(beyond > 0, end + beyond * (end - before), values)

    return straight(force), straight(approach), np.take_along_axis(force, last, axis=1)[:, 0]
