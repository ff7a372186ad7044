"""One plot function for each kind of result; each takes a dataset of results and returns a matplotlib figure.

The report and the documentation draw with the same functions. ``results.nc``, ``study.nc``, ``optimum.nc`` and
``verify.nc`` hold all that they need, so that any figure can be drawn again in a style of one's own.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
