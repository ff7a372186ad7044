"""Results of scenes for the pictures of the documentation, taken from the cache where an earlier run left them."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flankfilm.figures.style import styled
from flankfilm.files.cache import Cache, keep_compiled_code, user_cache

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from flankfilm.scene import Scene
    from flankfilm.stages.engine import Stage

HERE = Path(__file__).parent
EXAMPLES = HERE.parent / "examples"
IMAGES = HERE / "images"


def results(scene: Scene, stages: Sequence[Stage[Any]] = ()) -> xr.Dataset:
    """Give what ``results.nc`` of a scene holds, of some stages alone where they are given; nothing is written."""
    keep_compiled_code()
    from flankfilm.products.catalogue import goals
    from flankfilm.runs.dataset import results_dataset
    from flankfilm.stages.computed import Computed
    from flankfilm.stages.engine import Engine

    engine = Engine(scene, Cache(user_cache() / "results"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a scene's own run shows them
        for stage in stages or goals(scene):
            engine[stage]
    return results_dataset(Computed(scene, engine.results()))


def example(name: str) -> xr.Dataset:
    """Give the results of one of the examples."""
    from flankfilm.scene import read_scene

    return results(read_scene(EXAMPLES / f"{name}.toml"))


def save(drawn: Mapping[str, Figure], dpi: int = 110) -> None:
    """Write figures as ``docs/images/NAME.png``."""
    IMAGES.mkdir(exist_ok=True)
    with styled():
        for name, figure in drawn.items():
            figure.savefig(IMAGES / f"{name}.png", dpi=dpi)
