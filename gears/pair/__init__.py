"""Two gears in mesh: geometry, path of contact, checks, warm gears, inspection, and their shafts.

Public, in `gears`: `GearPair`, `half_width`, `peak_pressure`, `Dimensions`, `dimensions`, `MeshingCheck`,
`check_meshing`, `PathOfContact`, `PathPoints`, `Placement`, `Bearing`, `Shaft`, `ShaftSegment`, `Heat`, `WarmPair`,
`warm_pair`.
"""
