"""One gear, in modules and E*: how its flanks yield and what its fillets bear, for any load.

Smooth functions over the flank from a few finite-element solutions, kept for every pair that has the same gear.
"""
