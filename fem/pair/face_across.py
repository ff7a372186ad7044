"""What loads along the face do to the other side of the teeth, of both gears of a pair: waves and free ends.

As ``fem.pair.face_compliance`` for one side: here loads are on front flanks and deflections on back flanks, or the
reverse by Maxwell and Betti. The gears are solved for it when it is asked for, and not before.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.influence.back_face import (
    BackEndCorrection,
    BackHarmonics,
    back_end_correction,
    back_harmonics,
)
from fem.influence.gear_shape import MeshedShape, rounded
from fem.influence.gear_store import GearStore
from fem.influence.series import CrossSeries, of_teeth

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance
    from gears import GearPair

__all__ = [
    "PlacesAcross",
    "back_ends_of",
    "back_waves_of",
    "even_loads_across",
    "gear_waves_across",
    "pair_ends_across",
    "pair_waves_across",
    "places_across",
]


@record
class PlacesAcross:
    """Places of n contacts on front flanks and m on back flanks; leading dimensions as wanted.

    Attributes
    ----------
    front : (2, ..., n) array
        Curvature radii on pinion and wheel [m].
    back : (2, ..., m) array
        Curvature radii on the back flanks, those of the mirrored gears [m].
    steps : (2, ..., n, m) array of int
        From the tooth of each front contact to that of each back contact, anticlockwise by the shorter way.
    """

    front: Array
    back: Array
    steps: Integers

    def on_gear(self, gear: int) -> tuple[Array, Array]:
        """Curvature radii of front contacts (..., n, 1) and of back contacts (..., 1, m) on one gear [m]."""
        return self.front[gear][..., :, None], self.back[gear][..., None, :]


def places_across(
    pair: GearPair, front: Array, back: Array, front_teeth: Integers, back_teeth: Integers
) -> PlacesAcross:
    """Put contacts on both sides of the teeth together.

    Parameters
    ----------
    pair : GearPair
    front, back : (2, ..., n) and (2, ..., m) arrays
        As of ``PlacesAcross``.
    front_teeth, back_teeth : (2, ..., n) and (2, ..., m) arrays of int
        Numbers of the teeth of pinion and wheel: following teeth of the pinion stand clockwise, those of the wheel
        anticlockwise.
    """
    ahead = back_teeth[..., None, :] - front_teeth[..., :, None]
    numbers = (pair.pinion.teeth, pair.wheel.teeth)
    first, second = (
        (turn * step + teeth // 2) % teeth - teeth // 2
        for turn, step, teeth in zip((-1, 1), ahead, numbers, strict=True)
    )
    return PlacesAcross(front, back, np.stack([first, second]))


def back_waves_of(meshed: MeshedShape, gears: GearStore) -> BackHarmonics:
    """What waves of load on a gear's front flanks do to its back flanks, solved where it is kept nowhere."""
    return gears.record("waves across", (meshed,), partial(back_harmonics, meshed))


def back_ends_of(meshed: MeshedShape, width: float, gears: GearStore) -> BackEndCorrection:
    """What free ends add to it over a face of some width in modules, solved where it is kept nowhere."""
    long = rounded(width)
    return gears.record("ends across", (meshed, long), partial(back_end_correction, meshed, long))


def _ends_over(meshed: MeshedShape, width: float, edges: Array) -> Mapping[int, CrossSeries]:
    """The same over cells with edges (cells + 1,) in modules, put together where they are kept nowhere."""
    gears = GearStore()
    key = meshed, rounded(width), edges.tobytes()
    return gears.over_face("ends across", key, lambda: back_ends_of(meshed, width, gears).over(edges))


def pair_waves_across(
    bodies: PairCompliance, places: PlacesAcross, cells: int, gears: Sequence[int] = (0, 1)
) -> Array:
    """What waves of load yield beyond even loads (..., n, m, cells - 1), per force on the whole face [m/N].

    Parameters
    ----------
    bodies : PairCompliance
    places : PlacesAcross
    cells : int
        Waves k = m pi/b, m = 1 .. cells - 1.
    gears : sequence of int
        That yield: 0 is the pinion, 1 the wheel.
    """
    width = bodies.pair.face_width
    wavenumber: Array = np.arange(1, cells, dtype=float) * (np.pi * bodies.pair.module / width)
    compliance: Array = np.zeros((*places.steps.shape[1:], cells - 1))
    for gear in gears:
        compliance += gear_waves_across(bodies, gear, places, wavenumber) / width
    return compliance


def gear_waves_across(bodies: PairCompliance, gear: int, places: PlacesAcross, wavenumber: Array) -> Array:
    """What waves of line load yield beyond even ones on one gear (..., n, m, waves) [m per N/m].

    Teeth that are too far away to feel the load turn with the body under even loads, and stand still under waves.

    Parameters
    ----------
    bodies : PairCompliance
    gear : int
        0 is the pinion, 1 the wheel.
    places : PlacesAcross
    wavenumber : (waves,) array
        k times the module.
    """
    waves, module = back_waves_of(bodies.meshed[gear], GearStore()), bodies.pair.module
    load, point = places.on_gear(gear)
    moved = waves.across(places.steps[gear], load / module, point / module, wavenumber)
    flexible = (bodies.pinion, bodies.wheel)[gear]
    far = ~np.isin(places.steps[gear], list(waves.series))
    turned = far[..., None] * np.where(wavenumber > 0.0, flexible.hub_windup, 0.0)
    return np.asarray(moved / flexible.law.plane_modulus + turned)


def even_loads_across(bodies: PairCompliance, gear: int, places: PlacesAcross) -> Array:
    """What even line loads on front flanks do to back flanks of one gear (..., n, m) [m per N/m].

    Parameters
    ----------
    bodies, gear, places
        As of ``gear_waves_across``.
    """
    backs, windup = bodies.back_flanks[gear], (bodies.pinion, bodies.wheel)[gear].hub_windup
    far = ~np.isin(places.steps[gear], list(backs.series))
    return backs.across(places.steps[gear], *places.on_gear(gear)) - windup * far


def pair_ends_across(
    bodies: PairCompliance,
    places: PlacesAcross,
    edges: tuple[Array, Array],
    widths: tuple[float, float],
    gears: Sequence[int] = (0, 1),
) -> Array:
    """What free ends add between cells of front and back flanks (..., n, cells, m, cells) [m/N].

    Parameters
    ----------
    bodies : PairCompliance
    places : PlacesAcross
    edges : two (cells + 1,) arrays
        Of the cells on pinion and wheel, growing, from the middle of the gear's own face [m].
    widths : (float, float)
        Face widths of both [m].
    gears : sequence of int
        As of ``pair_waves_across``.
    """
    *leading, n, m = places.steps.shape[1:]
    cells, module = len(edges[0]) - 1, bodies.pair.module
    compliance: Array = np.zeros((*leading, n, cells, m, cells))
    for gear in gears:
        flexible = (bodies.pinion, bodies.wheel)[gear]
        ends = _ends_over(bodies.meshed[gear], widths[gear] / module, edges[gear] / module)
        load, point = places.on_gear(gear)
        moved = of_teeth(ends, places.steps[gear], load / module, point / module)
        compliance += np.swapaxes(moved, -3, -2) / (flexible.law.plane_modulus * module)
    return compliance
