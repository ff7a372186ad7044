"""Errors by the cells of a face and by its free ends: what half as many cells change, and how loads bend."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.influence.helix_ends import BETWEEN, FEWER, OFF_BY
from fem.pair.face_setting import FREE_ENDS, WALLS
from gears.sharing.mesh_arcs import Scatter

if TYPE_CHECKING:
    from fem.contact.cell_contact import CellContact
    from fem.contact.cell_share import CellShare
    from fem.pair.face_setting import FaceSetting
    from gears import LoadShare

__all__ = [
    "CellErrors",
    "cell_errors",
    "half_as_many",
    "no_errors",
]

LEFT = 1.0 / sqrt(3.0)
"""Part of what twice as many cells changed that is left of stiffness and deflection.

Every doubling changes about half as much as the one before, with a sign by chance: (1/4 + 1/16 + ...)^(1/2).
"""

ENDS_ERROR = 0.03
"""Part of what free ends do that their coarse sections leave uncertain, beside three-dimensional elements.

Of a displacement where the load stands 0.02. Of the root stress, by a separate section (``fem.influence.fillet_ends``)
and with what free ends do at most within two modules, 0.005 to 0.015; at the end itself under the end cell alone 0.03.
"""


@record
class CellErrors:
    """Errors by the cells of every torque, relative.

    Attributes
    ----------
    factor, line_load : (torques,) arrays
        Of the maximum face-load factor and the maximum line load.
    relative : (torques,) array
        Of stiffness and deflection at a position, root mean square over positions.
    ends : (torques,) array
        Further one of both from what free ends leave uncertain, alike at all positions.
    ends_scatter : dict of (3, torques) arrays
        As `scatter`, from what free ends of helical gears leave uncertain, but the most that it may move extremes and
        ranges; None of spur gears.
    scatter : dict of (3, torques) arrays
        As of ``gears.sharing.mesh_arcs.FewerCells``.
    centre : (torques,) array
        Of the centre of the load along the face, root mean square over positions [m].
    shafts, tilt, matrix : (torques,) arrays
        Of how far shafts give way, of their tilt, and of the mesh between bodies on them; 0 where they are rigid.
    """

    factor: Array
    line_load: Array
    relative: Array
    ends: Array
    scatter: Mapping[str, Array]
    centre: Array
    shafts: Array
    tilt: Array
    matrix: Array
    ends_scatter: Mapping[str, Array] | None = None

    def of(self, torque: int) -> dict[str, Scatter]:
        """Scatter of a single torque."""
        return _single(self.scatter, torque)

    def ends_of(self, torque: int) -> dict[str, Scatter] | None:
        """Scatter of a single torque by free ends; None of spur gears."""
        return None if self.ends_scatter is None else _single(self.ends_scatter, torque)


def _single(scatter: Mapping[str, Array], torque: int) -> dict[str, Scatter]:
    return {name: Scatter(*(float(size) for size in each[:, torque])) for name, each in scatter.items()}


def no_errors(torques: int) -> CellErrors:
    """Errors of loads that are even along the face, of a single cell: none."""
    none = np.zeros(torques)
    return CellErrors(none, none, none, none, {}, none, none, none, none)


def half_as_many(face: FaceSetting, helical: bool = False) -> tuple[FaceSetting, float]:
    """The face with half as many cells, and which part of what that changes is error.

    All of it on lines of contact: near their ends cells of the usual length do not yet change less by every doubling.
    """
    few = max(2 * (face.cells // 4), 2)  # two cells have no half: nobody asks for their error
    return replace(face, cells=few), (1.0 if helical else LEFT) / (max(face.cells / few, 2.0) - 1)


def cell_errors(over: CellContact, face: FaceSetting, fine: CellShare, coarse: CellShare) -> CellErrors:
    """Estimate errors of cycles with cells by those with half as many."""
    few, rest = half_as_many(face, over.helical)
    scatter, relative = {}, np.zeros(len(over.whole))
    curves = [_curves(over.whole, cell_share.share) for cell_share in (fine, coarse)]
    for name, curve in curves[0].items():
        change = rest * (curves[1][name] - curve)
        if name != "secant_stiffness":
            relative = np.maximum(relative, _size(change / curve))
        if name == "transmission_error" and fine.shafts is not None and coarse.shafts is not None:
            change = change + rest * (coarse.shafts.touch - fine.shafts.touch)
        scatter[name] = _scatter(change)
    each = [_load_errors(over, face, fine, coarse, torque) for torque in range(len(over.whole))]
    factor, line_load, ends = np.array(each).T
    centre = rest * _size(over.centre(fine.forces) - over.centre(coarse.forces))
    errors = CellErrors(
        factor, line_load, relative, ends, scatter, centre, *_shaft_errors(fine, coarse, rest)
    )
    doubtful = over.with_doubts(few, coarse) if face.model == FREE_ENDS else {}
    return with_doubts(over, errors, fine, coarse, doubtful) if doubtful else errors


def with_doubts(
    over: CellContact,
    errors: CellErrors,
    fine: CellShare,
    coarse: CellShare,
    doubtful: Mapping[str, CellShare],
) -> CellErrors:
    """Errors with those by free ends of helical gears: what doubts of them change with half as many cells.

    Parameters
    ----------
    over : CellContact
    errors : CellErrors
        By the cells alone.
    fine, coarse : CellShare
        With all cells, and with half as many.
    doubtful : mapping of str to CellShare
        With half as many, by doubts: ``fem.influence.helix_ends.OF_ENDS``. They are off by a part of these alone.
    """
    between, fewer = doubtful[BETWEEN], doubtful[FEWER]
    before, straight, less = (_curves(over.whole, each.share) for each in (coarse, between, fewer))
    scatter, varying, alike = {}, np.zeros(len(over.whole)), np.zeros(len(over.whole))
    for name, curve in before.items():
        change = (straight[name] - curve) / OFF_BY
        if name == "transmission_error" and coarse.shafts is not None and between.shafts is not None:
            change = change + (between.shafts.touch - coarse.shafts.touch) / OFF_BY
        scatter[name] = _bounds(change)
        if name != "secant_stiffness":
            part, whole = ((each[name] / curve - 1.0) / OFF_BY for each in (straight, less))
            varying = np.maximum(varying, _size(part - part.mean(axis=(1, 2), keepdims=True)))
            alike = np.maximum(alike, np.abs(whole.mean(axis=(1, 2))))
    centre = over.centre(coarse.forces)
    changes = [_size(over.centre(each.forces) - centre) / OFF_BY for each in (between, fewer)]
    own = _shaft_errors(coarse, between, 1.0 / OFF_BY)
    known = errors.shafts, errors.tilt, errors.matrix
    shafts, tilt, matrix = (np.hypot(each, of_ends) for each, of_ends in zip(known, own, strict=True))
    return replace(
        errors,
        factor=np.hypot(errors.factor, _of_largest(over, over.factors, coarse, between)),
        line_load=np.hypot(errors.line_load, _of_largest(over, over.largest, coarse, between)),
        relative=np.hypot(errors.relative, varying),
        ends=alike,
        centre=np.sqrt(sum(change**2 for change in (errors.centre, *changes))),
        shafts=shafts,
        tilt=tilt,
        matrix=matrix,
        ends_scatter=scatter,
    )


def _of_largest(
    over: CellContact, figure: Callable[[Array], Array], coarse: CellShare, between: CellShare
) -> Array:
    """Relative change of the largest of a figure of line loads (torques,), at least that at all positions.

    The change of the largest alone may vanish by chance.
    """
    changes = []
    for first, second in zip(coarse.forces, between.forces, strict=True):
        known, off = (figure(over.line_loads(forces)) for forces in (first, second))
        largest, everywhere = off.max() - known.max(), np.sqrt(np.mean((off - known) ** 2))
        changes.append(max(abs(float(largest)), float(everywhere)) / float(OFF_BY * known.max()))
    return np.array(changes)


def _bounds(change: Array) -> Array:
    """How far a change (torques, pitches, positions) may move an extreme, a range and a mean of a curve (3, torques).

    Wherever the extremes are: by its largest value, and by its own range.
    """
    flat = change.reshape(len(change), -1)
    return np.stack([np.abs(flat).max(axis=1), np.ptp(flat, axis=1), np.abs(flat.mean(axis=1))])


def _scatter(change: Array) -> Array:
    """Size of a change (torques, pitches, positions), of what varies of it, and of its mean (3, torques)."""
    varying, size = change - change.mean(axis=(1, 2), keepdims=True), _size(change)
    return np.stack([size, _size(varying), size / np.sqrt(_stretches(change))])


def _shaft_errors(fine: CellShare, coarse: CellShare, rest: float) -> Array:
    """Errors of what shafts do, of their tilt and of the mesh on them (3, torques), of the largest over positions."""
    if fine.shafts is None or coarse.shafts is None:
        return np.zeros((3, len(fine.forces)))
    fine_shafts, coarse_shafts = fine.shafts, coarse.shafts
    size = np.sqrt(_greatest(fine_shafts.mesh[..., 0, 0]) * _greatest(fine_shafts.mesh[..., 1, 1]))

    def error(first: Array, second: Array, over: Array | None = None) -> Array:
        change, most = rest * _greatest(second - first), _greatest(first) if over is None else over
        return np.divide(change, most, out=np.zeros_like(most), where=most > 0.0)

    return np.array(
        [
            error(fine_shafts.deflection, coarse_shafts.deflection),
            np.maximum(
                error(fine_shafts.tilt, coarse_shafts.tilt),
                error(fine_shafts.tilt_touch, coarse_shafts.tilt_touch),
            ),
            np.max(
                [
                    error(fine_shafts.mesh[..., 0, 0], coarse_shafts.mesh[..., 0, 0]),
                    error(fine_shafts.mesh[..., 1, 0], coarse_shafts.mesh[..., 1, 0], size),
                    error(fine_shafts.mesh[..., 1, 1], coarse_shafts.mesh[..., 1, 1]),
                ],
                axis=0,
            ),
        ]
    )


def _greatest(values: Array) -> Array:
    """Size over all but torques (torques,)."""
    return np.asarray(np.abs(values).reshape(len(values), -1).max(axis=1))


def _size(change: Array) -> Array:
    """Root mean square over pitches and positions (torques,)."""
    return np.asarray(np.sqrt(np.mean(change**2, axis=(1, 2))))


def _stretches(change: Array) -> Array:
    """Stretches of the mesh cycle in which a change (torques, pitches, positions) keeps its sign, at least one each.

    What changes by chance from one to the next is off in the mean by its size over the root of their number.
    """
    signs = np.sign(change.reshape(len(change), -1))
    return np.asarray(np.maximum(np.count_nonzero(signs != np.roll(signs, 1, axis=1), axis=1), 1))


def _curves(whole: Array, share: LoadShare) -> dict[str, Array]:
    """Curves of a cycle (torques, pitches, positions), deflection for transmission error."""
    moved = share.transmission_error
    return {"stiffness": share.stiffness, "transmission_error": moved, "secant_stiffness": whole / moved}


def _load_errors(
    over: CellContact, face: FaceSetting, fine: CellShare, coarse: CellShare, torque: int
) -> tuple[float, float, float]:
    """Errors of the maximum factor and line load, and that of stiffness and deflection by free ends."""
    loads, fewer = (over.line_loads(cell_share.forces[torque]) for cell_share in (fine, coarse))
    factors, half = over.factors(loads), over.factors(fewer)
    greatest, greatest_half = over.largest(loads), over.largest(fewer)
    ends, errors = 0.0, []
    for values, few_values, over_mean in ((factors, half, True), (greatest, greatest_half, False)):
        at, few_at = _place(values), _place(few_values)
        error = over.largest_error(loads, at, fewer, few_at, over_mean)
        if face.model == FREE_ENDS and not over.helical:
            free, held = coarse.share, _between_walls(over, face, coarse, torque, at)
            without = over.line_loads(held.forces[0])
            single = over.at(torque, *at)
            value = single.factors(without) if over_mean else single.largest(without)
            error += ENDS_ERROR * abs(float(few_values[at]) - float(value[0, 0])) / float(values[at])
            for name in ("stiffness", "transmission_error") if over_mean else ():
                apart = getattr(held.share, name)[0, 0, 0] / getattr(free, name)[torque, *at]
                ends = max(ends, ENDS_ERROR * abs(float(apart) - 1.0))
        errors.append(error)
    return errors[0], errors[1], ends


def _place(values: Array) -> tuple[int, int]:
    """Pitch and position of the maximum value."""
    pitch, position = np.unravel_index(int(np.argmax(values)), values.shape)
    return int(pitch), int(position)


def _between_walls(
    over: CellContact, face: FaceSetting, coarse: CellShare, torque: int, at: tuple[int, int]
) -> CellShare:
    """Half as many cells at one position without what free ends do."""
    few, _ = half_as_many(face)
    start = coarse.forces[torque, *at][None, None, None]
    return over.at(torque, *at).shared(replace(few, model=WALLS), start)
