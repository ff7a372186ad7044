"""Attractors and their basins: boundaries, manifolds, crises and whole diagrams."""
