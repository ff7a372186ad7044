"""From grid to grid and through time: plans, starts, refinement, the meniscus of a layer, steps."""
