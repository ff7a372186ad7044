"""Compliance between the cells of the face of all pairs in contact, kept for loads and alignments that follow."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from base import Array, Booleans, Integers
from fem.contact.cell_coupling import CellCoupling
from fem.influence.gear_store import GearStore
from fem.pair.face_across import pair_ends_across, pair_waves_across, places_across
from fem.pair.face_compliance import pair_ends, pair_waves
from fem.pair.face_setting import FREE_ENDS, SLICES, FaceSetting
from fem.pair.unequal_widths import cosines, overhang, overhang_across

if TYPE_CHECKING:
    from fem.laws.contact_candidates import ContactCandidates
    from fem.pair.pair_compliance import PairCompliance

__all__ = [
    "cell_coupling",
    "cell_matrix",
    "coupled_by",
    "cross_coupling",
    "cross_matrix",
    "in_blocks",
    "kept_unless_large",
]

T = TypeVar("T")

MOST_KEPT = 8_000_000
"""Numbers of a compliance up to which it is kept."""

MOST_AT_ONCE = 4_000_000
"""Numbers of the compliance of all candidates, of which those that cannot touch are left out again."""


def cell_coupling(
    face: FaceSetting,
    bodies: PairCompliance,
    candidates: ContactCandidates,
    matrix: Array,
) -> CellCoupling:
    """Compliance of the bodies between cells of pairs that may touch, arguments as of ``cell_matrix``."""
    size = int(np.sum((candidates.touchable.sum(axis=-1) * face.cells) ** 2))

    def cut() -> CellCoupling:
        def matrices(of: slice) -> Array:
            return cell_matrix(face, bodies, candidates.rho[:, of], matrix[of])

        return in_blocks(matrices, candidates.touchable, face.cells)

    key = coupled_by(bodies, face, candidates.rho, candidates.touchable, matrix)
    return kept_unless_large("cells", key, size, cut)


def cross_coupling(
    face: FaceSetting,
    bodies: PairCompliance,
    back: bool,
    candidates: tuple[ContactCandidates, ContactCandidates],
    matrix: Array,
) -> tuple[Array, ...]:
    """Compliance between cells that may touch on the loaded side and on the other, of each position [m/N].

    Parameters
    ----------
    face : FaceSetting
    bodies : PairCompliance
    back : bool
        Whether back flanks are the loaded ones.
    candidates : (ContactCandidates, ContactCandidates)
        Of both sides, the loaded one first.
    matrix : (positions, pairs, others) array
        The plane's (``fem.contact.contact_sides.between``) [m/N].
    """
    loaded, other = candidates
    front, rear = (other, loaded) if back else (loaded, other)
    plane = np.swapaxes(matrix, 1, 2) if back else matrix
    cells = face.cells

    def cut() -> tuple[Array, ...]:
        blocks: list[Array] = []
        step = max(1, MOST_AT_ONCE // (plane[0].size * cells**2))
        for first in range(0, len(plane), step):
            of = slice(first, first + step)
            sides = front.at(of), rear.at(of)
            between = cross_matrix(face, bodies, *sides, plane[of])
            rows, columns = (_touching(side.touchable, cells) for side in sides)
            chosen = zip(between, rows, columns, strict=True)
            blocks += (each.take(row, axis=0).take(column, axis=1) for each, row, column in chosen)
        return tuple(block.T for block in blocks) if back else tuple(blocks)

    touching = [side.touchable.sum(axis=-1) * cells for side in (front, rear)]
    arrays = (array for side in (front, rear) for array in (side.rho, side.touchable))
    key = back, *coupled_by(bodies, face, plane, *arrays)
    return kept_unless_large("cells across", key, int(np.sum(touching[0] * touching[1])), cut)


def kept_unless_large(name: str, key: tuple[Any, ...], numbers: int, cut: Callable[[], T]) -> T:
    """What is put together for a key, kept for loads and alignments that follow unless it has too many numbers."""
    return cut() if numbers > MOST_KEPT else GearStore().over_face(name, key, cut)


def coupled_by(bodies: PairCompliance, face: FaceSetting, *arrays: Array | Booleans) -> tuple[Any, ...]:
    """What decides how a pair couples cells: gears, face, and arrays of the places."""
    laws, pair = (bodies.pinion.law.plane_modulus, bodies.wheel.law.plane_modulus), bodies.pair
    sizes = (pair.module, pair.face_width, pair.face_widths, pair.face_offsets, bodies.reach)
    return bodies.meshed, laws, sizes, face.coupled, *(array.tobytes() for array in arrays)


def _touching(touchable: Booleans, cells: int) -> tuple[Integers, ...]:
    """Cells of pairs that may touch at each position, among those of all pairs."""
    own = np.arange(cells)
    return tuple((np.flatnonzero(row)[:, None] * cells + own).ravel() for row in touchable)


def in_blocks(matrices: Callable[[slice], Array], touchable: Booleans, cells: int) -> CellCoupling:
    """What stands between the cells of pairs that may touch.

    Parameters
    ----------
    matrices : callable
        Matrices (k, n, n) between the cells of all pairs at k of the positions, as a slice.
    touchable : (positions, pairs) boolean array
    cells : int
    """
    chosen, (positions, pairs) = _touching(touchable, cells), touchable.shape
    blocks: list[Array] = []
    step = max(1, MOST_AT_ONCE // (pairs * cells) ** 2)
    for first in range(0, positions, step):
        of = slice(first, first + step)
        blocks += (
            matrix.take(at, axis=0).take(at, axis=1)
            for matrix, at in zip(matrices(of), chosen[of], strict=True)
        )
    return CellCoupling(chosen, tuple(blocks), pairs * cells)


def cell_matrix(
    face: FaceSetting,
    bodies: PairCompliance,
    rho: Array,
    matrix: Array,
    gears: Sequence[int] = (0, 1),
) -> Array:
    """Compliance of the bodies between cells of all pairs (positions, pairs cells, pairs cells) [m/N].

    Parameters
    ----------
    face : FaceSetting
    bodies : PairCompliance
    rho : (2, positions, pairs) array
        Curvature radii [m].
    matrix : (positions, pairs, pairs) array
        The plane's compliance [m/N].
    gears : sequence of int
        That yield beside that: 0 is the pinion, 1 the wheel.
    """
    cells, (positions, pairs), pair, modes = face.cells, matrix.shape[:2], bodies.pair, cosines(face.cells)
    by_mode = np.repeat(matrix[..., None], cells, axis=-1)
    if face.model != SLICES:
        by_mode[..., 1:] += pair_waves(bodies, rho, cells, face.strip, gears)
    compliance = np.einsum("mc,pijm,md->picjd", modes, cells * by_mode, modes, optimize=True)
    if face.model != SLICES:
        for gear in gears:
            if pair.face_widths[gear] != pair.face_width:
                compliance += overhang(bodies, gear, rho[gear], face)
    if face.model == FREE_ENDS:
        edges = face.edges(pair)
        first, second = (edges - offset for offset in pair.face_offsets)
        compliance += pair_ends(bodies, rho, (first, second), pair.face_widths, gears)
    size = pairs * cells
    return np.asarray(compliance.reshape(positions, size, size))


def cross_matrix(
    face: FaceSetting,
    bodies: PairCompliance,
    front: ContactCandidates,
    back: ContactCandidates,
    matrix: Array,
    gears: Sequence[int] = (0, 1),
) -> Array:
    """Compliance of the bodies between cells of front and back flanks (positions, pairs cells, others cells) [m/N].

    As ``cell_matrix`` between cells of one side: even loads are the plane's, waves and free ends are taken along the
    normals of the flanks, also at tip edges. The transpose is that of loads on back flanks.

    Parameters
    ----------
    face : FaceSetting
    bodies : PairCompliance
    front, back : ContactCandidates
        Of the pair, and of the mirrored gears.
    matrix : (positions, pairs, others) array
        The plane's compliance (``fem.contact.contact_sides.across``) [m/N].
    gears : sequence of int
        As of ``cell_matrix``.
    """
    cells, (positions, pairs, others), pair = face.cells, matrix.shape, bodies.pair
    model = SLICES if "coupling" in bodies.left_out else face.model
    modes = cosines(cells)
    by_mode = np.repeat(matrix[..., None], cells, axis=-1)
    teeth = (side.teeth[:, :positions] for side in (front, back))
    places = places_across(pair, front.rho, back.rho, *teeth)
    if model != SLICES:
        by_mode[..., 1:] += pair_waves_across(bodies, places, cells, gears)
    compliance = np.einsum("mc,pijm,md->picjd", modes, cells * by_mode, modes, optimize=True)
    if model != SLICES:
        for gear in gears:
            if pair.face_widths[gear] != pair.face_width:
                compliance += overhang_across(bodies, gear, places, face)
    if model == FREE_ENDS:
        edges = face.edges(pair)
        first, second = (edges - offset for offset in pair.face_offsets)
        compliance += pair_ends_across(bodies, places, (first, second), pair.face_widths, gears)
    return np.asarray(compliance.reshape(positions, pairs * cells, others * cells))
