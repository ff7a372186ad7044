"""How pairs of teeth share the load, and smooth curves over the mesh cycle between its events.

Public, in `gears`: `LoadShare`, `independent_pairs`, `share_load`.
"""
