"""Piecewise-linear oscillators with periodic stiffness and backlash, by their exact flow.

Knows no gears: a Fourier series of stiffness goes in, motions come out; `dynamics.inverse` finds parameters from
their special points. Public names are loaded when first used, so that importing the package costs next to nothing
and compiles nothing.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
