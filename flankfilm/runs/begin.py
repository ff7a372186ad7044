"""What check and run begin with: the same rules, and the same stages."""

from __future__ import annotations

from typing import Any

from flankfilm.building.preflight import refuse
from flankfilm.files.cache import Cache
from flankfilm.processes.progress import Progress, in_steps, silent
from flankfilm.products.catalogue import goals
from flankfilm.scene import Scene
from flankfilm.stages.engine import Engine, Stage


def begin(scene: Scene, cache: Cache, progress: Progress = silent) -> tuple[Engine, tuple[Stage[Any], ...]]:
    """Refuse a scene, or give the engine that computes it and the stages that it wants.

    Parameters
    ----------
    scene : Scene
    cache : Cache
        Of the engine.
    progress : callable
        Called with what is being done, steps done, and steps in all: a step for each stage and two for the files.

    Raises
    ------
    InputError
        With every fault that shows without solving.
    """
    refuse(scene)
    wanted = goals(scene)
    announce = in_steps(progress, len(wanted) + 2)
    return Engine(scene, cache, lambda stage: announce(stage.title), progress=progress), wanted
