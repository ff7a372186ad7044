"""Pressure of a contact at or near a tip corner, on strips of the flanks: where it acts, how much, which way.

The strips are those of the contact's law (``fem.laws.tip_contact``), narrower; which of them bear a given force follows
from the signs of pressure and gap.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, SolverError, record
from fem.influence.tip_strips import FIRST_EDGE, REACH
from fem.laws.tip_contact import strips_of
from fem.laws.tip_geometry import TipRound

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["TipPressure", "tip_pressure"]

FINE = 1.08
"""Ratio of successive widths of the strips."""

ITERATIONS = 100


@record
class TipPressure:
    """Strips that bear, from the corner inwards.

    Attributes
    ----------
    distance, width : (n,) arrays
        From the corner along its flank to the strips' middles, and their widths [m].
    pressure : (n,) array
        [Pa]
    lean : (n,) array
        Angles of the forces from the inward normals of the corner's flank, away from the tip [rad].
    touched : (n,) array
        Curvature radii of the other gear's flank [m].
    """

    distance: Array
    width: Array
    pressure: Array
    lean: Array
    touched: Array

    @property
    def loads(self) -> Array:
        """Line load of each strip [N/m]."""
        return self.pressure * self.width

    def mean(self, values: Array) -> float:
        """Mean of values at the strips, weighted by their loads."""
        return float(np.sum(self.loads * values) / np.sum(self.loads))

    @property
    def extent(self) -> float:
        """Distance from the corner up to which the contact bears [m]."""
        return float(self.distance[-1] + 0.5 * self.width[-1])


def tip_pressure(
    bodies: PairCompliance, corner: int, rho1: float, line_load: float, rounding: TipRound | None = None
) -> TipPressure:
    """Pressure under a force.

    Parameters
    ----------
    bodies : PairCompliance
    corner : {0, 1}
        The gear whose corner is near.
    rho1 : float
        Position by rho1 of the unlimited involutes [m], on the path or outside.
    line_load : float
        Force per face width, along the normal of the touched flank [N/m].
    rounding : TipRound, optional
        Of the corner; sharp unless given.

    Raises
    ------
    base.SolverError
        Where no strips bear the force.
    """
    module = bodies.pair.module
    count = int(np.ceil(np.log(REACH / FIRST_EDGE) / np.log(FINE))) + 1
    edges = np.concatenate([[0.0], FIRST_EDGE * module * FINE ** np.arange(count)])
    fine = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    layout = None if rounding is not None and rounding.radius > 0.0 else fine
    other = (bodies.wheel, bodies.pinion)[corner].law
    tip = strips_of(bodies.pair, bodies.tips[corner], corner, rho1, other, layout, rounding)
    bears = np.ones(len(tip.width), dtype=bool)
    for _ in range(ITERATIONS):
        on = np.flatnonzero(bears)
        matrix = np.block(
            [[tip.kernel[np.ix_(on, on)], -tip.lever_ratios[on, None]], [np.ones((1, len(on))), 0.0]]
        )
        *loads, approach = np.linalg.solve(matrix, np.append(-tip.gaps[on], line_load))
        whole = np.zeros(len(bears))
        whole[on] = loads
        after = (whole > 0) | (~bears & (tip.kernel @ whole + tip.gaps < tip.lever_ratios * approach))
        if np.array_equal(after, bears):
            return TipPressure(
                tip.distance[on], tip.width[on], whole[on] / tip.width[on], tip.lean[on], tip.touched[on]
            )
        bears = after
    raise SolverError("no strips at the tip edge bear the force; reduce the torque")
