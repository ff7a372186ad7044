"""Compliance of one gear's flank: own tooth and neighbouring teeth, as smooth functions of rho.

Per unit line load, u_r at the load (``own``) holds everything but the local indentation: bending, shear,
root, body and hub. Near the tip corner it grows as a logarithm of the distance d from the corner, because a
wedge yields more than a half-plane. With the interior angle 2 beta of the corner and gamma = pi/2 - beta between
load and bisector, Michell's wedge under a force at its apex gives

    u_r ~ c ln d,   c = [2/pi - cos^2 gamma/(beta + sin(2 beta)/2) - sin^2 gamma/(beta - sin(2 beta)/2)]/E*

(S. P. Timoshenko and J. N. Goodier, Theory of Elasticity, 1970, article 38). That part is taken out before
the rest is interpolated by Chebyshev polynomials. What is left of ``own`` begins as d ln d at the corner, close beyond
the last load: it is a polynomial in the root of rho_end - rho, which moves that singularity away and brings loads close
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
from fem.elasticity import PlaneElasticity
from fem.line_load import LineLoads, flank_points, joined, line_loads
from fem.ring import Ring

if TYPE_CHECKING:
    from gears import ToothProfile
    from meshes import SectorMesh

__all__ = [
    "FlankSamples",
    "GearCompliance",
    "corner_logarithm",
    "flank_loads",
    "gear_compliance",
    "hub_windup",
    "sampled",
    "samples_of",
    "wedge_logarithms",
]

CORNER_CLEARANCE = 0.01
"""Loads nearer to the tip corner than this (in modules of rho) are placed at this distance."""

CROSS_DEGREE, CROSS_SHARE = 12, 5
"""Least degree of cross terms in either place, and eighths of the number of loads, with which it grows."""

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


def corner_logarithm(mesh: SectorMesh, law: PlaneElasticity, flank: str = "left") -> tuple[float, float]:
    """Interior angle of the tip corner [rad] and the coefficient c of ln d [m per N/m]."""
    points = mesh.points
    facets = mesh.facets[f"flank_{flank}"]
    last = facets[np.argmax(mesh.parameters[f"flank_{flank}"].max(axis=1))]
    at_end = 1 if flank == "right" else 0  # the outline runs up the right flank and down the left one
    corner = last[at_end]
    beyond = next(
        edge
        for name, edges in mesh.facets.items()
        if name.startswith(("top", "chamfer"))
        for edge in edges
        if corner in edge[:2]
    )
    arms = []
    for edge in (last, beyond):
        other = edge[0] if edge[1] == corner else edge[1]
        slope = -3 * points[corner] + 4 * points[edge[2]] - points[other]
        arms.append(slope / np.linalg.norm(slope))
    angle = float(np.arccos(np.clip(arms[0] @ arms[1], -1.0, 1.0)))
    return angle, wedge_logarithms(angle, law)[0]


def wedge_logarithms(angle: float, law: PlaneElasticity) -> tuple[float, float, float]:
    """Coefficients of ln d for force and displacement along a wedge's flank [m per N/m]: c_nn, c_nt, c_tt.

    A force at the apex moves the wedge by -ln(r)/E* times 1/(beta + sin(2 beta)/2) along the bisector and
    1/(beta - sin(2 beta)/2) across it, a half-plane by 2/pi in either direction. n is the inward normal, t
    the tangent towards the apex.

    Parameters
    ----------
    angle : float
        2 beta, of the material [rad].
    law : PlaneElasticity
    """
    half = 0.5 * angle
    along, across = 1 / (half + 0.5 * np.sin(angle)), 1 / (half - 0.5 * np.sin(angle))
    normal = along * np.sin(half) ** 2 + across * np.cos(half) ** 2
    tangential = along * np.cos(half) ** 2 + across * np.sin(half) ** 2
    mixed = 0.5 * (across - along) * np.sin(angle)
    parts = 2 / np.pi - normal, -mixed, 2 / np.pi - tangential
    c_nn, c_nt, c_tt = (float(part / law.plane_modulus) for part in parts)
    return c_nn, c_nt, c_tt


def hub_windup(profile: ToothProfile, law: PlaneElasticity) -> float:
    """Turn the body on its held bore, measured along the line of action [m per N/m].

    That of rings in shear by a torque, which is the mean turn of a gear's root circle exactly
    (``gears.closed_form.body_wind_up``). Closed forms of tooth deflection leave it out.
    """
    from gears.closed_form import body_wind_up

    return body_wind_up(profile.zones, profile.base_radius, law.shear_modulus)


@record
class FlankSamples:
    """Displacements by unit line loads at some places of a flank.

    Attributes
    ----------
    rho : (n,) array
        Curvature radii of the loads, growing [m].
    own : (n,) array
        u_r at each load [m per N/m].
    cross : (reach, n, n) array
        Displacement at the same places of the k-th tooth on the side of growing rho (rows: load).
    corner : (reach, n) array
        Displacement of that tooth's last place along the flank's tangent towards the tip.
    """

    rho: Array
    own: Array
    cross: Array
    corner: Array


def sample_places(profile: ToothProfile, count: int) -> Array:
    """Chebyshev points in the root of what rho lacks to the tip corner, stretched to include both ends of the flank.

    Whatever the mate reaches (count,) [m].
    """
    low, end = profile.flank_rho
    high = end - CORNER_CLEARANCE * profile.module
    unit = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    near, far = np.sqrt(end - high), np.sqrt(end - low)
    root = near + 0.5 * (far - near) * (1 + unit / unit[0])
    return np.asarray(np.clip(end - root**2, low, high))


def flank_loads(ring: Ring, rho: Array, flank: str = "left") -> LineLoads:
    """Load a flank at growing curvature radii [m], and the last place once more along the tangent towards the tip."""
    at = flank_points(ring.mesh, rho, flank)
    return line_loads(ring, joined(at, at.part(slice(-1, None)).towards_tip()))


def sampled(ring: Ring, rho: Array, reach: int = 1, flank: str = "left") -> FlankSamples:
    """Load a flank at growing curvature radii [m] and take the displacements there and on ``reach`` teeth."""
    return samples_of(flank_loads(ring, rho, flank), reach, flank)


def samples_of(every: LineLoads, reach: int = 1, flank: str = "left") -> FlankSamples:
    """As ``sampled``, by ``flank_loads``."""
    count = len(every.at.rho) - 1
    loads = every.part(slice(count))
    teeth = [tooth if flank == "left" else -tooth for tooth in range(1, reach + 1)]
    there = np.array([loads.on_neighbour(tooth, every) for tooth in teeth])
    cross, corner = np.swapaxes(there[:, :count], 1, 2), there[:, count]
    return FlankSamples(loads.at.rho, loads.regular_at_load(), cross, corner)


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
        {tooth + 1: fit @ some for tooth, some in enumerate(samples.corner)},
        hub_windup(profile, ring.law),
        _tail(own),
        remainder,
    )


def _upper(series: Array) -> Array:
    """Upper half of the degrees of a series of one or two places."""
    degree = np.max(np.indices(series.shape), axis=0)
    return np.where(2 * degree > len(series), series, 0.0)


def _over(size: float, values: Array) -> float:
    """Size over the greatest of some values; 0 where there are none."""
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
