"""Lines of contact of a helical pair before any load: how long they are at each position, and where on the flanks.

In the plane of action a line is inclined by the base helix angle: on the loaded flank of a right-handed pinion
rho1 = rho1(0) + z tan(beta_b), z = 0 at mid-face, and rho2 falls by as much. It touches where rho1 is between A and E.
Forces act along the common normal, inclined by beta_b to the transverse section, so that all levers and gaps along it
have the factor cos(beta_b).
"""

from __future__ import annotations

from dataclasses import replace
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, Integers, record
from fem.laws.tip_geometry import tangent_arm

if TYPE_CHECKING:
    from fem.laws.edges_of_lines import EdgesOfLines
    from fem.laws.relieved_lines import RelievedLines
    from gears import GearPair

__all__ = ["ContactLines", "LineCells", "contact_lines", "line_offsets", "part_on_path"]

SHORTEST = 1e-9
"""Part of the face below which a line does not touch."""

SHORT_CELL = 0.5
"""Of a cell's usual length, the face over their number: a shorter line is as stiff, per length, as one of that."""


@record
class LineCells:
    """Cells of lines of contact, equal ones of each line.

    Attributes
    ----------
    z : (positions, pairs, cells) array
        Middles along the face [m], 0 at mid-face; beyond a line's last cell those of further ones.
    rho : (2, positions, pairs, cells) array
        Curvature radii on pinion and wheel there [m].
    length : (positions, pairs) array
        Of a cell along the face [m].
    felt : (positions, pairs) array
        Length over which the bodies feel its load [m]: that of a line of one cell is never below ``SHORT_CELL`` of a
        usual cell, since the pressure of a line that begins is no strip of any length.
    used : (positions, pairs, cells) boolean array
        Cells that there are: the first ones of each line.
    """

    z: Array
    rho: Array
    length: Array
    felt: Array
    used: Booleans

    def largest_mean(self, forces: Array, window: float) -> Array:
        """Largest mean line load of each line over a length of it (..., positions, pairs) [N/m], per length of axis.

        Parameters
        ----------
        forces : (..., positions, pairs, cells) array
            On cells [N].
        window : float
            Length along the axis [m]; a shorter line counts with its whole force over it.
        """
        cells = forces.shape[-1]
        before = np.concatenate([np.zeros((*forces.shape[:-1], 1)), np.cumsum(forces, axis=-1)], axis=-1)
        place = np.arange(cells + 1) + (window / self.length)[..., None]
        whole = np.minimum(place.astype(int), cells - 1)
        here, force = (
            np.take_along_axis(values, np.broadcast_to(whole, (*forces.shape[:-1], cells + 1)), axis=-1)
            for values in (before, forces)
        )
        ahead = here + np.minimum(place - whole, 1.0) * force - before
        # the other way round, from the last cell back
        reached = np.maximum(np.arange(cells + 1) - (window / self.length)[..., None], 0.0)
        first = np.minimum(reached.astype(int), cells - 1)
        there, force = (
            np.take_along_axis(values, np.broadcast_to(first, (*forces.shape[:-1], cells + 1)), axis=-1)
            for values in (before, forces)
        )
        behind = before - there - (reached - first) * force
        return np.asarray(np.maximum(ahead, behind).max(axis=-1) / window)

    def faces(self, face_width: float, base_cosine: float) -> Array:
        """Force of a whole face [m] at a cell's load per length of the line, over the cell's (positions, pairs, cells).

        A cell of length h along the axis is h/cos(beta_b) long on its line.
        """
        faces = face_width * base_cosine / self.length
        return np.broadcast_to(faces[..., None], self.z.shape)

    @property
    def count(self) -> Integers:
        """Cells of each line (positions, pairs)."""
        return np.asarray(self.used.sum(axis=-1))


@record
class ContactLines:
    """Lines of contact of n positions.

    Attributes
    ----------
    start, stop : (n, pairs) arrays
        Where each line starts and ends along the face [m], 0 at mid-face; both 0 where it does not touch.
    middle : (n, pairs) array
        rho1 of each line at mid-face, beyond the path where it does not touch there [m].
    slope : float
        d rho1/dz.
    line_of_action : float
        rho1 + rho2 [m].
    face_width : float
        [m]
    edges : EdgesOfLines or None
        Tip edges beyond the path, up to which lines go on; None where they end at its ends.
    relieved : RelievedLines or None
        Where flanks with relief touch; None where they do so as involutes.
    """

    start: Array
    stop: Array
    middle: Array
    slope: float
    line_of_action: float
    face_width: float
    edges: EdgesOfLines | None = None
    relieved: RelievedLines | None = None

    def at(self, rows: slice) -> ContactLines:
        """Lines at some positions."""
        return replace(self, start=self.start[rows], stop=self.stop[rows], middle=self.middle[rows])

    @property
    def touches(self) -> Booleans:
        """Whether each line touches at all (n, pairs)."""
        return np.asarray(self.stop - self.start > SHORTEST * self.face_width)

    @property
    def place(self) -> Array:
        """rho1 in the middle of what touches of each line (n, pairs) [m]."""
        return np.asarray(self.middle + 0.5 * self.slope * (self.start + self.stop))

    @property
    def length(self) -> Array:
        """Of what touches along the face (n, pairs) [m]."""
        return np.asarray(self.stop - self.start)

    @property
    def length_on_path(self) -> Array:
        """Of what touches along the face between the ends of the path (n, pairs) [m]."""
        if self.edges is None:
            return np.where(self.touches, self.length, 0.0)
        low, high = self.edges.path
        ends = self.middle + self.slope * np.stack([self.start, self.stop])
        return np.asarray(np.ptp(np.clip(ends, low, high), axis=0) / abs(self.slope))

    def divided(self, cells: int) -> LineCells:
        """Divide every line into equal cells, of the length of `cells` on the whole face or a little less."""
        touches, length = self.touches, np.where(self.touches, self.length, self.face_width)
        count = np.where(touches, np.ceil(length / self.face_width * cells - 1e-9), 0).astype(int)
        each = length / np.maximum(count, 1)
        number = np.arange(cells)
        z = np.where(touches, self.start, 0.0)[..., None] + each[..., None] * (number + 0.5)
        used = number < count[..., None]
        felt = np.where(count == 1, np.maximum(each, SHORT_CELL * self.face_width / cells), each)
        return LineCells(z, self.rho(self._places(z, used)), each, felt, used)

    def places(self, cells: LineCells) -> Array:
        """rho1 of the unlimited involutes at cells [m], beyond the path at tip edges (positions, pairs, cells)."""
        return self._places(cells.z, cells.used)

    def on_path(self, cells: LineCells) -> Array:
        """Part of each cell between the ends of the path (positions, pairs, cells); 0 where there is none."""
        if self.edges is None:
            return cells.used.astype(np.float64)
        across = abs(self.slope) * cells.length[..., None]
        return np.where(cells.used, part_on_path(self.places(cells), across, self.edges.path), 0.0)

    def film_places(self, cells: LineCells) -> Array:
        """rho1 of films on cells [m], as many; nan of those beyond the path, which are dry."""
        if self.edges is None:
            return np.where(cells.used, self.places(cells), np.nan)
        place = np.clip(self.places(cells), *self.edges.path)
        return np.where(self.on_path(cells) > 0.0, place, np.nan)

    def _places(self, z: Array, used: Booleans) -> Array:
        rho1 = self.middle[..., None] + self.slope * z
        # cells that there are not have places, which are never used
        other = np.where(self.touches, self.place, 0.5 * self.line_of_action)
        return np.where(used, rho1, other[..., None])

    def rho(self, place: Array) -> Array:
        """Curvature radii where pinion and wheel touch at places of the line of action (2, ...) [m]."""
        if self.edges is None:
            rho = np.stack([place, self.line_of_action - place])
        else:
            rho = self.edges.rho(place, self.line_of_action)
        if self.relieved is None:
            return rho
        return np.where(self.relieved.on_flanks(place), self.relieved.rho(place), rho)

    def further_gaps(self, place: Array) -> Array:
        """Gaps at places of the line of action beyond what the flanks lack where they touch [m].

        Of tip edges and of relieved flanks; 0 of involutes.
        """
        gaps = np.zeros_like(place) if self.edges is None else self.edges.gaps(place)
        if self.relieved is None:
            return gaps
        return np.where(self.relieved.on_flanks(place), self.relieved.gaps(place), gaps)

    def levers(self, place: Array) -> Array:
        """Levers about both axes in the section, over base radii (2, ...); 1 of involutes."""
        levers = np.ones((2, *place.shape)) if self.edges is None else self.edges.levers(place)
        if self.relieved is None:
            return levers
        return np.where(self.relieved.on_flanks(place), self.relieved.levers(place), levers)

    def arms(self, place: Array, base_radii: tuple[float, float]) -> Array:
        """Distances from the feet of both axes on the normal to the contact (2, ...) [m], rho of involutes.

        Parameters
        ----------
        place : (...) array
            rho1 of the unlimited involutes [m].
        base_radii : (float, float)
            [m]
        """
        radii = np.reshape(base_radii, (2, *np.ones(place.ndim, dtype=int)))
        return tangent_arm(radii, self.rho(place), self.levers(place))

    def curvatures(self, place: Array) -> Array:
        """Of the flanks in the section over that of the involutes (...)."""
        return np.ones_like(place) if self.relieved is None else self.relieved.curvatures(place)

    def edge_touches(self, place: Array) -> Booleans:
        """Where a tip edge touches (...)."""
        return np.zeros(place.shape, dtype=bool) if self.edges is None else self.edges.beyond(place)


def part_on_path(place: Array, across: Array, ends: tuple[float, float]) -> Array:
    """Part of cells between the ends of the path; 0 of those beyond it, and 1 of all that end with it.

    Parameters
    ----------
    place : array
        rho1 of the unlimited involutes in their middles [m].
    across : array
        By how much rho1 changes over a cell [m].
    ends : (float, float)
        rho1 at the ends of the path [m].
    """
    start, end = ends
    before, after = (
        np.clip(0.5 + away / np.where(across > 0.0, across, end - start), 0.0, 1.0)
        for away in (place - start, end - place)
    )
    part = before + after - 1.0
    # cells that end with the path are whole but for rounding
    return np.asarray(np.where(part > 1.0 - 1e-9, 1.0, part))


def line_offsets(pair: GearPair, farther: float = 0.0) -> Integers:
    """Base pitches by which each line of a pair is ahead of the one that entered last at mid-face.

    Parameters
    ----------
    pair : GearPair
    farther : float
        Beyond the path, as far as lines may touch there [m].
    """
    beyond = 0.5 * pair.overlap_ratio + farther / pair.base_pitch
    return np.arange(-ceil(beyond), ceil(pair.contact_ratio + beyond))


def contact_lines(
    pair: GearPair,
    slope: float,
    ends: tuple[float, float],
    middle: Array,
    edges: EdgesOfLines | None = None,
    relieved: RelievedLines | None = None,
) -> ContactLines:
    """Lines of contact whose middles stand at some places.

    Parameters
    ----------
    pair : GearPair
        Helical.
    slope : float
        Change of rho1 by z along a line.
    ends : (float, float)
        rho1 at which contact starts and ends [m].
    middle : (n, pairs) array
        rho1 of each line at mid-face [m].
    edges : EdgesOfLines, optional
        Tip edges beyond the path, up to which lines go on.
    relieved : RelievedLines, optional
        Where flanks with relief touch.
    """
    (start, end), half = ends if edges is None else edges.reached, 0.5 * pair.face_width
    along = np.sort(np.stack([(start - middle) / slope, (end - middle) / slope]), axis=0)
    first, last = np.clip(along, -half, half)
    return ContactLines(first, last, middle, slope, pair.line_of_action, pair.face_width, edges, relieved)
