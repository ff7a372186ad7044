"""Curved second-order meshes of gears with named boundaries, and files of them for other programs.

Nothing is imported before it is used; gmsh only when something is meshed.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
