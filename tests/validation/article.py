"""The pair of the article from which the project starts, its operating point, contacts, and reference numbers.

z 36/40, m 2 mm, b 40 mm, 600 N m and 2000 rpm; bores of half the root radii. Numbers of finite elements are those of
an independent prototype (see test_fem_article_pair), numbers of Ishikawa's formula the article's own.
"""

from __future__ import annotations

from ehl import LineContact, Lubricant
from gears import Gear, GearPair

PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), module=2e-3, face_width=40e-3)
TORQUE = 600.0  # N m, of the pinion
FORCE = 17736.3  # N, along the line of action
FACE = 40e-3  # m
PER_MM_UM = 1e9 * FACE  # N/m of the whole face per N/(mm um)

OIL = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
PITCH = LineContact(load=4.434e5, entrainment=2.579, radius=6.48e-3, reduced_modulus=2.2e11, lubricant=OIL)
"""The contact at the pitch point; E' is the article's 220 GPa."""
SECTION_2_OIL = Lubricant(viscosity=0.06, pressure_viscosity=22.6e-9, density=910.0)
SECTION_2 = LineContact(
    load=1e5, entrainment=1.0, radius=0.015, reduced_modulus=2.2e11, lubricant=SECTION_2_OIL
)
"""The contact of the article's section 2."""

# N/(mm um); one pair at nine equal steps from A to E, then means and greatest values over a base pitch
ISHIKAWA_NINE = (9.41, 11.85, 14.19, 15.95, 16.60, 15.89, 14.09, 11.73, 9.28)
ISHIKAWA_MEAN, ISHIKAWA_GREATEST = 23.44, 26.7
ELEMENTS_NINE = (10.26, 12.39, 13.70, 14.53, 14.83, 14.56, 13.75, 12.45, 10.31)
ELEMENTS_AT_C = ELEMENTS_NINE[4]
ELEMENTS_MEAN_SECANT, ELEMENTS_MEAN = 19.113, 19.758
