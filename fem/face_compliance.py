"""Compliance of both gears of a pair along the face: waves and free ends of all pairs in contact, put together."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from fem.gear_face import FlankEnds, FlankWaves, flank_ends, flank_waves
from fem.solved_gear import Gears

if TYPE_CHECKING:
    from fem.bodies import Compliance

__all__ = ["pair_ends", "pair_waves"]


def pair_waves(bodies: Compliance, rho: Array, cells: int) -> Array:
    """What waves of load yield beyond even loads (..., n, n, cells - 1), per force on the whole face [m/N].

    Parameters
    ----------
    bodies : Compliance
    rho : (2, ..., n) array
        Curvature radii of n pairs on pinion and wheel, in order of rho1, one tooth apart [m].
    cells : int
        Waves k = m pi/b, m = 1 .. cells - 1.
    """
    gears, module, width = Gears(), bodies.pair.module, bodies.pair.face_width
    wavenumber: Array = np.arange(1, cells, dtype=float) * (np.pi * module / width)
    n = rho.shape[-1]
    found: Array = np.zeros((*rho.shape[1:], n, cells - 1))
    diagonal = np.arange(n)
    for gear, (meshed, flexible) in enumerate(zip(bodies.meshed, (bodies.pinion, bodies.wheel), strict=True)):
        waves: FlankWaves = gears.record("waves", (meshed,), partial(flank_waves, meshed))
        unit, at = 1.0 / (flexible.law.plane_modulus * width), rho[gear] / module
        found[..., diagonal, diagonal, :] += unit * waves.own_at(at, wavenumber)
        for apart in range(1, min(n, bodies.reach + 1)):
            behind, ahead = diagonal[:-apart], diagonal[apart:]
            # the pair ahead has the smaller rho2
            load, point = (behind, ahead) if gear == 0 else (ahead, behind)
            cross = unit * waves.cross_at(apart, at[..., load], at[..., point], wavenumber)
            found[..., behind, ahead, :] += cross
            found[..., ahead, behind, :] += cross
    return found


def pair_ends(bodies: Compliance, rho: Array, cells: int) -> Array:
    """What free ends add between cells of n pairs (..., n, cells, n, cells) [m/N]; arguments as of ``pair_waves``."""
    gears, module, width = Gears(), bodies.pair.module, bodies.pair.face_width
    n = rho.shape[-1]
    found: Array = np.zeros((*rho.shape[1:], cells, n, cells))
    for gear, (meshed, flexible) in enumerate(zip(bodies.meshed, (bodies.pinion, bodies.wheel), strict=True)):
        long = float(f"{width / module:.12g}")
        ends: FlankEnds = gears.record("ends", (meshed, long), partial(flank_ends, meshed, long))
        unit, at = 1.0 / (flexible.law.plane_modulus * module), rho[gear] / module
        for one in range(n):
            found[..., one, :, one, :] += unit * ends.own_at(at[..., one], cells)
        for apart in range(1, min(n, bodies.reach + 1)):
            for behind in range(n - apart):
                ahead = behind + apart
                load, point = (behind, ahead) if gear == 0 else (ahead, behind)
                cross = unit * ends.cross_at(apart, at[..., load], at[..., point], cells)
                found[..., load, :, point, :] += cross
                found[..., point, :, load, :] += np.swapaxes(cross, -1, -2)
    return found
