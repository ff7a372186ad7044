"""A pair: compliance of both gears together, references of the deflection, faces of unequal width.

Nothing here depends on the load but the indentation of two flanks, which belongs to the compliance of a pair.
"""
