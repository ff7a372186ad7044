"""Compliance of one gear's flank: own tooth and neighbouring teeth, as smooth functions of rho.

Per unit line load, u_r at the load (``own``) holds everything but the local indentation: bending, shear,
root, body and hub. Near the tip corner it grows as a logarithm of the distance d from the corner, because a
wedge yields more than a half-plane (``fem.elasticity.corner_singularity``). That part is taken out before the rest
is interpolated by Chebyshev polynomials. What is left of ``own`` begins as d ln d at the corner, close beyond the
last load: it is a polynomial in the root of rho_end - rho, which moves that singularity away and brings loads close
to it. Cross terms have no such part, and are fitted in rho itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.elasticity.corner_singularity import corner_logarithm
from fem.elasticity.flank_samples import FlankSamples
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.ring import Ring
from fem.influence.flank_variable import FlankVariable, RootVariable
from fem.influence.series import CrossSeries, FlankFit, FlankSeries, left_out

if TYPE_CHECKING:
    from gears import ToothProfile

__all__ = ["GearCompliance", "cross_degree", "gear_compliance", "hub_windup"]

CROSS_SHARE = 5
"""Degree of cross terms in either place, in eighths of the number of loads."""


@record
class GearCompliance:
    """What a gear's flank yields per unit line load, without the local indentation.

    Attributes
    ----------
    rho_end : float
        Curvature radius of the tip corner [m].
    base_radius, module : float
        [m]
    law : PlaneElasticity
    logarithm : float
        Coefficient c of ln(d/module) [m per N/m].
    own_series : FlankSeries
        u_r - c ln(d/module) in (rho_end - rho)^(1/2) [m per N/m].
    cross_series : mapping of int to CrossSeries
        For the k-th tooth on the side of growing rho: over the load's and the point's rho [m per N/m].
    corner_series : mapping of int to FlankSeries
        For the same tooth's corner along its tangent: over the load's rho [m per N/m].
    hub_windup : float
        Part of ``own`` and of every cross term that is the body's turning [m per N/m].
    own_error, cross_error : float
        What these series leave out: by the decay of the coefficients, and at the samples [m per N/m].
    """

    rho_end: float
    base_radius: float
    module: float
    law: PlaneElasticity
    logarithm: float
    own_series: FlankSeries
    cross_series: Mapping[int, CrossSeries]
    corner_series: Mapping[int, FlankSeries]
    hub_windup: float
    own_error: float
    cross_error: float

    @property
    def rho_range(self) -> tuple[float, float]:
        """Curvature radii covered [m]."""
        return self.own_series.variable.span

    @property
    def fit_error(self) -> float:
        """What the series leave out at most [m per N/m]."""
        return max(self.own_error, self.cross_error)

    def scaled(self, module: float, law: PlaneElasticity) -> GearCompliance:
        """Give a gear in modules and E* its size [m] and modulus."""
        modulus = law.plane_modulus
        return GearCompliance(
            self.rho_end * module,
            self.base_radius * module,
            module,
            law,
            self.logarithm / modulus,
            self.own_series.scaled(module, modulus),
            {tooth: series.scaled(module, modulus) for tooth, series in self.cross_series.items()},
            {tooth: series.scaled(module, modulus) for tooth, series in self.corner_series.items()},
            self.hub_windup / modulus,
            self.own_error / modulus,
            self.cross_error / modulus,
        )

    def off_by(self, other: GearCompliance, times: float) -> GearCompliance:
        """Series that are off by some times what those of another mesh, fitted alike, leave out.

        Parameters
        ----------
        other : GearCompliance
            The same gear on another mesh.
        times : float
        """
        own = left_out({0: other.own_series}, times * other.own_error)[0]
        cross = left_out(other.cross_series, times * other.cross_error)
        return replace(
            self,
            own_series=self.own_series.plus(own.coefficients),
            cross_series={
                tooth: self.cross_series[tooth].plus(series.coefficients) for tooth, series in cross.items()
            },
        )

    def own(self, rho: Array) -> Array:
        """u_r at the load along the load [m per N/m]; rho [m] beyond the range is moved to its end."""
        rho = self.own_series.variable.held(rho)
        away = (self.rho_end**2 - rho**2) / (2 * self.base_radius)
        return np.asarray(self.own_series.at(rho) + self.logarithm * np.log(away / self.module))

    def own_slope(self, rho: Array) -> Array:
        """Differentiate ``own`` by rho [1 per N/m]; places beyond the range are moved to its end."""
        rho = self.own_series.variable.held(rho)
        slope = self.own_series.at(rho, derivative=1)
        return np.asarray(slope - self.logarithm * 2 * rho / (self.rho_end**2 - rho**2))

    def own_bend(self, rho: Array) -> Array:
        """Differentiate ``own_slope`` by rho [1/m per N/m]; places beyond the range are moved to its end."""
        rho = self.own_series.variable.held(rho)
        away = self.rho_end**2 - rho**2
        bend = self.own_series.at(rho, derivative=2)
        return np.asarray(bend - self.logarithm * (2 / away + (2 * rho / away) ** 2))

    def cross_basis(self, rho: Array) -> Array:
        """Chebyshev polynomials (..., n) at curvature radii (...) [m], which the series of all other teeth share."""
        shared = next(iter(self.cross_series.values()))
        return shared.variable.basis(rho, len(shared.coefficients) - 1)

    def cross(self, tooth: int, load: Array, point: Array) -> Array:
        """Displacement along the inward normal of another tooth by a load on tooth 0.

        Parameters
        ----------
        tooth : int
            1, 2, ...: counted towards the teeth whose contacts have larger rho.
        load, point : arrays
            Curvature radii [m].

        Returns
        -------
        array
            [m per N/m]
        """
        return self.cross_series[tooth].at(load, point)

    def cross_slope(self, tooth: int, load: Array, point: Array) -> Array:
        """Change of ``cross`` as load and point move on together [1 per N/m]; arguments as there."""
        return self.cross_series[tooth].slope(load, point)

    def corner(self, tooth: int, load: Array) -> Array:
        """Displacement of another tooth's tip corner along its flank's tangent, towards the tip.

        Parameters
        ----------
        tooth : int
            As for ``cross``.
        load : array
            Curvature radius of a normal load on tooth 0 [m]; by Maxwell and Betti also the place where the
            normal displacement by a tangential load at the corner is asked for.

        Returns
        -------
        array
            [m per N/m]
        """
        series = self.corner_series[tooth]
        return np.asarray(series.basis(load) @ series.coefficients)


def hub_windup(profile: ToothProfile, law: PlaneElasticity) -> float:
    """Turn the body on its held bore, measured along the line of action [m per N/m].

    That of rings in shear by a torque, which is the mean turn of a gear's root circle exactly
    (``gears.closed_form.body_wind_up``). Closed forms of tooth deflection leave it out.
    """
    from gears.closed_form import body_wind_up

    return body_wind_up(profile.zones, profile.base_radius, law.shear_modulus)


def gear_compliance(
    ring: Ring,
    profile: ToothProfile,
    samples: FlankSamples,
    flank: str = "left",
) -> GearCompliance:
    """Interpolate samples at ``sample_places``.

    Parameters
    ----------
    ring : Ring
    profile : gears.ToothProfile
    samples : FlankSamples
    flank : {"left", "right"}
    """
    rho, rho_end = samples.rho, profile.flank_rho[1]
    span = float(rho[0]), float(rho[-1])
    _, logarithm = corner_logarithm(ring.mesh, ring.law, flank)
    away = (rho_end**2 - rho**2) / (2 * profile.base_radius)
    smooth = samples.own - logarithm * np.log(away / profile.module)
    root, place = RootVariable(span, rho_end), FlankVariable(span)
    own_fit = FlankFit(root, root.unit(rho, hold=False), len(rho) - 1)
    fit = FlankFit(place, place.unit(rho, hold=False), cross_degree(len(rho)))
    own, cross = own_fit.series(smooth), [fit.cross(displacement) for displacement in samples.cross]
    return GearCompliance(
        rho_end,
        profile.base_radius,
        profile.module,
        ring.law,
        logarithm,
        own,
        {tooth + 1: series for tooth, series in enumerate(cross)},
        {tooth + 1: fit.series(displacement) for tooth, displacement in enumerate(samples.corner)},
        hub_windup(profile, ring.law),
        float(own_fit.error(own, smooth)),
        max(float(fit.error(series, there)) for series, there in zip(cross, samples.cross, strict=True)),
    )


def cross_degree(loads: int) -> int:
    """Degree of cross terms in either place, from loads at a number of places."""
    return min(CROSS_SHARE * loads // 8, loads - 1)
