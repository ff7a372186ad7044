"""The line contact and its equations on one grid: gap, flux, squeeze, heat, and Newton's method.

Closed forms of the same contact stand beside them: formulas of the film thickness, regimes, flash temperature.
"""
