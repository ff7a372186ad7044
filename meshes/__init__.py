"""Curved second-order meshes of gears with named boundaries, and files of them for other programs.

gmsh is imported only when something is meshed.
"""

from meshes.annulus import GearMesh, gear_mesh
from meshes.errors import Fault, MeshError
from meshes.outline import Sizes
from meshes.sector import SectorMesh, mesh_sector, refined

__all__ = ["Fault", "GearMesh", "MeshError", "SectorMesh", "Sizes", "gear_mesh", "mesh_sector", "refined"]
