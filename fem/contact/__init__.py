"""Loaded contact of all pairs: how contacts share the load over flanks, cells of the face and both sides.

Contacts stay in place or move under their load; couplings, laws and levers are put together and solved.
"""
