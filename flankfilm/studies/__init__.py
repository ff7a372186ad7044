"""Studies: a scene over values of its keys, its rows computed side by side and kept."""
