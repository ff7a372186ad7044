"""Branches of periodic orbits over a parameter, their special points, and loci of these over two."""
