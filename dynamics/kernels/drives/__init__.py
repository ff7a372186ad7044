"""Compiled kernels of the exact flow in several freedoms: plain arrays in and out; nothing here checks its input.

Everything is measured in cells, as in `dynamics.kernels`, but time runs from 0 to 1 in each and motions are expanded
about where they enter it. The coordinates w are those of `dynamics.model.drive_coordinates`: the first of them is y,
which alone feels the mesh; m is their number. A state in the kernels is (y - region D, w_2, .., w_m) and its speeds.
Arrays that travel together:

- `par`, (9,): places as in `dynamics.kernels`; frequency, D, sides, and the force of y alone are used.
- `systems`, (3, m, m): the stiffness of all but the mesh times h^2; the damping times h in contact and in the dead
  zone, that of the mesh in it.
- `load`, (2 + p, m): the mean force times h^2; the first column of the damping times h, without that of the mesh; then
  directions of p periodic forces, times h^2.
- `series`, (cells, 2 + p, degree + 1): Taylor coefficients about the start of a cell of the mesh stiffness (over the
  mass of y, times h^2), of the error e, and of the periodic forces along their directions.
- `maps`, (2 cells, 2 m + 2, 2 m): the map over the whole cell, A, b and d, transposed: z becomes A z + b + region D d.
  The first `cells` rows hold in contact, the others in the dead zone.
- `reach`, (2 cells, 2 m + 2): factors which bound how far y departs from its chord, reach . (|z|, 1, D).
- `strides`, (cells // STRIDE, 2 m + 2, 2 m + 2 STRIDE), see `tabulating.gather`: the same of so many cells in contact
  at once, for motions that are followed long enough to be worth it; none for others.
"""

STRIDE = 8
"""Cells of a stride."""
