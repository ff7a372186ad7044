"""The lubricant: viscosity and density under pressure and temperature, grades, measured tables.

Public, in `ehl`: `Lubricant`, `MeasuredViscosity`, `Barus`, `ConstantDensity`, `ConstantViscosity`, `DensityLaw`,
`DowsonHigginson`, `Roelands`, `ViscosityLaw`.
"""
