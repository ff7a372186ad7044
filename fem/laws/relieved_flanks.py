r"""Where flanks touch that differ from involutes: relief and deviations turn and bend them, so that the contact moves.

With sigma the distance along the common tangent from where the involutes touch, towards the pinion's tip, flanks that
lack h(sigma) of material stand apart by sigma^2/(2 R) + h. They touch where that is smallest,

    sigma/R + h' = 0,    1/R' = 1/R + h'',

to the second order a contact of involutes there with the radius R', and with the gap h - (R' h'^2)/2 at its nominal
place. Slope and curvature of h are differences over ``SPAN`` on either side, so that waves shorter than a contact, over
which its pressure takes the mean, count with their depth alone. Where the minimum gap is that of a tip corner an edge
touches: tip relief moves that place outwards by R h'.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, record
from fem.laws.relieved_lines import RelievedLines
from fem.laws.tip_geometry import gap_at, opening_at, tangent_arm

if TYPE_CHECKING:
    from collections.abc import Callable

    from fem.laws.flank_forms import FlankForms
    from fem.laws.tip_contact import Removed
    from gears import GearPair

__all__ = ["Touch", "ends_of_flanks", "gentle", "plain_touch", "relieved_lines", "starts_of_relief", "touch"]

SPAN = 0.05
"""Half of the stretch over which slope and curvature of what is missing are differences [modules]."""

CURVATURES = (0.5, 4.0)
"""Minimum and maximum curvature 1/R' over 1/R: more than this is a wave or an edge, not a contact's curvature."""

SLACK = 1e-7
"""Distance [m of rho] on either side within which a flank is taken to be on the start of its relief."""

HOLLOWS = 201
"""Places at which flanks are looked at for hollows."""

CLOSE = 1e-12
"""Distance from the place within which it is found [modules]."""

MOST_STEPS = 100
"""Of the search for the place; on gentle flanks some ten are enough."""

STEPS = 1024
"""Of the tables for lines of contact: beside kinks gaps err by 1e-10 m, elsewhere by a tenth of that."""


@record
class Touch:
    """Contacts of flanks with relief or deviations (n,), where the minimum gap is not beyond a corner.

    Attributes
    ----------
    rho : (2, n) array
        Curvature radii where pinion and wheel are touched [m].
    gap : (n,) array
        Rotation of the pinion that closes the gap of the relieved flanks, times its base radius [m].
    curvature : (n,) array
        R/R'.
    lever : (2, n) array
        Levers of the common normal about the axes, over the base radii.
    arm : (2, n) array
        Distances from the feet of the axes on that normal to the contact [m].
    leaning : (2, n) array
        Angle from the involutes' own normals to the common one, away from either gear's tip [rad].
    beyond : (n,) boolean array
        Whether the gap would be less beyond a corner, which then is the nearest point.
    """

    rho: Array
    gap: Array
    curvature: Array
    lever: Array
    arm: Array
    leaning: Array
    beyond: Booleans


def plain_touch(pair: GearPair, place: Array) -> Touch:
    """Where true involutes touch."""
    rho = np.stack([place, pair.line_of_action - place])
    nothing, even = np.zeros_like(rho), np.ones_like(rho)
    return Touch(rho, nothing[0], even[0], even, rho, nothing, np.zeros(len(place), dtype=bool))


def touch(flanks: FlankForms, place: Array, removed: tuple[Removed, Removed]) -> Touch:
    """Where flanks touch whose unlimited involutes touch at ``place`` (n,) of the line of action [m]."""
    pair, line = flanks.pair, flanks.pair.line_of_action
    first, second = pair.base_radii
    other = line - place
    radius = place * other / line
    low = (other**2 - flanks.rounds[1].rho ** 2) / (2 * second)
    high = (flanks.rounds[0].rho ** 2 - place**2) / (2 * first)
    span = np.minimum(SPAN * pair.module, 0.25 * (high - low))

    def rho(sigma: Array) -> tuple[Array, Array]:
        return (
            np.sqrt(np.maximum(place**2 + 2 * first * sigma, 0.0)),
            np.sqrt(np.maximum(other**2 - 2 * second * sigma, 0.0)),
        )

    def missing(sigma: Array) -> Array:
        return np.stack([curve(at) for curve, at in zip(removed, rho(sigma), strict=True)])

    def bends(sigma: Array) -> tuple[Array, Array]:
        """Slope and curvature of what each flank lacks (2, n)."""
        middle = np.clip(sigma, low + span, high - span)
        before, here, after = (missing(middle + step) for step in (-span, 0.0, span))
        bent = (after - 2 * here + before) / span**2
        return (after - before) / (2 * span) + bent * (sigma - middle), bent

    def slopes(sigma: Array) -> Array:
        return np.asarray(sigma + radius * bends(sigma)[0].sum(axis=0))

    sigma, beyond = _least(slopes, low, high, CLOSE * pair.module)
    slope, bent = bends(sigma)
    curvature = np.clip(1 + radius * bent.sum(axis=0), *CURVATURES)
    touched = rho(sigma)
    gap, pinion_rho = gap_at(pair.base_radii, line, place, touched[1])
    # the normals of the involutes there are turned against each other, each by the slope of its relief
    leaning = np.stack([slope[0], -slope[1]])
    turned = opening_at(pair.base_radii, line, place, pinion_rho, touched[1])
    between = leaning[1] - leaning[0]
    leaning = leaning * np.divide(turned, between, out=np.zeros_like(turned), where=np.abs(between) > 1e-12)
    lever = np.cos(leaning) - np.sin(leaning) * np.stack([pinion_rho / first, touched[1] / second])
    lacking = (removed[0](pinion_rho) + removed[1](touched[1])) / lever[0]
    gap = np.where(sigma == 0.0, 0.0, gap) + lacking
    met = np.stack([pinion_rho, touched[1]])
    arm = tangent_arm(np.reshape(pair.base_radii, (2, 1)), met, lever)
    return Touch(met, gap, curvature, lever, arm, leaning, beyond)


def _least(slope: Callable[[Array], Array], low: Array, high: Array, close: float) -> tuple[Array, Booleans]:
    """Where gaps of growing slopes are smallest between bounds (n,), and whether they would be less beyond these.

    By false position, whose bound that stays counts half (Illinois), until slopes are ``close`` to zero: a slope that
    turns at the kink of a flank leads Newton's method to and fro between its two sides for ever.
    """
    before, least = low, high
    was, here = slope(before), slope(least)
    beyond = (was > 0.0) | (here < 0.0)
    least = np.where(was > 0.0, low, high)
    here = np.where(beyond, 0.0, here)
    for _ in range(MOST_STEPS):
        if np.all(np.abs(here) <= close):
            break
        apart = here - was
        step = np.divide(here, apart, out=np.zeros_like(here), where=here != 0.0) * (least - before)
        trial = least - step
        now = np.where(here == 0.0, 0.0, slope(trial))
        turned = now * here < 0.0
        before, was = np.where(turned, least, before), np.where(turned, here, 0.5 * was)
        least, here = trial, now
    return least, beyond


def gentle(flanks: FlankForms) -> bool:
    """Whether all teeth of a gear have one profile, without hollows that no single contact fills.

    Otherwise flanks are taken to touch where involutes do.
    """
    removed = flanks.removed
    if removed is None or not flanks.teeth_alike:
        return flanks.teeth_alike
    pair, line = flanks.pair, flanks.pair.line_of_action
    place = np.linspace(*flanks.ends, HOLLOWS)[1:-1]
    span, first, second = SPAN * pair.module, *pair.base_radii

    low = ((line - place) ** 2 - flanks.rounds[1].rho ** 2) / (2 * second)
    high = (flanks.rounds[0].rho ** 2 - place**2) / (2 * first)
    middle = np.clip(0.0, low + span, high - span)  # beyond the ends of flanks curves say nothing

    def missing(apart: float) -> Array:
        rho = place**2 + 2 * first * (middle + apart), (line - place) ** 2 - 2 * second * (middle + apart)
        # no flank begins below its base circle, where rho is 0
        here = [curve(np.sqrt(np.maximum(at, 0.0))) for curve, at in zip(removed, rho, strict=True)]
        return np.asarray(np.sum(here, axis=0))

    bent = (missing(span) - 2 * missing(0.0) + missing(-span)) / span**2
    return bool(np.all(1 + place * (line - place) / line * bent >= CURVATURES[0]))


def ends_of_flanks(flanks: FlankForms, single: bool) -> tuple[float, float]:
    """Places on the line of action [m] between which flanks touch beside their corners, under no load.

    A and E, or those of roundings; with relief farther out.

    Parameters
    ----------
    flanks : FlankForms
    single : bool
        Whether contacts are single ones (`gentle`).
    """
    start, end = flanks.ends
    removed = flanks.removed
    if removed is None or not single:
        return start, end
    pitch, ends = flanks.pair.base_pitch, []
    for place, outwards in ((start, -1.0), (end, 1.0)):
        apart = place + 0.5 * outwards * pitch * np.array([-1.0, 1.0])
        for _ in range(7):  # 15 places at once
            places = np.linspace(apart[0], apart[1], 17)
            inside = ~touch(flanks, places, removed).beyond
            last = int(np.flatnonzero(inside)[-1]) if inside.any() else 0
            apart = places[[min(last, 15), min(last, 15) + 1]]
        ends.append(float(apart.mean()))
    return ends[0], ends[1]


def relieved_lines(flanks: FlankForms, ends: tuple[float, float]) -> RelievedLines | None:
    """Tables of a pair's flanks with single contacts (`gentle`); None of true involutes.

    Parameters
    ----------
    flanks : FlankForms
    ends : (float, float)
        Places on the line of action between which flanks are looked at [m].
    """
    removed = flanks.removed
    if removed is None:
        return None
    place = np.linspace(*ends, STEPS + 1)
    at = touch(flanks, place, removed)
    gap = at.gap - removed[0](at.rho[0]) - removed[1](at.rho[1])
    return RelievedLines(place, gap, at.rho, at.lever, at.curvature)


def starts_of_relief(flanks: FlankForms) -> list[float]:
    """Places on the line of action [m] at which the law of touch changes at kinks, such as starts of tip relief.

    A flank stays on such a kink for a while; its slope and curvature, differences over ``SPAN``, know it from before
    it is touched until after. Contacts must be single ones (`gentle`).
    """
    removed = flanks.removed
    if removed is None:
        return []
    span, gears, wanted = SPAN * flanks.pair.module, [], []
    for gear, base in enumerate(flanks.pair.base_radii):
        for apart, slack in ((-span, 0.0), (0.0, -SLACK), (0.0, SLACK), (span, 0.0)):
            rho = np.sqrt(np.maximum(flanks.kinks(gear) ** 2 + 2 * base * apart, 0.0)) + slack
            gears += [gear] * len(rho)
            wanted += rho.tolist()
    which, target = np.array(gears, dtype=np.int64), np.array(wanted)
    places = np.linspace(*flanks.ends, 257) + np.zeros((len(target), 1))
    for _ in range(5):
        touched = touch(flanks, places.ravel(), removed).rho.reshape(2, *places.shape)
        above = np.take_along_axis(touched, which[None, :, None], axis=0)[0] > target[:, None]
        change = above[:, 1:] != above[:, :-1]
        met = change.any(axis=1)
        which, target, places, first = which[met], target[met], places[met], change[met].argmax(axis=1)
        rows = np.arange(len(first))
        start, end = places[rows, first, None], places[rows, first + 1, None]
        places = start + (end - start) * np.linspace(0.0, 1.0, 17)
    return [float(place) for place in places.mean(axis=1)]
