"""Periodic orbits: by Newton's method from a guess, or all those of a region.

Public, in `dynamics`: `find_orbits`, `Orbit`, `find_orbit`.
"""
