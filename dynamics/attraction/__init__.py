"""Attractors and what starts reach them: basins, boundaries, manifolds, crises and whole diagrams."""
