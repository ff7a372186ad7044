"""What a deflection is measured against: the rotation of the bores, of the bodies, or of the root circles.

A deflection D along the line of action is the pinion's rotation less that of the wheel, each times its base radius,
and a gear that yields has no single turn. What two references differ by is a turn of each gear, so it adds to D the
same for all pairs in contact and changes no force:

    D' = D - sum_g (c_g - c'_g) N_g,   dD'/dD = 1 - sum_g (c_g - c'_g) dN_g/dD,

N_g the moment of the normal forces about the gear's axis over its base radius, F without friction and tip edges. With
the torsional stiffness k_t of the support, the body's wind-up w between the held radius and the root circle
(``gears.closed_form.body_wind_up``, and ``fem.elasticity.torsion`` for a web), and the share lambda of it that is left
where inertia balances the torque (``gears.closed_form.inertial_wind_up``), the turn c per force that D holds is

- bore: w + r_b^2/k_t, all up to what holds the gear: the static transmission error between the shafts;
- body: lambda w, against the ring's rotation weighted by its inertia, the torque balanced by that inertia: what the
  equation of motion of a rigid gear means by its angle, while the shaft keeps the torque that it had. The inertia of
  the teeth is left out (docs/validation/fem.md has what that changes);
- teeth: 0, against the mean turn of the root circle.

Translations are no turn: a support's radial stiffness stays in D.
"""

from __future__ import annotations

from math import inf, pi
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Faults, Limit
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.support import Support, held_profiles
from fem.elasticity.torsion import step_wind_up
from gears.closed_form import body_wind_up, inertial_wind_up

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance
    from gears import GearPair

__all__ = ["REFERENCES", "check_reference", "default_reference", "held_turns", "turns"]

REFERENCES = ("body", "bore", "teeth")
"""What a deflection may be measured against."""

INERTIA = Limit(0.0, unit="kg m2", remedy="give what turns with the bore, 0 for nothing")


def turns(
    pair: GearPair,
    supports: tuple[Support, Support],
    reference: str,
    bore_inertia: tuple[float, float] = (0.0, 0.0),
) -> Array:
    """Turn of pinion and wheel along the line of action per force that a deflection holds (2,) [m/N].

    Parameters
    ----------
    pair : gears.GearPair
    supports : (Support, Support)
        How the bores are held. What a rigid hub fills beyond the bore turns with it, and so does its inertia.
    reference : {"bore", "body", "teeth"}
    bore_inertia : (float, float)
        What turns with the bores of pinion and wheel, for "body" [kg m2].
    """
    gear_turns = []
    for gear, profile in enumerate(held_profiles(pair, supports)):
        base, material, width = profile.base_radius, pair.materials[gear], pair.face_widths[gear]
        body = profile.zones, base, PlaneElasticity.of(material, "strain").shear_modulus
        if reference == "teeth":
            turn = 0.0
        elif reference == "bore":
            turn = (body_wind_up(*body) + step_wind_up(profile, width, body[2])) / width
            turn += supports[gear].turn(base)
        else:
            filled = profile.bore_radius**4 - pair.bore_radii[gear] ** 4
            inside = bore_inertia[gear] / (0.5 * pi * material.density * width) + filled
            turn = (inertial_wind_up(*body, inside) + step_wind_up(profile, width, body[2], inside)) / width
        gear_turns.append(turn)
    return np.array(gear_turns)


def held_turns(bodies: PairCompliance) -> tuple[str, tuple[Support, Support]]:
    """What a compliance measures against, and the supports whose turn it holds.

    Without the hub wind-up that is the teeth. Empty where the turn is not alike for all pairs: without coupling it
    goes with each pair's own force.
    """
    supports = bodies.supports
    if "support" in bodies.left_out:
        first, second = (Support(hub_radius=support.hub_radius) for support in supports)
        supports = first, second
    if "coupling" in bodies.left_out:
        return "", supports
    if "hub_windup" not in bodies.left_out:
        return "bore", supports
    sprung = any(support.torsional_stiffness != inf for support in supports)
    return ("" if sprung else "teeth"), supports


def default_reference(bodies: PairCompliance) -> str:
    """What a deflection is measured against unless something else is asked for: the bodies.

    A compliance without hubs or coupling is made to see what these do, and measures its own way ("bore").
    """
    return "body" if held_turns(bodies)[0] == "bore" else "bore"


def check_reference(
    faults: Faults, measured: str, reference: str, bore_inertia: tuple[float, float] = (0.0, 0.0)
) -> None:
    """Note what cannot be measured: `measured` is what a deflection is measured against, empty for nothing common."""
    faults.choice("reference", reference, REFERENCES)
    for name, inertia in zip(("pinion", "wheel"), bore_inertia, strict=True):
        faults.number(f"bore_inertia.{name}", inertia, INERTIA)
    if not measured:
        allowed = "requires a compliance whose coupling and supports' turn are not left out"
        faults.add("reference", repr(reference), allowed, "take the whole compliance")
