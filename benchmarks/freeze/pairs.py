"""Gear pairs, materials, shafts and oils that several cases compute with."""

from __future__ import annotations

import math

from ehl import LineContact, Lubricant
from gears import BasicRack, Bearing, Gear, GearPair, Lead, Material, Shaft, ShaftSegment, TipRelief

STEEL = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0)
POM = Material(youngs_modulus=2.8e9, poisson_ratio=0.35, density=1410.0)
RPM = math.pi / 30.0
SPEED = 2000 * RPM  # rad/s
TORQUE = 600.0  # N m

PAIR = GearPair(
    Gear(36, bore_radius=0.5 * 33.5e-3), Gear(40, bore_radius=0.5 * 37.5e-3), module=2e-3, face_width=40e-3,
    rack=BasicRack(), material=STEEL,
)  # fmt: skip
RELIEF = TipRelief(amount=15e-6, length=2.5e-3)
RELIEVED = GearPair(
    Gear(36, bore_radius=0.5 * 33.5e-3, tip_relief=RELIEF), Gear(40, bore_radius=0.5 * 37.5e-3, tip_relief=RELIEF),
    module=2e-3, face_width=40e-3, material=STEEL,
).with_backlash(80e-6)  # fmt: skip
SHIFTED = GearPair(
    Gear(17, profile_shift=0.35, bore_radius=8e-3), Gear(29, profile_shift=0.1, bore_radius=12e-3),
    module=3e-3, face_width=25e-3, material=STEEL,
).with_backlash(60e-6)  # fmt: skip
PLASTIC = GearPair(
    Gear(19, profile_shift=0.2),
    Gear(45, profile_shift=-0.1),
    module=1.5e-3,
    face_width=12e-3,
    material=(STEEL, POM),
).with_backlash(100e-6)
SMALL = GearPair(Gear(20), Gear(30), module=2e-3, face_width=20e-3, material=STEEL).with_backlash(100e-6)
CROWNED = GearPair(
    Gear(20, lead=Lead(crowning=8e-6, slope=3e-6)), Gear(30), module=2e-3, face_width=20e-3, material=STEEL
).with_backlash(100e-6)

ENDS = Bearing(0.005, 5e8), Bearing(0.195, 5e8)
SHAFTS = (
    Shaft((ShaftSegment(0.2, 0.02),), ENDS, 0.06, 0.0),
    Shaft((ShaftSegment(0.2, 0.025),), ENDS, 0.15, 0.2),
)

OIL = Lubricant(
    viscosity=0.05, pressure_viscosity=18e-9, density=860.0, temperature=343.15, viscosity_slope=0.042,
    conductivity=0.14, heat_capacity=2000.0, expansion=6.5e-4, eyring_stress=5e6,
)  # fmt: skip
COLD_OIL = Lubricant(viscosity=0.06, pressure_viscosity=22.6e-9, density=910.0)
COLD = LineContact(load=1e5, entrainment=1.0, radius=0.015, reduced_modulus=2.2e11, lubricant=COLD_OIL)
HOT = LineContact(
    load=1e5, entrainment=10.0, sliding=1.0, radius=0.012, reduced_modulus=2.2e11, lubricant=OIL
)
