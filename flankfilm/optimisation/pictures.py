"""Picture of an optimisation: what its `plot()` returns."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flankfilm import figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from flankfilm.optimisation.optimum import Optimum


def optimum(optimised: Optimum) -> Figure:
    """Draw the map where two keys vary, else the points."""
    from flankfilm.figures.optima import can_be_mapped
    from flankfilm.optimisation.files import dataset

    held = dataset(optimised)
    return figures.optimum_map(held) if can_be_mapped(held) else figures.optimum(held)
