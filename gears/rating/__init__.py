"""Load capacity by standards: load factors, safety against pitting, breakage and scuffing, life under a spectrum."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
