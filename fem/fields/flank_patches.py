"""Flanks in mesh as strips along the face: pressures that add up to the forces, line loads and gaps of the cells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from base import Array, Integers, quantity, record
from base.results import EXACT
from fem.cycle.result import MeshCycle
from fem.elasticity.flank_samples import CORNER_CLEARANCE
from fem.elasticity.line_load import FlankPoints
from fem.elasticity.plane_elasticity import reduced_modulus
from fem.fields.face_waves import on_flank
from gears.pair.hertz import half_width
from gears.tooth.rotation import turned
from meshes import SectorMesh

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["FlankField", "FlankPatch", "Place", "PointCells", "half_circle", "joined"]

ALONG, ACROSS = 14, 16
"""Strips of a flank from the form circle to the tip, and more of them across a contact."""


@record
class PointCells:
    """Points in space, and cells with numbers of their points."""

    no_error = "not estimated: it is for pictures"

    points: Array = quantity("m", "unloaded position", "point space")
    cells: Integers = quantity("1", "points of each cell", "cell corner")


F = TypeVar("F", bound=PointCells)


@record
class FlankField(PointCells):
    """Flanks in mesh of one gear, as strips divided into cells: of the face, or of the lines of contact of a helix.

    The pressures of the strips over their areas add up to the force of each pair.
    """

    no_error = "not estimated: it is for pictures"

    displacement_m: Array = quantity("m", "elastic displacement, as of the solid", "point space")
    pressure_Pa: Array = quantity("Pa", "mean pressure over the quadrangle", "cell")
    hertz_pressure_Pa: Array = quantity(
        "Pa", "maximum Hertz pressure of the cell; nan where no two flanks touch", "cell"
    )
    line_load_N_per_m: Array = quantity("N/m", "line load of the cell, per length of its line", "cell")
    gap_m: Array = quantity(
        "m", "gap left under load along the normal at the cell; nan beside a line of contact", "cell"
    )
    tooth: Integers = quantity("1", "tooth, 0 in the pair that entered last, counted anticlockwise", "cell")
    pair: Integers = quantity("1", "base pitches ahead of the pair that entered last", "cell")
    tip_edge: Integers = quantity(
        "1", "1 where a tip edge presses, over a width that is assumed", "cell", no_error=EXACT
    )


@record
class Place:
    """Where a tooth stands: angle of its section at mid-face [rad], axis of its gear [m], and turn by z [rad/m]."""

    angle: float
    centre: Array
    twist: float = 0.0

    def points(self, plane: Array, z: Array) -> Array:
        """Points (layers n, 3) of a section (n, 2) at layers."""
        along = np.repeat(z, len(plane))
        if self.twist:
            at = self.each(np.tile(plane, (len(z), 1)), along) + self.centre
        else:
            at = np.tile(turned(plane, self.angle) + self.centre, (len(z), 1))
        return np.column_stack([at, along])

    def vectors(self, own: Array, z: Array) -> Array:
        """Vectors (layers, n, 3) of the tooth's section at layers, one after the other."""
        flat = own.reshape(-1, 3)
        if not self.twist:
            return np.column_stack([turned(flat[:, :2], self.angle), flat[:, 2]])
        return np.column_stack([self.each(flat[:, :2], np.repeat(z, own.shape[1])), flat[:, 2]])

    def each(self, vectors: Array, z: Array) -> Array:
        """Vectors (n, 2) of the tooth's section, each as it is turned at its z."""
        cosine, sine = np.cos(self.angle + self.twist * z), np.sin(self.angle + self.twist * z)
        x, y = vectors.T
        return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)


@record
class FlankPatch:
    """One flank of one gear: strips between radii, and cells of the face."""

    at: FlankPoints
    face: Array
    force: Array
    line_load: Array
    hertz: Array
    gap: Array
    column: int
    edge: bool
    module: float

    @classmethod
    def of(
        cls, pair: GearPair, cycle: MeshCycle, row: int, column: int, gear: int, mesh: SectorMesh
    ) -> FlankPatch:
        """Divide a flank of a pair, a column of the cycle, into strips, closer together across its contact."""
        assert cycle.face is not None
        load, edge = cycle.face.line_load[row, column], bool(cycle.edge[row, column])
        module, base = pair.module, pair.base_radii[gear]
        half = np.full(load.shape, CORNER_CLEARANCE * module)
        if not edge:
            radius = cycle.face.curvature_radius[row, column]
            half = half_width(load, float(radius), reduced_modulus(pair, cycle.plane))
        low, high = on_flank(mesh, np.array([0.0, np.inf])).rho * module
        ends = np.array([low, high]) ** 2 / (2 * base)
        middle = float(np.clip(cycle.flank_rho[gear][row, column] ** 2 / (2 * base), *ends))
        strips = np.linspace(ends[0], ends[1], ALONG + 1)
        if load.any():
            across = middle + half.max() * np.cos(np.pi * np.arange(ACROSS + 1) / ACROSS)
            strips = np.unique(np.clip(np.concatenate([strips, across]), *ends))
        within = np.where(half > 0.0, (strips[:, None] - middle) / np.where(half > 0.0, half, 1.0), 0.0)
        parts = np.diff(half_circle(within), axis=0)
        parts = np.divide(parts, parts.sum(axis=0), out=np.zeros_like(parts), where=load > 0.0)
        edges = np.linspace(-0.5, 0.5, len(load) + 1) * pair.face_width
        return cls(
            on_flank(mesh, np.sqrt(2 * base * strips) / module),
            edges,
            parts * load * np.diff(edges),
            load,
            cycle.face.hertz_pressure[row, column],
            cycle.face.gap[row, column],
            int(cycle.pair_offset[column]),
            edge,
            module,
        )

    def placed(self, place: Place, layers: Array, moved: Array, tooth: int) -> FlankField:
        """Quadrangles in the common frame; ``moved`` (layers, nodes, 3) of the tooth."""
        section = self.module * self.at.points
        strips, cells = self.force.shape
        own = np.einsum("pk,lpka->lpa", self.at.weights, moved[:, self.at.nodes], optimize=True)
        between = np.array(
            [np.interp(self.face, layers, component) for component in own.reshape(len(layers), -1).T]
        )
        points = place.points(section, self.face)
        corner = np.arange(strips) + (strips + 1) * np.arange(cells)[:, None]
        quads = np.stack([corner, corner + 1, corner + strips + 2, corner + strips + 1], axis=-1)
        # on the chords that are drawn, so that pressures over areas add up
        area = np.linalg.norm(np.diff(section, axis=0), axis=1)[:, None] * np.diff(self.face)

        def each(values: Array) -> Array:
            return np.repeat(values, strips)

        return FlankField(
            points,
            quads.reshape(-1, 4),
            place.vectors(between.T.reshape(cells + 1, strips + 1, 3), self.face),
            (self.force / area).T.ravel(),
            each(self.hertz),
            each(self.line_load),
            each(self.gap),
            np.full(strips * cells, tooth),
            np.full(strips * cells, self.column),
            np.full(strips * cells, int(self.edge)),
        )


def half_circle(place: Array) -> Array:
    """Part of the area of a semicircle up to a place, -1 to 1."""
    x = np.clip(place, -1.0, 1.0)
    return np.asarray(0.5 + (x * np.sqrt(1.0 - x**2) + np.arcsin(x)) / np.pi)


def joined(parts: Sequence[F]) -> F:
    """Fields of points and cells, such as several flanks, as one."""
    starts = np.cumsum([0, *(len(part.points) for part in parts[:-1])])
    moved = [replace(part, cells=part.cells + start) for part, start in zip(parts, starts, strict=True)]
    together = {
        field.name: np.concatenate([getattr(part, field.name) for part in moved])
        for field in fields(parts[0])
    }
    return replace(parts[0], **together)
