"""Closed forms of the deflection and the root stress of a pair of spur-gear teeth."""

from gears.closed_form.contact import hertz
from gears.closed_form.ishikawa import ishikawa
from gears.closed_form.iso6336 import Iso6336Stiffness, iso6336
from gears.closed_form.iso6336_3 import Iso6336RootStress, RootSection, iso6336_3
from gears.closed_form.iso6336_dynamic import Iso6336DynamicFactor, iso6336_dynamic
from gears.closed_form.potential_energy import potential_energy
from gears.closed_form.record import ClosedForm
from gears.closed_form.sainsot import ring_wind_up, sainsot_body
from gears.closed_form.weber_banaschek import weber_banaschek

__all__ = [
    "ClosedForm",
    "Iso6336DynamicFactor",
    "Iso6336RootStress",
    "Iso6336Stiffness",
    "RootSection",
    "hertz",
    "ishikawa",
    "iso6336",
    "iso6336_3",
    "iso6336_dynamic",
    "potential_energy",
    "ring_wind_up",
    "sainsot_body",
    "weber_banaschek",
]
