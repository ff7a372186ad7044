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

from base import Array, Booleans, Integers, record
from fem.elasticity.flamant import hertz_half_width
from fem.influence.tip_strips import RATIO
from fem.laws.local_law import CutOff
from fem.laws.relieved_flanks import gentle
from fem.laws.tip_contact import rounded_law, strip_law

if TYPE_CHECKING:
    from collections.abc import Callable

    from fem.laws.contact_candidates import ContactCandidates
    from fem.laws.mesh_setup import MeshSetup
    from fem.laws.tip_contact import Removed
    from fem.laws.tip_geometry import TipRound
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["cut_off", "cut_offs"]

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

BELOW, ABOVE = 16, 32
"""Forces of the table below and above the one at which the contact reaches the corner."""


def cut_offs(
    setup: MeshSetup,
    bodies: PairCompliance,
    candidates: ContactCandidates,
    force: float,
    slid: tuple[float, float] = (0.0, 0.0),
) -> tuple[CutOff, ...]:
    """Corrections of all contacts on the path that may reach a corner under up to some force [N].

    Wavy flanks, and teeth that differ, have those of involutes.

    ``slid`` by pinion and wheel, as for ``cut_off``.
    """
    if not setup.beyond_path:
        return ()
    pair, corrections = bodies.pair, []
    widest = hertz_half_width(
        force / pair.face_width, candidates.rho.prod(axis=0) / pair.line_of_action, _reduced(bodies)
    )
    reach = np.minimum(FADE[1] * widest, FAR[1] * pair.module)
    for corner, gear in ((1, bodies.wheel), (0, bodies.pinion)):
        distance = (setup.rounds[corner].rho ** 2 - candidates.rho[corner] ** 2) / (2 * gear.base_radius)
        at = candidates.touchable & ~candidates.edge & (distance < reach)
        if at.any():
            known = setup.removed if gentle(setup) else None
            relieved = None if known is None else _Relieved.of(known, candidates, corner, at)
            law = candidates.place[at], at, setup.rounds[corner], relieved, slid[corner]
            corrections.append(cut_off(bodies, corner, *law))
    return tuple(corrections)


@record
class _Relieved:
    """Contacts (n,) of flanks with relief or deviations: what these lack, and where and how the contacts lie."""

    removed: tuple[Removed, Removed]
    rho: Array
    curvature: Array
    lacking: Array
    lever_ratios: Array
    leaning: Array

    @classmethod
    def of(
        cls, removed: tuple[Removed, Removed], candidates: ContactCandidates, corner: int, at: Booleans
    ) -> _Relieved:
        """Contacts near one gear's corner."""
        first = candidates.lever[0, : len(at)]
        of_corner = candidates.rho[corner][at], candidates.curvature[at], candidates.lacking[at], first[at]
        return cls(removed, *of_corner, candidates.leaning[corner][at])


def cut_off(
    bodies: PairCompliance,
    corner: int,
    rho1: Array,
    at: Booleans,
    rounding: TipRound | None = None,
    relieved: _Relieved | None = None,
    slid: float = 0.0,
    turned: int = 0,
) -> CutOff:
    """Correction of the flank's law for contacts on the path near one gear's corner.

    Parameters
    ----------
    bodies : PairCompliance
    corner : {0, 1}
        The gear whose corner is near: 1 (the wheel) after A, 0 (the pinion) before E.
    rho1 : (n,) array
        Places of the contacts [m].
    at : boolean array
        Which contacts these are, n of them.
    rounding : TipRound, optional
        Of the corner; distances are then those from its start. Sharp unless given.
    relieved : _Relieved, optional
        Where the flanks touch if they are no true involutes.
    slid : float
        Energy over the force cubed [m/N^2] by which strips have contacts slide on the corner's tooth: it is given back,
        since contacts that move have it in their own law (``fem.contact.moving_contact``).
    turned : {0, 1}
        As for ``edge_laws``.
    """
    pair, width, line = bodies.pair, bodies.pair.face_width, bodies.pair.line_of_action
    gear, other = (bodies.pinion, bodies.wheel)[corner], (bodies.wheel, bodies.pinion)[corner]
    place = rho1 if corner == 0 else line - rho1
    ones = np.ones_like(rho1)
    removed, rho, curvature, lacking, lever_ratios, lean = (
        (None, place, ones, 0.0 * ones, ones, 0.0 * ones)
        if relieved is None
        else (
            relieved.removed,
            relieved.rho,
            relieved.curvature,
            relieved.lacking,
            relieved.lever_ratios,
            relieved.leaning,
        )
    )
    round_end = gear.rho_end if rounding is None else rounding.rho
    distance = np.maximum(round_end**2 - rho**2, 0.0) / (2 * gear.base_radius)
    radius = place * (line - place) / (line * curvature)
    of_one = hertz_half_width(1 / (width * lever_ratios), radius, _reduced(bodies))
    law: Callable[[Array], tuple[Array, Array]]
    tips = pair, bodies.tips[corner], corner, rho1, other.law
    if rounding is None or rounding.radius == 0.0:
        force, approach = strip_law(*tips, removed, turned)
        least, law = force[:, FIRST], partial(_between, force, approach - lacking[:, None])
    else:
        force, approach = rounded_law(*tips, rounding, removed, turned)
        least = np.nanmin(np.where(force > 0.0, force, np.nan), axis=1)
        law = partial(_along, force, approach - lacking[:, None])
    if (
        removed is not None
    ):  # whose gap may have its minimum a little inside the corner, where few strips would pull
        least = np.maximum(least, (0.4 * tips[1].distance[FIRST] / of_one) ** 2)
    comes = np.clip((JOIN * distance / of_one) ** 2, least, LAST * force[:, -1])
    flank, own = (
        bodies.hertz(rho1, curvature, lever_ratios),
        (gear.own(rho) - gear.hub_windup) / (width * lever_ratios**2),
    )
    further = _leaning(bodies, corner, distance, rho, lean) / (width * lever_ratios**2)
    fade = 1.0 - _rise(distance / pair.module, *FAR)[0]
    below = 2 * np.log(np.geomspace(1 / (JOIN * FADE[1]), 1.0, BELOW + 1)[:-1]) + np.zeros((len(rho1), 1))
    above = np.linspace(0.0, 1.0, ABOVE) * np.log(force[:, -1:] / comes[:, None])
    start, per_log = np.log(comes)[:, None], np.reshape(flank.per_log + 0.0 * rho1, (-1, 1))
    whole, steepness = law(comes[:, None] * np.exp(above))
    away = whole - (flank.constant + own + further)[:, None] + per_log * (start + above)
    slope = steepness - whole + per_log
    logs = np.concatenate([below, above], axis=1)
    if (
        removed is not None
    ):  # the gap and the law by strips differ by nanometres, which few forces would resolve
        most = STEEPEST * np.abs(away[:, 0])
        slope[:, 0] = np.clip(slope[:, 0], -most, most)
    quotient, slope = _completed(logs, away, slope, 3 * slid * np.exp(start + logs))
    quotient = quotient + further[:, None]
    return CutOff(at, start + logs, fade[:, None] * quotient, fade[:, None] * slope)


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


def _rise(x: Array, start: float, end: float) -> tuple[Array, Array]:
    """From 0 to 1 between two places, with two continuous derivatives; and the first of these."""
    t = np.clip((x - start) / (end - start), 0.0, 1.0)
    return np.asarray(t**3 * (10 - 15 * t + 6 * t**2)), np.asarray(30 * (t * (1 - t)) ** 2 / (end - start))


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


def _along(force: Array, approach: Array, asked: Array) -> tuple[Array, Array]:
    """As ``_between`` for laws that begin with different strips, nan before."""
    from scipy.interpolate import CubicSpline

    value, slope = np.empty_like(asked), np.empty_like(asked)
    root = np.sqrt(asked)
    for k, known in enumerate(np.isfinite(force)):
        spline = CubicSpline(np.sqrt(force[k, known]), approach[k, known])
        value[k], slope[k] = spline(root[k]), spline(root[k], 1)
    return value / asked, 0.5 * slope / root


def _scaled_cubic(cubic: Array, strips: Integers, t: Array) -> tuple[Array, Array]:
    """Cubics (4, 2, n, m) times the square of the contact's length, and their derivatives."""
    size = RATIO ** (2.0 * (strips + t))
    value = ((cubic[0] * t + cubic[1]) * t + cubic[2]) * t + cubic[3]
    slope = (3 * cubic[0] * t + 2 * cubic[1]) * t + cubic[2]
    return value * size, (slope + 2 * np.log(RATIO) * value) * size


def _completed(log_part: Array, quotient: Array, slope: Array, slid: Array) -> tuple[Array, Array]:
    """Correction over force and its slope by ln F, with that of contacts that do not reach the corner.

    All but contacts far from it are given back what strips slide, over the force.
    """
    at, rises, part = quotient[:, :1], slope[:, :1], np.exp(log_part[:, :BELOW])
    first, second = (2 * at - rises) * part, (rises - at) * part**2
    whole = np.concatenate([first + second, quotient], axis=1) + slid
    slopes = np.concatenate([first + 2 * second, slope], axis=1) + slid
    apart = np.exp(-0.5 * log_part) / JOIN  # distance over half-width
    gone, going = _rise(apart, *FADE)
    return whole * (1 - gone), slopes * (1 - gone) + 0.5 * apart * going * whole
