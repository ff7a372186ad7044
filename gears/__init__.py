"""Spur-gear geometry, path of contact, load sharing and closed-form tooth deflection; loads numpy only."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
