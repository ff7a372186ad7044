"""Picture of a run: what its `plot()` returns."""

from __future__ import annotations

from typing import TYPE_CHECKING

from base import InputError
from flankfilm import figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from flankfilm.outcome.results import Results

MAIN = (
    ("diagram_force_factor", figures.diagram),
    ("sweep_frequency", figures.resonance),
    ("spectrum_force", figures.spectrum),
    ("film_central_thickness", figures.film_along_path),
    ("dry_secant_stiffness", figures.mesh_stiffness),
    ("single_pair_rho1", figures.single_pairs),
    ("outline_pinion", figures.gears_in_mesh),
)
"""A variable of ``results.nc``, and the picture of a run that has it; the first one that is there counts."""


def results(run: Results) -> Figure:
    """Draw what a run went furthest for: motion, films, stiffness, teeth."""
    for name, draw in MAIN:
        if name in run.dataset:
            return draw(run.dataset)
    raise InputError.at(
        "Results.plot", run.title, "has nothing to draw", "The scene's wants decide what is computed"
    )
