"""How large a motion is, however large its backlash, and sizes at which it is measured by another scale."""

from __future__ import annotations

from contextlib import suppress
from typing import NamedTuple

import numpy as np

from base import Array, InputError
from dynamics.flow.flows import flow_of
from dynamics.model.protocol import Oscillator
from dynamics.model.states import scale_of

SAMPLES = 32  # of a period
WIDTH = 4.0  # times its largest distance from the state at rest: the largest scale of a motion within the backlash
LARGE = 4.0  # times the size of the motion: where a growing motion is measured by a larger one
SMALL = 1.0 / 32.0  # times the size of the motion: where a shrinking motion is measured by a smaller one


class Sizes(NamedTuple):
    """Sizes of motions, as of `BranchProblem.size_of`, between which the scale stands.

    Attributes
    ----------
    least, most : float
        Over the scale.
    """

    least: float
    most: float


def size_of(
    oscillator: Oscillator,
    state: Array,
    periods: int,
    nodes: Array | None = None,
    tolerance: float | None = None,
) -> float:
    """Scale of a motion, of which the backlash is a part as far as the motion reaches.

    Displacements X of a pair at rest are D and the deflection. In large backlash a motion in X would be so large
    that nothing about it changes along a branch: it is measured by four times its largest distance from the state at
    rest, or four times what drives it, where that is less.

    Parameters
    ----------
    oscillator : Oscillator
        What moves.
    state : ndarray, shape (dimension,)
        State at tau = 0.
    periods : int
        Excitation periods to look at.
    nodes : ndarray, shape (any, dimension), optional
        States on the motion, if it cannot be followed from the first.
    tolerance : float, optional
        Of the flow, as of `find_orbit`.
    """
    whole, driven = scale_of(oscillator, state), WIDTH * oscillator.driven_size
    if whole <= driven:
        return whole
    states = state[None]
    if nodes is not None and len(nodes):
        states = nodes
    else:
        with suppress(InputError):  # too unstable to be followed: the state itself is what is known
            states = flow_of(oscillator, tolerance).sampled(state, periods, SAMPLES)[0]
    away = float(np.max(np.abs(states - oscillator.rest_state())))
    return min(whole, max(driven, WIDTH * away))
