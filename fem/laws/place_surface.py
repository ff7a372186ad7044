"""Laws of contacts beside a tip corner as a surface over place and force, for contacts that move.

Psi(F, z) is the energy of the corner's law over the force and over the place z, the contact's distance beyond the end
of the flank in curvature radii, without that of the flank's own law: by strips at places on either side of A or E, in
turns of the gear that is touched, as splines over the logarithms of force and of distance.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, record
from fem.laws.cut_off import FAR, cut_off
from fem.laws.local_law import Table
from fem.laws.tip_contact import edge_laws

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline, RectBivariateSpline

    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["PlaceSurface", "Pushed", "place_surface", "slid", "up_to"]

NEAR, STEP = 0.005, 0.2
"""Distance from the end [modules] below which places are even, and the step of asinh of the distance over it."""

FAR_OUT = 0.6
"""Base pitches beyond A and E up to which places have laws; farther ones have the last."""

ROUND = 0.1
"""Distance [modules of rho] from the end of a flank's fit within which places beyond it are rounded off to it."""

FORCES, LEAST = 0.25, 3e-6
"""Step of the forces' logarithm, and the minimum force over the largest."""


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
class Pushed:
    """Terms of an energy of forces (n,) that knows the turn D: its derivatives by F and D.

    Attributes
    ----------
    approach, slope : (..., n) arrays
        By F, and again by F [m], [m/N].
    push, less : (..., n) arrays
        By D [N], and by F and D.
    stiff : (..., n) array
        Twice by D [N/m].
    """

    approach: Array
    slope: Array
    push: Array
    less: Array
    stiff: Array


@record
class PlaceSurface:
    """Psi/F of contacts beside a corner over place and force, the flank's own law taken out.

    Attributes
    ----------
    unit : float
        Distance below which places are even [m].
    surface : RectBivariateSpline
        Over asinh(z/unit) and ln F, without the gaps [m].
    gaps : CubicSpline
        Over the first of these [m].
    reach : (float, float)
        Smallest and largest asinh of these; beyond nothing changes.
    forces : (float, float)
        Minimum and maximum force [N].
    sliding : float
        Growth of z per force by the tilt of the touched flank [m/N].
    """

    unit: float
    surface: RectBivariateSpline
    gaps: CubicSpline
    reach: tuple[float, float]
    forces: tuple[float, float]
    sliding: float

    @property
    def first(self) -> float:
        """Place from which on the corner has an effect [m]."""
        return float(self.unit * np.sinh(self.reach[0]))

    def _xi(self, place: Array) -> tuple[Array, Array, Array, Booleans]:
        """Coordinate, its two derivatives by the place, and whether places are covered."""
        away = place / self.unit
        slope = 1 / (self.unit * np.sqrt(1 + away**2))
        xi, (low, high) = np.arcsinh(away), self.reach
        return np.clip(xi, low, high), slope, -away * self.unit * slope**3, (xi > low) & (xi < high)

    def gap(self, place: Array) -> Array:
        """What is open at places without a force [m]."""
        return np.asarray(self.gaps(self._xi(place)[0]))

    def at(self, place: Array, force: Array) -> Pushed:
        """Derivatives by forces [N] and by shifts of places [m], the gap among them; linear below the minimum force."""
        size = np.clip(force, *self.forces)
        xi, by_place, curved, covered = self._xi(place + self.sliding * force)
        log, part = np.log(size), np.minimum(force / self.forces[0], 1.0)
        lower, upper = force < self.forces[0], force >= self.forces[1]

        def value(dx: int = 0, dy: int = 0) -> Array:
            derivative = np.asarray(self.surface.ev(xi, log, dx=dx, dy=dy))
            return np.where(covered, derivative, 0.0) if dx else derivative

        def open_(order: int) -> Array:
            return np.where(covered, self.gaps(xi, order), 0.0)

        p, p_f, p_x, p_xf = value(), value(dy=1), value(dx=1), value(1, 1)
        inner = np.where(lower, p + p_f, p_f + value(dy=2)) / size
        by_x, by_xx = p_x * part + open_(1), value(dx=2) * part + open_(2)
        push, less = force * by_x * by_place, ((p_x + p_xf) * part + open_(1)) * by_place
        stiff = force * (by_xx * by_place**2 + by_x * curved)
        return Pushed(
            (p + p_f) * part + self.gaps(xi) + self.sliding * push,
            np.where(upper, 0.0, inner) + self.sliding * (2 * less + self.sliding * stiff),
            push,
            less + self.sliding * stiff,
            stiff,
        )


def place_surface(setup: MeshSetup, bodies: PairCompliance, corner: int, slid: float) -> PlaceSurface:
    """Surface beside a corner of true involutes: of the wheel (1) beside A, of the pinion (0) beside E.

    ``slid`` as for ``fem.laws.cut_off.cut_off``.
    """
    from scipy.interpolate import CubicSpline, RectBivariateSpline

    pair, line, rounding = bodies.pair, bodies.pair.line_of_action, setup.rounds[corner]
    gear, other = (bodies.pinion, bodies.wheel)[corner], (bodies.wheel, bodies.pinion)[corner]
    end, unit = float(rounding.rho), NEAR * pair.module
    inside = end - np.sqrt(max(end**2 - 2 * gear.base_radius * FAR[1] * pair.module, 0.25 * end**2))
    low, high = -np.arcsinh(inside / unit) - 2 * STEP, np.arcsinh(FAR_OUT * pair.base_pitch / unit)
    xi = np.linspace(low, high, int((high - low) / STEP) + 1)
    rho = end + unit * np.sinh(xi)
    place, on = rho if corner == 0 else line - rho, rho <= end
    tips = bodies.tips[corner]
    law = edge_laws(pair, tips, corner, place[~on], other.law, rounding, turned=1 - corner)
    largest = float(np.median(law.force[:, -1]))
    log = np.arange(np.log(LEAST * largest), np.log(largest) + FORCES, FORCES)
    force = np.exp(log)[:, None]
    contacts = np.ones((1, on.sum()), dtype=bool)
    near = cut_off(bodies, corner, place[on], contacts, rounding, None, slid, 1 - corner)
    edge, _ = Table.through(law.force, law.approach, law.smooth).value_and_slope(
        np.repeat(force, (~on).sum(), axis=1)
    )
    at_end = np.full((~on).sum(), end if corner == 0 else line - end)
    own, rounded = (
        (gear.own(at) - gear.hub_windup) / pair.face_width
        for at in (rho, up_to(rho, gear.rho_range[1], pair.module)[0])
    )
    values, gaps = np.empty((len(xi), len(log))), np.zeros(len(xi))
    values[on] = near.value_and_slope(np.repeat(force, on.sum(), axis=1))[0].T
    values[~on] = (edge - bodies.hertz(at_end).approach(force) - own[~on] * force + 3 * slid * force**2).T
    gaps[~on] = law.approach[:, 0]
    values += (own - rounded)[:, None] * force.T - gaps[:, None]
    energy = CubicSpline(log, values * force.T, axis=1).antiderivative()(log) + 0.5 * values[:, :1] * force[0]
    fit = RectBivariateSpline(xi, log, energy / force.T, s=0)
    radius = end * (line - end) / line
    sliding = radius * _tilt(bodies, 1 - corner, line - end) * gear.base_radius / (end * pair.face_width)
    limits = (float(low), float(high)), (float(force[0, 0]), float(force[-1, 0]))
    return PlaceSurface(unit, fit, CubicSpline(xi, gaps), *limits, sliding)


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
