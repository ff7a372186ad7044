"""What surfaces of teeth must be: closed, outward, of the solids' volume, with the grids' values; loads add up."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

from base import Array, Integers
from fem import MeshCycle, PairCompliance, field_blocks
from fem.fields.surface_frames import GEARS, ContactLoads, Surfaces
from fem.fields.tooth_surfaces import turned_to
from gears import GearPair

Blocks = Mapping[str, Any]


def blocks_of(pair: GearPair, cycle: MeshCycle, row: int, bodies: PairCompliance) -> Blocks:
    """Blocks of a position by their names."""
    found = field_blocks(pair, cycle, row, bodies)
    return {name: found[name] for name in found.keys()}  # noqa: SIM118 - no mapping


def surfaces_of(pair: GearPair, held: Blocks) -> Surfaces:
    """Surfaces of the teeth of a position's blocks."""
    return Surfaces.of(held, pair.placement(pair.points.C).wheel_centre, pair.face_width)


def check_closed(pair: GearPair, held: Blocks) -> None:
    """Every edge has a triangle on either side, and the volume inside is that of a tooth's cells."""
    for name, tooth in zip(GEARS, surfaces_of(pair, held).teeth, strict=True):
        there, back = _edges(tooth.triangles)
        assert len(np.unique(there)) == len(there)  # each once in either sense
        assert set(there.tolist()) == set(back.tolist())
        grid = held[name]
        sizes = grid.extract_cells(np.flatnonzero(grid["tooth"] == grid["tooth"][0])).compute_cell_sizes()
        whole = sizes["Area"] * pair.face_width if "contacts" in held else sizes["Volume"]
        # sides of cells are straight here, and solids have fewer layers
        assert _volume(tooth.points, tooth.triangles) == pytest.approx(float(np.abs(whole).sum()), rel=5e-3)


def check_values(pair: GearPair, held: Blocks) -> None:
    """Each tooth has the displacement and the stress of the grid's points at the same places."""
    surfaces = surfaces_of(pair, held)
    centres = np.zeros(3), np.append(surfaces.wheel_centre, 0.0)
    gears = surfaces.frame(held).gears
    for name, tooth, values, centre in zip(GEARS, surfaces.teeth, gears, centres, strict=True):
        grid, found = held[name], []
        cells, points = grid.cells.reshape(grid.n_cells, -1)[:, 1:], np.asarray(grid.points, dtype=float)
        moved = np.asarray(grid["displacement_m"], dtype=float)
        for k, angle in enumerate(values.angles):
            at = turned_to(tooth.places, angle) + centre
            own = np.unique(cells[grid["tooth"] == values.first + k])
            away, there = cKDTree(points[own]).query(at)
            nearest, near = own[there], away < 1e-6 * np.abs(points).max()
            found.append(near.mean())
            apart = turned_to(values.displacement[k], angle) - moved[nearest]
            assert np.abs(apart[near]).max() < 1e-3 * np.abs(moved).max()
            if values.von_mises is not None:
                apart = values.von_mises[k] - np.asarray(grid["von_mises_Pa"])[nearest]
                assert np.abs(apart[near]).max() < 1e-3 * values.von_mises.max()
        assert found[0] == 1.0
        assert min(found) > 0.6  # teeth in contact have other cells


def check_loads(pair: GearPair, held: Blocks, torque: float) -> ContactLoads:
    """Loads of the contacts take the torque of both gears, and stand on the wheel's flanks."""
    surfaces = surfaces_of(pair, held)
    loads = surfaces.frame(held).contacts
    force = np.linalg.norm(np.diff(loads.ends, axis=1)[:, 0], axis=1)[:, None] * loads.load
    middle = loads.ends.mean(axis=1)
    assert np.cross(middle, -force).sum(axis=0)[2] == pytest.approx(-torque, rel=1e-2)
    on_wheel = np.cross(middle - np.append(surfaces.wheel_centre, 0.0), force).sum(axis=0)[2]
    ratio = pair.wheel.teeth / pair.pinion.teeth
    assert on_wheel == pytest.approx(-torque * ratio, rel=1e-2)
    plane = "contacts" in held
    places = np.asarray(held["wheel" if plane else "wheel_flanks"].points, dtype=float)
    ends = loads.ends.reshape(-1, 3) * ([1.0, 1.0, 0.0] if plane else 1.0)
    assert cKDTree(places).query(ends)[0].max() < 0.2 * pair.module
    return loads


def _edges(triangles: Integers) -> tuple[Integers, Integers]:
    """Each edge in its sense and in the other one, as whole numbers."""
    a, b = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).T
    size = int(triangles.max()) + 1
    return a * size + b, b * size + a


def _volume(points: Array, triangles: Integers) -> float:
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0
