"""Two published ratings: a listing of a helical pair, z 24/95, and ISO/TR 6336-30 example 1 as an open program has it.

The listing prints no sizes of its wheel's web. Its C_R 0.898 is met by a web that was chosen for it, and its reduced
mass, 0.36503 kg/mm, is taken as given.
"""

from __future__ import annotations

import math
import warnings

import pytest

from gears import BasicRack, Blank, Gear, GearPair
from gears.rating import RatedSteel

CASE_HARDENED = (RatedSteel("Eh", 1500e6, 430e6),) * 2
RPM = math.pi / 30.0


def listing() -> GearPair:
    web = Blank(rim_thickness=42e-3, web_thickness=0.3948 * 0.36)
    tip = -0.938 / 14.0
    pinion = Gear(24, 0.48, tip_alteration=tip)
    wheel = Gear(95, 0.6691, tip_alteration=tip, blank=web)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the printed centre distance is rounded by 0.1 um
        return GearPair(pinion, wheel, 14e-3, 0.36, centre_distance=0.861, helix_angle=math.radians(10.0))


def report_30() -> GearPair:
    rack = BasicRack(h_aP=1.0, h_fP=1.4, rho_fP=0.39)
    beta = math.radians(15.8)
    return GearPair(Gear(17, 0.145), Gear(103), 8e-3, 0.1, rack, centre_distance=0.5, helix_angle=beta)


def printed(value: float, digits: int) -> object:
    """What rounds to a printed value."""
    return pytest.approx(value, abs=0.5 * 10.0**-digits)
