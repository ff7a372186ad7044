"""Stiffness, oil film and motion of lubricated spur and helical gear pairs; each number with its error and its cost.

With plain arguments: :func:`lubricated_cycle`, :func:`mesh_cycle`, :func:`pair_oscillator`, :func:`jump_speeds`. From
files: :func:`run`, :func:`study`, :func:`optimise`, :func:`verify`. Nothing heavy is imported before it is used.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
