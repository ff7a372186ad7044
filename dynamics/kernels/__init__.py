"""Compiled kernels: plain arrays in and out; nothing here checks its input.

Everything is measured in cells: the period is cut into equal cells, time runs from -1/2 to 1/2 in each, and the
speed is W = h V with h the length of a cell in tau. Arrays that travel together:

- `par`, (9 + 2 J + 2 M,): mean stiffness, zeta, F_m, eps, omega, error phase, D, sides with backlash (2 or 1), J;
  amplitudes and phases of J harmonics of the stiffness; amplitudes and phases of the error's harmonics 2 to M + 1.
- `coef`, (2 cells, 4, degree + 1): Taylor coefficients about the middle of a cell of the solutions that pass it
  with (1, 0) and (0, 1), of the forced one that passes it with (0, 0), and of the stiffness times h^2. The first
  `cells` rows hold in contact (y = X -+ D), the others in the dead zone (y = X).
- `edge`, (2 cells, 27): the map over the whole cell, A (4, row by row) and b (2); three factors which bound how far
  y departs from the chord of the cell, factor . (|y|, |W|, 1); the map from the state at the start of the cell to
  that at its middle, C (4) and c (2); three factors which bound how far W departs from its chord; the bounds of y for
  the three solutions alone (3); their values and speeds at the end of the cell (3 + 3).

The region is 1 above D, 0 in the dead zone, -1 below -D; the coordinate y = X - region D belongs to it. With backlash
on both sides and D = 0 there is no region 0; with backlash on one side there is no region -1.
"""
