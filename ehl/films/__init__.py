"""Films and the functions that solve for them: smooth and rough, with heat, in time, and their responses."""
