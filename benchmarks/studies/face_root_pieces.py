"""What the section, pieces and places leave open of what free ends do to the root stress of the article's pinion.

Against pieces half as long at the end that grow by two in place of four, elements of 0.7 of theirs, and more places of
loads, with the load at C and 64 cells. Run with ``python benchmarks/studies/face_root_pieces.py`` (two minutes of
processor time).
"""

from __future__ import annotations

import numpy as np
from face_three_dimensions import CELLS, FULL, PAIR

import fem
import fem.influence.fillet_ends as ends
from fem.stress.face_fillets import root_influences

FROM_END = np.array([0.0, 0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0])
"""Places [modules]."""

Z = (np.arange(CELLS) + 0.5) / CELLS - 0.5

LOADS = {
    "even": np.ones(CELLS),
    "sloping": 1.0 - 1.6 * Z,
    "two modules at the end": np.where(Z < -0.4, 1.0, 0.0),
    "the end cell alone": np.eye(CELLS)[0],
}


def tensions(model: str) -> dict[str, np.ndarray]:
    """Greatest tension along the fillet at the places by each load."""
    roots = fem.fillets(PAIR, 0.003)
    over = root_influences(roots, PAIR, model)[0]
    z, rho = FROM_END * PAIR.module - 0.5 * PAIR.face_width, np.array([PAIR.points.C])
    return {
        name: over.tangential(0, rho, FULL * load[None], z)[0, :, 0].max(axis=-1)
        for name, load in LOADS.items()
    }


def compare() -> None:
    """Print what ends do and what is left open of it, in parts of the greatest stress."""
    usual, walls = tensions("free-ends"), tensions("walls")
    half, last = ends.half_face, 0.5 * ends.LAST
    ends.half_face = lambda width, module, *_: half(width, module, last, 2.0)
    ends.SIZES, ends.PLACES, ends.DEGREE = ends.SIZES.scaled(0.7), 10, 7
    fem.forget_gears()
    fine = tensions("free-ends")
    np.set_printoptions(precision=2, suppress=True, linewidth=120)
    print(f"modules from the end: {FROM_END}; below, % of the greatest tension")
    for name, true in fine.items():
        rows = {"tension": true, "free ends do": true - walls[name], "left open": usual[name] - true}
        for what, values in rows.items():
            print(f"{name:24} {what:13} {100 * values / true.max()}")


if __name__ == "__main__":
    compare()
