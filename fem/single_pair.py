"""Stiffness of one tooth pair alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fem.bodies import Compliance
from fem.compliance import compliance as _compliance
from fem.errors import Fault, FemError

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["single_pair_stiffness"]

Array = NDArray[np.float64]


def single_pair_stiffness(
    pair: GearPair,
    force: float,
    rho1: Array,
    compliance: Compliance | None = None,
    tolerance: float = 0.001,
    plane: str = "strain",
) -> Array:
    """Secant stiffness F/deflection of one tooth pair alone, hub and bodies included [N/m].

    Parameters
    ----------
    pair : gears.GearPair
    force : float
        Normal force [N] at the pair's face width.
    rho1 : (n,) array
        Curvature radii on the pinion [m]. Within ``0.01`` modules of a tip corner, A and E included, the
        load stands at that distance: a line load on the corner itself would have no finite displacement.
    compliance : Compliance, optional
        Of this pair.

    Returns
    -------
    (n,) array

    Raises
    ------
    FemError
        Force not positive and finite, or a place off the path of contact.
    """
    bodies = compliance or _compliance(pair, tolerance, plane)
    rho1 = np.atleast_1d(np.asarray(rho1, dtype=float))
    points = pair.points
    faults = []
    if not (np.isfinite(force) and force > 0):
        faults.append(
            Fault("force", f"{force!r}", "finite and > 0 (N)", "give the force along the line of action")
        )
    slack = 1e-9 * points.E
    if not np.all((rho1 >= points.A - slack) & (rho1 <= points.E + slack)):
        allowed = f"{points.A:g} to {points.E:g} m, the path of contact"
        faults.append(Fault("rho1", f"{np.min(rho1):g} .. {np.max(rho1):g}", allowed, "stay between A and E"))
    if faults:
        raise FemError(*faults)
    approach = bodies.own(rho1) * force + bodies.hertz(rho1).approach(np.full(len(rho1), float(force)))
    stiffness: Array = force / approach
    return stiffness
