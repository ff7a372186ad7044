from .annulus import GearMesh as GearMesh
from .annulus import gear_mesh as gear_mesh
from .outline import Sizes as Sizes
from .sector import SectorMesh as SectorMesh
from .sector import mesh_sector as mesh_sector
from .sector import refined as refined
