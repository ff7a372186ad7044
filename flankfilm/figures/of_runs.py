"""Pictures of runs, studies and optimisations: what their `plot()` returns."""

from __future__ import annotations

from typing import TYPE_CHECKING

from base import InputError
from flankfilm import figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from flankfilm.optimisation.optimum import Optimum
    from flankfilm.results import Results
    from flankfilm.studies.run import StudyResults

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


def study(studied: StudyResults) -> Figure:
    """Draw every output against the keys that vary."""
    from flankfilm.studies.files import dataset

    keys = studied.plan.keys[: studied.plan.varied]
    return figures.study(dataset(studied), keys, studied.plan.outputs)


def optimum(optimised: Optimum) -> Figure:
    """Draw the map where two keys vary, else the points."""
    from flankfilm.figures.optima import can_be_mapped
    from flankfilm.optimisation.files import dataset

    held = dataset(optimised)
    return figures.optimum_map(held) if can_be_mapped(held) else figures.optimum(held)
