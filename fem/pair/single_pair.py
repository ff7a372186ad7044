"""Stiffness of one tooth pair alone."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Faults, Limit
from fem.pair.checked import check_pair, numbers_of
from fem.pair.compliance import compliance as _compliance
from fem.pair.pair_compliance import PairCompliance
from fem.pair.references import REFERENCES, check_reference, held_turns, turns
from gears.pair.spur_only import check_spur

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["single_pair_stiffness"]

FORCE = Limit(0.0, unit="N", low_open=True, remedy="give the force along the line of action")


def single_pair_stiffness(
    pair: GearPair,
    force: float,
    rho1: Array,
    compliance: PairCompliance | None = None,
    tolerance: float = 0.001,
    plane: str = "strain",
    *,
    reference: str = "bore",
    bore_inertia: tuple[float, float] = (0.0, 0.0),
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
    compliance : PairCompliance, optional
        Of this pair.
    reference : {"bore", "body", "teeth"}
        What the deflection is measured against, as of `mesh_cycle`; unlike there, the bores unless given.
    bore_inertia : (float, float)
        What turns with the bores of pinion and wheel beside their own bodies, for "body" [kg m2].

    Returns
    -------
    (n,) array

    Raises
    ------
    base.InputError
        Force not positive and finite, or a place off the path of contact.

    Examples
    --------
    >>> from fem import compliance, single_pair_stiffness
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> bodies = compliance(pair, tolerance=0.05)
    >>> at_C = single_pair_stiffness(pair, force=17736.3, rho1=pair.points.C, compliance=bodies)
    >>> float(at_C[0] / 40e-3 / 1e9).__round__(1)  # N/(mm um)
    14.8
    """
    faults = Faults()
    if check_pair(faults, pair):
        check_spur(faults, pair, "single pairs")
    rho1 = np.atleast_1d(numbers_of(faults, "rho1", rho1, "give metres"))
    faults.instance("compliance", compliance, PairCompliance, "as of fem.compliance", optional=True)
    faults.raise_if_any()
    bodies = compliance or _compliance(pair, tolerance, plane)
    points = pair.points
    faults.number("force", force, FORCE)
    slack = 1e-9 * points.E
    if not np.all((rho1 >= points.A - slack) & (rho1 <= points.E + slack)):
        allowed = f"must be {points.A:g} to {points.E:g} m, the path of contact"
        faults.add("rho1", f"{np.min(rho1):g} .. {np.max(rho1):g}", allowed, "stay between A and E")
    faults.choice("reference", reference, REFERENCES)
    faults.raise_if_any()
    approach = bodies.own(rho1) * force + bodies.hertz(rho1).approach(np.full(len(rho1), float(force)))
    if reference != "bore":
        held, supports = held_turns(replace(bodies, left_out=bodies.left_out - {"coupling"}))
        check_reference(faults, held, reference, bore_inertia)
        faults.raise_if_any()
        less = turns(pair, supports, held) - turns(pair, supports, reference, bore_inertia)
        approach = approach - force * less.sum()
    stiffness: Array = force / approach
    return stiffness
