"""Spur-gear geometry, path of contact, load sharing and closed-form tooth deflection; loads numpy only."""

import lazy_loader as _lazy

from base import show_with as _show_with

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)

_show_with(
    {
        "gears.pair.gear_pair:GearPair": "gears.notebook:pair_html",
        "gears.closed_form.record:ClosedForm": "gears.notebook:closed_form_html",
    }
)
