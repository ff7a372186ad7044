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
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, record
from fem.elasticity.corner_singularity import corner_logarithm
from fem.elasticity.flank_samples import FlankSamples
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.ring import Ring

if TYPE_CHECKING:
    from gears import ToothProfile

__all__ = ["GearCompliance", "gear_compliance", "hub_windup"]

CROSS_DEGREE, CROSS_SHARE = 12, 5
"""Smallest degree of cross terms in either place, and eighths of the number of loads, with which it grows."""

PLACES = 65
"""Places along the flank at which the size of what a fit leaves out is looked at."""


@record
class GearCompliance:
    """What a gear's flank yields per unit line load, without the local indentation.

    Attributes
    ----------
    rho_range : (float, float)
        Curvature radii covered [m].
    rho_end : float
        Curvature radius of the tip corner [m].
    base_radius, module : float
        [m]
    law : PlaneElasticity
    logarithm : float
        Coefficient c of ln(d/module) [m per N/m].
    own_series : (n,) array
        Chebyshev coefficients of u_r - c ln(d/module) over ``rho_range`` in (rho_end - rho)^(1/2).
    cross_series : mapping of int to (k, k) array
        For the k-th tooth on the side of growing rho: coefficients over (load's rho, point's rho).
    corner_series : mapping of int to (k,) array
        For the same tooth's corner along its tangent: coefficients over the load's rho.
    hub_windup : float
        Part of ``own`` and of every cross term that is the body's turning [m per N/m].
    own_error, cross_error : float
        What these series leave out: by the decay of the coefficients, and at the samples [m per N/m].
    """

    rho_range: tuple[float, float]
    rho_end: float
    base_radius: float
    module: float
    law: PlaneElasticity
    logarithm: float
    own_series: Array
    cross_series: Mapping[int, Array]
    corner_series: Mapping[int, Array]
    hub_windup: float
    own_error: float
    cross_error: float

    @property
    def fit_error(self) -> float:
        """What the series leave out at most [m per N/m]."""
        return max(self.own_error, self.cross_error)

    def scaled(self, module: float, law: PlaneElasticity) -> GearCompliance:
        """Give a gear in modules and E* its size [m] and modulus."""
        modulus = law.plane_modulus
        low, high = self.rho_range
        return GearCompliance(
            (low * module, high * module),
            self.rho_end * module,
            self.base_radius * module,
            module,
            law,
            self.logarithm / modulus,
            self.own_series / modulus,
            {tooth: series / modulus for tooth, series in self.cross_series.items()},
            {tooth: series / modulus for tooth, series in self.corner_series.items()},
            self.hub_windup / modulus,
            self.own_error / modulus,
            self.cross_error / modulus,
        )

    def off_by(self, other: GearCompliance, times: float) -> GearCompliance:
        """Series that are off by some times what those of another mesh, fitted alike, leave out.

        A fit's remainder waves about zero faster than any of its terms, and is largest where these are: its shape is
        that of the upper half of the degrees, its size what the series leave out.

        Parameters
        ----------
        other : GearCompliance
            The same gear on another mesh.
        times : float
        """
        unit = np.linspace(-1.0, 1.0, PLACES)
        own = _upper(other.own_series)
        own = own * _over(other.own_error, np.abs(chebyshev.chebval(unit, own)))
        cross = {tooth: _upper(series) for tooth, series in other.cross_series.items()}
        sizes = [np.abs(chebyshev.chebgrid2d(unit, unit, series)).max() for series in cross.values()]
        part = times * _over(other.cross_error, np.array(sizes, ndmin=1))
        return replace(
            self,
            own_series=self.own_series + times * own,
            cross_series={tooth: self.cross_series[tooth] + part * series for tooth, series in cross.items()},
        )

    def _unit(self, rho: Array) -> Array:
        low, high = self.rho_range
        return np.clip((2 * rho - low - high) / (high - low), -1.0, 1.0)

    def _root(self, rho: Array) -> tuple[Array, Array]:
        """Argument of ``own_series``, -1 to 1, and its derivative by rho [1/m]."""
        near, far = (float(np.sqrt(self.rho_end - end)) for end in self.rho_range[::-1])
        root = np.sqrt(self.rho_end - rho)
        return np.clip((2 * root - near - far) / (far - near), -1.0, 1.0), -1.0 / (root * (far - near))

    def own(self, rho: Array) -> Array:
        """u_r at the load along the load [m per N/m]; rho [m] beyond the range is moved to its end."""
        rho = np.clip(rho, *self.rho_range)
        away = (self.rho_end**2 - rho**2) / (2 * self.base_radius)
        own = chebyshev.chebval(self._root(rho)[0], self.own_series)
        return np.asarray(own + self.logarithm * np.log(away / self.module))

    @cached_property
    def _own_slopes(self) -> tuple[Array, Array]:
        """First and second derivatives of ``own_series``."""
        return _derivative(self.own_series), _derivative(self.own_series, 2)

    @cached_property
    def _cross_slopes(self) -> dict[int, tuple[Array, Array]]:
        """Derivatives of ``cross_series`` by the load's and the point's place."""
        return {
            tooth: (_derivative(series), _derivative(series.T).T)
            for tooth, series in self.cross_series.items()
        }

    def own_slope(self, rho: Array) -> Array:
        """Differentiate ``own`` by rho [1 per N/m]; places beyond the range are moved to its end."""
        rho = np.clip(rho, *self.rho_range)
        unit, by_rho = self._root(rho)
        slope = chebyshev.chebval(unit, self._own_slopes[0]) * by_rho
        return np.asarray(slope - self.logarithm * 2 * rho / (self.rho_end**2 - rho**2))

    def own_bend(self, rho: Array) -> Array:
        """Differentiate ``own_slope`` by rho [1/m per N/m]; places beyond the range are moved to its end."""
        rho = np.clip(rho, *self.rho_range)
        unit, by_rho = self._root(rho)
        slope, bend = (chebyshev.chebval(unit, series) for series in self._own_slopes)
        away = self.rho_end**2 - rho**2
        whole = bend * by_rho**2 + slope * by_rho / (2 * (self.rho_end - rho))
        return np.asarray(whole - self.logarithm * (2 / away + (2 * rho / away) ** 2))

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
        series = self.cross_series[tooth]
        loads, points = (chebyshev.chebvander(self._unit(rho), len(series) - 1) for rho in (load, point))
        return np.asarray(np.sum((loads @ series) * points, axis=-1))

    def cross_slope(self, tooth: int, load: Array, point: Array) -> Array:
        """Change of ``cross`` as load and point move on together [1 per N/m]; arguments as there."""
        low, high = self.rho_range
        series = self.cross_series[tooth]
        by_load, by_point = self._cross_slopes[tooth]
        loads, points = (chebyshev.chebvander(self._unit(rho), len(series) - 1) for rho in (load, point))
        slope = np.sum((loads[..., :-1] @ by_load) * points, axis=-1)
        slope = slope + np.sum((loads @ by_point) * points[..., :-1], axis=-1)
        return np.asarray(slope * 2 / (high - low))

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
        return np.asarray(chebyshev.chebvander(self._unit(load), len(series) - 1) @ series)


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
    low, high = float(rho[0]), float(rho[-1])
    unit = (2 * rho - low - high) / (high - low)
    _, logarithm = corner_logarithm(ring.mesh, ring.law, flank)
    away = (rho_end**2 - rho**2) / (2 * profile.base_radius)
    smooth = samples.own - logarithm * np.log(away / profile.module)
    near, far = np.sqrt(rho_end - high), np.sqrt(rho_end - low)
    root = (2 * np.sqrt(rho_end - rho) - near - far) / (far - near)
    own = np.asarray(np.linalg.solve(chebyshev.chebvander(root, len(rho) - 1), smooth), dtype=float)
    degree = max(CROSS_DEGREE, CROSS_SHARE * len(rho) // 8)
    basis = chebyshev.chebvander(unit, min(degree, len(rho) - 1))
    fit = np.linalg.pinv(basis)
    cross = fit @ samples.cross @ fit.T
    remainder = float(np.max(np.abs(basis @ cross @ basis.T - samples.cross)))
    return GearCompliance(
        (low, high),
        rho_end,
        profile.base_radius,
        profile.module,
        ring.law,
        logarithm,
        own,
        {tooth + 1: series for tooth, series in enumerate(cross)},
        {tooth + 1: fit @ corner for tooth, corner in enumerate(samples.corner)},
        hub_windup(profile, ring.law),
        _tail(own),
        remainder,
    )


def _upper(series: Array) -> Array:
    """Upper half of the degrees of a series of one or two places."""
    degree = np.max(np.indices(series.shape), axis=0)
    return np.where(2 * degree > len(series), series, 0.0)


def _over(size: float, values: Array) -> float:
    """Size over the largest of some values; 0 where there are none."""
    greatest = float(np.max(values, initial=0.0))
    return size / greatest if greatest > 0.0 else 0.0


def _derivative(series: Array, times: int = 1) -> Array:
    """Coefficients of a series' derivative, by its first place if it has two."""
    return np.asarray(chebyshev.chebder(series, times), dtype=float)


def _tail(series: Array) -> float:
    """Size of what follows the last coefficients, were they to go on as they decay; twice, for aliasing."""
    size = np.abs(series)
    last, before = float(np.max(size[-3:])), float(np.max(size[-9:-6]))
    ratio = float(min((last / max(before, 1e-300)) ** (1 / 6), 0.9))
    return 2 * last * ratio / (1 - ratio)
