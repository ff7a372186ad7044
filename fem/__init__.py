"""Elasticity of gear pairs by finite elements: flexibility, loaded tooth contact, root stress, fields.

Nothing heavy is imported before something is computed.
"""

from fem.bodies import Compliance
from fem.compliance import compliance
from fem.contact import MeshCycle, mesh_cycle, torque_sweep
from fem.cost import Cost
from fem.errors import Fault, FemError
from fem.fillet_influence import Fillets, fillets
from fem.local_law import Film
from fem.meshing import unloaded_transmission_error
from fem.root_stress import RootStress, root_stress
from fem.single_pair import single_pair_stiffness
from fem.support import Support

__all__ = [
    "Compliance",
    "Cost",
    "Fault",
    "FemError",
    "Fillets",
    "Film",
    "MeshCycle",
    "RootStress",
    "Support",
    "compliance",
    "fillets",
    "mesh_cycle",
    "root_stress",
    "single_pair_stiffness",
    "torque_sweep",
    "unloaded_transmission_error",
]
