"""The most loaded cells of the places of the path, in their order, for films along the path."""

from __future__ import annotations

from dataclasses import replace
from math import ceil

import numpy as np

import gears
from base import Array, Integers
from flankfilm.coupling.films.films import LEAST_SHARE, touching
from flankfilm.coupling.mesh.cells import cells_of, line_loads
from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["most_loaded", "part_of_path", "parts_of_path"]


def most_loaded(pair: gears.GearPair, cycle: MeshCycle, kept: Integers) -> tuple[Array, Array]:
    """Places of the path, in order [m], and the line load of the most loaded cell at each [N/m].

    Places are those of the loaded pairs at some positions; where lines of contact cross the face they are the middles
    of equal parts of the path, as many to a base pitch, and cells of all positions come by, but for
    those at ends of lines.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
    kept : ndarray of int
        Numbers of the positions.
    """
    if cycle.lines is not None:
        cells, count = cells_of(cycle), parts_of_path(pair, kept.size)
        load = np.zeros(count)
        parts = part_of_path(pair, cells.rho1[cells.inside], count)
        np.maximum.at(load, parts, cells.line_load[cells.inside])
        middles = pair.points.A + (pair.points.E - pair.points.A) * (np.arange(count) + 0.5) / count
        loaded = load > LEAST_SHARE * load.max()
        return middles[loaded], load[loaded]
    few = replace(
        cycle,
        rho1=cycle.rho1[kept],
        forces=cycle.forces[kept],
        load_share=cycle.load_share[kept],
        contact=None,
    )
    position, number = touching(few)
    greatest = line_loads(cycle, pair.face_width).max(axis=-1)[kept]
    return few.rho1[position, number], greatest[position, number]


def parts_of_path(pair: gears.GearPair, to_pitch: int) -> int:
    """Equal parts of the path, so many to a base pitch or a few more."""
    return ceil(pair.contact_ratio * to_pitch)


def part_of_path(pair: gears.GearPair, rho1: Array, count: int) -> Integers:
    """Which of so many equal parts of the path places are in (n,) [m]."""
    along = (rho1 - pair.points.A) / (pair.points.E - pair.points.A)
    return np.asarray(np.clip((along * count).astype(int), 0, count - 1))
