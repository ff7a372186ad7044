"""Many starts carried over whole periods."""

import math

import numpy as np

from dynamics.kernels.compiling import FINE, ZERO, FloatArray, Table, kernel
from dynamics.kernels.flow import iterate


@kernel
def carry(table: Table, states: FloatArray, periods: int) -> int:
    """Replace every state by its image after `periods`; nan where the motion is lost. Returns the lost ones."""
    one, counts, jac = np.zeros((1, 2)), np.zeros((1, 2), dtype=np.int64), np.zeros((3, 2))
    state = np.empty(2)
    lost = 0
    for i in range(len(states)):
        state[0], state[1] = states[i, 0], states[i, 1]
        if iterate(table, state, periods - 1, ZERO, jac, one, counts) == FINE:
            states[i, 0], states[i, 1] = state[0], state[1]
        else:
            states[i, 0] = states[i, 1] = math.nan
            lost += 1
    return lost
