"""What free ends of the face add to the stress along the fillets, by functions over half the face.

As for displacements (``fem.elasticity.free_ends``): one prism on a coarse section is solved with free ends and between
walls, for loads that are equal and such that are opposite on both halves, and the difference is kept. It is smooth
along the fillet, so that few samples show it. Shear is left to the waves: it vanishes at walls and at free ends alike.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.elasticity.fillet import FilletLine, fillet_line, local_cubic
from fem.elasticity.fillet_strain import FilletStrain, fillet_strains
from fem.elasticity.free_ends import HalfFace, half_face
from fem.elasticity.line_load import FlankPoints, flank_points
from fem.elasticity.prism import prism
from fem.elasticity.section import Section, section
from fem.influence.fillet_waves import solid_of
from fem.influence.flank_variable import FlankVariable, stretched_points
from fem.influence.series import FlankFit
from meshes.outline import Sizes

if TYPE_CHECKING:
    from fem.influence.gear_shape import GearShape
    from gears import ToothProfile

__all__ = ["FilletEnds", "fillet_ends"]

PLACES, SAMPLES = 8, 21
"""Places of loads on the flank, and samples of a fillet."""

TEETH = (-1, 0, 1)
"""Teeth that are looked at, counted anticlockwise from the loaded one; farther ones hardly feel where a face ends."""

SIZES = Sizes(flank=0.3, fillet=0.25, root=0.5, corner=0.5, top=1.2, growth=1.6)
"""Of the section."""

LAST, GROWTH = 0.5, 4.0
"""Pieces of half the face, as of ``free_ends``: loads are farther from the fillet than from their own flank."""


@record
class FilletEnds:
    """What free ends add to E* eps_t and E* eps_z on the fillets of one gear, in modules.

    Attributes
    ----------
    place : FlankVariable
        Of loads.
    half : HalfFace
    even, odd : two (teeth, degree + 1, psi, psi, 2, samples) and (teeth, degree + 1, psi, phi, 2, samples) arrays
        Of loads that are equal and opposite on both halves: Chebyshev coefficients of what a unit functional (first
        psi) does to the functions of E* eps_t, and to those of w by whose derivatives E* eps_z is.
    """

    place: FlankVariable
    half: HalfFace
    even: tuple[Array, Array]
    odd: tuple[Array, Array]

    def add(
        self, tooth: int, rho: Array, force: Array, edges: Array, z: Array, samples: int
    ) -> tuple[Array, Array]:
        """E* eps_t and E* eps_z that free ends add at places z (loads, places, 2, samples).

        Parameters
        ----------
        tooth : int
            Of ``TEETH``.
        rho : (loads,) array
            Curvature radii [modules].
        force : (loads, cells) array
            On the cells.
        edges : (cells + 1,) array
            Of the cells, growing, from the middle of the gear's own face [modules].
        z : (places,) array
            [modules]
        samples : int
            Of a fillet.
        """
        degree = self.even[0].shape[1] - 1
        by_place = self.place.basis(self.place.held(rho), degree, hold=False)
        finer = local_cubic(np.linspace(0.0, 1.0, SAMPLES), np.linspace(0.0, 1.0, samples), 4)
        # the face that was solved ends where cells and places do, to the last bit
        most = float(self.half.ends[-1])
        edges, z = (np.clip(coordinate, -most, most) for coordinate in (edges, z))
        values, slopes = self.half.values(np.abs(z)), self.half.slopes(np.abs(z))
        total = np.zeros((2, len(rho), len(z), 2, SAMPLES))
        for means, series, sign, skipped in zip(
            self.half.means(edges), (self.even, self.odd), (np.ones_like(z), np.sign(z)), (0, 1), strict=True
        ):
            unit = force @ means[skipped:].T
            for kind, (functions, first) in enumerate(((values, skipped), (slopes, 1 - skipped))):
                by_function = np.einsum(
                    "la,lp,apqsn->lqsn", by_place, unit, series[kind][TEETH.index(tooth)], optimize=True
                )
                total[kind] += 0.5 * np.einsum(
                    "lqsn,qz->lzsn", by_function, functions[first:] * sign, optimize=True
                )
        along, across = total @ finer.T
        return along, across


def fillet_ends(shape: GearShape, face_width: float, rho_low: float) -> FilletEnds:
    """Solve a gear of module 1 with free ends and between walls; its face width in modules.

    Parameters
    ----------
    shape : GearShape
    face_width : float
        Of the gear's face [modules].
    rho_low : float
        Minimum curvature radius of loads [modules], if the flank goes on below it.
    """
    from meshes import mesh_sector

    profile = shape.profile
    mesh = mesh_sector(profile, SIZES, 0)
    low, high = max(rho_low, profile.flank_rho[0]), profile.flank_rho[1]
    place, unit = FlankVariable((low, high)), stretched_points(PLACES)
    at = flank_points(mesh, place.rho(unit))
    line = fillet_line(profile, SAMPLES)
    over, half = section(mesh, solid_of(shape.poisson)), half_face(0.5 * face_width, 1.0, LAST, GROWTH)
    weights = FlankFit(place, unit, 2 * PLACES // 3).weights
    series = []
    for even in (True, False):
        free, walls = (_strains(over, profile, half, even, ends, at, line) for ends in (True, False))
        # between walls w has no value at the end
        w = free[1]
        w[:, :, :, : walls[1].shape[3]] -= walls[1]
        series.append(
            tuple(np.einsum("al,tlpqsn->tapqsn", weights, functions) for functions in (free[0] - walls[0], w))
        )
    (even_t, even_z), (odd_t, odd_z) = series
    return FilletEnds(place, half, (even_t, even_z), (odd_t, odd_z))


def _strains(
    over: Section,
    profile: ToothProfile,
    half: HalfFace,
    even: bool,
    free: bool,
    at: FlankPoints,
    line: FilletLine,
) -> tuple[Array, Array]:
    """Functions of eps_t and of w (teeth, loads, psi, functions, 2, samples) by unit functionals psi."""
    solved = prism(over, half.face(even, free))
    moved = solved.displacements(at, TEETH)
    psi, phi, nodes, loads = solved.psi, solved.phi, moved.shape[1], len(at.rho)
    strains: tuple[FilletStrain, ...] = fillet_strains(over.mesh, profile, line)
    along = np.zeros((len(TEETH), loads, psi, psi, 2, len(line.arc)))
    across = np.zeros((len(TEETH), loads, psi, phi, 2, len(line.arc)))
    for number, here in enumerate(moved):
        for side, strain in enumerate(strains):
            for q in range(psi):
                plane = here[:, 2 * q : 2 * q + 2].reshape(2 * nodes, -1)
                along[number, :, :, q, side] = (strain.along @ plane).T.reshape(loads, psi, -1)
            for q in range(phi):
                across[number, :, :, q, side] = (strain.value @ here[:, 2 * psi + q]).T.reshape(
                    loads, psi, -1
                )
    return along, across
