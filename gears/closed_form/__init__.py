"""Closed forms of the deflection of a pair of spur-gear teeth."""

from gears.closed_form.contact import hertz
from gears.closed_form.ishikawa import ishikawa
from gears.closed_form.iso6336 import Iso6336Stiffness, iso6336
from gears.closed_form.potential_energy import potential_energy
from gears.closed_form.record import ClosedForm
from gears.closed_form.sainsot import ring_wind_up, sainsot_body
from gears.closed_form.weber_banaschek import weber_banaschek

__all__ = [
    "ClosedForm",
    "Iso6336Stiffness",
    "hertz",
    "ishikawa",
    "iso6336",
    "potential_energy",
    "ring_wind_up",
    "sainsot_body",
    "weber_banaschek",
]
