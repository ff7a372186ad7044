"""Film formulas of line contacts against the solver, over Moes' numbers M and L.

Run with ``OPENBLAS_NUM_THREADS=1 python benchmarks/studies/ehl_formulas.py [FIGURE.png]``; takes about 2 s
without a figure. Errors are formula/solver - 1 of a compressible oil (Roelands, z = 0.68, alpha = 22 /GPa, E' = 220
GPa), and of an incompressible one for the formulas that were fitted to that.
"""

from __future__ import annotations

import sys
import warnings

import numpy as np

from base import RangeWarning
from ehl import (
    LineContact,
    dowson_higginson_minimum,
    dowson_toyoda_central,
    moes_central,
    nijenbanning_line_central,
    pan_hamrock_central,
    pan_hamrock_minimum,
    solve,
)

LOADS = (0.5, 2.0, 5.0, 20.0, 50.0, 200.0, 1000.0)
LUBRICANTS = (1.0, 2.5, 5.0, 10.0, 15.0, 20.0)
FORMULAS = {
    "Dowson-Higginson, minimum": (dowson_higginson_minimum, "minimum_thickness", True),
    "Dowson-Toyoda, central": (dowson_toyoda_central, "central_thickness", True),
    "Pan-Hamrock, minimum": (pan_hamrock_minimum, "minimum_thickness", True),
    "Pan-Hamrock, central": (pan_hamrock_central, "central_thickness", True),
    "Moes, central": (moes_central, "central_thickness", False),
    "Nijenbanning-Venner-Moes, long ellipse": (nijenbanning_line_central, "central_thickness", False),
}


def errors() -> dict[str, np.ndarray]:
    """Return formula/solver - 1 by M (rows) and L (columns)."""
    found = {name: np.empty((len(LOADS), len(LUBRICANTS))) for name in FORMULAS}
    for i, M in enumerate(LOADS):
        for j, L in enumerate(LUBRICANTS):
            films = {}
            for compressible in (True, False):
                films[compressible] = solve(LineContact.from_moes(M, L, compressible=compressible))
            for name, (formula, figure, compressible) in FORMULAS.items():
                film = films[compressible]
                found[name][i, j] = formula(film.contact) / getattr(film, figure) - 1.0
    return found


def table(found: dict[str, np.ndarray]) -> None:
    for name, values in found.items():
        print(f"\n{name}: per cent, M down, L across")
        print("       " + "".join(f"{L:8g}" for L in LUBRICANTS))
        for M, row in zip(LOADS, values, strict=True):
            print(f"{M:7g}" + "".join(f"{100 * value:8.1f}" for value in row))


def figure(found: dict[str, np.ndarray], path: str) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    drawing, axes = plt.subplots(2, 3, figsize=(11, 6), sharex=True, sharey=True, layout="constrained")
    for ax, (name, values) in zip(axes.flat, found.items(), strict=True):
        shade = ax.pcolormesh(
            LUBRICANTS, LOADS, 100 * values, vmin=-30, vmax=30, cmap="RdBu_r", shading="nearest"
        )
        ax.set(title=name, yscale="log", xlabel="L", ylabel="M")
    drawing.colorbar(shade, ax=axes, label="formula over solver - 1 [%]")
    drawing.savefig(path, dpi=120)


def main() -> None:
    warnings.simplefilter("ignore", RangeWarning)
    found = errors()
    table(found)
    if len(sys.argv) > 1:
        figure(found, sys.argv[1])


if __name__ == "__main__":
    main()
