"""Periodic orbits: by Newton's method from a guess, or all those of a region."""
