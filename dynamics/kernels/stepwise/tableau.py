"""Coefficients of the Dormand-Prince scheme of order 8 with its dense output of order 7, as scipy holds them.

Source: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., Springer 1993,
section II.10, doi:10.1007/978-3-540-78862-1. A test checks the order conditions of quadrature and the row sums.
"""

import numpy as np
from scipy.integrate import DOP853

STAGES = 12  # of a step; stage 12 is the slope at its end, 13 to 15 belong to the dense output
C = np.concatenate([DOP853.C, [1.0], DOP853.C_EXTRA])
B, E3, E5 = DOP853.B, DOP853.E3, DOP853.E5  # weights of a step, and of the estimates of orders 3 and 5
A = np.vstack([np.pad(DOP853.A, ((0, 0), (0, 4))), np.pad(B, (0, 4)), DOP853.A_EXTRA])
"""Row s: weights of the earlier slopes in stage s."""
DENSE = DOP853.D
"""The last four of the seven coefficients of the dense output."""
