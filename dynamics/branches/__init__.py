"""Branches of periodic orbits over a parameter, their special points, and loci of these over two.

Public, in `dynamics`: `Branch`, `SpecialPoint`, `continue_branch`, `doubled_orbit`, `contact_grazing`,
`continue_locus`, `carried_point`, `special_sensitivities`.
"""
