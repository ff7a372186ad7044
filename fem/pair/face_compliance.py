"""Compliance of both gears of a pair along the face: waves and free ends of all pairs in contact, put together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from fem.influence.gear_face import AxialHarmonics, EndCorrection, axial_harmonics, end_correction
from fem.influence.gear_shape import MeshedShape, rounded
from fem.influence.gear_store import GearStore
from fem.influence.series import CrossSeries, FlankSeries
from fem.pair.pair_compliance import contacts_apart
from fem.pair.wide_contact import beyond_logarithm

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["ends_of", "gear_waves", "pair_ends", "pair_waves", "waves_of"]

SPREAD = 0.15
"""Arc from the tip corner [modules] within which loads on cells count as there: the pressure of a contact beside a
corner, or of the corner, spreads as far; a line at the corner would yield less than nothing in short waves."""


def waves_of(meshed: MeshedShape, gears: GearStore) -> AxialHarmonics:
    """Answer of a gear to waves of load, solved where it is kept nowhere."""
    return gears.record("waves", (meshed,), partial(axial_harmonics, meshed))


def ends_of(meshed: MeshedShape, width: float, gears: GearStore) -> EndCorrection:
    """What free ends add to it over a face of some width in modules, solved where it is kept nowhere."""
    long = rounded(width)
    return gears.record("ends", (meshed, long), partial(end_correction, meshed, long))


def _ends_over(
    meshed: MeshedShape, width: float, edges: Array
) -> tuple[FlankSeries, Mapping[int, CrossSeries]]:
    """The same over cells with edges (cells + 1,) in modules, put together where they are kept nowhere."""
    gears = GearStore()
    key = meshed, rounded(width), edges.tobytes()
    return gears.over_face("ends", key, lambda: ends_of(meshed, width, gears).over(edges))


def pair_waves(
    bodies: PairCompliance, rho: Array, cells: int, strip: float = 0.0, gears: Sequence[int] = (0, 1)
) -> Array:
    """What waves of load yield beyond even loads (..., n, n, cells - 1), per force on the whole face [m/N].

    Parameters
    ----------
    bodies : PairCompliance
    rho : (2, ..., n) array
        Curvature radii of n pairs on pinion and wheel, in order of rho1, one tooth apart [m].
    cells : int
        Waves k = m pi/b, m = 1 .. cells - 1.
    strip : float
        Half-width of strips of pressure over a cell's length; 0 is a line.
    gears : sequence of int
        That yield: 0 is the pinion, 1 the wheel.
    """
    width = bodies.pair.face_width
    long = width / bodies.pair.module
    wavenumber: Array = np.arange(1, cells, dtype=float) * (np.pi / long)
    n = rho.shape[-1]
    compliance: Array = np.zeros((*rho.shape[1:], n, cells - 1))
    for gear in gears:
        compliance += gear_waves(bodies, gear, rho[gear], wavenumber, strip * long / cells) / width
    return compliance


def gear_waves(
    bodies: PairCompliance, gear: int, rho: Array, wavenumber: Array, half_width: float = 0.0
) -> Array:
    """What waves of line load yield beyond even ones on one gear (..., n, n, waves) [m per N/m].

    Parameters
    ----------
    bodies : PairCompliance
    gear : int
        0 is the pinion, 1 the wheel.
    rho : (..., n) array
        Curvature radii of n pairs on it, in order of rho1, one tooth apart [m].
    wavenumber : (waves,) array
        k times the module.
    half_width : float
        Of strips of pressure, over the module; 0 is a line.
    """
    meshed, flexible = bodies.meshed[gear], (bodies.pinion, bodies.wheel)[gear]
    waves = waves_of(meshed, GearStore())
    n = rho.shape[-1]
    compliance: Array = np.zeros((*rho.shape, n, len(wavenumber)))
    diagonal = np.arange(n)
    module = bodies.pair.module
    last = waves.rho_end**2 - 2.0 * SPREAD * flexible.base_radius / module
    unit, at = 1.0 / flexible.law.plane_modulus, np.minimum(rho / module, np.sqrt(last))
    wide = beyond_logarithm(wavenumber * half_width) if half_width else 0.0
    compliance[..., diagonal, diagonal, :] = unit * (waves.own_at(at, wavenumber) + 2 / np.pi * wide)
    for apart, load, point in contacts_apart(gear, n, bodies.reach):
        cross = unit * waves.cross_at(apart, at[..., load], at[..., point], wavenumber)
        compliance[..., load, point, :] = compliance[..., point, load, :] = cross
    return compliance


def pair_ends(
    bodies: PairCompliance,
    rho: Array,
    edges: tuple[Array, Array],
    widths: tuple[float, float],
    gears: Sequence[int] = (0, 1),
) -> Array:
    """What free ends add between cells of n pairs (..., n, cells, n, cells) [m/N].

    Parameters
    ----------
    bodies : PairCompliance
    rho : (2, ..., n) array
        As of ``pair_waves``.
    edges : two (cells + 1,) arrays
        Of the cells on pinion and wheel, growing, from the middle of the gear's own face [m].
    widths : (float, float)
        Face widths of both [m].
    gears : sequence of int
        As of ``pair_waves``.
    """
    n, cells = rho.shape[-1], len(edges[0]) - 1
    compliance: Array = np.zeros((*rho.shape[1:], cells, n, cells))
    module = bodies.pair.module
    for gear in gears:
        flexible = (bodies.pinion, bodies.wheel)[gear]
        own, cross = _ends_over(bodies.meshed[gear], widths[gear] / module, edges[gear] / module)
        unit, at = 1.0 / (flexible.law.plane_modulus * module), rho[gear] / module
        for contact in range(n):
            compliance[..., contact, :, contact, :] += unit * own.at(at[..., contact])
        for apart, loads, points in contacts_apart(gear, n, bodies.reach):
            for load, point in zip(loads.tolist(), points.tolist(), strict=True):
                moved = unit * cross[apart].at(at[..., load], at[..., point])
                compliance[..., load, :, point, :] += moved
                compliance[..., point, :, load, :] += np.swapaxes(moved, -1, -2)
    return compliance
