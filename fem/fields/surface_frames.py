"""One position of the loaded pair as surfaces: where the teeth in mesh stand, how they move, their stress, the load.

Made from the blocks that are written for ParaView, of a run or read back from its files; nothing is solved again.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.distance import cdist

from base import Array, Integers, record
from fem.fields.paraview_state import FILLET
from fem.fields.tooth_surfaces import ToothSurface, lean, tooth_surface, turned_to

if TYPE_CHECKING:
    import pyvista

__all__ = ["ContactLoads", "GearSurface", "SurfaceFrame", "Surfaces"]

BESIDE = 2
"""Teeth of plane gears that are shown on either side of those in contact; solids have fewer."""

GEARS = ("pinion", "wheel")


@record
class GearSurface:
    """Teeth of one gear, copies of one surface.

    Attributes
    ----------
    first : int
        Number of the first tooth.
    angles : (teeth,) array
        Of the teeth [rad], 0 along +y.
    displacement : (teeth, values, 3) array
        In each tooth's frame [m].
    von_mises : (teeth, values) array or None
        [Pa]; None of solids, whose stress is not found.
    """

    first: int
    angles: Array
    displacement: Array
    von_mises: Array | None


@record
class ContactLoads:
    """Line loads on the wheel, a straight piece of a line of contact each.

    Attributes
    ----------
    ends : (pieces, 2, 3) array
        [m]
    moved : (pieces, 2, 3) array
        Displacement of the wheel there [m].
    load : (pieces, 3) array
        Force per length of the line [N/m].
    """

    ends: Array
    moved: Array
    load: Array


@record
class SurfaceFrame:
    """Both gears and their contact at one position.

    Attributes
    ----------
    gears : tuple of GearSurface
        Pinion and wheel.
    contacts : ContactLoads
    fillet_stress : float
        Maximum von Mises stress between root and form circle of the teeth shown [Pa]; nan without stress.
    """

    gears: tuple[GearSurface, GearSurface]
    contacts: ContactLoads
    fillet_stress: float


@record
class Surfaces:
    """Surfaces of a pair, for any number of positions.

    Attributes
    ----------
    teeth : tuple of ToothSurface
        Pinion and wheel.
    wheel_centre : (2,) array
        [m]
    face_width : float
        [m]
    """

    teeth: tuple[ToothSurface, ToothSurface]
    wheel_centre: Array
    face_width: float

    @classmethod
    def of(
        cls, grids: Mapping[str, pyvista.UnstructuredGrid], wheel_centre: Array, face_width: float
    ) -> Surfaces:
        """Surfaces of the teeth of one position's blocks; arguments as of the attributes."""
        pinion = tooth_surface(grids["pinion"], np.zeros(2), face_width)
        return cls(
            (pinion, tooth_surface(grids["wheel"], wheel_centre, face_width)), wheel_centre, face_width
        )

    def frame(self, grids: Mapping[str, pyvista.UnstructuredGrid]) -> SurfaceFrame:
        """Take the surfaces' values from the blocks of a position."""
        pinion, wheel = (
            _gear(grids, gear, surface, centre)
            for gear, (surface, centre) in enumerate(
                zip(self.teeth, (np.zeros(2), self.wheel_centre), strict=True)
            )
        )
        fillets = [_fillet_stress(grids, gear) for gear in (0, 1)]
        return SurfaceFrame((pinion, wheel), _contacts(grids, self.face_width), max(fillets))


def _gear(
    grids: Mapping[str, pyvista.UnstructuredGrid], gear: int, surface: ToothSurface, centre: Array
) -> GearSurface:
    """Values of the teeth of one gear that are shown."""
    grid = grids[GEARS[gear]]
    cells, tooth = grid.cell_connectivity.reshape(grid.n_cells, -1), np.asarray(grid["tooth"])
    points = np.asarray(grid.points, dtype=float) - np.append(centre, 0.0)
    moved = np.asarray(grid["displacement_m"], dtype=float)
    stress = np.asarray(grid["von_mises_Pa"], dtype=float) if "von_mises_Pa" in grid.point_data else None
    numbers, counts = np.unique(tooth, return_counts=True)
    shown = _shown(grids, gear, numbers)

    def of_tooth(number: int) -> Integers:
        """Points of a tooth follow each other."""
        own = cells[tooth == number]
        return np.arange(own.min(), own.max() + 1)

    nodes = [of_tooth(number) for number in shown]
    alike = int(numbers[np.argmin(counts)])
    middle = lean(points[of_tooth(alike)])
    # sectors of the plane are of a whole gear, and those in contact have other points; those of solids are all alike
    whole = "contacts" in grids
    angles = [
        middle + (number - alike) * 2.0 * np.pi / len(numbers) if whole else lean(points[own])
        for number, own in zip(shown, nodes, strict=True)
    ]
    at = [own[surface.sources(points[own], angle)] for own, angle in zip(nodes, angles, strict=True)]
    return GearSurface(
        shown[0],
        np.array(angles),
        np.stack([turned_to(moved[of], -angle) for of, angle in zip(at, angles, strict=True)]),
        None if stress is None else np.stack([stress[of] for of in at]),
    )


def _shown(grids: Mapping[str, pyvista.UnstructuredGrid], gear: int, numbers: Integers) -> list[int]:
    """Numbers of the teeth that are shown: of a whole gear those in contact and some beside them, else all."""
    if "contacts" not in grids:
        return [int(number) for number in numbers]
    # 0 is the pair that entered last, where nothing carries load
    loaded = np.append(np.asarray(grids["contacts"]["pair"]), 0) * (1 if gear == 0 else -1)
    return [int(number) for number in numbers if loaded.min() - BESIDE <= number <= loaded.max() + BESIDE]


def _fillet_stress(grids: Mapping[str, pyvista.UnstructuredGrid], gear: int) -> float:
    """Maximum von Mises stress [Pa] of the fillets of a gear, without cells whose stress is only indicative."""
    grid = grids[GEARS[gear]]
    if "von_mises_Pa" not in grid.point_data:
        return float("nan")
    cells = grid.cell_connectivity.reshape(grid.n_cells, -1)
    fillet = (np.asarray(grid["region"]) == FILLET) & (np.asarray(grid["indicative"]) == 0)
    return float(np.asarray(grid["von_mises_Pa"])[cells[fillet]].max())


def _contacts(grids: Mapping[str, pyvista.UnstructuredGrid], width: float) -> ContactLoads:
    """Loads on the wheel, by the blocks that hold them: points of the plane, lines of a helix, strips of flanks."""
    if "contacts" in grids:
        ends, load = _of_plane(grids["contacts"], width)
    elif "lines" in grids:
        ends, load = _of_lines(grids["lines"])
    else:
        ends, load = _of_flanks(grids["pinion_flanks"])
    wheel = grids["wheel" if "contacts" in grids else "wheel_flanks"]
    places = np.asarray(wheel.points, dtype=float)
    at = ends.reshape(-1, 3) * ([1.0, 1.0, 0.0] if "contacts" in grids else 1.0)
    nearest = cdist(at, places, "sqeuclidean").argmin(axis=1)
    moved = np.asarray(wheel["displacement_m"], dtype=float)[nearest]
    return ContactLoads(ends, moved.reshape(ends.shape), load)


def _of_plane(contacts: pyvista.UnstructuredGrid, width: float) -> tuple[Array, Array]:
    """Lines over the whole face, and their even loads."""
    on_wheel = np.asarray(contacts["gear"]) == 1
    points = np.asarray(contacts.points, dtype=float)[on_wheel]
    half = np.array([0.0, 0.0, 0.5 * width])
    return np.stack([points - half, points + half], axis=1), np.asarray(contacts["force_N"])[on_wheel] / width


def _of_lines(lines: pyvista.UnstructuredGrid) -> tuple[Array, Array]:
    """Segments that carry load, of the wheel."""
    force = np.asarray(lines["force_N"], dtype=float)
    chosen = (np.asarray(lines["gear"]) == 1) & (np.linalg.norm(force, axis=1) > 0.0)
    ends = np.asarray(lines.points, dtype=float)[lines.cell_connectivity.reshape(-1, 2)[chosen]]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    return ends, force[chosen] / length[:, None]


def _of_flanks(flanks: pyvista.UnstructuredGrid) -> tuple[Array, Array]:
    """Cells of the face that carry load, from the pressures on the pinion's flanks, each at its pressure's middle."""
    corners = np.asarray(flanks.points, dtype=float)[flanks.cell_connectivity.reshape(-1, 4)]
    middle = corners.mean(axis=1)
    area = 0.5 * np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    # the pinion pushes the wheel the way it turns, anticlockwise
    ahead = area[:, 1] * middle[:, 0] - area[:, 0] * middle[:, 1]
    force = np.asarray(flanks["pressure_Pa"])[:, None] * area * np.sign(ahead)[:, None]
    size = np.linalg.norm(force, axis=1)
    low, high = corners[:, :, 2].min(axis=1), corners[:, :, 2].max(axis=1)
    cell = np.rint(middle[:, 2] / np.median(high - low) * 2.0)
    _, first, of = np.unique(
        np.column_stack([flanks["pair"], cell]), axis=0, return_index=True, return_inverse=True
    )
    of = of.ravel()
    total = np.bincount(of, size)
    load = np.column_stack([np.bincount(of, part) for part in force.T]) / (high - low)[first, None]
    place = (
        np.column_stack([np.bincount(of, size * part) for part in middle.T])
        / np.maximum(total, 1e-300)[:, None]
    )
    ends = np.stack([place, place], axis=1)
    ends[:, 0, 2], ends[:, 1, 2] = low[first], high[first]
    return ends[total > 0.0], load[total > 0.0]
