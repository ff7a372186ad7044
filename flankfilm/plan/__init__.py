"""What a scene's tolerance buys: which models it gets, and which part of a run may err by how much."""
