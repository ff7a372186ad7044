"""Load sharing over pairs and cells of the face: the plane's equations with more unknowns.

Every pair's face is divided into equal cells. With F_ic the force on a cell and n of them, n F_ic is the force that the
whole face would bear at that line load, so that laws of the plane hold for it. With z the cells' middles, T the cosine
transform over the face and k_m = m pi/b,

    approach = n T^T diag(B_ij + W_ij(k_m)) T F_j + E_ij F_j + law(n F_i) + gap_i + g_c ,

B the plane's compliance, W what waves yield beyond it (``fem.gear_face``), E what free ends add. Modes of a tip edge,
whose law holds tooth and body, change by W as those of a flank at its corner do. One active set runs over all.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.cell_matrix import cell_coupling
from fem.face_setting import FREE_ENDS, WALLS
from fem.face_shafts import ShaftsUnderFace, shafts_under_face
from fem.flamant import hertz_half_width
from fem.local_law import Film, FilmLaw, PairLaws, film_yielding
from fem.wide_contact import shared_by_width

if TYPE_CHECKING:
    from fem.bodies import Compliance
    from fem.cell_coupling import CellCoupling
    from fem.contact_candidates import ContactCandidates
    from fem.face_setting import FaceSetting
    from fem.setting import Setting
    from gears import LoadShare

__all__ = ["FaceShare", "face_load_factors", "share_over_face", "yielding_over_face"]

LEFT = 0.6
"""Part of what twice as many cells changed that is left: all of it in the first order, a third in the second."""

FAR = 4.0
"""Times what neighbouring cells say of halving them that the change from half as many is believed."""

ENDS_ERROR = 0.1
"""Part of what free ends do that their coarse section leaves uncertain."""


@record
class CellLaws:
    """Laws of pairs, asked for the cells of their faces: (..., positions, pairs cells)."""

    whole: PairLaws | FilmLaw
    cells: int

    def approach(self, force: Array) -> Array:
        """Deflection [m]."""
        return self.value_and_slope(force)[0]

    def slope(self, force: Array) -> Array:
        """Its derivative [m/N]."""
        return self.value_and_slope(force)[1]

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Both together."""
        value, slope = self.whole.value_and_slope(self._together(force))
        return self._apart(value), self.cells * self._apart(slope)

    def _together(self, force: Array) -> Array:
        """Forces of whole faces at the cells' line loads (cells, ..., positions, pairs)."""
        return self.cells * np.moveaxis(force.reshape(*force.shape[:-1], -1, self.cells), -1, 0)

    def _apart(self, found: Array) -> Array:
        moved = np.moveaxis(found, 0, -1)
        return np.asarray(moved.reshape(*moved.shape[:-2], -1))


@record
class FaceShare:
    """Forces on cells.

    Attributes
    ----------
    forces : (torques, pitches, positions, pairs, cells) array
        [N]
    left : (torques, pitches, positions, pairs, cells) array
        Gap that is left under load [m]; where a cell bears, minus what the contact's own law yields.
    factor_error : (torques,) array
        Estimated error of the greatest face-load factor: what more cells would change there, and a part of what free
        ends do.
    stiffness_error : (torques,) array
        Estimated relative error of mean stiffness and deflection by the cells.
    shafts : ShaftsUnderFace or None
        None where they are rigid.
    """

    forces: Array
    left: Array
    factor_error: Array
    stiffness_error: Array
    shafts: ShaftsUnderFace | None

    @property
    def open(self) -> Array:
        """Least gap that is left along the face (torques, pitches, positions, pairs) [m]."""
        return np.asarray(self.left.min(axis=-1))


@record
class _Face:
    """What is shared over the face of whole pairs, arguments as of ``gears.share_load``."""

    given: Setting
    bodies: Compliance
    whole: Array
    where: ContactCandidates
    kappa: Array
    matrix: Array
    laws: PairLaws
    gaps: Array
    oil: FilmLaw | None
    levers: Array | None

    def shared(self, face: FaceSetting, near: Array) -> tuple[LoadShare, Array]:
        """Share over cells of a face, from forces of pairs on some parts of it (torques, ..., pairs, parts).

        And the gap that each cell is left with.
        """
        from gears.load_sharing import share_load

        cells, radius, unit = face.cells, self._radius, self.given.pair.face_width / face.cells
        apart = self.gaps[..., None] + face.gaps(self.given.pair, radius)
        apart = np.maximum(apart - apart.min(axis=(-2, -1), keepdims=True), 0.0)
        apart = np.where(self.where.touchable[..., None], apart, np.inf).reshape(*apart.shape[:-2], -1)
        film = None if self.oil is None else CellLaws(self.oil, cells)
        arms = None if self.levers is None else np.repeat(self.levers, cells, axis=-1)
        start, laws = _on_cells(near, cells), CellLaws(self.laws, cells)

        @lru_cache(maxsize=1)  # large ones are kept nowhere else
        def coupling(strip: float) -> CellCoupling:
            return cell_coupling(replace(face, strip=strip), self.bodies, self.where, self.kappa, self.matrix)

        def share(strip: float, some: Integers) -> LoadShare:
            return share_load(self.whole[some], coupling(strip), laws, apart, film, arms, start[some])

        def widest(found: LoadShare) -> Array:
            most = found.forces.reshape(*found.forces.shape[:-1], -1, cells).max(axis=-1)
            return self._half_widths(most / unit)

        mean = self._half_widths(near.sum(axis=-1) / self.given.pair.face_width)
        found, strips = shared_by_width(share, widest, unit, mean)
        bent = np.zeros_like(found.forces) + apart
        for strip in np.unique(strips):
            some = np.flatnonzero(strips == strip)
            forces = found.forces[some]
            every = np.ones(forces.shape[:-1], dtype=bool)
            bent[some] += coupling(float(strip)).applied(forces, every, np.zeros_like(forces))
        if film is not None:
            bent = bent - film.approach(np.zeros_like(found.forces))
        left = bent.reshape(*bent.shape[:-1], -1, cells) - found.transmission_error[..., None, None]
        return found, left

    @property
    def _radius(self) -> Array:
        rho1, rho2 = self.where.rho
        return np.asarray(rho1 * rho2 / (rho1 + rho2))

    def _half_widths(self, line_load: Array) -> Array:
        """Greatest half-widths of contacts of two flanks (torques,) [m] by line loads (torques, ..., pairs)."""
        flanks, modulus = self.where.touchable & ~self.where.edge, self.bodies.pinion.law.plane_modulus
        other = self.bodies.wheel.law.plane_modulus
        load = np.where(flanks, line_load / self.kappa, 0.0)
        radius = np.where(flanks, self._radius, 1.0)
        wide = hertz_half_width(load, radius, 2.0 / (1.0 / modulus + 1.0 / other))
        return np.asarray(wide.max(axis=(1, 2, 3)))

    def at(self, torque: int, pitch: int, position: int) -> _Face:
        """The same at a single torque and position."""
        one, where = slice(position, position + 1), self.where
        return replace(
            self,
            whole=self.whole[torque : torque + 1],
            where=replace(where, rho=where.rho[:, one], touchable=where.touchable[one], edge=where.edge[one]),
            kappa=self.kappa[one],
            matrix=self.matrix[one],
            laws=self.laws.at(position),
            gaps=self.gaps[pitch : pitch + 1, one],
            oil=None if self.oil is None else FilmLaw(self.oil.film, self.oil.rho1[one]),
            levers=None if self.levers is None else self.levers[one],
        )


def share_over_face(
    given: Setting,
    bodies: Compliance,
    whole: Array,
    where: ContactCandidates,
    kappa: Array,
    matrix: Array,
    laws: PairLaws,
    gaps: Array,
    oil: FilmLaw | None,
    levers: Array | None,
) -> tuple[LoadShare, FaceShare]:
    """Share forces over pairs and cells, arguments as of ``gears.share_load`` for whole faces.

    Returns
    -------
    LoadShare
        Of the pairs.
    FaceShare
        Of their cells.
    """
    from gears.load_sharing import LoadShare, share_load

    assert given.face is not None
    over = _Face(given, bodies, whole, where, kappa, matrix, laws, gaps, oil, levers)
    plane = share_load(whole, matrix, laws, gaps, oil, levers)
    cells = given.face.cells
    few = replace(given.face, cells=2 * (cells // 4))
    coarse, _ = over.shared(few, plane.forces[..., None])
    found, left = over.shared(given.face, coarse.forces.reshape(*plane.forces.shape, few.cells))
    forces, slopes = (one.reshape(*one.shape[:-1], -1, cells) for one in (found.forces, found.pair_stiffness))
    pairs = forces.sum(axis=-1)
    share = LoadShare(pairs, found.transmission_error, found.stiffness, slopes.sum(axis=-1), found.iterations)
    errors = _errors(over, given.face, found, few, coarse)
    shafts = shafts_under_face(given.face, given.pair)
    if shafts is not None:
        loads, by_slope = ((one / kappa[..., None]).sum(axis=-2) for one in (forces, slopes))
        share = shafts.measured_between(share, loads, by_slope)
    return share, FaceShare(forces, left, *errors, shafts)


def _errors(
    over: _Face, face: FaceSetting, found: LoadShare, few: FaceSetting, other: LoadShare
) -> tuple[Array, Array]:
    """Errors of every torque by half as many cells: of the greatest face-load factor, and relative of stiffness."""
    rest, kappa = LEFT / (face.cells / few.cells - 1), over.kappa[..., None]
    loads, fewer = (
        one.forces.reshape(*one.forces.shape[:-1], -1, on.cells) / kappa
        for one, on in ((found, face), (other, few))
    )
    factors, coarse = face_load_factors(loads), face_load_factors(fewer)
    stiffness = np.zeros(len(loads))
    for name in ("stiffness", "transmission_error"):
        fine, half = (getattr(one, name).mean(axis=(1, 2)) for one in (found, other))
        stiffness = np.maximum(stiffness, rest * np.abs(half / fine - 1.0))
    factor = np.zeros(len(loads))
    for torque, some in enumerate(factors):
        pitch, position = (int(k) for k in np.unravel_index(int(np.argmax(some)), some.shape))
        half = float(np.max(coarse[torque]))
        cells = loads[torque, pitch, position]
        settled = rest * abs(float(np.max(some)) - half)
        between = _between(cells[int(np.argmax(cells.sum(axis=-1)))])
        factor[torque] = np.clip(settled, between, FAR * between)
        if face.model == FREE_ENDS:
            at = over.at(torque, pitch, position)
            near = (fewer * kappa)[torque, pitch, position][None, None, None]
            share, _ = at.shared(replace(few, model=WALLS), near)
            walls = share.forces.reshape(1, -1, few.cells) / at.kappa[..., None]
            there = float(coarse[torque, pitch, position])
            factor[torque] += ENDS_ERROR * abs(there - float(face_load_factors(walls)[0]))
    return factor, stiffness


def _on_cells(near: Array, cells: int) -> Array:
    """Forces on cells (..., pairs cells) from those on fewer parts of the face: line loads between their middles."""
    parts = near.shape[-1]
    middles, asked = ((np.arange(count) + 0.5) / count for count in (parts, cells))
    hats = np.array([np.interp(asked, middles, hat) for hat in np.eye(parts)])
    line_load = near @ hats
    return np.asarray((line_load * (parts / cells)).reshape(*near.shape[:-2], -1))


def _between(cells: Array) -> float:
    """What halving changes of the greatest cell over their mean, by a parabola through three or at an end a line."""
    k = int(np.argmax(cells))
    if k in (0, len(cells) - 1):
        change = (cells[k] - cells[1 if k == 0 else k - 1]) / 4
    else:
        change = (2 * cells[k] - cells[k - 1] - cells[k + 1]) / 16
    return float(change / cells.mean())


def face_load_factors(forces: Array) -> Array:
    """Greatest force on a cell of the most loaded pair over that pair's mean (...) of forces (..., pairs, cells)."""
    most = np.argmax(forces.sum(axis=-1), axis=-1)[..., None, None]
    chosen = np.take_along_axis(forces, most, axis=-2)[..., 0, :]
    return np.asarray(chosen.max(axis=-1) / chosen.mean(axis=-1))


def yielding_over_face(film: Film, rho1: Array, forces: Array, shares: Array) -> Array:
    """What films of all cells yield beyond the transmission error (positions,) [m], see ``film_yielding``.

    Parameters
    ----------
    film : Film
        Of a whole face.
    rho1 : (positions, pairs) array
        Places [m]; nan where a pair is dry.
    forces : (positions, pairs, cells) array
        [N]
    shares : (positions, pairs) array
        Of the pairs, of the whole force.
    """
    positions, pairs, cells = forces.shape
    whole = forces.sum(axis=-1, keepdims=True)
    part = np.divide(forces, whole, out=np.zeros_like(forces), where=whole > 0.0)
    flat = (positions, pairs * cells)
    places = np.repeat(rho1, cells, axis=-1)
    return film_yielding(film, places, cells * forces.reshape(flat), (shares[..., None] * part).reshape(flat))
