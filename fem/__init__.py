"""Elasticity of gear pairs by finite elements: flexibility of flanks, loaded tooth contact, fields.

Nothing heavy is imported before something is computed.
"""

from fem.compliance import Compliance, Cost, compliance, single_pair_stiffness
from fem.contact import MeshCycle, mesh_cycle, torque_sweep
from fem.errors import Fault, FemError
from fem.local_law import Film
from fem.meshing import unloaded_transmission_error

__all__ = [
    "Compliance",
    "Cost",
    "Fault",
    "FemError",
    "Film",
    "MeshCycle",
    "compliance",
    "mesh_cycle",
    "single_pair_stiffness",
    "torque_sweep",
    "unloaded_transmission_error",
]
