"""Elasticity of gear pairs by finite elements: compliance, loaded tooth contact, root stress, fields.

Nothing is imported before it is used.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
