"""What loads that vary along the face do to the other side of the teeth: front flanks loaded, back flanks seen.

Waves of line load on the left flank of tooth 0, cos k z, move the right flank of tooth k as cos k z too, along its
inward normal. Kept is what a wave moves beyond the same load spread evenly, X(k) - X(0), which vanishes without a
wave; X(0) is that of ``fem.influence.back_compliance``. Short waves reach no back flank, not even that of the loaded
tooth: X(k) falls as exp(-k d) with the distance d through the tooth, so that nothing singular is taken out. Tooth and
wave numbers, section and solved waves are those of ``fem.influence.gear_face``, and what free ends add is looked at as
there.

The mirror of the section and Maxwell and Betti let load and point change places, as in the plane: X_k(a, b; k) =
X_k(b, a; k). Mid-face is its own mirror image, so that functions over the face change places with the points. Samples
that are not symmetric show an error of the elements.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from base import Array, Integers, record
from fem.elasticity.flank_samples import sample_places
from fem.elasticity.free_ends import HalfFace, free_ends_across, half_face, over_cells
from fem.elasticity.line_load import flank_points
from fem.elasticity.prism import prism
from fem.elasticity.section import Face
from fem.influence.back_compliance import teeth_around
from fem.influence.flank_variable import FlankVariable
from fem.influence.gear_face import END_PLACES, ENDS_SIZES, PLACES, between_waves, section_of, solved_waves
from fem.influence.gear_shape import MeshedShape
from fem.influence.series import CrossSeries, FlankFit, of_teeth

__all__ = [
    "BackEndCorrection",
    "BackHarmonics",
    "back_end_correction",
    "back_harmonics",
]


@record
class BackHarmonics:
    """What waves of line load move back flanks beyond such loads without a wave, in modules and E*.

    Attributes
    ----------
    series : mapping of int to CrossSeries of (waves,)
        For each tooth, counted anticlockwise from the loaded one: X(k) - X(0) of the solved waves over the load's and
        the point's rho.
    error : float
        Largest asymmetry of the samples and what the series leave out.
    """

    series: Mapping[int, CrossSeries]
    error: float

    def across(self, tooth: Integers, load: Array, point: Array, wavenumber: Array) -> Array:
        """X(k) - X(0) of the right flank of a tooth by a load on the left flank of tooth 0 (..., waves).

        Parameters
        ----------
        tooth : (...) array of int
            Counted anticlockwise from the loaded one; 0 where it is too far away to feel the load.
        load, point : (...) arrays
            Curvature radii [modules].
        wavenumber : (waves,) array
            k [1/module].
        """
        weights = between_waves(wavenumber).T
        series = {
            number: CrossSeries(known.variable, known.coefficients @ weights)
            for number, known in self.series.items()
        }
        return of_teeth(series, tooth, load, point)


@record
class BackEndCorrection:
    """What free ends add to the motion of back flanks of a gear between walls, in modules and E*.

    Attributes
    ----------
    place : FlankVariable
    half : HalfFace
    cross : two arrays (teeth, places, places, psi, psi)
        Chebyshev coefficients over the load's and the point's rho, of loads that are equal and opposite on both halves;
        as many teeth on either side of the loaded one, clockwise ones first.
    error : float
        Largest asymmetry of the samples over the largest of them, and what the series leave out.
    """

    place: FlankVariable
    half: HalfFace
    cross: tuple[Array, Array]
    error: float

    def over(self, edges: Array) -> Mapping[int, CrossSeries]:
        """Put loads on cells between edges (cells + 1,), growing, from mid-face.

        Returns
        -------
        mapping of int to CrossSeries of (cells, cells)
            For each tooth, counted anticlockwise from the loaded one: means over cells by a unit force on a cell, of
            the load first [module per E* module^2 of force].
        """
        tables = over_cells(self.half, *self.cross, edges)
        return {
            tooth: CrossSeries(self.place, table) for tooth, table in enumerate(tables, -(len(tables) // 2))
        }


def back_harmonics(meshed: MeshedShape) -> BackHarmonics:
    """Solve a gear of module 1 and E* = 1 for waves along the face, and look at its back flanks."""
    over = section_of(meshed, meshed.sizes, meshed.refinements)
    teeth = teeth_around(over.mesh.teeth, meshed.shape.reach)
    rho = sample_places(meshed.shape.profile, PLACES)
    at, seen = (flank_points(over.mesh, rho, flank) for flank in ("left", "right"))
    _, wavenumber = solved_waves()
    by_wave = [prism(over, Face.wave(k)).across(at, seen, teeth)[:, :, 0, :, 0] for k in wavenumber]
    moved = np.stack(by_wave, axis=-1)  # (teeth, loads, points, waves)
    beyond = moved - moved[..., -1:]
    even = 0.5 * (beyond + np.swapaxes(beyond, 1, 2))
    place, fit = _fit(rho, 3 * PLACES // 4)
    coefficients = _coefficients(fit, even)
    error = max(float(np.max(np.abs(beyond - even))), _remainder(fit, coefficients, even))
    return BackHarmonics(
        {tooth: CrossSeries(place, table) for tooth, table in zip(teeth, coefficients, strict=True)},
        error,
    )


def back_end_correction(meshed: MeshedShape, face_width: float) -> BackEndCorrection:
    """Solve a gear of module 1 and E* = 1 with free ends, and look at its back flanks; its face width in modules."""
    over = section_of(meshed, ENDS_SIZES, 0)
    teeth = teeth_around(over.mesh.teeth, meshed.shape.reach)
    rho, half = sample_places(meshed.shape.profile, END_PLACES), half_face(0.5 * face_width, 1.0)
    at, seen = (flank_points(over.mesh, rho, flank) for flank in ("left", "right"))
    place, fit = _fit(rho, 2 * END_PLACES // 3)
    cross, error = [], 0.0
    for added in free_ends_across(over, half, at, seen, teeth):
        even = 0.5 * (added + np.transpose(added, (0, 2, 1, 4, 3)))
        cross.append(_coefficients(fit, even))
        off = max(float(np.max(np.abs(added - even))), _remainder(fit, cross[-1], even))
        error = max(error, off / float(np.max(np.abs(even))))
    return BackEndCorrection(place, half, (cross[0], cross[1]), error)


def _fit(rho: Array, degree: int) -> tuple[FlankVariable, FlankFit]:
    place = FlankVariable((float(rho[0]), float(rho[-1])))
    return place, FlankFit(place, place.unit(rho, hold=False), degree)


def _coefficients(fit: FlankFit, samples: Array) -> Array:
    """Coefficients (teeth, degree + 1, degree + 1, ...) of samples (teeth, loads, points, ...)."""
    by_degree = np.einsum("ai,bj,tij...->tab...", fit.weights, fit.weights, samples, optimize=True)
    return np.asarray(by_degree)


def _remainder(fit: FlankFit, coefficients: Array, samples: Array) -> float:
    """Largest distance of the samples from their series."""
    fitted = np.einsum("ia,jb,tab...->tij...", fit.basis, fit.basis, coefficients, optimize=True)
    return float(np.max(np.abs(fitted - samples)))
