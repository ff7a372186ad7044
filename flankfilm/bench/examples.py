"""What all cases compute: the pair, the contact and the oscillator of the examples."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from dynamics import DriveOscillator, GearOscillator
    from ehl import LineContact
    from gears import GearPair


TORQUE = 600.0
START = (0.5, 0.2)
PERIODS = 5
"""Excitation periods after which states are compared."""
DOMAIN = (-4.0, 1.5)
"""Half-widths on which the film is solved beside the relaxed iteration."""


def example_pair() -> GearPair:
    """Pair 36/40, module 2 mm, face 40 mm, bores of half the root radii: the one of the examples."""
    from gears import Gear, GearPair

    return GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04)


def pitch_point() -> LineContact:
    """Contact of the pair 36/40 at its pitch point, one pair, 600 N m and 2000 rpm."""
    from ehl import LineContact, Lubricant

    oil = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
    return LineContact(load=4.434e5, entrainment=2.579, radius=6.48e-3, reduced_modulus=2.2e11, lubricant=oil)


def contacts_along_path(count: int) -> list[LineContact]:
    """Contacts from A to E with two jumps of the load share."""
    middle = pitch_point()
    return [
        replace(
            middle,
            load=middle.load * (1.0 if abs(s) < 0.3 else 0.5),
            radius=middle.radius * (1.0 - 0.25 * s * s),
            entrainment=middle.entrainment * (1.0 + 0.05 * s),
        )
        for s in np.linspace(-1.0, 1.0, count)
    ]


def oscillator(frequency: float = 0.6) -> GearOscillator:
    """Oscillator whose motion from `START` leaves and meets the flanks in every period."""
    from dynamics import FourierStiffness, GearOscillator

    return GearOscillator(FourierStiffness(1.0, (0.2,), (0.0,)), 0.05, 0.1, 0.2, frequency, half_backlash=0.2)


def drive_train() -> DriveOscillator:
    """Motor, pinion, wheel and load on soft shafts, that leave and meet the flanks in every period."""
    from dynamics import DriveOscillator, FourierStiffness

    mass = np.diag([2.0, 0.9, 1.3, 3.0])
    stiffness = np.array([[0.85, -0.8, 0, 0], [-0.8, 0.8, 0, 0], [0, 0, 0.6, -0.6], [0, 0, -0.6, 0.7]])
    return DriveOscillator(
        mass=mass,
        damping=0.02 * mass + 0.03 * stiffness,
        stiffness=stiffness,
        direction=[0.0, 1.0, 1.0, 0.0],
        mesh_stiffness=FourierStiffness(1.0, (0.2,), (0.0,)),
        mesh_damping=0.03,
        mean_force=[0.1, 0.0, 0.0, 0.12],
        error_amplitude=0.4,
        frequency=0.9,
        half_backlash=0.15,
    )
