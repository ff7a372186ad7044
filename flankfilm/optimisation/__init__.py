"""Looks for the best of a scene's keys within bounds: one figure minimised, or several traded off."""
