"""The mesh cycle: deflection and stiffness over the positions, events between them, figures and errors.

`mesh_cycle` stands here, with the record that it returns.

Public, in `fem`: `FaceLoads`, `LineLoads`, `mesh_cycle`, `MeshCycle`.
"""
