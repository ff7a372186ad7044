"""Contacts on the path so near to a tip corner that it cuts off their pressure.

Within a half-width a of A or E the strips that give a tip edge its law (``fem.laws.tip_contact``) describe the contact
on the path as well: it spreads from the corner as soon as the load is great enough. With d the contact's distance from
the corner, the flank's own law, Hertz's indentation and the compliance at one point, is corrected by

    Delta(F) = D_strips(F) - Hertz(F) - own F,            a(F) > JOIN d,

so that nothing steps at A and E. Below that force the contact does not reach the corner. What is left of the
difference comes from the slope of the tooth's answer along the flank and from its lean; both are of the second order,
Delta = F^2 (k + l F) with value and slope of the strips where the two join. It fades out, over forces and over
distances, towards the law of contacts that stay where undeformed teeth touch.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers
from fem.elasticity.flamant import hertz_half_width
from fem.influence.tip_strips import RATIO
from fem.laws.tip_contact import rounded_law, strip_law

if TYPE_CHECKING:
    from collections.abc import Callable

    from fem.laws.relieved_flanks import Touch
    from fem.laws.tip_contact import Removed
    from fem.laws.tip_geometry import TipRound
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["along", "cut_off"]

JOIN = 1.25
"""Half-widths over distances from the corner at which a contact has reached it."""

FADE = (1.0, 3.0)
"""Distances from the corner, in half-widths, between which the correction fades out."""

FAR = (0.06, 0.16)
"""Distances [modules] between which it fades out in any case: strips about contacts farther in are too few."""

STEEPEST = 3.0
"""Largest slope by the force's logarithm, over the correction itself, where relieved flanks reach a corner."""

FIRST, LAST = 4, 0.8
"""Strip, counted from the corner, at which the smallest contact joins, and the part of the maximum force."""

NEWTON = 5
"""Steps to the number of strips at which a contact bears a force."""


def cut_off(
    bodies: PairCompliance,
    corner: int,
    touched: Touch,
    rho1: Array,
    force: Array,
    rounding: TipRound | None = None,
    removed: tuple[Removed, Removed] | None = None,
    slid: float = 0.0,
    turned: int = 0,
) -> Array:
    """What contacts on the path near one gear's corner approach beyond the flank's law, over the force (n, k) [m/N].

    Parameters
    ----------
    bodies : PairCompliance
    corner : {0, 1}
        The gear whose corner is near: 1 (the wheel) after A, 0 (the pinion) before E.
    touched : Touch
        Where the flanks touch (``fem.laws.relieved_flanks``).
    rho1 : (n,) array
        Places of the contacts [m].
    force : (k,) array
        Forces [N].
    rounding : TipRound, optional
        Of the corner; distances are then those from its start. Sharp unless given.
    removed : (function, function), optional
        What flanks lack that are no true involutes.
    slid : float
        Energy over the force cubed [m/N^2] by which strips have contacts slide on the corner's tooth: it is given back,
        since contacts that move have it in their own law (``fem.contact.moving_contact``).
    turned : {0, 1}
        As for ``edge_laws``.
    """
    pair, width, line = bodies.pair, bodies.pair.face_width, bodies.pair.line_of_action
    gear, other = (bodies.pinion, bodies.wheel)[corner], (bodies.wheel, bodies.pinion)[corner]
    rho, lever = touched.rho[corner], touched.lever[0]
    round_end = gear.rho_end if rounding is None else rounding.rho
    distance = np.maximum(round_end**2 - rho**2, 0.0) / (2 * gear.base_radius)
    radius = rho1 * (line - rho1) / (line * touched.curvature)
    of_one = hertz_half_width(1 / width, radius, _reduced(bodies))
    gap = lever * touched.gap
    law: Callable[[Array], tuple[Array, Array]]
    tips = pair, bodies.tips[corner], corner, rho1, other.law, lever
    rounded = rounding is not None and rounding.radius > 0.0
    if rounding is None or not rounded:
        points, approach = strip_law(*tips, removed, turned)
        least, law = points[:, FIRST], partial(_between, points, approach - gap[:, None])
    else:
        points, approach = rounded_law(*tips, rounding, removed, turned)
        least = np.where(points > 0.0, points, np.inf).min(axis=1)
        law = partial(along, points, approach - gap[:, None])
    if removed is not None:
        # whose gap may have its minimum a little inside the corner, where few strips would pull
        least = np.maximum(least, (0.4 * tips[1].distance[FIRST] / of_one) ** 2)
    # flanks so far apart at the corner that all strips would pull keep their own law
    reached = (points > 0.0).sum(axis=1) >= 2
    least = np.where(reached, least, LAST)
    last = np.where(reached, np.where(np.isnan(points), 0.0, points).max(axis=1), 1.0)
    comes = np.clip((JOIN * distance / of_one) ** 2, least, LAST * last)[:, None]
    flank = bodies.hertz(rho1, touched.curvature)
    own = (gear.own(rho) - gear.hub_windup) / width
    further = _leaning(bodies, corner, distance, rho, touched.leaning[corner]) / width
    per_log, constant = np.reshape(flank.per_log + 0.0 * rho1, (-1, 1)), flank.constant + own + further
    # over a rounding the law goes on straight beyond its last strip
    asked = np.clip(force, comes, (np.full_like(last, np.inf) if rounded else last)[:, None])
    quotient, steepness = law(np.concatenate([comes, asked], axis=1))
    away = quotient + per_log * np.log(np.concatenate([comes, asked], axis=1)) - constant[:, None]
    slope = steepness[:, :1] - quotient[:, :1] + per_log
    if removed is not None:
        # the gap and the law by strips differ by nanometres, which few forces would resolve
        most = STEEPEST * np.abs(away[:, :1])
        slope = np.clip(slope, -most, most)
    part = np.minimum(force / comes, 1.0)
    below = ((2 * away[:, :1] - slope) + (slope - away[:, :1]) * part) * part
    whole = np.where(force < comes, below, away[:, 1:]) + 3 * slid * force
    apart = np.sqrt(comes / force) / JOIN  # distance over half-width
    whole = whole * (1 - _rise(apart, *FADE)) + further[:, None]
    near = 1.0 - _rise(distance / pair.module, *FAR)
    return np.where(reached[:, None], near[:, None] * whole, 0.0)


def _leaning(bodies: PairCompliance, corner: int, distance: Array, rho: Array, lean: Array) -> Array:
    """What a gear yields more along a normal that leans from its involute's own [m per N/m], its turn left out."""
    gear, strips = (bodies.pinion, bodies.wheel)[corner], bodies.tips[corner]
    if not np.any(lean):
        return np.zeros_like(rho)
    cos, sin = np.cos(lean), np.sin(lean)
    along = np.interp(
        np.log(np.maximum(distance, strips.distance[0])), np.log(strips.distance), np.diag(strips.mixed)
    )
    lever = cos - sin * rho / gear.base_radius
    own = (cos**2 - 1) * gear.own(rho) - 2 * sin * cos * along
    return np.asarray(own - gear.hub_windup * (lever**2 - 1))


def _reduced(bodies: PairCompliance) -> float:
    return 2 / (1 / bodies.pinion.law.plane_modulus + 1 / bodies.wheel.law.plane_modulus)


def _rise(x: Array, start: float, end: float) -> Array:
    """From 0 to 1 between two places, with two continuous derivatives."""
    t = np.clip((x - start) / (end - start), 0.0, 1.0)
    return np.asarray(t**3 * (10 - 15 * t + 6 * t**2))


def _between(force: Array, approach: Array, asked: Array) -> tuple[Array, Array]:
    """Approach over force [m/N] and slope of the approach [m/N] at forces (n, m) between the points of laws by strips.

    Both are smooth in the number of strips that bear, from points on whose strips pull at the corner.
    """
    from scipy.interpolate import CubicSpline

    strips = np.arange(1, force.shape[1])
    points = np.stack([force, approach])[..., 1:] * RATIO ** (-2.0 * strips)
    parts = CubicSpline(strips, points, axis=-1).c
    rows = np.arange(len(force))[:, None]
    cell = np.clip((force[:, None, 1:] <= asked[..., None]).sum(axis=-1) - 1, 0, len(strips) - 2)
    cubic = np.moveaxis(parts[:, cell, :, rows], (-2, -1), (0, 1))  # (4, 2, n, m)
    t = np.full(asked.shape, 0.5)
    for _ in range(NEWTON):
        (value, _), (slope, _) = _scaled_cubic(cubic, strips[cell], t)
        t = np.clip(t - (value - asked) / slope, 0.0, 1.0)
    (_, value), slopes = _scaled_cubic(cubic, strips[cell], t)
    return value / asked, slopes[1] / slopes[0]


def along(force: Array, approach: Array, asked: Array) -> tuple[Array, Array]:
    """As ``_between`` for laws that begin and end with different strips, nan before and after; straight beyond.

    No law goes through fewer than two points: nan.
    """
    from scipy.interpolate import CubicSpline

    value, slope = np.full_like(asked, np.nan), np.full_like(asked, np.nan)
    last = np.where(np.isnan(force), 0.0, force).max(axis=1)[:, None]
    last = np.where(last > 0.0, last, np.inf)
    root = np.sqrt(np.minimum(asked, last))
    for k, known in enumerate(np.isfinite(force)):
        if known.sum() >= 2:
            spline = CubicSpline(np.sqrt(force[k, known]), approach[k, known])
            value[k], slope[k] = spline(root[k]), spline(root[k], 1)
    slope *= 0.5 / root
    return (value + slope * np.maximum(asked - last, 0.0)) / asked, slope


def _scaled_cubic(cubic: Array, strips: Integers, t: Array) -> tuple[Array, Array]:
    """Cubics (4, 2, n, m) times the square of the contact's length, and their derivatives."""
    size = RATIO ** (2.0 * (strips + t))
    value = ((cubic[0] * t + cubic[1]) * t + cubic[2]) * t + cubic[3]
    slope = (3 * cubic[0] * t + 2 * cubic[1]) * t + cubic[2]
    return value * size, (slope + 2 * np.log(RATIO) * value) * size
