"""Contacts that are about as wide as the cells of the face: strips of pressure feel short waves less than lines do.

What a wave of line load yields falls as -2 ln k/(pi E*) for as long as it is longer than the contact is wide. A strip
of half-width a never yields less than nothing: with the pressure that a rigid edge leaves, which is what more load adds
to Hertz's,

    mean of K_0(k |s - s'|) over the strip = (2/pi) Int_0^(pi/2) I_0(k a cos t) K_0(k a cos t) dt ,

and what that has beyond the logarithm is added here. Cells that are more than ``NARROW`` half-widths long need none of
it, and one matrix serves all loads. Narrower ones get a strip of 2, 4, 8, .. cells over NARROW, the first that is as
wide as the widest contact: then slopes of Hertz's law and waves together stay definite.

Fewer cells are no way round it: lines alone on the usual 64 cells of a face of ten modules, 40 um askew, have a
face-load factor 1.5 % too high at 270 N/mm and no solution at 530 N/mm, on 128 cells none at 130 N/mm.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers

if TYPE_CHECKING:
    from gears import LoadShare

__all__ = ["NARROW", "beyond_logarithm", "shared_by_width", "shares_together"]

NARROW = 2.5
"""Half-widths of the contact that a cell is long without being narrow."""

WIDEST = 12
"""Doublings of the strip that are tried."""

ANGLES = 32
"""At which the strip's mean is taken."""


def beyond_logarithm(wave: Array) -> Array:
    """What a strip yields beyond a line's logarithm, times pi E*/2 per line load; of k a (...).

    Examples
    --------
    >>> beyond_logarithm(np.array([0.0, 0.1, 1.0, 100.0])).round(4)
    array([0.    , 0.0062, 0.2009, 3.8143])
    """
    from scipy.special import i0e, k0e

    angle = (np.arange(ANGLES) + 0.5) * (0.5 * np.pi / ANGLES)
    y = np.maximum(wave[..., None] * np.cos(angle), 1e-12)
    return np.asarray(np.mean(i0e(y) * k0e(y) + np.log(0.5 * y) + np.euler_gamma, axis=-1))


def shared_by_width(
    share: Callable[[float, Integers], LoadShare],
    width: Callable[[LoadShare], Array],
    cell: float,
    start: Array,
) -> tuple[LoadShare, Array]:
    """Share every torque with strips that are as wide as its contact.

    Parameters
    ----------
    share : callable
        Shares some torques (numbers) over cells, with strips of a half-width over a cell's length, 0 for lines.
    width : callable
        Largest half-width [m] of the contacts of such shares (torques,).
    cell : float
        Length of a cell [m].
    start : (torques,) array
        Half-widths [m] to begin with.

    Returns
    -------
    LoadShare
        Of all torques.
    (torques,) array
        Half-widths of their strips over a cell's length.

    Raises
    ------
    gears.LoadSharingError
        No strip is wide enough.
    """
    from gears.tooth.errors import LoadSharingError

    level = np.zeros(len(start), dtype=int)
    shares: dict[int, LoadShare] = {}

    def strip(of: int) -> float:
        return 2.0**of / NARROW if of else 0.0

    def reaches(of: Array) -> Array:
        return cell / NARROW * 2.0**of

    while np.any(short := (start > reaches(level)) & (level < WIDEST)):
        level[short] += 1
    todo = [np.flatnonzero(level == step) for step in np.unique(level)]
    while todo:
        numbers = todo.pop()
        at = int(level[numbers[0]])
        try:
            shared = share(strip(at), numbers)
        except LoadSharingError:
            if len(numbers) > 1:
                todo += [numbers[k : k + 1] for k in range(len(numbers))]
                continue
            if at == WIDEST:
                raise
            level[numbers] += 1
            todo.append(numbers)
            continue
        wide = (width(shared) > reaches(level[numbers])) & (at < WIDEST)
        for k, number in enumerate(numbers):
            if not wide[k]:
                shares[int(number)] = shares_together([shared], np.array([k]))
        if wide.any():
            level[numbers[wide]] += 1
            todo.append(numbers[wide])
    numbers = np.arange(len(start))
    share_of_all = shares_together([shares[number] for number in numbers.tolist()], numbers)
    return share_of_all, np.array([strip(int(step)) for step in level])


def shares_together(shares: Sequence[LoadShare], order: Integers) -> LoadShare:
    """Shares of several torques each as one of all, in an order of the torques.

    Parameters
    ----------
    shares : sequence of LoadShare
    order : (torques,) array of int
        Numbers of the torques, of all shares one after the other.
    """
    return replace(
        shares[0],
        forces=np.concatenate([share.forces for share in shares])[order],
        transmission_error=np.concatenate([share.transmission_error for share in shares])[order],
        stiffness=np.concatenate([share.stiffness for share in shares])[order],
        pair_stiffness=np.concatenate([share.pair_stiffness for share in shares])[order],
        iterations=max(share.iterations for share in shares),
    )
