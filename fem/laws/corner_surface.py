"""Surface of the law beside a tip corner, from the laws of strips at places on either side of A or E."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.elasticity.flamant import hertz_half_width
from fem.laws.corner_law import CornerSurface
from fem.laws.cut_off import FAR, FIRST, along, cut_off
from fem.laws.local_law import Table
from fem.laws.relieved_flanks import plain_touch, touch
from fem.laws.tip_contact import edge_laws, edge_lever, nearest_gap, rounded_law

if TYPE_CHECKING:
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["corner_surfaces", "rolling_surface", "slid", "up_to"]

NEAR, STEP = 0.005, 0.1
"""Distance from the end [modules] below which places are even, and the step of asinh of the distance over it."""

OPEN = 0.5
"""Gap [modules] of a corner to the other flank up to which places have laws; farther ones have none."""

ROUND = 0.1
"""Distance [modules of rho] from the end of a flank's fit within which places beyond it are rounded off to it."""

FORCES, WIDTHS = 0.125, (5e-4, 2.0)
"""Step of the forces' logarithm, and half-widths [modules] of contacts at the end under the smallest and largest."""


def up_to(rho: Array, high: float, module: float) -> tuple[Array, Array, Array]:
    """Places no farther than the end of a flank's fit, smoothly, and their derivatives by those that are asked for.

    So that a compliance that grows as a logarithm towards the corner, and then no more, leaves no separate corner.
    """
    length = ROUND * module
    t = np.clip(0.5 * (rho - high) / length + 0.5, 0.0, 1.0)
    place = np.where(t > 0.0, high - length + 2 * length * (t - t**4 * (2.5 - 3 * t + t**2)), rho)
    first, second = 1 - t**3 * (10 - 15 * t + 6 * t**2), -30 * (t * (1 - t)) ** 2 / (2 * length)
    return np.where(t < 1.0, place, high), first, second


@record
class _Side:
    """Laws at places (n,): coordinates, approach over the force (n, k) [m/N], gaps [m], largest forces [N]."""

    xi: Array
    quotient: Array
    gap: Array
    largest: Array


@record
class _Corner:
    """One gear's corner: what is asked for its surface."""

    setup: MeshSetup
    bodies: PairCompliance
    corner: int
    turned: int
    slid: float

    @property
    def end(self) -> float:
        return float(self.setup.rounds[self.corner].rho)

    def place(self, rho: Array) -> Array:
        """rho1 where the involute of the corner's gear has the curvature radius rho."""
        return rho if self.corner == 0 else self.setup.pair.line_of_action - rho

    def half_width(self) -> Array:
        """Of a contact at the end, by 1 N [m]."""
        pair = self.setup.pair
        modulus = 2 / (1 / self.bodies.pinion.law.plane_modulus + 1 / self.bodies.wheel.law.plane_modulus)
        radius = np.array(self.end * (pair.line_of_action - self.end) / pair.line_of_action)
        return hertz_half_width(1 / pair.face_width, radius, modulus)

    def own(self, rho: Array) -> Array:
        """What the corner's tooth yields by itself, rounded off at the end of its fit [m/N]."""
        gear = (self.bodies.pinion, self.bodies.wheel)[self.corner]
        rounded = up_to(rho, gear.rho_range[1], gear.module)[0]
        return np.asarray(gear.own(rounded) - gear.hub_windup) / self.setup.pair.face_width

    def inside(self, z: Array, force: Array) -> Array:
        """Contacts on the flank: what they approach further, over the force (n, k) [m/N]."""
        setup, corner = self.setup, self.corner
        gear = (self.bodies.pinion, self.bodies.wheel)[corner]
        removed, place = setup.removed if setup.flanks.gentle else None, self.place(self.end + z)
        near = plain_touch(setup.pair, place) if removed is None else touch(setup.flanks, place, removed)
        more = cut_off(
            self.bodies, corner, near, place, force, setup.rounds[corner], removed, self.slid, self.turned
        )
        own = (gear.own(near.rho[corner]) - gear.hub_windup) / setup.pair.face_width
        return np.asarray(more + (own - self.own(near.rho[corner]))[:, None])

    def open(self, z: Array) -> Array:
        """Gaps between the corner and the other flank at places [m]."""
        pair, rounding = self.setup.pair, self.setup.rounds[self.corner]
        return nearest_gap(pair, self.corner, self.place(self.end + z), rounding)

    def edges(self, z: Array, force: Array) -> tuple[Array, Array, Array]:
        """Contacts of the tip edge: approach over the force (n, k) [m/N], gaps [m], and the largest forces [N]."""
        setup, corner, rounding = self.setup, self.corner, self.setup.rounds[self.corner]
        other, place = (self.bodies.wheel, self.bodies.pinion)[corner], self.place(self.end + z)
        tips = setup.pair, self.bodies.tips[corner], corner, place, other.law
        shape = setup.removed, self.turned
        asked = np.repeat(force[None], len(z), axis=0)
        if rounding.radius > 0.0:
            lever = edge_lever(setup.pair, corner, place, rounding, self.turned)
            points, approach = rounded_law(*tips, lever, rounding, *shape)
            gap = np.where(np.isnan(approach), np.inf, approach).min(axis=1)
            # where strips farther in recede, those that bear go on bearing
            largest = np.where(np.isfinite(points[:, -1]), points[:, -1], np.inf)
            # contacts of a few strips are Hertz's on the arc
            few = np.clip(np.isfinite(points).sum(axis=1, keepdims=True) - 1, 0, FIRST)
            size = np.maximum(asked, np.take_along_axis(np.sort(points, axis=1), few, axis=1))
            by_strips = along(points, approach - gap[:, None], size)[0]
            per_log = self.bodies.hertz(place[:1]).per_log
            return by_strips - per_log * np.log(asked / size), gap, largest
        law = edge_laws(*tips, *shape)
        table = Table.through(law.force, law.approach - law.approach[:, :1], law.smooth)
        return (table.value_and_slope(asked.T)[0] / force[:, None]).T, law.approach[:, 0], law.largest

    def outside(self, z: Array, force: Array) -> tuple[Array, Array, Array]:
        """What edges approach beyond Hertz's law at the end of the flank and their tooth, as of ``inside``."""
        whole, gap, largest = self.edges(z, force)
        end = self.bodies.hertz(self.place(np.array([self.end])))
        flank = end.approach(force) / force + self.own(self.end + z)[:, None]
        return whole - flank + 3 * self.slid * force, gap, largest

    @cached_property
    def origin(self) -> float:
        """Place at which the contact leaves the flank [m]."""
        leaves = self.setup.flanks.touching_ends[1 - self.corner]
        return float(self.place(np.array(leaves))) - self.end

    @cached_property
    def log_force(self) -> Array:
        """Logarithms of the forces [N]."""
        of_one, module = float(self.half_width()), self.setup.pair.module
        least, most = (2 * np.log(width * module / of_one) for width in WIDTHS)
        return np.linspace(least, most, int((most - least) / FORCES) + 1)

    def sides(self, far: float) -> tuple[_Side, _Side]:
        """Laws at places on the flank and beyond its end."""
        pair, unit = self.setup.pair, NEAR * self.setup.pair.module
        inside = self.end**2 - 2 * pair.base_radii[self.corner] * FAR[1] * pair.module
        deep = self.end - np.sqrt(max(inside, 0.25 * self.end**2)) + abs(self.origin)
        low, high = -np.arcsinh(deep / unit), np.arcsinh(far * pair.base_pitch / unit)
        xi = np.linspace(low, 0.0, int(-low / STEP) + 2), np.linspace(0.0, high, int(high / STEP) + 2)
        within, beyond = (self.origin + unit * np.sinh(at) for at in xi)
        # farther out the touched flank turns away from the corner, where strips have no law; worn ones are left on the
        # flank itself, where the gap closes first
        gap = self.open(beyond)
        opens = (np.diff(gap, prepend=-np.inf) > 0.0) | (beyond <= abs(self.origin))
        near = np.logical_and.accumulate((gap < OPEN * pair.module) & opens)
        near[:4] = True  # as many as a spline needs
        force, none = np.exp(self.log_force), np.zeros(len(within))
        return (
            _Side(xi[0], self.inside(within, force), none, none),
            self.filled(_Side(xi[1][near], *self.outside(beyond[near], force)), gap[near]),
        )

    def filled(self, side: _Side, gap: Array) -> _Side:
        """Places where strips have no law: the law of the nearest that have one, for no force at all."""
        known = np.asarray(np.isfinite(side.quotient).all(axis=1))
        if known.all():
            return side
        rows = np.flatnonzero(known)
        quotient = np.zeros_like(side.quotient)
        if rows.size:
            nearest = np.abs(np.arange(len(known))[:, None] - rows).argmin(axis=1)
            quotient = side.quotient[rows[nearest]]
        gap = np.where(known, side.gap, gap)
        return _Side(side.xi, quotient, gap, np.where(known, side.largest, 0.0))

    def surface(self, side: _Side) -> CornerSurface:
        """Splines through the laws at places."""
        from scipy.interpolate import CubicSpline, RectBivariateSpline

        log = self.log_force
        return CornerSurface(
            NEAR * self.setup.pair.module,
            self.origin,
            RectBivariateSpline(side.xi, log, _energy(log, side.quotient), s=0),
            CubicSpline(side.xi, side.gap),
            (float(side.xi[0]), float(side.xi[-1])),
            log,
            np.stack([side.xi, side.largest]),
            0.0,
        )


def corner_surfaces(
    setup: MeshSetup, bodies: PairCompliance, corner: int, far: float, slid: float = 0.0
) -> tuple[CornerSurface, CornerSurface]:
    """Surfaces for contacts that stay, on the flank and of the tip edge.

    The contact leaves the flank at A or E, with relief farther out, where the law has a fold.

    Parameters
    ----------
    setup : MeshSetup
        At any positions.
    bodies : PairCompliance
    corner : {0, 1}
        Of the pinion, beside E, or of the wheel, beside A.
    far : float
        Base pitches beyond the end up to which places have laws; farther ones have none.
    slid : float
        As for ``fem.laws.cut_off.cut_off``.
    """
    asked = _Corner(setup, bodies, corner, 0, slid)
    inside, outside = (asked.surface(side) for side in asked.sides(far))
    return inside, outside


def rolling_surface(
    setup: MeshSetup, bodies: PairCompliance, corner: int, far: float, slid: float
) -> CornerSurface:
    """Surface for contacts that roll on past the end of the flank, in turns of the gear that is touched.

    True involutes; arguments as of ``corner_surfaces``.
    """
    asked = _Corner(setup, bodies, corner, 1 - corner, slid)
    inside, outside = asked.sides(far)
    xi, places = np.append(inside.xi, outside.xi[1:]), slice(1, None)
    whole = _Side(
        xi,
        np.concatenate([inside.quotient, outside.quotient[places]]),
        np.append(inside.gap, outside.gap[places]),
        np.append(inside.largest, outside.largest[places]),
    )
    end, line = asked.end, setup.pair.line_of_action
    tilt = _tilt(bodies, 1 - corner, line - end)
    growth = (line - end) / line * tilt * setup.pair.base_radii[corner] / setup.pair.face_width
    return replace(asked.surface(whole), sliding=growth)


def _energy(log: Array, quotient: Array) -> Array:
    """Energy over the force squared e, of 2 e + de/dlnF = q over even steps of ln F (n, k) [m/N]."""
    from scipy.interpolate import CubicSpline

    parts, step = CubicSpline(log, quotient, axis=1).c, log[1] - log[0]
    moments = [0.5 * np.expm1(2 * step)]  # of powers of ln F times F^2 over a step
    for power in (1, 2, 3):
        moments.append(0.5 * (step**power * np.exp(2 * step) - power * moments[-1]))
    work = np.tensordot(moments[::-1], parts, axes=1)  # (steps, n)
    first = 0.5 * quotient[:, 0] - 0.25 * parts[2, 0]
    square = np.exp(2 * (log - log[0]))
    whole = np.cumsum(np.concatenate([first[None], work * square[:-1, None]]), axis=0)
    return np.asarray((whole / square[:, None]).T)


def _tilt(bodies: PairCompliance, gear: int, rho: float) -> float:
    """Slope of a flank's displacement into the gear towards its tip, per unit line load [1 per N/m]."""
    flank = (bodies.pinion, bodies.wheel)[gear]
    at = float(np.clip(rho, *bodies.motions[gear].rho_range))
    return 0.5 * float(flank.own_slope(np.array(at))) * flank.base_radius / at


def slid(bodies: PairCompliance) -> tuple[float, float]:
    """Energies over the force cubed [m/N^2] by which strips let contacts slide on pinion and wheel, at their tips.

    (R/2)(tau + t/R)^2 for a unit line load: strips know tilt and motion of the corner's tooth, to the second order in
    the distance from the contact.
    """
    pair, energies = bodies.pair, []
    for gear, motion in enumerate(bodies.motions):
        rho = motion.rho_range[1]
        radius = rho * (pair.line_of_action - rho) / pair.line_of_action
        along = float(motion.tangential(np.array(rho)))
        energies.append(0.5 * radius * (_tilt(bodies, gear, rho) + along / radius) ** 2 / pair.face_width**2)
    return energies[0], energies[1]
