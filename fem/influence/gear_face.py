"""A gear's answer to loads that vary along the face: smooth functions of places on the flank and of the wave number.

What a wave of load yields less than the same load spread evenly falls as a logarithm where the wave is short,

    c(k) - c(0) ~ -2 ln k/(pi E*) ,

which is taken out before the rest is interpolated by Chebyshev polynomials, in s = k/(k + kappa) and in places as in
``fem.influence.gear_compliance``. Beyond the shortest wave that the mesh shows the logarithm goes on alone. Neighbours
feel long waves alone. Free ends (``fem.elasticity.free_ends``) are looked at on a coarse section and at few places.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, record
from fem.elasticity.flank_samples import sample_places
from fem.elasticity.free_ends import FreeEnds, HalfFace, free_ends, half_face, over_cells
from fem.elasticity.line_load import flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.prism import Face, Section, prism, section
from fem.influence.gear_shape import MeshedShape
from meshes.outline import Sizes

__all__ = [
    "AxialHarmonics",
    "EndCorrection",
    "EndCorrectionOfCells",
    "axial_harmonics",
    "between_waves",
    "end_correction",
    "section_of",
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
    rho_range : (float, float)
        Curvature radii covered.
    rho_end : float
        Curvature radius of the tip corner.
    own : (places, waves) array
        Chebyshev coefficients of c(k) - c(0) + ln(1 + (k/kappa)^2)/pi over (rho_end - rho)^(1/2) and s.
    cross : (reach, places, places, waves) array
        Coefficients of c(k) - c(0) over the load's and the point's rho and s.
    """

    rho_range: tuple[float, float]
    rho_end: float
    own: Array
    cross: Array

    def own_at(self, rho: Array, wavenumber: Array) -> Array:
        """c(k) - c(0) at each load (..., waves) for rho (...) and k (waves,)."""
        near, far = (np.sqrt(self.rho_end - end) for end in self.rho_range[::-1])
        root = np.sqrt(self.rho_end - np.clip(rho, *self.rho_range))
        places = chebyshev.chebvander(
            np.clip((2 * root - near - far) / (far - near), -1, 1), len(self.own) - 1
        )
        smooth = places @ (self.own @ _waves(wavenumber, self.own.shape[1]).T)
        return np.asarray(smooth - _logarithm(wavenumber))

    def cross_at(self, tooth: int, load: Array, point: Array, wavenumber: Array) -> Array:
        """c(k) - c(0) on a neighbour (..., waves), counted from 1 to the side of growing rho."""
        size, waves = self.cross.shape[1], self.cross.shape[3]
        loads, points = (_by_place(rho, self.rho_range, size) for rho in (load, point))
        by_wave = self.cross[tooth - 1] @ _waves(wavenumber, waves).T
        return np.asarray(np.einsum("...i,ijk,...j->...k", loads, by_wave, points, optimize=True))


def _by_root(rho: Array, rho_range: tuple[float, float], rho_end: float, count: int) -> Array:
    """Chebyshev polynomials (..., count) of the root of what rho lacks to the tip corner."""
    near, far = (np.sqrt(rho_end - end) for end in rho_range[::-1])
    root = np.sqrt(rho_end - np.clip(rho, *rho_range))
    unit = np.clip((2 * root - near - far) / (far - near), -1.0, 1.0)
    return np.asarray(chebyshev.chebvander(unit, count - 1), dtype=float)


def _by_place(rho: Array, rho_range: tuple[float, float], count: int) -> Array:
    """Chebyshev polynomials (..., count) of rho."""
    low, high = rho_range
    unit = np.clip((2 * rho - low - high) / (high - low), -1.0, 1.0)
    return np.asarray(chebyshev.chebvander(unit, count - 1), dtype=float)


def _logarithm(wavenumber: Array) -> Array:
    return np.asarray(np.log1p((wavenumber / BEND) ** 2) / np.pi)


def _waves(wavenumber: Array, count: int) -> Array:
    """Chebyshev polynomials of s (waves, count); constant beyond the shortest wave."""
    s = wavenumber / (wavenumber + BEND)
    most = SHORTEST / (SHORTEST + BEND)
    return np.asarray(chebyshev.chebvander(np.clip(2 * s / most - 1, -1.0, 1.0), count - 1), dtype=float)


def solved_waves() -> tuple[Array, Array]:
    """Places of the solved waves in the polynomials (WAVES,), -1 to 1, and their wave numbers [1/module]; last 0."""
    unit = np.cos(np.pi * (np.arange(WAVES) + 0.5) / WAVES)
    unit /= unit[0]
    s = 0.5 * (unit + 1) * SHORTEST / (SHORTEST + BEND)
    wavenumber = BEND * s / (1 - s)
    return unit, np.where(wavenumber > 1e-9, wavenumber, 0.0)


def between_waves(wavenumber: Array) -> Array:
    """Weights (waves, WAVES) of the solved waves in what any waves do; constant beyond the shortest one."""
    unit, _ = solved_waves()
    return np.asarray(_waves(wavenumber, WAVES) @ np.linalg.inv(chebyshev.chebvander(unit, WAVES - 1)))


def _solid(meshed: MeshedShape) -> PlaneElasticity:
    """The solid whose plane strain has E* = 1 and the shape's nu*."""
    nu = meshed.shape.poisson / (1 + meshed.shape.poisson)
    return PlaneElasticity("strain", 1 - nu**2, nu)


def section_of(meshed: MeshedShape, sizes: Sizes, refinements: int) -> Section:
    """Section of a gear of module 1 and E* = 1."""
    from meshes import mesh_sector

    return section(mesh_sector(meshed.shape.profile, sizes, refinements), _solid(meshed))


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
    low, high, end = float(rho[0]), float(rho[-1]), profile.flank_rho[1]
    by_wave = np.linalg.inv(chebyshev.chebvander(unit, WAVES - 1))
    by_root = np.linalg.inv(_by_root(rho, (low, high), end, PLACES))
    by_place = np.linalg.pinv(_by_place(rho, (low, high), 2 * PLACES // 3 + 1))
    series = np.einsum("kw,wrij,ai,bj->rabk", by_wave, cross, by_place, by_place, optimize=True)
    return AxialHarmonics((low, high), end, by_root @ (by_wave @ own).T, series)


@record
class EndCorrection:
    """What free ends add to the answer of one gear between walls, in modules and E*, by functions over half its face.

    Attributes
    ----------
    rho_range, rho_end
        As of ``AxialHarmonics``.
    half : HalfFace
    own : two arrays (places, psi, psi)
        Chebyshev coefficients over (rho_end - rho)^(1/2), of loads that are equal and opposite on both halves.
    cross : two arrays (reach, places, places, psi, psi)
        Over the load's and the point's rho.
    """

    rho_range: tuple[float, float]
    rho_end: float
    half: HalfFace
    own: tuple[Array, Array]
    cross: tuple[Array, Array]

    def over(self, edges: Array) -> EndCorrectionOfCells:
        """Put loads on cells between edges (cells + 1,), growing, from mid-face."""
        cross = over_cells(self.half, *self.cross, edges)
        return EndCorrectionOfCells(
            self.rho_range, self.rho_end, over_cells(self.half, *self.own, edges), cross
        )


@record
class EndCorrectionOfCells:
    """What free ends add between cells, in modules and E*: [module per E* module^2 of force].

    Attributes
    ----------
    rho_range, rho_end
        As of ``AxialHarmonics``.
    own : (places, cells, cells) array
        Chebyshev coefficients over (rho_end - rho)^(1/2).
    cross : (reach, places, places, cells, cells) array
        Over the load's and the point's rho.
    """

    rho_range: tuple[float, float]
    rho_end: float
    own: Array
    cross: Array

    def own_at(self, rho: Array) -> Array:
        """Means over cells by a unit force on a cell (..., cells, cells) for rho (...)."""
        places = _by_root(rho, self.rho_range, self.rho_end, len(self.own))
        return np.asarray(np.tensordot(places, self.own, axes=1))

    def cross_at(self, tooth: int, load: Array, point: Array) -> Array:
        """The same on a neighbour; cells of the load first."""
        size = self.cross.shape[1]
        loads, points = (_by_place(rho, self.rho_range, size) for rho in (load, point))
        products = (loads[..., :, None] * points[..., None, :]).reshape(*loads.shape[:-1], size**2)
        series = self.cross[tooth - 1].reshape(size**2, *self.cross.shape[3:])
        return np.asarray(np.tensordot(products, series, axes=1))


def end_correction(meshed: MeshedShape, face_width: float) -> EndCorrection:
    """Solve a gear of module 1 and E* = 1 with free ends; its face width in modules."""
    over, profile, reach = section_of(meshed, ENDS_SIZES, 0), meshed.shape.profile, meshed.shape.reach
    rho, end = sample_places(profile, END_PLACES), profile.flank_rho[1]
    ends = float(rho[0]), float(rho[-1])
    half = half_face(0.5 * face_width, 1.0)
    solved: FreeEnds = free_ends(over, half, flank_points(over.mesh, rho), reach)
    by_root = np.linalg.inv(_by_root(rho, ends, end, END_PLACES))
    by_place = np.linalg.pinv(_by_place(rho, ends, 2 * END_PLACES // 3 + 1))
    own = [np.einsum("ai,ipq->apq", by_root, table) for table in solved.own]
    cross = [
        np.einsum("ai,bj,rijpq->rabpq", by_place, by_place, table, optimize=True) for table in solved.cross
    ]
    return EndCorrection(ends, end, half, (own[0], own[1]), (cross[0], cross[1]))
