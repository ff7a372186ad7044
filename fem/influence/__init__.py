"""One gear, in modules and E*: flexibility of its flanks and stress of its fillets for any load.

Smooth functions over the flank (``series``) from a few finite-element solutions, kept for every pair that has the same
gear.

Public, in `fem`: `ResultStore`, `forget_gears`.
"""
