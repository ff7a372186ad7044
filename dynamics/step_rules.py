"""How long a step along a branch may be: numbers that single steps and many at a time share."""

ITERATIONS = 8  # of Newton's method, at most
EASY = 4  # iterations after which the next step may be longer
LONGER = 1.4  # by how much
ASTRAY = 2.0  # steps from the last point at most
CORNER = 0.9  # least cosine between tangents of neighbours
JUMP = 0.3  # change of the trace at most, over its size or 1
PATIENT = 16.0  # least steps down to which corners and jumps make a step shorter
STRAIGHT = 1e-5  # between neighbours: from there on the difference of their tangents is more than rounding
NEAR = 0.05  # of the orbit's period: how far an extremum may move between neighbours
FALLEN = 1e-3  # of the halves' distance at the last point: Newton's method has come to the orbit of half the period
FAR = 1.02  # squared steps from a place: too far to pass it
