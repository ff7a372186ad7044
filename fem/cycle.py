"""Result of the loaded tooth contact: forces, stiffness, transmission error, pressures, sliding, losses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem.cost import Cost
from fem.elasticity import PlaneElasticity
from fem.meshing import Meshing
from gears import GearPair, half_width, peak_pressure

__all__ = ["MeshCycle"]

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MeshCycle:
    """Some base pitches of a loaded pair; rows are positions, columns pairs in order of growing rho1.

    Attributes
    ----------
    torque, force : float
        Of the pinion [N m], and torque over base radius [N].
    position : (n,) array
        Way from A in base pitches, of the pair that entered last at first: midpoints of equal intervals.
    pair_offset : (pairs,) array of int
        Base pitches that each column is ahead of the pair that entered last.
    rho1 : (n, pairs) array
        Curvature radius on the pinion [m]; nan where there is no contact between A and E.
    edge : (n, pairs) boolean array
        Candidates outside the path, where a tip edge touches if it carries force.
    flank_rho : (2, n, pairs) array
        Curvature radii of pinion's and wheel's flank at the contact, tip edges included [m].
    forces : (n, pairs) array
        Normal forces [N]; zero where unloaded.
    load_share : (n, pairs) array
        Share of the torque; rows sum to one.
    gaps : (n, pairs) array
        Unloaded gaps along the line of action [m], from the position without any deviation, so they may be
        negative; inf for pairs that cannot touch.
    approach : (n,) array
        D [m]: turn of the pinion times its base radius, hubs' turn, the wheel's hub held. Positive when the
        teeth yield.
    stiffness : (n,) array
        Tangent dF/dD [N/m]: small vibration about the load.
    secant_stiffness : (n,) array
        F/(D - D_0) [N/m], D_0 the unloaded transmission error.
    plane : str
    beyond_path : bool
    error : float
        Estimated relative numerical error of stiffness and deflection.
    cost : Cost
        Of this cycle, and of the compliance if it was computed here; of a sweep as a whole.
    converged : bool
    message : str
    pair : gears.GearPair
    meshing : Meshing
        Places, teeth, levers and unloaded gaps.
    friction : float
        Coefficient of friction with which the forces were tilted; 0 for none.
    """

    torque: float
    force: float
    position: Array
    pair_offset: NDArray[np.int64]
    rho1: Array
    edge: NDArray[np.bool_]
    flank_rho: Array
    forces: Array
    load_share: Array
    gaps: Array
    approach: Array
    stiffness: Array
    secant_stiffness: Array
    plane: str
    beyond_path: bool
    error: float
    cost: Cost
    converged: bool
    message: str
    pair: GearPair
    meshing: Meshing
    friction: float = 0.0

    @property
    def transmission_error(self) -> Array:
        """Loaded static transmission error, the approach D along the line of action (n,) [m].

        It contains tip relief and deviations (as gaps) and all deflection; positive when the wheel lags.
        """
        return self.approach

    @property
    def unloaded_transmission_error(self) -> Array:
        """D at which the gears touch without load (n,) [m]: the smallest gap."""
        return np.asarray(self.gaps.min(axis=1))

    @property
    def teeth(self) -> NDArray[np.int64]:
        """Numbers of the teeth of pinion and wheel in each pair (2, n, pairs)."""
        return self.meshing.teeth

    @property
    def back_gap(self) -> Array:
        """Smallest gap between back flanks without load (n,) [m]: below zero the teeth jam."""
        return self.meshing.back_gap

    def _loaded_radius(self) -> tuple[Array, Array, float]:
        """Line loads [N/m] and radii of relative curvature [m] of contacts of two flanks, else nan; E'."""
        touching = np.isfinite(self.rho1) & (self.forces > 0)
        rho1, rho2 = self.flank_rho
        load = np.where(touching, self.forces / self.pair.face_width, np.nan)
        laws = [PlaneElasticity.of(material, self.plane) for material in self.pair.materials]
        return load, rho1 * rho2 / (rho1 + rho2), 2 / sum(1 / law.plane_modulus for law in laws)

    @property
    def hertz_pressure(self) -> Array:
        """Largest Hertz pressure of each contact (n, pairs) [Pa].

        nan where two flanks do not touch, and at tip edges: there the pressure is no ellipse, and at a sharp
        corner it has no bound.
        """
        return peak_pressure(*self._loaded_radius())

    @property
    def half_width(self) -> Array:
        """Half-width of each Hertz contact (n, pairs) [m]; nan as for ``hertz_pressure``."""
        return half_width(*self._loaded_radius())

    def surface_speeds(self, speed: float = 1.0) -> Array:
        """Speeds of pinion's and wheel's surface along the tangent of each contact (2, n, pairs) [m/s].

        The gears turn evenly; tip edges included, along the tangent of the flank that they touch.

        Parameters
        ----------
        speed : float
            Of the pinion [rad/s].
        """
        first, second = self.pair.base_radii
        return np.asarray(speed * self.meshing.tangent_arm * np.array([1.0, first / second])[:, None, None])

    def sliding(self, speed: float = 1.0) -> Array:
        """Sliding speed u1 - u2 of each contact (n, pairs) [m/s], negative before C; pinion at [rad/s]."""
        first, second = self.surface_speeds(speed)
        return np.asarray(first - second)

    @property
    def specific_sliding(self) -> Array:
        """Sliding over the surface's own speed, (u1 - u2)/u1 and (u2 - u1)/u2, (2, n, pairs).

        Infinite where a flank is touched on its base circle.
        """
        speeds = self.surface_speeds()
        with np.errstate(divide="ignore"):
            return np.asarray((speeds - speeds[::-1]) / speeds)

    @property
    def wheel_torque(self) -> Array:
        """Torque on the wheel (n,) [N m]: of the normal forces, tilted by friction if there is any.

        Where a tip edge presses it differs from the torque of the pinion times the ratio even without
        friction, by what the yielding teeth store; over a cycle that evens out.
        """
        slip = np.sign(self.sliding())
        arm = self.meshing.lever[1] * self.pair.base_radii[1]
        arm = arm + self.friction * slip * self.meshing.tangent_arm[1]
        return np.asarray(np.sum(self.forces * arm, axis=1, where=np.isfinite(arm)))

    def friction_loss(self, speed: float) -> Array:
        """Power lost by sliding (n,) [W], sum of ``mu F_i |u1 - u2|``; speed of the pinion [rad/s]."""
        slip = np.abs(self.sliding(speed))
        return np.asarray(np.sum(self.friction * self.forces * slip, axis=1, where=np.isfinite(slip)))

    @property
    def efficiency(self) -> float:
        """Mean power lost by sliding taken off the power put in, over that; 1 without friction."""
        return float(1.0 - np.mean(self.friction_loss(1.0)) / self.torque)
