"""Attractors and their basins: boundaries, manifolds, crises and whole diagrams.

Public, in `dynamics`: `BasinResult`, `basins`, `BasinBoundary`, `basin_boundary`, `Crisis`, `boundary_crises`,
`boundary_crisis`, `Diagram`, `diagram`, `edge_saddles`, `ChaosEnd`, `chaos_end`, `Manifold`, `manifold`,
`MultiSweep`, `multi_sweep`.
"""
