"""Lubricated mesh cycle, oscillator of a pair, jump speeds, verification: plain SI arguments in, records out.

Knows no scene and no files. Start with :func:`lubricated_cycle`.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
