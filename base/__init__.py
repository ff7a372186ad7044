"""Below all packages, on numpy alone: faults and limits, cost, what every result has, whole files, units."""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
