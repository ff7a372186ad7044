"""The stage of the load over the face by other models."""

from __future__ import annotations

from flankfilm import coupling
from flankfilm.stages.catalogue import DRY_CYCLE, TEETH, loaded_teeth
from flankfilm.stages.engine import Engine, stage


@stage("load over the face", "load over the face by other models", TEETH, DRY_CYCLE)
def FACE_MODELS(run: Engine) -> coupling.FaceLoadModels:
    """Walls, slices and ISO 6336-1 beside the mesh cycle, of a scene whose load varies along the face."""
    return coupling.face_load_models(loaded_teeth(run), run[DRY_CYCLE])
