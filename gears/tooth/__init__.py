"""One gear: rack, profile and fillet, blank, deviations, lead, material, and outlines to draw.

Public, in `gears`: `Blank`, `GearDeviations`, `PitchDeviations`, `GeometryError`, `GeometryWarning`,
`LoadSharingError`, `Alignment`, `Lead`, `LeadTrace`, `ProfileDeviation`, `WearDepth`, `FlankMap`,
`flank_map`, `Gear`, `TipRelief`, `STEEL`, `Material`, `reduced_modulus`, `MATERIALS`, `NamedMaterial`,
`named_material`, `outline`, `ToothProfile`, `ISO_53_A`, `BasicRack`, `Topography`.
"""
