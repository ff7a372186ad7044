"""Index of the period map on a large circle: what the indices of all its fixed points add up to."""

from __future__ import annotations

import math
from functools import singledispatch

import numpy as np

from base import Array
from dynamics.flow.exact_flow import exact_flow
from dynamics.flow.flows import flow_of
from dynamics.flow.motions import period_map
from dynamics.flow.protocol import propagated
from dynamics.model.excitation import largest
from dynamics.model.oscillator import GearOscillator
from dynamics.model.protocol import PeriodicOscillator

LARGE = (1e3, 1e4)  # radii, over the larger of D and the shift by the forces, at which the turns must agree
TURN = 0.5  # rad: neighbours on the circle between which the displacement turns by more are halved
MOST = 100_000  # points on the circle


def index_at_infinity(oscillator: PeriodicOscillator, n: int) -> int | None:
    r"""Index of the n-period map P on a large circle; None if it has none.

    With backlash on both sides D does not count far out, and the index is that of the linear equation with D = 0, the
    sign of :math:`(1 - m_1^n)(1 - m_2^n) \cdots` over all multipliers; it has none where that is zero.

    With contact on one side the map far out is not linear. Where X > 0 the spring works, where X < 0 there is none:
    there a motion without speed stays where it is but for the mean force, :math:`\dot V + 2 \zeta V = F_m`, whose
    push turns the displacement P(x) - x from one side of the X axis to the other. So the index depends on the
    sign of F_m however large the circle is, and is counted as the turns of the displacement along it. Where all
    motions come back to a bounded region it is 1. Without mean force motions out of contact repeat
    at any mean X, the displacement is zero on part of every circle, and there is no index. That of a drive train with
    contact on one side is not known.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator.
    n : int
        Excitation periods.
    """
    if not oscillator.one_sided:
        linear = flow_of(oscillator.in_contact(1)[0])
        jacobian = period_map(linear, np.zeros(linear.dimension)).jacobian
        if not np.all(np.isfinite(jacobian)):
            return None
        product = np.prod(1.0 - np.linalg.eigvals(jacobian) ** n)
        return int(np.sign(product.real)) if abs(product) > 1e-6 else None
    return _one_sided(oscillator, n)


@singledispatch
def _one_sided(oscillator: PeriodicOscillator, n: int) -> int | None:
    """Index with contact on one side; None where it is not known."""
    return None


@_one_sided.register
def _of_pair(oscillator: GearOscillator, n: int) -> int | None:
    if oscillator.mean_force == 0.0:
        return None
    shift = (abs(oscillator.mean_force) + largest(oscillator.error_series)) / min(
        oscillator.stiffness.mean, 1.0
    )
    turns = {winding(oscillator, n, size * max(oscillator.half_backlash, shift)) for size in LARGE}
    return turns.pop() if len(turns) == 1 else None


def winding(oscillator: GearOscillator, n: int, radius: float) -> int | None:
    """Turns of the displacement by the n-period map along a circle; None if they cannot be counted.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator.
    n : int
        Excitation periods.
    radius : float
        Of the circle in the plane of X and V, about the origin.
    """
    table = exact_flow(oscillator)

    def directions(angles: Array) -> Array:
        at = radius * np.column_stack([np.cos(angles), np.sin(angles)])
        move = propagated(table, at, n) - at
        return np.asarray(np.arctan2(move[:, 1], move[:, 0]))

    angles = np.linspace(-math.pi, math.pi, 65)
    ways = directions(angles)
    while True:
        turn = np.mod(np.diff(ways) + math.pi, 2.0 * math.pi) - math.pi
        wide = np.flatnonzero(~(np.abs(turn) < TURN))
        if len(wide) == 0:
            return round(float(np.sum(turn)) / (2.0 * math.pi))
        middle = 0.5 * (angles[wide] + angles[wide + 1])
        if len(angles) + len(wide) > MOST or float(np.min(np.diff(angles))) < 1e-15:
            return None
        angles, ways = np.insert(angles, wide + 1, middle), np.insert(ways, wide + 1, directions(middle))
