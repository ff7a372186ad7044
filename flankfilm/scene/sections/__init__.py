"""Sections of the scene file: their keys, each with its unit, range and explanation."""
