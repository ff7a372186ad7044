"""Elastohydrodynamic line contacts: lubricant, film and film stiffness. Knows no gears.

Start with :class:`Lubricant`, :class:`LineContact` and :func:`solve`.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
