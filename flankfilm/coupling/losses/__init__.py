"""Films with heat: friction, losses and temperatures of the mesh in agreement with the load share.

Public, in `flankfilm.coupling`: `HeatScreen`, `heat_screen`, `hottest_film`, `LossesAlongPath`, `LineLosses`,
`FaceLosses`, `BoundaryBand`, `LossBand`, `MeshLosses`, `mesh_losses`.
"""
