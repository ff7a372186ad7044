"""Contact of helical pairs: cells of all lines of contact, one active set over them.

Lines cross the flanks, so that every cell has its place, its curvature and its length. With F the force on a cell of
length h along the axis, its line load along the line is F cos(beta_b)/h, and by Hertz it approaches with the radius
rho1 rho2/((rho1 + rho2) cos(beta_b)).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Self

import numpy as np

from base import Array, Integers, record
from fem.contact.cell_contact import CellContact
from fem.contact.cell_coupling import CellCoupling
from fem.contact.cell_laws import WITHIN, LawOnLines, drops_within
from fem.contact.cell_matrix import coupled_by, kept_unless_large
from fem.contact.cell_share import CellShare
from fem.elasticity.flamant import hertz_half_width
from fem.influence.helix_ends import OF_ENDS, OFF_BY
from fem.laws.contact_candidates import SEEN_ALONG, line_gaps
from fem.laws.line_friction import further_levers
from fem.laws.local_law import FilmLaw, PairLaws
from fem.pair.line_compliance import FeltLine, GearLines, gear_lines
from fem.pair.line_shafts import PlacesOnLines, ShaftsUnderLines, shafts_under_lines
from fem.pair.wide_contact import shared_by_width

if TYPE_CHECKING:
    from fem.laws.line_candidates import ContactLines, LineCells
    from fem.laws.mesh_setup import MeshSetup
    from fem.pair.face_setting import FaceSetting
    from fem.pair.pair_compliance import PairCompliance
    from gears import LoadShare
    from gears.sharing.staying_contacts import JointLaw

__all__ = ["WINDOW", "LineContact"]

PEAK = 1.5
"""Half-width of the pressure where a line begins, over that of an even load: strips are as wide, so that slopes of
Hertz's law and short waves together stay definite."""

WIDE = 1.5
"""Half-widths of the pressure below which a line of one cell is felt over as much: it is no line any more."""

WINDOW = 0.5
"""Modules of a line over which the maximum line load is a mean: at ends of lines that of single cells goes with their
length."""


@record
class LineContact(CellContact):
    """What is shared over the lines of contact of a helical pair; attributes as of ``CellContact``."""

    @property
    def setup(self) -> MeshSetup:
        """With the loaded flanks."""
        return self.sides.setups[0]

    @property
    def lines(self) -> ContactLines:
        """Lines of contact at all positions."""
        lines = self.sides.flanks[0].candidates.lines
        assert lines is not None  # of a helical pair
        return lines

    def coupling(self, face: FaceSetting) -> CellCoupling:
        """Compliance of the bodies between cells of all lines."""
        if self.bodies.doubt in OF_ENDS:
            return self._off_by_ends(face)
        bodies, lines, cells = self.bodies, self.lines, self.lines.divided(face.cells)
        offset = self.sides.flanks[0].candidates.offset.tolist()
        module = self.pair.module
        own = [gear.own(rho) for gear, rho in zip((bodies.pinion, bodies.wheel), cells.rho, strict=True)]
        half_width = face.strip * self.pair.face_width / face.cells / module

        def cut() -> CellCoupling:
            gears = gear_lines(bodies, lines.slope, face.model)
            blocks = tuple(
                lines_compliance(bodies, gears, offset, cells, position, half_width)
                for position in range(len(lines.middle))
            )
            used = cells.used.reshape(len(blocks), -1)
            return CellCoupling(tuple(np.flatnonzero(row) for row in used), blocks, used.shape[1])

        key = coupled_by(bodies, face, lines.middle, np.array(_held_by(bodies)), *own)
        numbers = int(np.sum(cells.count.sum(axis=-1) ** 2))
        return kept_unless_large("lines", (lines.slope, *key), numbers, cut)

    def _off_by_ends(self, face: FaceSetting) -> CellCoupling:
        """The same with free ends off by a part of a doubt."""
        bodies, lines, cells = self.bodies, self.lines, self.lines.divided(face.cells)
        offset = self.sides.flanks[0].candidates.offset.tolist()
        sure = replace(self, bodies=bodies.doubtful(""))
        own = [gear.own(rho) for gear, rho in zip((bodies.pinion, bodies.wheel), cells.rho, strict=True)]

        def cut() -> CellCoupling:
            known = sure.coupling(face)
            solved = [gear_lines(each, lines.slope, face.model) for each in (bodies, sure.bodies)]
            blocks = []
            for position, block in enumerate(known.blocks):
                off, as_solved = (ends_compliance(bodies, each, offset, cells, position) for each in solved)
                blocks.append(block + OFF_BY * (off - as_solved))
            return CellCoupling(known.cells, tuple(blocks), known.unknowns)

        key = coupled_by(bodies, face, lines.middle, np.array(_held_by(bodies)), *own)
        numbers = int(np.sum(cells.count.sum(axis=-1) ** 2))
        return kept_unless_large("lines off", (lines.slope, bodies.doubt, *key), numbers, cut)

    def with_doubts(self, face: FaceSetting, coarse: CellShare) -> dict[str, CellShare]:
        """As of ``CellContact``: free ends off by ``OFF_BY`` of ``fem.influence.helix_ends.OF_ENDS``."""
        return {
            doubt: replace(self, bodies=self.bodies.doubtful(doubt)).shared(face, coarse.forces, coarse.rise)
            for doubt in OF_ENDS
        }

    def laws(self, face: FaceSetting) -> JointLaw:
        """Hertz's law of each cell; beside tip corners and at their edges that of their line loads in the section."""
        cells, cosine = self.lines.divided(face.cells), self.pair.helix.base_cosine
        flanks, positions = self.sides.flanks[0], len(cells.z)
        if self.lines.edges is not None and flanks.corner_laws is not None:
            whole, _ = flanks.corner_laws.at(flanks.candidates.on_cells(cells, cosine), tooth_apart=True)
            return LawOnLines(whole, cells.faces(self.pair.face_width, cosine).reshape(positions, -1))
        length = np.broadcast_to(cells.length[..., None], cells.z.shape) / cosine
        place = self.lines.places(cells)
        curvature = cosine * self.lines.curvatures(place)
        law = self.bodies.hertz(np.clip(place, *self.setup.ends), curvature, length)
        return PairLaws(
            replace(
                law,
                constant=law.constant.reshape(positions, -1),
                per_log=np.reshape(law.per_log, (positions, -1)),
            )
        )

    def levers(self, face: FaceSetting) -> tuple[Array, Array]:
        """As of ``CellContact``, and what friction adds in every cell.

        Forces at edges of the pinion stand on the wheel's flank, which shortens their lever; relief turns the normal.
        """
        reach, levers = super().levers(face)
        turned = self.lines.levers(self.lines.places(self.lines.divided(face.cells)))[0].reshape(reach.shape)
        further = further_levers(self.setup, self.lines, face.cells).reshape(levers.shape)
        return reach * turned, levers + np.repeat(self.sides.sign, face.cells) * further

    def tilts(self, face: FaceSetting) -> Array:
        """Places z of cells, moved along their lines to the pitch point (positions, n) [m]."""
        cells = self.lines.divided(face.cells)
        places = cells.z + (cells.rho[0] - self.pair.points.C) * self.pair.helix.base_tangent
        return np.where(cells.used, places, 0.0).reshape(len(cells.z), -1)

    def approach_and_tilt(self, face: FaceSetting, slopes: Array) -> Array:
        """Stiffness of the mesh between two bodies (..., 2, 2) of slopes of cells (2, ..., n), as of ``LineLoads``."""
        reach, _ = self.levers(face)
        moved = reach * np.stack([slopes, self.tilts(face) * slopes])
        matrix = np.moveaxis(moved.sum(axis=-1), (0, 1), (-2, -1))
        return np.asarray(0.5 * (matrix + np.swapaxes(matrix, -1, -2)))

    def shafts(self, face: FaceSetting) -> ShaftsUnderLines | None:
        """Shafts under the cells of all lines; None where both are rigid."""
        if not face.on_shafts:
            return None
        cells, seen = (self._places(self.lines.divided(number)) for number in (face.cells, SEEN_ALONG))
        return shafts_under_lines(face, self.pair, self.lines.slope, cells, seen)

    def _places(self, cells: LineCells) -> PlacesOnLines:
        """Middles of cells, line after line, and the gaps there without load."""
        gaps, flat = self._gaps_at(cells.z, self.lines.places(cells)), (len(cells.z), -1)
        length = np.where(cells.used, cells.length[..., None], 0.0)
        return PlacesOnLines(
            cells.z.reshape(flat),
            cells.rho.reshape(2, *flat),
            cells.used.reshape(flat),
            length.reshape(flat),
            gaps.reshape(-1, len(cells.z), cells.z[0].size),
        )

    def films(self, face: FaceSetting) -> JointLaw | None:
        """Films of cells, each under its line load along the line; None where they are dry.

        Tip edges are dry: of a cell that ends beyond the path the film counts by the part on it, so that none comes at
        once.
        """
        oil = self.sides.flanks[0].oil
        if oil is None:
            return None
        cells, pair, positions = self.lines.divided(face.cells), self.pair, len(self.lines.middle)
        shape = (positions, -1)
        part = None if self.lines.edges is None else self.lines.on_path(cells).reshape(shape)
        return LawOnLines(
            FilmLaw(oil.film, self.lines.film_places(cells).reshape(shape)),
            cells.faces(pair.face_width, pair.helix.base_cosine).reshape(shape),
            part,
        )

    def spread(self, face: FaceSetting, near: Array) -> Array:
        """Spread forces evenly over the cells of each line; arguments as of ``CellContact``."""
        cells = self.lines.divided(face.cells)
        each = near.sum(axis=-1) / np.maximum(cells.count, 1)
        return np.asarray(each[..., None] * cells.used)

    @property
    def even(self) -> Array:
        """Forces on the lines (..., lines, 1) by one line load at all of them [N]."""
        lines = self.lines
        length = np.where(lines.touches, lines.length, 0.0)
        share = length / length.sum(axis=-1, keepdims=True) / self.pair.helix.base_cosine
        return np.asarray((self.whole[..., None] * share)[..., None])

    def by_width(
        self, face: FaceSetting, near: Array, share: Callable[[float, Integers], LoadShare]
    ) -> tuple[LoadShare, Array]:
        """Share all torques: lines as narrow as usual serve all of them, wider ones get strips by powers of two.

        Still wider ones where short waves of load beside a tip corner are not definite.
        """
        lines, unit = self.lines, self.pair.face_width / face.cells
        length = np.where(lines.touches, lines.length, 0.0).sum(axis=-1)
        load = (self.whole / length).reshape(len(self.whole), -1).mean(axis=-1)
        modulus = 2.0 / sum(1.0 / gear.law.plane_modulus for gear in (self.bodies.pinion, self.bodies.wheel))
        cosine = self.pair.helix.base_cosine
        radius = np.full_like(load, np.median(self.sides.radius[lines.touches]) / cosine)
        width = PEAK * hertz_half_width(load, radius, modulus)
        return shared_by_width(share, lambda load_share: np.zeros(len(load_share.forces)), unit, width)

    def line_loads(self, forces: Array) -> Array:
        """Line loads times the face width (..., lines, cells) [N] of forces on cells."""
        cells = self.lines.divided(forces.shape[-1])
        return np.asarray(forces * (self.pair.face_width / cells.length[..., None]))

    def largest(self, loads: Array) -> Array:
        """Largest mean of line loads over half a module of a line (...); arguments as of ``CellContact``."""
        cells = self.lines.divided(loads.shape[-1])
        forces = loads * (cells.length[..., None] / self.pair.face_width)
        largest = cells.largest_mean(forces, WINDOW * self.pair.module * self.pair.helix.base_cosine)
        return np.asarray(largest.max(axis=-1) * self.pair.face_width)

    def factors(self, loads: Array) -> Array:
        """Load factors (...): that over the mean of all lines."""
        length = self.lines.divided(loads.shape[-1]).length[..., None]
        touches = self.lines.length_on_path.sum(axis=-1)
        return np.asarray(self.largest(loads) / (np.sum(loads * length, axis=(-2, -1)) / touches))

    def largest_error(
        self, loads: Array, at: tuple[int, int], fewer: Array, few_at: tuple[int, int], over_mean: bool
    ) -> float:
        """Relative error of a maximum: all that half as many cells change."""
        value = self.factors if over_mean else self.largest
        return abs(float(value(fewer)[few_at] / value(loads)[at]) - 1.0)

    def centre(self, forces: Array) -> Array:
        """Centre of the load along the face (...) [m] of forces (..., lines, cells)."""
        z = self.lines.divided(forces.shape[-1]).z
        return np.asarray(np.sum(forces * z, axis=(-2, -1)) / forces.sum(axis=(-2, -1)))

    def gap_drops(self, face: FaceSetting, coarse: CellShare) -> Array:
        """By how much the minimum gap of cells falls short of their mean (torques, ..., lines, cells) [m]."""
        cells, before = self.lines.divided(face.cells), self.lines.divided(coarse.bends.shape[-1])
        slope = _slopes(coarse.bends, before, cells)
        within = np.arange(WITHIN + 1) / WITHIN - 0.5
        gaps = self.pair.helix.base_cosine * self._gaps_within(cells, within)
        return np.where(cells.used, drops_within(gaps + slope[..., None] * within), 0.0)

    def _apart(self, face: FaceSetting) -> Array:
        """Gaps without load, beyond where the first place touches (pitches, positions, lines cells) [m]."""
        cells = self.lines.divided(face.cells)
        gaps = self._gaps_within(cells, np.array([-0.5, 0.0, 0.5])) @ np.array([1.0, 4.0, 1.0]) / 6.0
        nearest = self.sides.flanks[0].candidates.gap.min(axis=-1)
        apart = self.pair.helix.base_cosine * np.maximum(gaps - nearest[..., None, None], 0.0)
        apart = apart * self.lines.levers(self.lines.places(cells))[0]
        return np.where(cells.used, apart, np.inf).reshape(*apart.shape[:-2], -1)

    def _gaps_within(self, cells: LineCells, within: Array) -> Array:
        """Gaps in the section at places of every cell (pitches, positions, lines, cells, places) [m], -1/2 to 1/2."""
        along = cells.length[..., None, None] * within
        place = self.lines.places(cells)[..., None] + self.lines.slope * along
        flat = (*cells.z.shape[:2], -1)
        gaps = self._gaps_at((cells.z[..., None] + along).reshape(flat), place.reshape(flat))
        return gaps.reshape(-1, *place.shape)

    def _gaps_at(self, z: Array, place: Array) -> Array:
        """Gaps in the section at places of each line, by its teeth (pitches, positions, lines, places) [m]."""
        candidates = self.sides.flanks[0].candidates
        teeth = candidates.teeth.reshape(2, -1, *z.shape[:2])
        rolling = self.setup.rolling_gap(self.lines.middle)
        gaps = line_gaps(self.setup, z, self.lines.rho(place), teeth) + rolling[..., None]
        return gaps + self.lines.further_gaps(place)

    def at(self, torque: int, pitch: int, position: int) -> Self:
        """The same at a single torque and position, with the teeth that meet there."""
        (flanks,), teeth = self.sides.flanks, self.sides.flanks[0].candidates.teeth
        single = super().at(torque, pitch, position)
        (there,) = single.sides.flanks
        number = pitch * len(flanks.candidates.place) + position
        candidates = replace(there.candidates, teeth=teeth[:, number : number + 1])
        return replace(single, sides=replace(single.sides, flanks=(replace(there, candidates=candidates),)))


def _slopes(bends: Array, before: LineCells, cells: LineCells) -> Array:
    """By how much bends (..., lines, parts) of some cells rise over each of others (..., lines, cells) [m]."""
    count = before.count
    last = np.maximum(count - 2, 0)[..., None]
    step = np.diff(bends, axis=-1, append=bends[..., -1:])
    # steps between neighbours; where a line has one cell only, none
    place = (np.arange(cells.z.shape[-1]) + 0.5) / np.maximum(cells.count, 1)[..., None] * count[..., None]
    at = np.clip(np.floor(place - 0.5).astype(int), 0, last)
    per_part = np.take_along_axis(step, np.broadcast_to(at, (*bends.shape[:-1], at.shape[-1])), axis=-1)
    ratio = np.where(count > 1, count / np.maximum(cells.count, 1), 0.0)[..., None]
    return np.asarray(per_part * ratio)


def lines_compliance(
    bodies: PairCompliance,
    gears: Sequence[GearLines],
    offset: Sequence[int],
    cells: LineCells,
    position: int,
    half_width: float,
) -> Array:
    """Compliance of both bodies between the used cells of all lines at a position (n, n) [m/N], but for local laws.

    Parameters
    ----------
    bodies : PairCompliance
    gears : two GearLines
    offset : sequence of int
        Base pitches by which each line is ahead.
    cells : LineCells
    position : int
    half_width : float
        Of the pressure, in modules.
    """

    def between(solved: GearLines, load: FeltLine, point: FeltLine) -> Array:
        return solved.between(load, point, half_width)

    compliance = _of_gears(bodies, gears, offset, cells, position, half_width, between)
    # what hubs and supports move all teeth by, by the part of the normal force across the axis
    return compliance + _held_by(bodies) * bodies.pair.helix.base_cosine**2


def ends_compliance(
    bodies: PairCompliance,
    gears: Sequence[GearLines],
    offset: Sequence[int],
    cells: LineCells,
    position: int,
) -> Array:
    """What of ``lines_compliance`` free ends of both gears add (n, n) [m/N]; arguments as there."""
    return _of_gears(bodies, gears, offset, cells, position, 0.0, GearLines.by_ends)


def _of_gears(
    bodies: PairCompliance,
    gears: Sequence[GearLines],
    offset: Sequence[int],
    cells: LineCells,
    position: int,
    half_width: float,
    between: Callable[[GearLines, FeltLine, FeltLine], Array],
) -> Array:
    """Sum over both gears of what stands between the used cells of all lines (n, n) [m/N]."""
    count, module = cells.count[position], bodies.pair.module
    chosen = np.flatnonzero(count).tolist()
    ends = np.concatenate([[0], np.cumsum(count[chosen])])
    compliance = np.zeros((ends[-1], ends[-1]))
    half = 0.5 * bodies.pair.face_width
    single = np.where(count == 1, WIDE * half_width * module, 0.0)
    felt = 0.5 * np.maximum(cells.felt[position], single)
    for gear, solved in enumerate(gears):
        lines = [
            solved.line(
                int(offset[line]),
                np.clip(cells.z[position, line, : count[line]], felt[line] - half, half - felt[line]),
                cells.rho[gear, position, line, : count[line]],
                2.0 * felt[line],
            )
            for line in chosen
        ]
        for i, load in enumerate(lines):
            own = slice(ends[i], ends[i + 1])
            compliance[own, own] += between(solved, load, load)
            for j, point in enumerate(lines[:i]):
                other = slice(ends[j], ends[j + 1])
                moved = between(solved, load, point)
                compliance[own, other] += moved
                compliance[other, own] += moved.T
    return compliance


def _held_by(bodies: PairCompliance) -> float:
    """What hubs and supports move all teeth by along the transverse line of action [m/N]."""
    return sum(bodies.support) + sum(bodies.step_windup)
