"""Closed forms of the deflection and the root stress of a pair of spur-gear teeth."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
