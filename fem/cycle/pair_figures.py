"""What follows for the pairs of a mesh cycle from their forces: pressures, sliding, friction, moments on the gears."""

from __future__ import annotations

import numpy as np

from base import Array, described
from base.results import EXACT
from fem.contact.opposite_flanks import OppositeFlanks
from fem.cycle.face_loads import FaceLoads
from fem.cycle.line_loads import LineLoads
from fem.elasticity.plane_elasticity import reduced_modulus
from fem.laws.contact_candidates import ContactCandidates
from gears import GearPair, half_width, peak_pressure
from gears.pair.hertz import HERTZ

__all__ = ["PairFigures"]


class PairFigures:
    """Figures of a cycle's pairs, from these of its attributes."""

    torque: float
    position: Array
    rho1: Array
    flank_rho: Array
    forces: Array
    pair_stiffness: Array
    plane: str
    pair: GearPair
    candidates: ContactCandidates
    friction: float
    lever_loss: Array | float
    further_lever_loss: Array | float
    flank: str
    opposite: OppositeFlanks | None
    face: FaceLoads | None
    lines: LineLoads | None

    @described("N", "position")
    def opposite_force(self) -> Array:
        """Normal force of all flanks on the other side together; zero where they do not bear."""
        zero = np.zeros(len(self.position))
        return zero if self.opposite is None else np.asarray(self.opposite.forces.sum(axis=-1))

    @described("N", "position")
    def separating_force(self) -> Array:
        """Force of the flanks on both sides that pushes the gears apart, along the line of centres."""
        force = self._across_axis() + self.opposite_force
        return np.asarray(force * np.sin(self.pair.working_pressure_angle))

    @described("N", "position")
    def bearing_force(self) -> Array:
        """Force on the bearings of either gear by the normal forces: separating and tangential part together.

        In the transverse section; tip edges are taken along the line of action.
        """
        across = self._across_axis() - self.opposite_force
        return np.asarray(np.hypot(self.separating_force, across * np.cos(self.pair.working_pressure_angle)))

    def _across_axis(self) -> Array:
        """Normal force of the loaded flanks in the transverse section (n,) [N]."""
        return np.asarray(self.forces.sum(axis=-1) * self.pair.helix.base_cosine)

    def _loaded_radius(self) -> tuple[Array, Array, float]:
        """Maximum line loads [N/m] and radii of relative curvature [m] of contacts of two flanks, else nan; E'.

        Of lines of contact that cross the face the largest mean over half a module, with the radius at their middle.
        """
        touching = np.isfinite(self.rho1) & (self.forces > 0)
        rho1, rho2 = self.flank_rho
        even = self.forces / self.pair.face_width
        load = np.where(touching, even if self.face is None else self.face.line_load.max(axis=-1), np.nan)
        radius = rho1 * rho2 / (rho1 + rho2)
        if self.lines is not None:
            load = np.where(touching, self.lines.most_loaded, np.nan)
            radius = radius / self.pair.helix.base_cosine
        return load, radius, reduced_modulus(self.pair, self.plane)

    @described("Pa", "position pair", shown="MPa", no_error=HERTZ)
    def hertz_pressure(self) -> Array:
        """Maximum Hertz pressure, over the face too; nan where two flanks do not touch.

        nan at tip edges too: there the pressure is no ellipse, and at a sharp corner it has no bound.
        """
        return peak_pressure(*self._loaded_radius())

    @described("m", "position pair", shown="um", no_error=HERTZ)
    def half_width(self) -> Array:
        """Half-width of the Hertz contact, the largest over the face; nan where two flanks do not touch."""
        return half_width(*self._loaded_radius())

    def surface_speeds(self, speed: float = 1.0) -> Array:
        """Speeds of pinion's and wheel's surface along the tangent of each contact (2, n, pairs) [m/s].

        The gears turn evenly; tip edges included, along the tangent of the flank that they touch. Towards the tip of
        the pinion; back flanks move the other way.

        Parameters
        ----------
        speed : float
            Of the pinion [rad/s].
        """
        first, second = self.pair.base_radii
        speed = speed if self.flank == "front" else -speed
        return np.asarray(
            speed * self.candidates.tangent_arm * np.array([1.0, first / second])[:, None, None]
        )

    def sliding(self, speed: float = 1.0) -> Array:
        """Sliding speed u1 - u2 of each contact (n, pairs) [m/s], negative before C; pinion at [rad/s]."""
        first, second = self.surface_speeds(speed)
        return np.asarray(first - second)

    @described("1", "gear position pair", no_error=EXACT)
    def specific_sliding(self) -> Array:
        """Sliding over the surface's own speed, (u1 - u2)/u1 and (u2 - u1)/u2.

        Infinite where a flank is touched on its base circle.
        """
        speeds = self.surface_speeds()
        with np.errstate(divide="ignore"):
            return np.asarray((speeds - speeds[::-1]) / speeds)

    @described("N m", "position")
    def wheel_torque(self) -> Array:
        """Torque on the wheel of the normal forces, tilted by friction if there is any; of the loaded flanks alone.

        Where a tip edge presses, and on relief, it differs from the torque of the pinion times the ratio even without
        friction, because the yielding teeth store energy; over a cycle that evens out.
        """
        slip = np.sign(self.sliding())
        arm = self.candidates.lever[1] * self.pair.base_radii[1]
        if self.lines is None:
            arm = arm + self.friction * slip * self.candidates.tangent_arm[1]
        total = np.sum(self.forces * arm, axis=1, where=np.isfinite(arm))
        if self.lines is not None:
            turning = self.friction if self.flank == "front" else -self.friction
            total = total + turning * self.lines.rubbed[1] + self.lines.turned[1]
        return np.asarray(total if self.flank == "front" else -total)

    def edge_sliding(self, speed: float = 1.0) -> Array:
        """Sum of ``F |u1 - u2|`` of tip edges on lines of contact beyond the path (n,) [W]; zero of spur pairs.

        By a coefficient of friction it is the power that they lose.

        Parameters
        ----------
        speed : float
            Of the pinion [rad/s].
        """
        lines = self.lines
        if lines is None:
            return np.zeros(len(self.position))
        first, second = self.pair.base_radii
        arms = np.nan_to_num(lines.arms)
        slip = np.abs(speed * (arms[0] - arms[1] * first / second))
        beyond = np.where(np.isfinite(lines.z), 1.0 - lines.on_path, 0.0)
        return np.asarray(np.sum(beyond * lines.force * slip, axis=(-2, -1)))

    def friction_loss(self, speed: float) -> Array:
        """Power lost by sliding (n,) [W], sum of ``mu F_i |u1 - u2|``; speed of the pinion [rad/s]."""
        if self.lines is not None:
            first, second = self.pair.base_radii
            rubbed = self.lines.rubbed
            return np.asarray(self.friction * abs(speed) * (rubbed[0] - rubbed[1] * first / second))
        slip = np.abs(self.sliding(speed))
        return np.asarray(np.sum(self.friction * self.forces * slip, axis=1, where=np.isfinite(slip)))

    @described(
        "1",
        no_error="not estimated: by forces in single positions, in which their error is not known; 1 without friction",
    )
    def efficiency(self) -> float:
        """Power put in less the mean power lost by sliding, over the power put in; 1 without friction."""
        return float(1.0 - np.mean(self.friction_loss(1.0)) / abs(self.torque))

    def _moments(self) -> tuple[Array, Array]:
        """Net normal force by its levers about both gears, and its slope by D (2, n)."""
        lever = np.where(self.forces > 0, self.candidates.lever, 0.0)
        sums = [
            np.sum((lever - np.where(self.forces > 0, lost, 0.0)) * per_pair, axis=-1)
            for lost, per_pair in (
                (self.lever_loss, self.forces),
                (self.further_lever_loss, self.pair_stiffness),
            )
        ]
        if self.opposite is not None:
            other = self.opposite
            bears = other.forces > 0
            for total, per_pair, lost in (
                (sums[0], other.forces, other.lever_loss),
                (sums[1], other.pair_stiffness, other.further_lever_loss),
            ):
                total -= np.sum(np.where(bears, other.lever - lost, 0.0) * per_pair, axis=-1)
        return sums[0], sums[1]
