"""Flanks of helical gears in mesh as strips along their lines of contact, and these lines with their forces.

Strips are closer together across the contact and follow its line over the flank, so that the pressures of the
quadrangles over their areas add up to the force of each cell.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, Integers, quantity, record
from base.results import EXACT
from fem.elasticity.flank_samples import CORNER_CLEARANCE
from fem.elasticity.plane_elasticity import MIRROR, reduced_modulus
from fem.fields.face_waves import on_flank
from fem.fields.flank_patches import FlankField, Place, PointCells, half_circle
from fem.fields.helix_solids import TwistedGear
from gears import half_width

if TYPE_CHECKING:
    from fem.cycle.line_loads import LineLoads
    from gears import ToothProfile

__all__ = ["LineField", "LineOnGear"]

BESIDE, ACROSS = 7, 16
"""Strips of a flank on either side of a contact, and across it."""

FLAT = 1e-9
"""Area of a quadrangle that is left out, in square modules."""


@record
class LineField(PointCells):
    """Lines of contact, a segment for each of their cells; each line is listed once for each gear.

    The forces of all segments of a gear add up to T/r_b along the line of action and to the axial force.
    """

    no_error = (
        "not estimated cell by cell; the cycle has errors of the largest line load and of the load's centre"
    )

    force_N: Array = quantity("N", "force on the gear of that row", "cell space")
    line_load_N_per_m: Array = quantity(
        "N/m", "normal force per length of the line; zero where flanks stand clear", "cell"
    )
    hertz_pressure_Pa: Array = quantity("Pa", "maximum Hertz pressure", "cell")
    half_width_m: Array = quantity("m", "half-width of the pressure", "cell")
    gap_m: Array = quantity("m", "gap left under load along the common normal", "cell")
    gear: Integers = quantity("1", "0 the pinion, 1 the wheel", "cell", no_error=EXACT)
    pair: Integers = quantity(
        "1",
        "base pitches ahead of the pair that entered last at mid-face",
        "cell",
        no_error=EXACT,
    )


@record
class LineOnGear:
    """One line of contact on one gear.

    Attributes
    ----------
    profile : ToothProfile
        Of the transverse section.
    gear : int
    column, pair, tooth : int
        Column of the cycle, base pitches ahead, and tooth counted anticlockwise.
    rho, z : (cells,) arrays
        Of the middles of its cells [m].
    length : float
        Of a cell along the axis [m].
    slope : float
        Change of rho by z.
    first_rho : float
        Of its first cell on an involute without end, beyond the path where that is.
    limits : (float, float)
        Between which flanks are touched [m]; without bounds where no cell is beyond the path.
    half_width, force, load, pressure, gap : (cells,) arrays
        Half-widths of tip edges are those of flanks at the ends of the path.
    edge : (cells,) boolean array
        Cells of tip edges.
    cosine : float
        cos(beta_b)
    """

    profile: ToothProfile
    gear: int
    column: int
    pair: int
    tooth: int
    rho: Array
    z: Array
    length: float
    slope: float
    first_rho: float
    limits: tuple[float, float]
    half_width: Array
    force: Array
    load: Array
    pressure: Array
    gap: Array
    edge: Booleans
    cosine: float

    @classmethod
    def of(cls, lines: LineLoads, row: int, column: int, gear: int, ahead: int) -> LineOnGear:
        """Line of a column of the cycle, `ahead` base pitches from the one that entered last."""
        used, cosine = np.isfinite(lines.z[row, column]), lines.pair.helix.base_cosine
        side = 1 - 2 * gear

        def cells(values: Array) -> Array:
            return np.asarray(values[row, column, used])

        load, edge = cells(lines.line_load), cells(lines.on_path) == 0.0
        beyond = bool(edge.any())
        modulus = reduced_modulus(lines.pair, lines.plane)
        return cls(
            profile=lines.pair.teeth_profiles[gear],
            gear=gear,
            column=column,
            pair=ahead,
            tooth=side * ahead,
            rho=cells(lines.rho[gear]),
            z=cells(lines.z),
            length=float(lines.length[row, column]) * cosine,
            slope=side * lines.slope,
            first_rho=float(cells(lines.unlimited_rho[gear])[0]),
            limits=tuple(lines.within(gear, np.array([-np.inf, np.inf])).tolist())
            if beyond
            else (-np.inf, np.inf),
            half_width=half_width(load, cells(lines.curvature_radius), modulus),
            force=cells(lines.force),
            load=load,
            pressure=cells(lines.hertz_pressure),
            gap=cells(lines.gap),
            edge=edge,
            cosine=cosine,
        )

    @property
    def ends(self) -> Array:
        """Ends of the cells along the face (cells + 1,) [m]."""
        return np.append(self.z - 0.5 * self.length, self.z[-1] + 0.5 * self.length)

    def segments(self, place: Place) -> LineField:
        """Its cells as segments on the unloaded flank."""
        ends, count = self.ends, len(self.z)
        points = self._on_flank(place, self._rho_at(ends), ends)
        # outward of the right flank in the plane, mirrored to the left one; a gear is pushed into its flank
        inward = place.each(-self.profile.normal(self.rho) * MIRROR, self.z)
        along_axis = self.slope * np.ones(count)
        across = self.force[:, None] * self.cosine
        return LineField(
            points,
            np.stack([np.arange(count), np.arange(1, count + 1)], axis=-1),
            across * np.column_stack([inward, along_axis]),
            self.load,
            self.pressure,
            self.half_width,
            self.gap,
            np.full(count, self.gear),
            np.full(count, self.pair),
        )

    def flank(self, place: Place, ready: TwistedGear, moved: Array, face: Array, cell: float) -> FlankField:
        """Quadrangles of the flank in the common frame.

        Parameters
        ----------
        place : Place
            Of the tooth.
        ready : TwistedGear
        moved : (nodes, functions, 3) array
            Of the tooth [m].
        face : (2,) array
            Ends of the gear's face [m].
        cell : float
            Length of a usual cell [m], as which the flank beside the line is divided.
        """
        z, line = self._along(face, cell)
        arcs, offset = self._strips(ready, z)
        rho = np.sqrt(2.0 * self.profile.base_radius * arcs)
        columns, strips = len(z) - 1, arcs.shape[1] - 1
        all_z = np.repeat(z, strips + 1)
        points = self._on_flank(place, rho.ravel(), all_z)
        corner = np.arange(strips) + (strips + 1) * np.arange(columns)[:, None]
        quads = np.stack([corner, corner + 1, corner + strips + 2, corner + strips + 1], axis=-1)
        area = _areas(points, quads)
        shown = area > FLAT * ready.module**2
        force = np.zeros((columns, strips))
        force[line] = self._forces(offset[line.start : line.stop + 1], shown[line])
        own = _displacements(ready, moved, rho.ravel(), all_z - float(face.mean()))

        def of_line(values: Array, elsewhere: float) -> Array:
            by_column = np.full(columns, elsewhere)
            by_column[line] = values
            return np.repeat(by_column[:, None], strips, axis=1)[shown]

        count = int(shown.sum())
        return FlankField(
            points,
            quads[shown],
            np.column_stack([place.each(own[:, :2], all_z), own[:, 2]]),
            force[shown] / area[shown],
            of_line(self.pressure, 0.0),
            of_line(self.load, 0.0),
            of_line(self.gap, np.nan),
            np.full(count, self.tooth),
            np.full(count, self.pair),
            of_line(self.edge.astype(np.float64), 0.0).astype(int),
        )

    def _rho_at(self, z: Array) -> Array:
        """Curvature radii of the line, beyond its ends those at the ends."""
        ends = self.ends
        along = np.clip(z, ends[0], ends[-1]) - self.z[0]
        return np.asarray(np.clip(self.first_rho + self.slope * along, *self.limits))

    def _on_flank(self, place: Place, rho: Array, z: Array) -> Array:
        """Points of the exact flank (n, 3) in the common frame."""
        section = self.profile.involute(rho) * MIRROR
        return np.column_stack([place.each(section, z) + place.centre, z])

    def _along(self, face: Array, cell: float) -> tuple[Array, slice]:
        """Ends of the columns along the face [m], and which columns are cells of the line."""
        ends = self.ends
        parts = []
        for start, stop in ((face[0], ends[0]), (ends[-1], face[1])):
            wide = stop - start > FLAT * (face[1] - face[0])
            count = max(1, round((stop - start) / cell)) if wide else 0
            parts.append(np.linspace(start, stop, count + 1))
        before, after = parts
        first = len(before) - 1
        return np.concatenate([before[:-1], ends, after[1:]]), slice(first, first + len(self.z))

    def _strips(self, ready: TwistedGear, z: Array) -> tuple[Array, Array]:
        """Arcs of the strips' edges on the involute at ends of columns, and their distance from the line [m]."""
        base, module = self.profile.base_radius, ready.module
        limits = (on_flank(ready.mesh, np.array([0.0, np.inf])).rho * module) ** 2 / (2.0 * base)
        half = max(float(self.half_width.max()), CORNER_CLEARANCE * module)
        middle = self._rho_at(z)[:, None] ** 2 / (2.0 * base)
        across = middle - half * np.cos(np.pi * np.arange(ACROSS + 1) / ACROSS)
        across = np.clip(across, *limits)
        part = np.arange(BESIDE) / BESIDE
        below = limits[0] + part * (across[:, :1] - limits[0])
        above = limits[1] - part[::-1] * (limits[1] - across[:, -1:])
        arcs = np.concatenate([below, across, above], axis=1)
        return arcs, arcs - middle

    def _forces(self, offset: Array, shown: Booleans) -> Array:
        """Force on every strip of every cell (cells, strips), by distances from the line at the cells' ends."""
        half = np.where(self.half_width > 0.0, self.half_width, 1.0)[:, None]
        parts = np.diff(half_circle(0.5 * (offset[1:] + offset[:-1]) / half), axis=1) * shown
        whole = parts.sum(axis=1, keepdims=True)
        loaded = self.force[:, None] > 0.0
        shares = np.divide(parts, whole, out=np.zeros_like(parts), where=loaded)
        return np.asarray(self.force[:, None] * shares)


def _areas(points: Array, quads: Integers) -> Array:
    """Of quadrangles (...) as viewers divide them: two triangles with the first corner."""
    a, b, c, d = (points[quads[..., k]] for k in range(4))
    halves = (np.cross(b - a, c - a), np.cross(c - a, d - a))
    return np.asarray(0.5 * sum(np.linalg.norm(half, axis=-1) for half in halves))


def _displacements(ready: TwistedGear, moved: Array, rho: Array, z: Array) -> Array:
    """Displacements (n, 3) of places of the flank, in their sections."""
    at = on_flank(ready.mesh, rho / ready.module)
    along = ready.pieces.values(z / ready.module)
    return np.asarray(np.einsum("nk,nkpa,np->na", at.weights, moved[at.nodes], along, optimize=True))
