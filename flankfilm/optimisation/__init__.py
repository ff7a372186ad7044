"""Looks for the best of a scene's keys within bounds: one figure least, or several traded off."""
