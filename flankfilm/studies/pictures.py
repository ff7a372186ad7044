"""Picture of a study: what its `plot()` returns."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flankfilm import figures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from flankfilm.studies.run import StudyResults


def study(studied: StudyResults) -> Figure:
    """Draw every output against the keys that vary."""
    from flankfilm.studies.files import dataset

    keys = studied.plan.keys[: studied.plan.varied]
    return figures.study(dataset(studied), keys, studied.plan.outputs)
