"""A gear's answer to loads that vary along the face: smooth functions of places on the flank and of the wave number.

What a wave of load yields less than the same load spread evenly falls as a logarithm where the wave is short,

    c(k) - c(0) ~ -2 ln k/(pi E*) ,

which is taken out before the rest is interpolated by Chebyshev polynomials, in s = k/(k + kappa) and in places as in
``fem.influence.gear_compliance``. Beyond the shortest wave that the mesh shows the logarithm goes on alone. Neighbours
feel long waves alone. Free ends (``fem.elasticity.free_ends``) are looked at on a coarse section and at few places.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, record
from fem.elasticity.flank_samples import sample_places
from fem.elasticity.free_ends import HalfFace, free_ends, half_face, over_cells
from fem.elasticity.line_load import flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.prism import prism
from fem.elasticity.section import Face, Section, section
from fem.influence.flank_variable import FlankVariable, RootVariable, stretched_points
from fem.influence.gear_shape import MeshedShape
from fem.influence.series import CrossSeries, FlankFit, FlankSeries
from meshes.outline import Sizes

__all__ = [
    "AxialHarmonics",
    "EndCorrection",
    "axial_harmonics",
    "between_waves",
    "end_correction",
    "section_of",
    "solid_of",
    "solved_waves",
]

WAVES, PLACES, END_PLACES = 13, 16, 10
"""Wave numbers and places of loads, and places at which free ends are looked at."""

BEND, SHORTEST = 0.6, 16.0
"""kappa and the largest wave number that is solved [1/module]."""

ENDS_SIZES = Sizes(flank=0.3, fillet=0.35, root=0.4, corner=0.3, top=1.2, growth=1.0)
"""Of the section on which free ends are looked at: loads at the end feel the elements that are nearer than a cell."""


@record
class AxialHarmonics:
    """What waves of line load along the face yield beyond such loads without a wave, in modules and E*.

    Attributes
    ----------
    rho_end : float
        Curvature radius of the tip corner.
    own : FlankSeries of (waves,)
        Chebyshev coefficients in s of c(k) - c(0) + ln(1 + (k/kappa)^2)/pi over (rho_end - rho)^(1/2).
    cross : mapping of int to CrossSeries of (waves,)
        For the k-th tooth on the side of growing rho, those of c(k) - c(0) over the load's and the point's rho.
    """

    rho_end: float
    own: FlankSeries
    cross: Mapping[int, CrossSeries]

    def own_at(self, rho: Array, wavenumber: Array) -> Array:
        """c(k) - c(0) at each load (..., waves) for rho (...) and k (waves,)."""
        by_place = self.own.coefficients
        smooth = self.own.basis(rho) @ (by_place @ _waves(wavenumber, by_place.shape[1]).T)
        return np.asarray(smooth - _logarithm(wavenumber))

    def cross_at(self, tooth: int, load: Array, point: Array, wavenumber: Array) -> Array:
        """c(k) - c(0) on a neighbour (..., waves), counted from 1 to the side of growing rho."""
        series = self.cross[tooth]
        loads, points = series.bases(load, point)
        by_wave = series.coefficients @ _waves(wavenumber, series.coefficients.shape[2]).T
        return np.asarray(np.einsum("...i,ijk,...j->...k", loads, by_wave, points, optimize=True))


def _logarithm(wavenumber: Array) -> Array:
    return np.asarray(np.log1p((wavenumber / BEND) ** 2) / np.pi)


def _waves(wavenumber: Array, count: int) -> Array:
    """Chebyshev polynomials of s (waves, count); constant beyond the shortest wave."""
    s = wavenumber / (wavenumber + BEND)
    most = SHORTEST / (SHORTEST + BEND)
    return np.asarray(chebyshev.chebvander(np.clip(2 * s / most - 1, -1.0, 1.0), count - 1), dtype=float)


def solved_waves() -> tuple[Array, Array]:
    """Places of the solved waves in the polynomials (WAVES,), -1 to 1, and their wave numbers [1/module]; last 0."""
    unit = stretched_points(WAVES)
    s = 0.5 * (unit + 1) * SHORTEST / (SHORTEST + BEND)
    wavenumber = BEND * s / (1 - s)
    return unit, np.where(wavenumber > 1e-9, wavenumber, 0.0)


def between_waves(wavenumber: Array, solved: int = WAVES) -> Array:
    """Weights (waves, solved) of the solved waves in what any waves do; constant beyond the shortest one."""
    by_wave = np.linalg.inv(chebyshev.chebvander(stretched_points(solved), solved - 1))
    return np.asarray(_waves(wavenumber, solved) @ by_wave)


def solid_of(poisson: float) -> PlaneElasticity:
    """Solid whose plane strain has E* = 1 and nu*."""
    nu = poisson / (1 + poisson)
    return PlaneElasticity("strain", 1 - nu**2, nu)


def section_of(meshed: MeshedShape, sizes: Sizes, refinements: int, twist: float = 0.0) -> Section:
    """Section of a gear of module 1 and E* = 1, twisted by some radians a module."""
    from meshes import mesh_sector

    mesh = mesh_sector(meshed.shape.profile, sizes, refinements)
    return section(mesh, solid_of(meshed.shape.poisson), twist)


def axial_harmonics(meshed: MeshedShape) -> AxialHarmonics:
    """Solve a gear of module 1 and E* = 1 for waves along the face."""
    over = section_of(meshed, meshed.sizes, meshed.refinements)
    profile, reach = meshed.shape.profile, meshed.shape.reach
    rho = sample_places(profile, PLACES)
    at = flank_points(over.mesh, rho)
    unit, wavenumber = solved_waves()
    answers = [prism(over, Face.wave(k)).influence(at, reach) for k in wavenumber]
    still = answers[-1]
    own = np.array([answer[0][:, 0, 0] - still[0][:, 0, 0] for answer in answers])
    cross = np.array([answer[1][:, :, 0, :, 0] - still[1][:, :, 0, :, 0] for answer in answers])
    own += _logarithm(wavenumber)[:, None]
    root, place = _variables(rho, profile.flank_rho[1])
    by_wave = np.linalg.inv(chebyshev.chebvander(unit, WAVES - 1))
    by_root = FlankFit(root, root.unit(rho), PLACES - 1).weights
    by_place = FlankFit(place, place.unit(rho), 2 * PLACES // 3).weights
    tables = np.einsum("kw,wrij,ai,bj->rabk", by_wave, cross, by_place, by_place, optimize=True)
    return AxialHarmonics(
        root.rho_end,
        FlankSeries(root, by_root @ (by_wave @ own).T),
        {tooth: CrossSeries(place, table) for tooth, table in enumerate(tables, 1)},
    )


def _variables(rho: Array, rho_end: float) -> tuple[RootVariable, FlankVariable]:
    """Variables over the span of growing curvature radii: of a load at itself, and of other teeth."""
    span = float(rho[0]), float(rho[-1])
    return RootVariable(span, rho_end), FlankVariable(span)


@record
class EndCorrection:
    """What free ends add to the answer of one gear between walls, in modules and E*, by functions over half its face.

    Attributes
    ----------
    root : RootVariable
        Of ``own``.
    place : FlankVariable
        Of ``cross``.
    half : HalfFace
    own : two arrays (places, psi, psi)
        Chebyshev coefficients over (rho_end - rho)^(1/2), of loads that are equal and opposite on both halves.
    cross : two arrays (reach, places, places, psi, psi)
        Over the load's and the point's rho.
    """

    root: RootVariable
    place: FlankVariable
    half: HalfFace
    own: tuple[Array, Array]
    cross: tuple[Array, Array]

    def over(self, edges: Array) -> tuple[FlankSeries, Mapping[int, CrossSeries]]:
        """Put loads on cells between edges (cells + 1,), growing, from mid-face.

        Returns
        -------
        own : FlankSeries of (cells, cells)
            Means over cells by a unit force on a cell [module per E* module^2 of force].
        cross : mapping of int to CrossSeries of (cells, cells)
            The same on the k-th tooth on the side of growing rho; cells of the load first.
        """
        own, cross = (over_cells(self.half, *tables, edges) for tables in (self.own, self.cross))
        series = {tooth: CrossSeries(self.place, table) for tooth, table in enumerate(cross, 1)}
        return FlankSeries(self.root, own), series


def end_correction(meshed: MeshedShape, face_width: float) -> EndCorrection:
    """Solve a gear of module 1 and E* = 1 with free ends; its face width in modules."""
    over, profile, reach = section_of(meshed, ENDS_SIZES, 0), meshed.shape.profile, meshed.shape.reach
    rho = sample_places(profile, END_PLACES)
    root, place = _variables(rho, profile.flank_rho[1])
    half = half_face(0.5 * face_width, 1.0)
    by_load, by_neighbour = free_ends(over, half, flank_points(over.mesh, rho), reach)
    by_root = FlankFit(root, root.unit(rho), END_PLACES - 1).weights
    by_place = FlankFit(place, place.unit(rho), 2 * END_PLACES // 3).weights
    own = [np.einsum("ai,ipq->apq", by_root, table) for table in by_load]
    cross = [
        np.einsum("ai,bj,rijpq->rabpq", by_place, by_place, table, optimize=True) for table in by_neighbour
    ]
    return EndCorrection(root, place, half, (own[0], own[1]), (cross[0], cross[1]))
