"""What a gear that is wider than the face in contact yields less: its body goes on beyond the load.

Between walls at the ends of its face b_g a gear answers waves k_m = m pi/b_g. Loads and deflections in the middles
z_c of the cells, h wide, hold waves up to K = pi/h; with c(k) the answer to a wave of line load, even loads included,

    C_cd = c(K) delta_cd/h + sum_(k_m < K) (2 - delta_m0)/b_g [c(k_m) - c(K)] cos k_m z_c cos k_m z_d ,

z from the end of its face. The sum's terms vanish towards K, so that cells need not divide the face; where they do,
and for b_g = b, this is the cosine transform of equally wide gears (``fem.contact.shared_contacts``), by which it
replaces it here.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from fem.pair.face_across import PlacesAcross, even_loads_across, gear_waves_across
from fem.pair.face_compliance import gear_waves
from fem.pair.face_setting import FaceSetting

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["cosines", "overhang", "overhang_across"]


def overhang(bodies: PairCompliance, gear: int, rho: Array, face: FaceSetting) -> Array:
    """Compliance of a gear's own face less that of one as wide as the face in contact (positions, n, cells, n, cells).

    Parameters
    ----------
    bodies : PairCompliance
    gear : int
        0 is the pinion, 1 the wheel.
    rho : (positions, n) array
        Curvature radii of n pairs on it, in order of rho1, one tooth apart [m].
    face : FaceSetting

    Returns
    -------
    array
        [m/N]
    """
    even = bodies.even_loads(gear, rho)
    if "hub_windup" in bodies.left_out:
        even = even - (bodies.pinion, bodies.wheel)[gear].hub_windup
    return _wider(bodies, gear, face, even, partial(gear_waves, bodies, gear, rho))


def overhang_across(bodies: PairCompliance, gear: int, places: PlacesAcross, face: FaceSetting) -> Array:
    """As ``overhang``, of loads on front flanks seen on back flanks (positions, n, cells, m, cells) [m/N].

    Parameters
    ----------
    bodies, gear, face
        As of ``overhang``.
    places : PlacesAcross
    """
    even = even_loads_across(bodies, gear, places)
    if "hub_windup" in bodies.left_out:  # torques of the two sides are opposed
        even = even + (bodies.pinion, bodies.wheel)[gear].hub_windup
    return _wider(bodies, gear, face, even, partial(gear_waves_across, bodies, gear, places))


def _wider(
    bodies: PairCompliance, gear: int, face: FaceSetting, plane: Array, by_wave: Callable[[Array], Array]
) -> Array:
    """Compliance of a gear's own face less that of the face in contact, by even loads and what waves do beyond."""
    pair, cells, even = bodies.pair, face.cells, plane[..., None]
    width, module = pair.face_widths[gear], pair.module
    shortest = np.pi * cells / pair.face_width  # K, 1/m
    wave: Array = np.arange(int(np.ceil(shortest * width / np.pi)), dtype=float) * (np.pi / width)
    wave = wave[wave < shortest * (1.0 - 1e-9)]
    answer: Array = even + by_wave(np.append(wave, shortest) * module)
    last = answer[..., -1:]
    z = face.middles(pair.face_width) - pair.face_offsets[gear] + 0.5 * width
    shapes = np.cos(wave[:, None] * z) * np.sqrt(np.where(wave > 0.0, 2.0, 1.0) / width)[:, None]
    compliance = _by_waves(shapes, answer[..., :-1] - last)
    compliance[..., np.arange(cells), :, np.arange(cells)] += (
        np.moveaxis(last, -1, 0) * cells / pair.face_width
    )
    equal: Array = np.arange(cells, dtype=float) * np.pi / pair.face_width
    same = even + by_wave(equal * module)
    return compliance - _by_waves(cosines(cells) * np.sqrt(cells / pair.face_width), same)


def _by_waves(shapes: Array, answer: Array) -> Array:
    """Between cells (positions, n, cells, n, cells), of shapes (waves, cells) and answers (positions, n, n, waves)."""
    return np.asarray(np.einsum("mc,pijm,md->picjd", shapes, answer, shapes, optimize=True))


def cosines(cells: int) -> Array:
    """Orthonormal cosines over equal cells (modes, cells)."""
    m, c = np.arange(cells)[:, None], np.arange(cells) + 0.5
    modes = np.cos(np.pi * m * c / cells) * np.sqrt(2.0 / cells)
    modes[0] = np.sqrt(1.0 / cells)
    return np.asarray(modes)
