"""From sections of a scene to objects of the solvers, and what a scene would surely fail by."""
