"""The drive train of a pair: shafts, bearings, motor and load, and their reduction to a few modes.

Public, in `flankfilm.coupling`: `SpatialMesh`, `cell_wrenches`, `spatial_mesh`, `PairDrive`, `pair_drive`,
`BearingForces`, `SpatialPair`, `spatial_pair`, `SpatialBearing`, `bearing_stiffness`, `tilting_mesh`,
`LoadTravel`.
"""
