"""Two gears in mesh: geometry, path and lines of contact, checks, warm gears, inspection, and their shafts.

Public, in `gears`: `ContactLines`, `contact_lines`, `GearPair`, `half_width`, `peak_pressure`, `Dimensions`,
`dimensions`, `MeshForces`, `mesh_forces`, `MeshingCheck`, `check_meshing`, `PathOfContact`, `PathPoints`, `Placement`,
`Bearing`, `Shaft`, `ShaftSegment`, `Heat`, `WarmPair`, `warm_pair`.
"""
