r"""A helical gear's answer to waves of load along its face, between two places of the flank.

A line of contact crosses the flank, so that a load at one place is felt at others of the same flank. By e^(ikz) at a,
in coordinates that turn with the section, b yields c(a, b; k) e^(ikz), and c(b, a; k) = conj c(a, b; k). Beyond an even
load along the helix that is S(a, b; k) = c(a, b; k) - c(a, b; 0).

Near the load the flank is a half-space, which yields 1/(pi E* R) at a distance R. From a point of the helix through a
to one of that through b, zeta farther along the axis,

.. math:: R^2 = \ell^2 (\zeta + \delta)^2 + q^2, \qquad \ell^2 = 1 + \tau^2 (r_b^2 + \rho^2), \quad
   \delta = \frac{\tau \rho r}{\ell^2}, \quad q = r \frac{\sqrt{1 + \tau^2 r_b^2}}{\ell},

with tau the twist, rho^2 = a b and r = (a^2 - b^2)/(2 r_b) the way along the profile. Over zeta that is a wave
(2/(pi E* l)) e^(ik delta) K_0(k q/l), l the root of l^2 and q the distance of the helices, and S has

.. math:: \frac{2}{\pi E^* \ell} \left[ e^{i k \delta} K_0(k q/\ell) + \ln \frac{k q}{2 \ell} + \gamma \right]
   - \frac{1}{\pi E^* \ell} \ln\left(1 + \frac{k^2}{\kappa^2}\right) ,

the last term for the logarithm of short waves as in ``fem.influence.gear_face``. That is taken out before the rest is
interpolated by Chebyshev polynomials, in both places and in s = k/(k + kappa). Neighbours feel long waves alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, record, unclocked
from fem.elasticity.flank_samples import sample_places
from fem.elasticity.line_load import FlankPoints, flank_points
from fem.elasticity.prism import prism
from fem.elasticity.section import Face, Section, section
from fem.influence.flank_variable import FlankVariable, RootVariable
from fem.influence.gear_face import BEND, between_waves, solid_of, solved_waves
from fem.influence.gear_shape import MeshedShape
from fem.influence.series import CrossSeries, FlankFit, FlankSeries

__all__ = ["HelixHarmonics", "helix_harmonics"]

PLACES = 12
"""Places of loads."""


@record
class HelixHarmonics:
    """What waves of line load along the face yield beyond even loads, in modules and E*.

    Attributes
    ----------
    base_radius, twist : float
        r_b, and tau = tan(beta_b)/r_b, positive for a right hand.
    own : CrossSeries of (waves, 2)
        Real and imaginary part of the smooth rest of S at the solved waves, on the loaded flank.
    cross : mapping of int to CrossSeries of (waves, 2)
        S on the k-th tooth on the side of growing rho; on the other side it is the conjugate with places exchanged.
    even_own : FlankSeries
        What an even load yields at itself beyond u_r/l, u_r that of an even load on the spur gear of this section
        (``fem.influence.gear_compliance``).
    even_cross : mapping of int to CrossSeries
        c(a, b; 0) on the k-th tooth.
    """

    base_radius: float
    twist: float
    own: CrossSeries
    cross: Mapping[int, CrossSeries]
    even_own: FlankSeries
    even_cross: Mapping[int, CrossSeries]

    @property
    def cos_base(self) -> float:
        """cos(beta_b): length of the axis over that of a line of contact."""
        return float(1.0 / np.sqrt(1.0 + (self.twist * self.base_radius) ** 2))

    def helix(self, load: Array, point: Array) -> Array:
        """Length l of a helix through the flank for a unit of z, in the mean between two places (...)."""
        return _helix(self.base_radius, self.twist, load * point)

    @property
    def mirrored(self) -> HelixHarmonics:
        """The same section with the other hand: z is counted the other way, so that waves run back."""
        back = np.array([1.0, -1.0])
        return replace(
            self,
            twist=-self.twist,
            own=replace(self.own, coefficients=self.own.coefficients * back),
            cross={
                tooth: replace(series, coefficients=series.coefficients * back)
                for tooth, series in self.cross.items()
            },
        )

    def smooth(self, tooth: int, load: Array, point: Array) -> Array:
        """Smooth part of S at the solved waves (..., waves), complex; tooth 0 is the loaded one."""
        series = self.cross[abs(tooth)] if tooth else self.own
        load, point = np.broadcast_arrays(load, point)
        parts = series.at(point, load) if tooth < 0 else series.at(load, point)
        return np.asarray(parts[..., 0] + (-1j if tooth < 0 else 1j) * parts[..., 1])

    def own_at(self, load: Array, point: Array, wavenumber: Array) -> Array:
        """S on the loaded flank (..., waves), complex, for curvature radii (...) and k (waves,)."""
        return self.cross_at(0, load, point, wavenumber) + self._half_space(load, point, wavenumber)

    def cross_at(self, tooth: int, load: Array, point: Array, wavenumber: Array) -> Array:
        """S on a neighbour (..., waves), counted from 1 to the side of growing rho; negative on the other side."""
        return np.asarray(self.smooth(tooth, load, point) @ between_waves(wavenumber).T)

    def _half_space(self, load: Array, point: Array, wavenumber: Array) -> Array:
        return _half_space(self.base_radius, self.twist, load, point, wavenumber)


def _helix(base_radius: float, twist: float, place: Array) -> Array:
    """Length l of a helix through the flank for a unit of z, by the product of curvature radii (...)."""
    return np.asarray(np.sqrt(1.0 + twist**2 * (base_radius**2 + place)))


def _half_space(base_radius: float, twist: float, load: Array, point: Array, wavenumber: Array) -> Array:
    """What S has of a half-space (..., waves), complex."""
    with unclocked():
        from scipy.special import k0

    place = load * point
    helix = _helix(base_radius, twist, place)
    along_profile = (load**2 - point**2) / (2.0 * base_radius)
    shift = twist * np.sqrt(place) * along_profile / helix**2
    across = np.abs(along_profile) * np.sqrt(1.0 + (twist * base_radius) ** 2) / helix**2
    turns = wavenumber * across[..., None]
    # the bracket vanishes as (turns/2)^2 ln(turns) at the load, where its parts are infinite
    near = np.where(turns > 1e-9, turns, 1.0)
    bracket = np.exp(1j * wavenumber * shift[..., None]) * k0(near) + np.log(0.5 * near) + np.euler_gamma
    bracket = np.where(turns > 1e-9, bracket, 0.0)
    return np.asarray((2.0 * bracket - np.log1p((wavenumber / BEND) ** 2)) / (np.pi * helix[..., None]))


def helix_harmonics(meshed: MeshedShape, twist: float, reach: int | None = None) -> HelixHarmonics:
    """Solve a gear of module 1 and E* = 1 for waves along the face.

    Parameters
    ----------
    meshed : MeshedShape
        Of the transverse section.
    twist : float
        tan(beta_b)/r_b, positive for a right hand [rad/module].
    reach : int, optional
        Neighbours that are observed on the side of growing rho; those of the shape unless given.
    """
    from meshes import mesh_sector

    profile = meshed.shape.profile
    reach = meshed.shape.reach if reach is None else reach
    mesh = mesh_sector(profile, meshed.sizes, meshed.refinements)
    over, rho = section(mesh, solid_of(meshed.shape.poisson), twist), sample_places(profile, PLACES)
    at, teeth = flank_points(mesh, rho), list(range(reach + 1))
    _, wavenumber = solved_waves()
    answers = [prism(over, Face.wave(float(k), twisted=True)).across(at, at, teeth) for k in wavenumber]
    still = answers[-1][:, :, 0, :, 0]
    # by the cosine: the answer's cosine is the real part, its sine minus the imaginary one
    by_wave = np.array([answer[:, :, 0, :, 0] - still for answer in answers])
    turned = np.array(
        [-answer[:, :, 0, :, 1] if answer.shape[-1] == 2 else 0.0 * still for answer in answers]
    )
    samples = np.moveaxis(np.stack([by_wave, turned], axis=-1), 0, -2)  # (teeth, loads, points, waves, 2)
    half_space = _half_space(profile.base_radius, twist, rho[:, None], rho[None, :], wavenumber)
    samples[0] -= np.stack([half_space.real, half_space.imag], axis=-1)
    span, rho_end = (float(rho[0]), float(rho[-1])), profile.flank_rho[1]
    own = _fitted(RootVariable(span, rho_end), rho, samples[0])
    place = FlankVariable(span)
    cross = {tooth: _fitted(place, rho, samples[tooth]) for tooth in teeth[1:]}
    even = _at_the_load(over, at, np.diagonal(still[0]))
    return HelixHarmonics(
        profile.base_radius,
        twist,
        own,
        cross,
        FlankFit(own.variable, own.variable.unit(rho, hold=False), PLACES - 1).series(even),
        {tooth: _fitted(place, rho, still[tooth]) for tooth in teeth[1:]},
    )


def _at_the_load(over: Section, at: FlankPoints, by_nodes: Array) -> Array:
    """What even loads yield at themselves beyond u_r/l (loads,), from answers of nodal forces there.

    What nodal forces lack is what they lack in the plane on the same mesh, where u_r is known, for lengths that the
    helix leaves of those in the section.
    """
    straight = prism(section(over.mesh, over.law), Face.wave(0.0)).influence(at, 0)[0][:, 0, 0]
    radius, twist = over.mesh.base_radius, over.twist
    helix = _helix(radius, twist, at.rho**2)
    shorter = np.sqrt(1.0 + (twist * radius) ** 2) / helix**2
    return np.asarray(by_nodes + (2.0 / np.pi * np.log(shorter) - straight) / helix)


def _fitted(variable: FlankVariable, rho: Array, samples: Array) -> CrossSeries:
    """Series through samples (loads, points, ...) at the same places."""
    basis = chebyshev.chebvander(variable.unit(rho, hold=False), len(rho) - 1)
    inverse = np.linalg.inv(basis)
    return CrossSeries(variable, np.einsum("ai,bj,ij...->ab...", inverse, inverse, samples, optimize=True))
