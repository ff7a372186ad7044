"""How a gear's flank moves at its contact beyond yielding along the normal, and what that adds to the energy.

Per unit line load at rho, without the local field of the contact: t, the flank's displacement along its tangent
towards the tip, and tau = (r_b/rho) (1/2) d own/d rho, the slope of its displacement into the gear along the flank
towards the tip (half, since by Maxwell and Betti the place of the load and that of the displacement count alike).
A contact that carries w has, with third-order energies per face width of gear and half-plane
(``fem.elasticity.nonlinear_energy``),

    U_3 = w^3 [sum (alpha + t tau + t^2/(2 rho)) + (R/2) (tau_1 - tau_2)^2] + w^3/a sum c + local

- alpha, c: the strained gear; t tau + t^2/(2 rho): the common normal turns with the flanks while they move along
  themselves; (R/2) (tau_1 - tau_2)^2: flanks tilted against each other touch R (tau_2 - tau_1) w farther towards the
  pinion's tip; sums are over both gears;
- local = (64/(45 pi^2)) (beta_1/rho_2 - beta_2/rho_1) (kappa_1 - kappa_2) w^2 a, beta_i = (1/E*_i)/(1/E*_1 + 1/E*_2),
  kappa = (1 - nu*)/E*: surfaces of unlike gears slip within Hertz's contact.

The sum does not change when a gear is turned as a whole: then tau = 0, and alpha = -t^2/(2 rho).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.elasticity.line_load import flank_points, line_loads
from fem.elasticity.nonlinear_energy import NOMINAL, third_order
from fem.influence.flank_variable import FlankVariable
from fem.influence.series import FlankFit, FlankSeries, left_out

if TYPE_CHECKING:
    from fem.elasticity.plane_elasticity import PlaneElasticity
    from fem.elasticity.ring import Ring

__all__ = ["FIT", "WIDTH", "FlankMotion", "flank_motion"]

FIT, WIDTH = "fit", "width"
"""What the motion may be off by."""

PLACES = 9
"""Loads along the flank; two thirds as many terms follow them."""
CLEARANCE = 0.15
"""Nearest place to the tip corner, as an arc in modules; nearer contacts take its values."""
FOOT = 0.5
"""Minimum curvature radius in modules; contacts nearer to the base circle take its values."""


@record
class FlankMotion:
    """Motion of a gear's flank under a unit line load; arguments beyond the range are moved to its end.

    Attributes
    ----------
    tangential_series : FlankSeries
        t [m per N/m].
    energy_series : FlankSeries of (3,)
        The gear's third-order integrals per load cubed and face width (``fem.elasticity.nonlinear_energy``).
    doubts : mapping of str to FlankMotion
        What both may be off by: ``FIT`` is what the series leave out, ``WIDTH`` what half the half-width of the
        pressure changes.
    """

    tangential_series: FlankSeries
    energy_series: FlankSeries
    doubts: Mapping[str, FlankMotion]

    @property
    def rho_range(self) -> tuple[float, float]:
        """Curvature radii covered [m]."""
        return self.tangential_series.variable.span

    def tangential(self, rho: Array) -> Array:
        """Displacement t towards the tip [m per N/m] at rho [m]."""
        return self.tangential_series.at(rho)

    def energy(self, rho: Array) -> Array:
        """Third-order integrals (3, ...) at rho [m], less those of the half-plane; alpha is the first [m^3/N^2]."""
        return np.moveaxis(self.energy_series.at(rho), -1, 0)

    def off_by(self, doubt: str) -> FlankMotion:
        """Motion that is off by a doubt of it."""
        change = self.doubts[doubt]
        return replace(
            self,
            tangential_series=self.tangential_series.plus(change.tangential_series.coefficients),
            energy_series=self.energy_series.plus(change.energy_series.coefficients),
        )

    def scaled(self, module: float, law: PlaneElasticity) -> FlankMotion:
        """Give a gear in modules and E* its size [m] and modulus."""
        modulus = law.plane_modulus
        units = module * np.array([modulus**2, modulus**3, modulus**3])
        return FlankMotion(
            self.tangential_series.scaled(module, modulus),
            self.energy_series.scaled(module, units),
            {name: change.scaled(module, law) for name, change in self.doubts.items()},
        )


def flank_motion(ring: Ring, flank: str = "left") -> FlankMotion:
    """Load a gear's flank at some places from its foot to near the tip."""
    mesh = ring.mesh
    low = float(np.sqrt(2 * mesh.base_radius * mesh.parameters[f"flank_{flank}"].min()))
    low = max(low, FOOT * mesh.module)
    arc = float(mesh.parameters[f"flank_{flank}"].max()) - CLEARANCE * mesh.module
    high = float(np.sqrt(2 * mesh.base_radius * arc))
    unit = -np.cos(np.pi * (np.arange(PLACES) + 0.5) / PLACES)
    place = FlankVariable((low, high))
    at, fit = flank_points(mesh, place.rho(unit), flank), FlankFit(place, unit, 2 * PLACES // 3)
    loads = line_loads(ring, at)
    tangential = np.diagonal(loads.on_tooth(0, at.towards_tip()))
    integrals, narrow = (third_order(loads, times * NOMINAL) for times in (1.0, 0.5))
    along = fit.series(tangential)
    energy, narrowed = (
        FlankSeries(place, (samples @ fit.weights.T).T) for samples in (integrals, narrow - integrals)
    )
    by_fit = [
        _left_out(fit, series, samples) for series, samples in ((along, tangential), (energy, integrals.T))
    ]
    still = replace(along, coefficients=np.zeros_like(along.coefficients))
    doubts = {FIT: FlankMotion(by_fit[0], by_fit[1], {}), WIDTH: FlankMotion(still, narrowed, {})}
    return FlankMotion(along, energy, doubts)


def _left_out(fit: FlankFit, series: FlankSeries, samples: Array) -> FlankSeries:
    """What a fit leaves out, at least the size of its last term: few samples lie close to it."""
    return left_out({0: series}, np.maximum(fit.error(series, samples), np.abs(series.coefficients[-1])))[0]
